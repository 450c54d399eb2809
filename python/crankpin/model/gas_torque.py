"""Bundled table of gas-torque harmonics of stated cycles.

``gas_torque.csv`` beside this file has it; ``python benchmarks/gas_torque.py`` makes it.
"""

from __future__ import annotations

import csv
import functools
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from crankpin._support.tables import Column, Table
from crankpin.model.computed_cycles import example
from crankpin.model.cycle import Cycle
from crankpin.model.cylinder import Cylinder

TABLE_FILE: Final = Path(__file__).with_name("gas_torque.csv")
ROD_RATIOS: Final = (0.25, 0.3, 0.4)
"""λ = r/l of the table: long rods, cars, large two-strokes."""
HIGHEST_TABULATED: Final = 12
"""Highest order of the table."""
HEADER: Final = (
    ("cycle", ""),
    ("strokes", ""),
    ("rod ratio", ""),
    ("imep", "bar"),
    ("peak pressure", "bar"),
    ("order", ""),
    ("cosine", ""),
    ("sine", ""),
    ("amplitude", ""),
)
"""Columns and their units."""


class Stated(NamedTuple):
    """Engine of a cycle of the table."""

    bore: float
    stroke: float
    figures: dict[str, Any]
    """Arguments of :meth:`Cycle.wiebe`."""


_PETROL, _DIESEL = (example(kind)[1] for kind in ("petrol", "diesel"))
_CAR = (0.086, 0.086)

STATED: Final = {
    "petrol, full load": Stated(*_CAR, _PETROL),
    "petrol, half load": Stated(
        *_CAR, _PETROL | {"intake_pressure": 0.55e5, "start_deg": -24.0, "duration_deg": 60.0}
    ),
    "petrol, idle": Stated(
        *_CAR,
        _PETROL
        | {"intake_pressure": 0.32e5, "start_deg": -28.0, "duration_deg": 75.0, "rpm": 900.0},
    ),
    "diesel, full load": Stated(*_CAR, _DIESEL),
    "diesel, half load": Stated(
        *_CAR, _DIESEL | {"intake_pressure": 1.4e5, "exhaust_pressure": 1.4e5, "excess_air": 2.8}
    ),
    "gas engine, full load": Stated(
        0.17,
        0.21,
        {
            "compression_ratio": 12.5,
            "excess_air": 1.7,
            "stoichiometric_ratio": 17.2,
            "heating_value": 50e6,
            "start_deg": -14.0,
            "duration_deg": 52.0,
            "m": 2.2,
            "gamma": 1.32,
            "intake_pressure": 2.9e5,
            "exhaust_pressure": 2.7e5,
            "charge_temperature": 345.0,
            "wall_temperature": 450.0,
            "rpm": 1500.0,
        },
    ),
    "slow two-stroke diesel, full load": Stated(
        0.5,
        2.0,
        {
            "compression_ratio": 15.0,
            "excess_air": 2.2,
            "stoichiometric_ratio": 14.5,
            "heating_value": 42.7e6,
            "start_deg": -2.0,
            "duration_deg": 60.0,
            "m": 0.9,
            "gamma": 1.34,
            "intake_pressure": 3.6e5,
            "charge_temperature": 345.0,
            "wall_temperature": 520.0,
            "rpm": 110.0,
            "intake_closes_deg": -100.0,
            "exhaust_opens_deg": 115.0,
            "strokes": 2,
        },
    ),
}
"""Cycles of the table: Wiebe burns of no engine in particular, with wall loss."""


def stated_cycle(name: str, rod_ratio: float) -> tuple[Cycle, Cylinder]:
    """Return a cycle of the table, computed again, and its cylinder."""
    bore, stroke, figures = STATED[name]
    # The mass of the piston is no part of the pressure.
    cylinder = Cylinder(stroke / 2.0, stroke / 2.0 / rod_ratio, 0.0, bore=bore)
    return Cycle.wiebe(cylinder, **figures, name=name), cylinder


def compute() -> Table:
    """Return the table, computed."""
    rows = []
    for name in STATED:
        for rod_ratio in ROD_RATIOS:
            cycle, cylinder = stated_cycle(name, rod_ratio)
            step = 1.0 if cycle.strokes == 2 else 0.5
            orders = np.arange(step, HIGHEST_TABULATED + step, step)
            # Mean torque is imep·A·r over π in a two-stroke, over 2π in a four-stroke.
            mean = cycle.mean_torque(cylinder)
            scale = mean * np.pi * (1 if cycle.strokes == 2 else 2)
            before = (
                cycle.strokes,
                rod_ratio,
                cycle.imep(cylinder) / 1e5,
                cycle.pressure.max() / 1e5,
            )
            for order, phasor in zip(
                orders, cycle.torque_harmonics(cylinder, orders) / scale, strict=True
            ):
                figures = (*before, order, phasor.real, -phasor.imag, abs(phasor))
                rows.append([name, *(float(f"{value:.6g}") for value in figures)])
    return _table(rows)


@functools.cache
def gas_torque_harmonics() -> Table:
    """Return the harmonics of gas torque of stated cycles, over imep, orders ½ to 12.

    The torque of one cylinder on the crank is ``imep·A·r`` times its mean (1/2π in a four-stroke,
    1/π in a two-stroke) and the sum over orders of ``cosine·cos kθ + sine·sin kθ``: A the piston's
    area, r the crank radius, θ from the firing top dead centre, pressure against an atmosphere of
    101325 Pa in the crankcase.

    The cycles are Wiebe burns with Woschni's heat loss; their figures are in
    ``crankpin.model.gas_torque.STATED``. The table is licensed as crankpin is, MIT or
    Apache-2.0, and in the package as a CSV of six digits.

    Returns
    -------
    Table
        A row for each cycle and order; the columns ``cosine`` and ``sine`` have no unit.

    Examples
    --------
    >>> import crankpin as cp
    >>> table = cp.gas_torque_harmonics()
    >>> table.header[5:]
    ['order', 'cosine', 'sine', 'amplitude']
    >>> sorted(set(table["cycle"].values))[:2]
    ['diesel, full load', 'diesel, half load']
    """
    with TABLE_FILE.open(encoding="utf-8", newline="") as opened:
        rows = list(csv.reader(line for line in opened if not line.startswith("#")))
    return _table([[name, *map(float, figures)] for name, *figures in rows[1:]])


def _table(rows: list[list[Any]]) -> Table:
    columns = list(zip(*rows, strict=True))
    columns[1] = tuple(int(value) for value in columns[1])
    columns[5] = tuple(int(value) if value % 1 == 0 else value for value in columns[5])
    return Table(
        "Harmonics of gas torque over imep · piston area · crank radius",
        tuple(
            Column(name, values, unit) for (name, unit), values in zip(HEADER, columns, strict=True)
        ),
    )
