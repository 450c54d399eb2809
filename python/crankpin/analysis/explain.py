"""How an engine shakes, as findings: the residual, what cancels and why, and what would help."""

from __future__ import annotations

import html
import itertools
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from crankpin._support import inputs, labels
from crankpin._support.record import Record
from crankpin.analysis.balance import UNIT_RPM, Balance, mean_piston_speed
from crankpin.analysis.contributions import contributions, phasors
from crankpin.analysis.request import Request, engine_core
from crankpin.analysis.sentences import sentence

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from crankpin._support.inputs import Order
    from crankpin.analysis.vanishing import Verdicts
    from crankpin.model.engine import Engine

MATTERS = 0.01
"""Orders are mentioned from this part of one piston's first-order force, at the longest lever."""
ROUNDING = 1e-9
"""Phasors that differ by less of the largest are taken for equal."""
HIGHEST = 12
"""Highest order whose cancelling is explained."""
REMOVABLE = 2
"""Highest order for which balance shafts are named: faster ones are hardly built."""
FITTED = ("counterweights", "balance shafts")
"""Groups of contributions that are no banks."""


def explain(engine: Engine, rpm: float | None = None) -> Explanation:
    """Return the explanation; :meth:`Engine.explain` documents the arguments."""
    speed = inputs.optional_number("rpm", rpm)
    found = Explanation(engine, speed)
    if speed is not None:
        inputs.warn_of_units(mean_piston_speed(engine, speed))
    return found


class Finding(NamedTuple):
    """A fact about an engine, before it is put into words."""

    kind: str
    """``"hardware"``, ``"shakes"``, ``"remedy"``, ``"bob weights"``, ``"cancels"``, ``"rest"``,
    ``"inertia torque"``, ``"gas torque"``, ``"gas orders"``, ``"firing"`` or ``"articulated"``."""
    quantity: str = ""
    """``"force"``, ``"moment"``, or empty."""
    orders: tuple[Order, ...] = ()
    """Orders that it is about."""
    values: tuple[float, ...] = ()
    """Figures: N, N·m and degrees; without a speed forces and moments are over ω²."""
    reason: str = ""
    """Why it is so, or what does it."""
    groups: tuple[tuple[int, ...], ...] = ()
    """Numbers of the cylinders that cancel each other, or share a crankpin."""
    proved: bool = False
    """True if its zeros are proved, as by :meth:`Engine.vanishing_orders`."""


def _of_planes(finding: Finding) -> bool:
    """Return whether a finding is about force or moment."""
    return bool(finding.quantity)


