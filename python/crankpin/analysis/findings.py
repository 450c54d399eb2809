"""What each part of an engine adds to an order, and the findings that follow from it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from crankpin.analysis.contributions import contributions, phasors

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from crankpin._support.inputs import Order
    from crankpin.analysis.balance import Balance
    from crankpin.analysis.vanishing import Verdicts

MATTERS = 0.01
"""Orders are mentioned from this part of one piston's first-order force, at the longest lever."""
ROUNDING = 1e-9
"""Phasors that differ by less of the largest are taken for equal."""
REMOVABLE = 2
"""Highest order for which balance shafts are named: faster ones are hardly built."""
FITTED = ("counterweights", "balance shafts")
"""Groups of contributions that are no banks."""


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
        cranks, crank_of = self.engine._core.cranks
        self.ratios = np.array([cranks[each][2] for each in crank_of])
        """Speed of each cylinder's crank over that of the main one: (n_cylinders,)."""
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
        for k, order in enumerate(self.orders):
            acting = {
                group: added[:, k]
                for group, added in self.hardware.items()
                if np.abs(added[:, k]).sum() > MATTERS * self.size
            }
            if not acting:
                continue
            after = np.abs(self.turning[:, k])
            before = np.abs(self.turning[:, k] - sum(acting.values()))
            before[before <= ROUNDING * np.abs(list(acting.values())).max()] = 0.0
            parts = (self.verdicts.forward, self.verdicts.backward)
            gone = [v[order] for v, b, a in zip(parts, before, after, strict=True) if b and not a]
            proved = bool(gone) and all(each == "vanishes" for each in gone)
            values = (*before.tolist(), *after.tolist())
            yield Finding("hardware", self.name, (order,), values, " and ".join(acting), (), proved)

    def shaking(self, k: int) -> Iterator[Finding]:
        """Yield what one order leaves, and what would remove it."""
        order = self.orders[k]
        forward, backward = np.abs(self.turning[:, k]).tolist()
        reason = "together" if self.name == "force" and self._together(k) else ""
        values = (forward, backward, float(self.tilt_deg[k]))
        yield Finding("shakes", self.name, (order,), values, reason)
        if order <= REMOVABLE:
            # A part that would not be mentioned alone is not worth hardware of its own; a weight on
            # a crank turns with it.
            parts = {order: forward, -order: backward}
            worth = [ratio for ratio, part in parts.items() if part > MATTERS * self.size]
            weighed = [ratio for ratio in worth if ratio in {1, *self.ratios.tolist()}]
            ratios = [ratio for ratio in worth if ratio not in weighed]
            weights = "" if not weighed else "counterweights"
            weights += " on other cranks" * (weighed not in ([], [1]))
            kept = sum(part for ratio, part in parts.items() if ratio not in (weighed or worth))
            if worth:
                yield Finding("remedy", self.name, (order,), (kept, *map(float, ratios)), weights)

    def _together(self, k: int) -> bool:
        """Return whether all pistons pull at once, each along its own bore."""
        pulls = self._pulls(k)
        largest = np.abs(pulls).max()
        if len(pulls) < 2 or not largest:
            return False
        return bool(abs(np.abs(pulls).sum() - abs(pulls.sum())) <= ROUNDING * largest)

    def _pulls(self, k: int) -> NDArray[np.complex128]:
        """Return half the pull of each piston along its bore: (n_cylinders,)."""
        along = self.cylinders[:, :, k] * np.exp(-1j * np.radians(self.engine.bank_deg))[:, None]
        # What rotates has no part that turns against its own crank.
        return np.where(self.ratios > 0, along[:, 1].conj(), along[:, 0])

    # --- why orders cancel ----------------------------------------------------------------------

    def cancelling(self, noticed: NDArray[np.bool_]) -> Iterator[Finding]:
        """Yield why orders are zero that the pistons make, those of one reason together."""
        cancelled: dict[tuple[str, tuple[tuple[int, ...], ...], bool], list[Order]] = {}
        for k, order in enumerate(self.orders):
            whole = np.abs(self.cylinders[:, :, k].sum(axis=0)).max()
            if noticed[k] and not self.peaks[k] and whole <= ROUNDING * self._largest(k):
                key = (*self._reason(k), self.verdicts[order] == "vanishes")
                cancelled.setdefault(key, []).append(order)
        for (reason, groups, proved), orders in cancelled.items():
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
        pulls = self._pulls(k)[bank]
        pulls = pulls / np.abs(pulls).max()
        distinct, counts = np.unique(np.round(pulls / pulls[0], 6), return_counts=True)
        same = np.abs(pulls ** len(distinct) - pulls[0] ** len(distinct)).max()
        return self.name == "force" and len(set(counts)) == 1 and bool(same <= 1e-6)

    def _pairs(self, k: int) -> tuple[tuple[int, ...], ...] | None:
        """Return pairs of cylinders that cancel: of one bank, or moments at opposite levers."""
        bank, z = np.array(self.engine._core.bank), self.engine.z - self.engine.reference_z
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
