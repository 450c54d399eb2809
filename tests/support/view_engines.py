"""Engines that show what a page can draw."""

from __future__ import annotations

import crankpin as cp

from support.engines import CYLINDER


def everything() -> cp.Engine:
    """Return an engine with everything that acts: offset, rod, split pins, weights, shafts."""
    rod = cp.Rod(mass=0.6, inertia=0.0025, length=0.145, to_crankpin=0.05)
    return (
        cp.Engine.vee(
            cp.Cylinder.from_rod(rod, crank_radius=0.043, piston_mass=0.4, pin_offset=-0.004),
            bank_angle_deg="360/7",
            throws_deg=[0, 100, 220],
            spacing=0.1,
            pin_split_deg=13,
            bank_stagger=0.02,
            rotating_mass=0.3,
            first_tdc_deg=17,
            name="Everything",
        )
        .with_counterweights([cp.Unbalance(0.01, -0.05, 77), cp.Unbalance(0.02, 0.1, 180, pin=2)])
        .with_shafts(
            [
                cp.Shaft(-1, [cp.Unbalance(0.01, 0, 30)], x=0.1, y=0.05),
                cp.Shaft(2, [cp.Unbalance(0.003, 0.1, "100/3")], x=-0.1, y=0.02),
            ]
        )
    )


def radial() -> cp.Engine:
    """Return nine cylinders around one crankpin."""
    return cp.Engine.from_lists(
        CYLINDER,
        bank_deg=[90 - 40 * k for k in range(9)],
        pin_deg=[90] * 9,
        z=[0] * 9,
        rotating_mass=0.2,
        name="Radial-9",
    )


def square_four() -> cp.Engine:
    """Return four cylinders on two cranks that turn against each other."""
    return cp.Engine.square_four(cp.Cylinder(0.025, 0.1, 0.25), spacing=0.1, distance=0.12)


def opposed_pistons(upper_radius: float = 0.05) -> cp.Engine:
    """Return three bores with pressure, two pistons in each; one crank leads by 12°."""
    lower, upper = (cp.Cylinder(radius, 0.2, 1.2, bore=0.09) for radius in (0.05, upper_radius))
    cycle = cp.Cycle.wiebe(lower, compression_ratio=14, heat=900, start_deg=-8, strokes=2)
    return cp.Engine.opposed_pistons(
        lower,
        upper=upper,
        throws_deg=[0, 120, 240],
        spacing=0.15,
        distance=0.9,
        lead_deg=12,
        ratio=-1,
        firing_order="1-3-2",
    ).with_cycle(cycle)
