"""Random engines with several cranks, for tests to share."""

from __future__ import annotations

from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

RATIOS = (1, -1, 2, -2)


class Draft:
    """The lists of an engine with several cranks, which a law changes before it is built."""

    def __init__(self, seed: int, *, ratios: Sequence[int] = RATIOS, offset: bool = True) -> None:
        """Draw cylinders, some of them dead, on a main crank and up to three more.

        Parameters
        ----------
        seed
            Seed of the drawing.
        ratios
            Speeds of the further cranks over that of the main one.
        offset
            Whether pistons may have pin offsets and rods inertia.
        """
        random = np.random.default_rng(seed)
        others = int(random.integers(1, 4))
        self.cranks = [(0.0, 0.0, 1)] + [
            (*random.uniform(-0.3, 0.3, 2).tolist(), int(random.choice(ratios)))
            for _ in range(others)
        ]
        count = int(random.integers(1, 7))
        self.crank_of = random.integers(0, others + 1, count).tolist()
        dead = random.random(count) < 0.2
        self.cylinders = [
            cp.Cylinder(
                radius := float(random.uniform(0.02, 0.1)),
                radius * float(random.uniform(2.2, 5.0)),
                0.0 if none else float(random.uniform(0.1, 2.0)),
                radius * float(random.uniform(-0.3, 0.3)) * offset,
                rod_inertia_excess=float(random.uniform(-1e-3, 1e-3)) * offset * (not none),
            )
            for none in dead
        ]
        angles = 15.0 * random.integers(0, 24, (2, count))
        odd = random.random((2, count)) < 0.3
        self.tdc_deg, self.bank_deg = np.where(odd, random.uniform(0, 360, (2, count)), angles)
        self.z = random.uniform(-0.5, 0.5, count)
        self.rotating_mass = random.uniform(0.0, 1.0, count)
        pins = random.integers(1, count + 1, 3).tolist()
        self.weights = [
            cp.Unbalance(
                float(random.uniform(1e-3, 0.02)),
                float(random.uniform(-0.5, 0.5)),
                float(random.uniform(0, 360)),
                pin=pin,
            )
            for pin in pins[: int(random.integers(0, 4))]
        ]
        self.shafts = [
            cp.Shaft(
                int(random.choice([1, -1, 2, -2])),
                [
                    cp.Unbalance(
                        float(random.uniform(1e-3, 0.02)), 0.1, float(random.uniform(0, 360))
                    )
                ],
                x=float(random.uniform(-0.3, 0.3)),
                y=float(random.uniform(-0.3, 0.3)),
            )
            for _ in range(int(random.integers(0, 3)))
        ]
        self.reference_z = 0.07
        # Weights that keep their direction, on cranks that have throws.
        carrying = sorted(set(self.crank_of) - {0})
        self.weights += [
            cp.Unbalance(
                float(random.uniform(1e-3, 0.02)),
                float(random.uniform(-0.5, 0.5)),
                float(random.uniform(0, 360)),
                crank=crank,
            )
            for crank in carrying[: int(random.integers(0, 3))]
        ]

    def engine(self) -> cp.Engine:
        """Return the engine that the lists describe."""
        others = ", ".join(
            f"{{ x = {x!r}, y = {y!r}, ratio = {ratio} }}" for x, y, ratio in self.cranks[1:]
        )
        places = ",\n".join(
            f"{{ tdc_deg = {tdc!r}, bank_deg = {bank!r}, z = {z!r}, rotating_mass = {mass!r}, "
            f"crank = {crank}, cylinder = {{ crank_radius = {c.crank_radius!r}, "
            f"rod_length = {c.rod_length!r}, reciprocating_mass = {c.reciprocating_mass!r}, "
            f"pin_offset = {c.pin_offset!r}, rod_inertia_excess = {c.rod_inertia_excess!r} }} }}"
            for tdc, bank, z, mass, crank, c in zip(
                (float(each) for each in self.tdc_deg),
                (float(each) for each in self.bank_deg),
                (float(each) for each in self.z),
                (float(each) for each in self.rotating_mass),
                self.crank_of,
                self.cylinders,
                strict=True,
            )
        )
        text = f"schema = 1\ncranks = [{others}]\nplacements = [\n{places}\n]\n"
        engine = cp.Engine.from_toml(text).with_counterweights(self.weights)
        return engine.with_shafts(self.shafts).replace(reference_z=self.reference_z)

    def mirrored(self) -> Draft:
        """Return the mirror image in x = 0, each crank and shaft turning the other way.

        Of an engine without cylinders on its main crank, which keeps its sense.
        """
        image = Draft.__new__(Draft)
        image.__dict__.update(self.__dict__)
        image.cranks = [self.cranks[0], *((-x, y, -ratio) for x, y, ratio in self.cranks[1:])]
        image.bank_deg = 180.0 - self.bank_deg
        image.weights = [
            weight.replace(angle_deg=180.0 - float(weight.angle_deg)) if weight.crank else weight
            for weight in self.weights
        ]
        image.shafts = [
            shaft.replace(
                ratio=-shaft.ratio,
                x=-shaft.x,
                unbalances=[
                    each.replace(angle_deg=180.0 - float(each.angle_deg))
                    for each in shaft.unbalances
                ],
            )
            for shaft in self.shafts
        ]
        return image


def random_engine(seed: int, *, ratios: Sequence[int] = RATIOS, offset: bool = True) -> cp.Engine:
    """Return a random engine with several cranks, weights and shafts; see :class:`Draft`."""
    return Draft(seed, ratios=ratios, offset=offset).engine()


def fired_engine(seed: int) -> cp.Engine:
    """Return a random engine on cranks as fast as the main one, with pressure in most cylinders."""
    engine = random_engine(seed, ratios=(1, -1))
    engine = engine.replace(firing_order=engine.firing_orders()[0].order)
    cylinders = [each.replace(bore=0.08) for each in engine.cylinders]
    cycle = cp.Cycle.example("petrol")
    cycles = [None if k % 4 == 3 else cycle for k in range(len(engine))]
    return engine.replace(cylinder=cylinders).with_cycle(cycles)


def size(engine: cp.Engine, rpm: float) -> float:
    """Return what rounding is relative to: Σ m·r·ω² at the levers of all parts, N·m."""
    cranks, crank_of = engine._core.cranks
    axes = np.array([cranks[k] for k in crank_of])
    masses = np.array([c.reciprocating_mass for c in engine.cylinders]) + engine.rotating_mass
    radii = np.array([c.crank_radius for c in engine.cylinders])
    levers = 1.0 + np.abs(engine.z) + np.abs(axes[:, :2]).sum(axis=1)
    found = float((masses * radii * axes[:, 2] ** 2 * levers).sum())
    found += sum(4.0 * each.amount * 2.0 for each in engine.counterweights)
    found += sum(4.0 * each.amount * 2.0 for shaft in engine.shafts for each in shaft.unbalances)
    return (np.pi * rpm / 30.0) ** 2 * (found or 1e-6)