class Explanation(Record):
    """How an engine shakes: a plain sentence for each finding.

    What matters most stands first: what counterweights and shafts do, what shakes and what would
    remove it, what cancels and why, what all other orders add up to, torque and firing. "Exactly
    zero" is said where it is proved. Forces are mentioned from a hundredth of one piston's
    first-order force on, rocking moments from a hundredth of that at the longest lever. ``str()``
    joins the sentences, one a line; Jupyter shows a list.

    Made by :meth:`Engine.explain`.

    Examples
    --------
    >>> import crankpin as cp
    >>> cp.Engine.preset("v8-crossplane").explain(rpm=6000).sentences[0]
    'Order 1 leaves a rocking moment of 2.42 kN·m, constant in size, turning with the crank.'
    """

    engine: Engine
    """The engine."""
    rpm: float | None
    """Crank speed, rpm; None for figures relative to one piston's first-order force."""

    def __post_init__(self) -> None:
        engine_core(self.engine)
        if self.rpm is not None:
            inputs.angular_speed(self.rpm)

    @property
    def sentences(self) -> tuple[str, ...]:
        """Sentences, what matters most first."""
        return tuple(sentence(each, self) for each in self.findings)

    def __str__(self) -> str:
        return "\n".join(self.sentences)

    def __repr__(self) -> str:
        speed = "" if self.rpm is None else f" at {self.rpm:g} rpm"
        return f"{labels.name_of(self.engine)}{speed}\n{self}"

    def _repr_html_(self) -> str:
        return self.html()

    def html(self, most: int | None = None) -> str:
        """Return all sentences, or the first that are about force and moment, as a list in HTML."""
        found = self._found() if most is None else filter(_of_planes, self._found())
        items = (html.escape(sentence(each, self)) for each in itertools.islice(found, most))
        return f"<ul>{''.join(f'<li>{item}</li>' for item in items)}</ul>"

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """What the sentences say, as data."""
        return tuple(self._found())

    def _found(self) -> Iterator[Finding]:
        """Yield the findings, what matters most first."""
        chosen = self._balance(torque=False)
        orders = tuple(sorted({*chosen.orders, *range(1, HIGHEST + 1)}))
        balance, verdicts = chosen._at_orders(orders), self.engine.vanishing_orders(orders)
        force = Sums(balance, "force", self.unit, verdicts.force)
        moment = Sums(balance, "moment", self.unit * self.lever, verdicts.moment)
        both = (force, moment)
        for sums in both:
            yield from sums.of_hardware()
        shaking = [(sums, int(k)) for sums in both for k in np.flatnonzero(sums.shakes)]
        shaking.sort(key=lambda each: -each[0].share(each[1]))
        weights = self._bob_weights()
        for sums, k in shaking:
            for finding in sums.shaking(k):
                yield finding
                if finding.reason == "counterweights":
                    yield from weights  # once
        noticed = np.abs(force.cylinders).sum(axis=(0, 1)) > MATTERS * self.unit
        for sums in both:
            yield from sums.cancelling(noticed)
        rest = tuple(
            float(each.peaks[~each.shakes].sum() + chosen.error_bound[each.name]) for each in both
        )
        yield Finding("rest", "", tuple(orders[k] for _, k in shaking), rest)
        yield from self._torques()
        yield from self._firing()
        yield from self._shared_pins()

    # --- what figures are relative to -----------------------------------------------------------

    def _balance(self, *, torque: bool) -> Balance:
        """Return the balance that findings are read from; over ω² without a speed."""
        request = Request.checked(orders="auto", rtol=None, spectrum=None, torque=torque)
        return Balance(self.engine, UNIT_RPM if self.rpm is None else self.rpm, request)

    @cached_property
    def unit(self) -> float:
        """First-order force of the strongest piston, without pistons of a throw; 0 without both."""
        parts = list(zip(self.engine.cylinders, self.engine.rotating_mass.tolist(), strict=True))
        pistons = max(
            each.reciprocating_mass * each.crank_radius * abs(each.harmonics(1)[0])
            for each, _ in parts
        )
        throws = max(mass * each.crank_radius for each, mass in parts)
        omega = inputs.angular_speed(UNIT_RPM if self.rpm is None else self.rpm)
        return omega**2 * float(pistons or throws)

    @cached_property
    def lever(self) -> float:
        """Longest lever of a cylinder or an unbalance about the reference plane, m."""
        on_shafts = [each for shaft in self.engine.shafts for each in shaft.unbalances]
        places = [*self.engine.z, *(each.z for each in (*self.engine.counterweights, *on_shafts))]
        return float(np.abs(np.array(places) - self.engine.reference_z).max())

    # --- other findings -------------------------------------------------------------------------

    def _bob_weights(self) -> Iterator[Finding]:
        """Yield the bob weight that removes what turns with the crank: half of the pistons'."""
        offset = any(each.pin_offset for each in self.engine.cylinders)
        if not offset and not any(shaft.ratio == 1 for shaft in self.engine.shafts):
            yield Finding("bob weights", "", (1,), (0.5,))

    def _torques(self) -> Iterator[Finding]:
        """Yield the largest orders of roll torque: of inertia, and of gas if it counts."""
        balance = self._balance(torque=True)
        orders, gas = balance.orders, balance.crank_torque.gas
        if (peaks := balance.torque.inertia.peak).any():
            k = int(np.argmax(peaks))
            yield Finding("inertia torque", "", (orders[k],), (float(peaks[k]),))
        if self.engine.fired and (peaks := gas.peak).any():
            largest = [int(k) for k in np.argsort(-peaks)[:2] if peaks[k]]
            values = (gas.mean, *(float(peaks[k]) for k in largest))
            yield Finding("gas torque", "", tuple(orders[k] for k in largest), values)

    def _firing(self) -> Iterator[Finding]:
        """Yield how the engine fires, and the orders of gas torque that this leaves."""
        if not self.engine.firing_order:
            return
        fires = self.engine.firing()
        reason = "evenly" if fires.even else "unevenly"
        yield Finding("firing", "", (), tuple(fires.intervals_deg.tolist()), reason, (fires.order,))
        in_two_turns = 4 * len(self.engine) // self.engine.strokes
        orders = [half / 2 for half in range(1, in_two_turns + 1)]
        gas = self.engine.vanishing_orders(orders).gas_torque
        if not gas.undecided and gas.remaining:
            yield Finding("gas orders", "", gas.remaining, (), reason, proved=True)

    def _shared_pins(self) -> Iterator[Finding]:
        """Yield the rows of a radial, whose articulated rods are not modelled."""
        pins: dict[tuple[float, float], list[int]] = {}
        where = zip(self.engine.z.tolist(), self.engine.pin_deg.round(6).tolist(), strict=True)
        for number, pin in enumerate(where, start=1):
            pins.setdefault(pin, []).append(number)
        rows = tuple(tuple(row) for row in pins.values() if len(row) > 2)
        if rows:
            yield Finding("articulated", "", (), (), "", rows)


