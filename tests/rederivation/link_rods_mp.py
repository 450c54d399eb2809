"""Harmonics of link rods in 50 digits: sums of samples of the piston's position.

``python tests/rederivation/link_rods_mp.py`` writes ``tests/data/link_rods_50_digits.csv``.
"""

from __future__ import annotations

from pathlib import Path

import mpmath

TABLE = Path(__file__).parents[1] / "data" / "link_rods_50_digits.csv"
SAMPLES = 1024
"""Of a turn: what they fold back is below 1e-30 of the rods here."""
ORDERS = (1, 2, 3, 4, 5, 6, 8)
RODS = (
    # r/L, r/l, a/r, D, ψ
    (0.33, 0.26, 0.87, 72.0, 72.0),
    (0.33, 0.26, 0.87, 72.0, 79.0),
    (0.33, 0.26, 0.87, -72.0, -79.0),
    (0.33, 0.26, 0.87, 144.0, 140.0),
    (0.33, 0.26, 0.87, 180.0, 180.0),
    (0.33, 0.26, 0.87, 60.0, 67.0),
    (0.33, 0.26, 0.87, 72.0, 72.0 + 2.0**-20),
    (0.33, 0.26, 0.87, 72.0, 72.0 + 2.0**-33),
    (0.33, 0.26, 1e-3, 72.0, 79.0),
    (0.33, 0.26, 1e-9, 72.0, 79.0),
    (0.1, 0.25, 4.0, 20.0, 20.0),
    (0.1, 0.25, 4.0, 20.0, 24.0),
    (0.45, 0.35, 0.5, 90.0, 100.0),
    (0.33, 0.26, 0.87, 0.0, 90.0),
    (0.33, 0.26, 0.87, 0.0, 0.0),
    (0.2, 0.9, 0.3, 120.0, 125.0),
)


def harmonics(figures: tuple[float, ...]) -> list[mpmath.mpc]:
    """Return the harmonics of the force over m·r·ω²."""
    rod, master, knuckle = (mpmath.mpf(figure) for figure in figures[:3])
    bore, angle = (mpmath.radians(mpmath.mpf(figure)) for figure in figures[3:])
    heights, angles = [], [2 * mpmath.pi * k / SAMPLES for k in range(SAMPLES)]
    for theta in angles:
        lean = -mpmath.asin(master * mpmath.sin(theta + bore))
        place = mpmath.expj(theta) + knuckle * mpmath.expj(angle - bore + lean)
        heights.append(place.real + mpmath.sqrt(rod**-2 - place.imag**2))
    pairs = list(zip(heights, angles, strict=True))
    return [
        2
        * n
        * n
        * mpmath.fsum(height * mpmath.expj(-n * theta) for height, theta in pairs)
        / SAMPLES
        for n in ORDERS
    ]


def main() -> None:
    """Write the file."""
    lines = ["rod_ratio,master_ratio,knuckle_ratio,bore_deg,knuckle_deg,order,re,im"]
    with mpmath.workdps(50):
        for figures in RODS:
            for n, value in zip(ORDERS, harmonics(figures), strict=True):
                parts = (
                    mpmath.nstr(mpmath.chop(part, 1e-40), 25) for part in (value.real, value.imag)
                )
                lines.append(",".join([*map(repr, figures), str(n), *parts]))
    TABLE.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