class Sums:
    """Force or moment of an engine: its orders, and what each part adds to them."""

    def __init__(self, balance: Balance, name: str, size: float, verdicts: Verdicts) -> None:
        self.name, self.orders, self.size, self.verdicts = name, balance.orders, size, verdicts
        self.engine = balance.engine
        parts = contributions(balance, name)
        self.turning = phasors(balance, name)
        """Forward and backward parts: (2, n_orders), as of contributions."""
        self.tilt_deg = getattr(balance, name).tilt_deg
        self.peaks = balance.read(name, "peak")
        self.shakes = (self.peaks > MATTERS * size) & (self.peaks > 0.0)
        self.cylinders = np.array([each.phasors for each in parts[: len(self.engine)]])
        """What each cylinder adds: (n_cylinders, 2, n_orders)."""
        self.hardware = {
            group: np.sum([each.phasors for each in parts if each.group == group], axis=0)
            for group in FITTED
            if any(each.group == group for each in parts)
        }
        """What counterweights and shafts add: (2, n_orders) each."""

    def share(self, k: int) -> float:
        """Return how large one order is, in units; infinite of shafts without pistons."""
        return float(self.peaks[k]) / self.size if self.size else np.inf

    def of_hardware(self) -> Iterator[Finding]:
        """Yield what counterweights and shafts do: forward and backward, before and after."""
        for group, added in self.hardware.items():
            for k, order in enumerate(self.orders):
                if np.abs(added[:, k]).sum() <= MATTERS * self.size:
                    continue
                after = np.abs(self.turning[:, k])
                before = np.abs(self.turning[:, k] - added[:, k])
                before[before <= ROUNDING * np.abs(added[:, k]).max()] = 0.0
                parts = (self.verdicts.forward, self.verdicts.backward)
                gone = [
                    v[order] for v, b, a in zip(parts, before, after, strict=True) if b and not a
                ]
                proved = bool(gone) and all(each == "vanishes" for each in gone)
                values = (*before.tolist(), *after.tolist())
                yield Finding("hardware", self.name, (order,), values, group, (), proved)

    def shaking(self, k: int) -> Iterator[Finding]:
        """Yield what one order leaves, and what would remove it."""
        order = self.orders[k]
        forward, backward = np.abs(self.turning[:, k]).tolist()
        reason = "together" if self.name == "force" and self._together(k) else ""
        values = (forward, backward, float(self.tilt_deg[k]))
        yield Finding("shakes", self.name, (order,), values, reason)
        if order <= REMOVABLE:
            ratios = [order] * bool(forward and order > 1) + [-order] * bool(backward)
            weights = "counterweights" if forward and order == 1 else ""
            kept = (backward, *map(float, ratios))
            yield Finding("remedy", self.name, (order,), kept, weights)

    def _together(self, k: int) -> bool:
        """Return whether all pistons pull at once, each along its own bore."""
        bores = np.exp(-1j * np.radians(self.engine.bank_deg))
        pulls = self.cylinders[:, 1, k] * bores  # counterweights and throws have no backward part
        largest = np.abs(pulls).max()
        return len(pulls) > 1 and abs(np.abs(pulls).sum() - abs(pulls.sum())) <= ROUNDING * largest

    # --- why orders cancel ----------------------------------------------------------------------

    def cancelling(self, noticed: NDArray[np.bool_]) -> Iterator[Finding]:
        """Yield why orders are zero that the pistons make, those of one reason together."""
        found: dict[tuple[str, tuple[tuple[int, ...], ...], bool], list[Order]] = {}
        for k, order in enumerate(self.orders):
            whole = np.abs(self.cylinders[:, :, k].sum(axis=0)).max()
            if noticed[k] and not self.peaks[k] and whole <= ROUNDING * self._largest(k):
                key = (*self._reason(k), self.verdicts[order] == "vanishes")
                found.setdefault(key, []).append(order)
        for (reason, groups, proved), orders in found.items():
            yield Finding("cancels", self.name, tuple(orders), (), reason, groups, proved)

    def _largest(self, k: int) -> float:
        return float(np.abs(self.cylinders[:, :, k]).max())

    def _zero(self, k: int, members: Sequence[int]) -> bool:
        """Return whether some cylinders cancel each other."""
        sums = self.cylinders[list(members), :, k].sum(axis=0)
        return bool(np.abs(sums).max() <= ROUNDING * self._largest(k))

    def _reason(self, k: int) -> tuple[str, tuple[tuple[int, ...], ...]]:
        """Return why the cylinders' sum is zero, and which cylinders cancel in pairs."""
        if not self._largest(k):
            return "plane", ()
        if (pairs := self._pairs(k)) is not None:
            z = self.engine.z - self.engine.reference_z
            apart = max(abs(z[one - 1] + z[other - 1]) for one, other in pairs)
            mirrored = self.name == "moment" and apart <= ROUNDING * np.abs(z).max()
            return "mirrored" if mirrored else "pairs", pairs
        banks = [[number - 1 for number in bank] for bank in self.engine.banks.values()]
        if not all(self._zero(k, bank) for bank in banks):
            return "between", ()
        return "evenly" if all(self._evenly(k, bank) for bank in banks) else "each", ()

    def _evenly(self, k: int, bank: Sequence[int]) -> bool:
        """Return whether the pistons of a bank pull as strongly, at even intervals."""
        pulls = self.cylinders[bank, 1, k]
        pulls = pulls / np.abs(pulls).max()
        distinct, counts = np.unique(np.round(pulls / pulls[0], 6), return_counts=True)
        same = np.abs(pulls ** len(distinct) - pulls[0] ** len(distinct)).max()
        return self.name == "force" and len(set(counts)) == 1 and bool(same <= 1e-6)

    def _pairs(self, k: int) -> tuple[tuple[int, ...], ...] | None:
        """Return pairs of cylinders that cancel: of one bank, or moments at opposite levers."""
        bank, z = np.array(self.engine.core.bank), self.engine.z - self.engine.reference_z
        far = np.abs(z[:, None] + z) if self.name == "moment" else bank[:, None] != bank
        free = [
            one for one in range(len(z))
            if np.abs(self.cylinders[one, :, k]).max() > ROUNDING * self._largest(k)
        ]  # fmt: skip
        pairs = []
        while free:
            one = free.pop(0)
            others = [each for each in free if self._zero(k, (one, each))]
            if not others:
                return None
            other = others[int(np.argmin(far[one, others]))]
            free.remove(other)
            pairs.append((one + 1, other + 1))
        return tuple(pairs)
