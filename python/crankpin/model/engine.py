"""Engines: cylinders on one or several crankshafts, with hardware, gas pressure and loads."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from types import FunctionType
from typing import TYPE_CHECKING, Literal

import numpy as np

from crankpin._support import labels, units
from crankpin._support.drawing import inline_svg
from crankpin._support.frames import Framed
from crankpin._support.parameters import documented
from crankpin._support.record import AbsentError
from crankpin._support.tables import Table
from crankpin.analysis import firing
from crankpin.analysis.balance import Balance, balance
from crankpin.analysis.closed_form import ClosedForm, closed_form
from crankpin.analysis.explain import Explanation, explain
from crankpin.analysis.vanishing import VanishingOrders, vanishing_orders
from crankpin.analysis.waveform import Waveform, waveform
from crankpin.model import shafts as rotating
from crankpin.model.builders import Builders
from crankpin.model.data import EngineData, Hold

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from crankpin._support.inputs import Orders, Spectrum
    from crankpin.analysis.firing import Firing
    from crankpin.model.cylinder import Cylinder
    from crankpin.model.shafts import Shaft, Unbalance
    from crankpin.view.widget import EngineWidget

__all__ = ["Engine", "Hold"]


class Engine(Framed, Builders):
    """Cylinders on one or several crankshafts, with hardware, gas pressure and loads.

    Three lists describe it: the crank angle of each cylinder's top dead centre, the direction of
    its bore and its place along the crank. Made by :meth:`from_lists` from these; by
    :meth:`inline`, :meth:`vee`, :meth:`flat` and :meth:`boxer` from throws; by :meth:`radial`; by
    :meth:`from_firing_order`; by :meth:`preset`; or from a file. An engine does not change;
    :meth:`replace` returns another. Two engines are equal if all their figures, their names and
    their firing orders are.

    Examples
    --------
    >>> import crankpin as cp
    >>> cylinder = cp.Cylinder(crank_radius=0.045, rod_length=0.158, reciprocating_mass=1.487)
    >>> v6 = cp.Engine.vee(
    ...     cylinder, bank_angle_deg=60, throws_deg=[0, 120, 240], pin_split_deg=-60, spacing=0.13,
    ...     firing_order="1-2-3-4-5-6", name="V6",
    ... )
    >>> v6
    V6: 6 cylinders, bank angle 60°
    stroke 0.09 m, rod 0.158 m, reciprocating mass 1.487 kg
    throws 0-120-240°, pins split by -60°
    4-stroke 1-2-3-4-5-6, even, 120°
    cylinder  bank   bore °  TDC °  crankpin °   z m
           1  right      60      0          60     0
           2  left      120    120           0     0
           3  right      60    240         180  0.13
           4  left      120      0         120  0.13
           5  right      60    120         300  0.26
           6  left      120    240         240  0.26
    >>> len(v6), v6.firing().even
    (6, True)
    """

    @classmethod
    @documented()
    def preset(
        cls,
        name: str,
        *,
        cylinder: Cylinder | None = None,
        spacing: float | None = None,
        rotating_mass: ArrayLike | None = None,
        counterweights: Iterable[Unbalance] | None = None,
        shafts: Iterable[Shaft] | None = None,
    ) -> Engine:
        """Return an engine by its name in :func:`crankpin.presets`.

        Parameters
        ----------
        name : str
            Such as ``"v8-crossplane"``.
        cylinder : Cylinder, optional
            Moving parts of all cylinders; by default the preset's.
        spacing : float, optional
            Distance between neighbouring throws, m; by default the preset's.
        rotating_mass : array_like, optional
            … By default the preset's.
        counterweights : sequence of Unbalance, optional
            … By default the preset's.
        shafts : sequence of Shaft, optional
            … By default the preset's.

        Returns
        -------
        Engine
            The engine.

        Raises
        ------
        InputError
            If there is no such preset; the nearest name is suggested.

        Examples
        --------
        >>> import crankpin as cp
        >>> cp.Engine.preset("v8-crossplane").name
        'V8 90°, cross-plane'
        """
        from crankpin.model import presets

        engine = presets.preset(name, cylinder=cylinder, spacing=spacing)
        return engine.replace(
            rotating_mass=rotating_mass, counterweights=counterweights, shafts=shafts
        )

    @property
    def firing_intervals_deg(self) -> NDArray[np.float64]:
        """Crank angles between the firings of ``firing_order``, degrees, one for each that fires.

        Of shape (n_firing,): of an engine with cycles only cylinders that have one fire. Undefined
        if the firing order is not known.
        """
        return self._own_firing("firing_intervals_deg").intervals_deg

    @property
    def fires_evenly(self) -> bool:
        """True if all intervals of ``firing_order`` are equal; undefined if it is not known."""
        return self._own_firing("fires_evenly").even

    def _own_firing(self, name: str) -> Firing:
        if not self.firing_order:
            hint = "give it with replace(firing_order=…), or use firing(…)"
            raise self._undefined(name, f"its firing order is not known; {hint}")
        return self.firing()

    # --- analyses -------------------------------------------------------------------------------

    @documented()
    def balance(
        self,
        rpm: float,
        *,
        orders: Orders = "auto",
        rtol: float | None = None,
        spectrum: Spectrum | None = None,
        torque: bool = True,
    ) -> Balance:
        """Return force, moment and torque at one speed, order by order.

        Moments are about the engine's :attr:`reference_z`; :meth:`Balance.about` moves them.

        Parameters
        ----------
        rpm : float
            Crank speed, rpm.

        Returns
        -------
        Balance
            Phasors and peaks by order, N and N·m.

        Raises
        ------
        InputError
            If an argument is out of range.

        Warns
        -----
        UserWarning
            If pistons are faster than in any engine, as with lengths in millimetres.

        Examples
        --------
        >>> import crankpin as cp
        >>> b = cp.Engine.preset("i4").balance(rpm=6000, orders=[1, 2, 4])
        >>> b.force.shape, b.torque.shape
        ((3, 2), (3,))
        >>> b.force.xy[0]  # an inline-4 has no force of order 1
        array([0.+0.j, 0.+0.j])
        """
        return balance(self, rpm, orders=orders, rtol=rtol, spectrum=spectrum, torque=torque)

    @documented(balance)
    def waveform(
        self,
        rpm: float,
        theta_deg: ArrayLike | None = None,
        *,
        orders: Orders | None = None,
        rtol: float | None = None,
        spectrum: Spectrum | None = None,
        torque: bool = True,
    ) -> Waveform:
        """Return force, moment and torque at given crank angles.

        Forces and moments within the bound of their rounding error are exactly zero.

        Parameters
        ----------
        rpm : float
            Crank speed, rpm.
        theta_deg : array_like, shape (n_theta,), optional
            Crank angles, degrees; by default 0, 1, …, 720.
        orders : number, sequence of numbers or "auto", optional
            None for exact kinematics; numbers, whole or half, for the sum of those orders;
            ``"auto"`` for the few that reach ``rtol``, the rest being in ``omitted`` and
            ``error_bound``.
        rtol : float, optional
            … By default 1e-6.
        spectrum : mapping of int to complex, optional
            …; a spectrum needs ``orders``.
        torque : bool, default True
            …; a spectrum needs ``orders``.

        Returns
        -------
        Waveform
            Force, moment and torque over crank angle, N and N·m.

        Raises
        ------
        InputError
            If an argument is out of range.

        Warns
        -----
        UserWarning
            If pistons are faster than in any engine, or angles seem to be in radians.

        Examples
        --------
        >>> import crankpin as cp
        >>> w = cp.Engine.preset("i4").waveform(rpm=6000, theta_deg=[0, 90, 180])
        >>> w.force.shape
        (3, 2)
        """
        return waveform(
            self, rpm, theta_deg=theta_deg, orders=orders, rtol=rtol, spectrum=spectrum,
            torque=torque,
        )  # fmt: skip

    def firing(
        self, firing_order: str | Iterable[int] | None = None, *, strokes: int | None = None
    ) -> Firing:
        """Return angles and intervals of firing in an order; the most even of several schedules.

        Of an engine with cycles, without arguments, it is the way in which these fire.

        Parameters
        ----------
        firing_order : str or sequence of int, optional
            Cylinder numbers, as ``"1-8-4-3-6-5-7-2"`` or a list, beginning with any of them. In
            text, ``+`` joins cylinders that fire together: ``"1+4-2+3"``. By default the engine's
            ``firing_order``.
        strokes : {4, 2}, optional
            4, or 2 for a cycle in each turn; by default the engine's ``strokes``.

        Returns
        -------
        Firing
            The firing: angles and intervals, degrees.

        Raises
        ------
        InputError
            If the crank does not allow this order (the message has those it does allow), or none is
            given nor known.

        Examples
        --------
        >>> import crankpin as cp
        >>> cp.Engine.preset("v6-90-odd-fire").firing()
        <Firing 4-stroke 1-6-5-4-3-2, 150-90-150-90-150-90°>
        """
        return firing.firing(self, firing_order, strokes)

    @documented(firing)
    def firing_schedules(
        self, firing_order: str | Iterable[int] | None = None, *, strokes: int | None = None
    ) -> tuple[Firing, ...]:
        """Return every schedule of firing in this order, the most even first.

        Empty if the crank does not allow the order. There are several where the order follows the
        top dead centres of one turn, so that the next turn may begin after any cylinder.

        Returns
        -------
        tuple of Firing
            All ways, the most even first.

        Raises
        ------
        InputError
            If the order is none of these cylinders, or none is given nor known.

        Examples
        --------
        >>> import crankpin as cp
        >>> for f in cp.Engine.preset("i2-180").firing_schedules("1-2"):
        ...     print(f)
        <Firing 4-stroke 1-2, 180-540°>
        <Firing 4-stroke 1-2, 540-180°>
        """
        return firing.firings(self, firing_order, strokes)

    def firing_orders(self, *, strokes: int | None = None) -> tuple[Firing, ...]:
        """Return every schedule of firing, the most even first.

        In a four-stroke each cylinder but the first fires in either of two turns: 2ⁿ⁻¹ ways, for up
        to 16 cylinders. Cylinders at top dead centre together may fire together.

        Parameters
        ----------
        strokes : {4, 2}, optional
            4, or 2 for a cycle in each turn; by default the engine's ``strokes``.

        Returns
        -------
        tuple of Firing
            All ways, the most even first.

        Raises
        ------
        InputError
            If a four-stroke has more than 16 cylinders; give an order to :meth:`firings` then.

        Examples
        --------
        >>> import crankpin as cp
        >>> for f in cp.Engine.preset("i4").firing_orders()[:3]:
        ...     print(f)
        <Firing 4-stroke 1-2-4-3, even, 180°>
        <Firing 4-stroke 1-3-4-2, even, 180°>
        <Firing 4-stroke 1-2+3-4, 180-0-180-360°>
        """
        return firing.firing_orders(self, strokes)

    def vanishing_orders(
        self, orders: Orders = range(1, 13), *, reference_z: float | None = None
    ) -> VanishingOrders:
        """Return which orders of force, moment and torque vanish at any speed, proved in integers.

        Parameters
        ----------
        orders : number or sequence of numbers, optional
            Multiples of crank speed; by default 1 to 12. Half orders are those of gas and need
            the engine's firing order.
        reference_z : float, optional
            Plane about which moments are taken, m; by default the engine's own
            :attr:`reference_z`.

        Returns
        -------
        VanishingOrders
            A verdict for each order and sum.

        Raises
        ------
        InputError
            If an argument is out of range, or a half order is given and the firing order unknown.

        Examples
        --------
        >>> import crankpin as cp
        >>> cp.Engine.preset("i6").vanishing_orders().force.vanishing
        (1, 2, 3, 4, 5, 7, 8, 9, 10, 11)
        """
        return vanishing_orders(self, orders, reference_z=reference_z)

    @documented(vanishing_orders)
    def closed_form(
        self,
        order: int,
        quantity: Literal["force", "moment"] = "moment",
        *,
        reference_z: float | None = None,
    ) -> ClosedForm:
        """Return force or moment of one order as exact expressions (needs SymPy).

        Parameters
        ----------
        order : int
            Whole multiple of crank speed.
        quantity : {"force", "moment"}, default "moment"
            ``"force"`` or ``"moment"``.

        Returns
        -------
        ClosedForm
            SymPy expressions and their values.

        Raises
        ------
        InputError
            If angles are no rational parts of a turn, masses or places no rational multiples of
            each other, or slider-cranks of different proportions.
        ImportError
            If SymPy is not installed.

        Examples
        --------
        >>> import crankpin as cp
        >>> cp.Engine.preset("i3").closed_form(1).peak
        sqrt(3)*F*a
        """
        return closed_form(self, order, quantity, reference_z=reference_z)

    def explain(self, rpm: float | None = None) -> Explanation:
        """Return how the engine shakes, in plain sentences.

        Parameters
        ----------
        rpm : float, optional
            Crank speed, rpm, for figures in N and N·m; by default they are relative to the
            first-order force of one piston.

        Returns
        -------
        Explanation
            The sentences, and what they say as data.

        Raises
        ------
        InputError
            If an argument is out of range.

        Examples
        --------
        >>> import crankpin as cp
        >>> cp.Engine.preset("i4").explain(rpm=6000).sentences[0]
        'Order 2 leaves a shaking force of 9.27 kN, up and down: all four pistons pull together.'
        """
        return explain(self, rpm)

    # --- pages ----------------------------------------------------------------------------------

    @documented(balance)
    def view(
        self,
        rpm: float = 3000.0,
        *,
        inertia: float | None = None,
        spectrum: Spectrum | None = None,
        compact: bool = False,
        controls: str | Sequence[str] | None = None,
    ) -> EngineWidget:
        """Return the turning engine as a widget for notebooks (needs anywidget).

        Its traits ``angle_deg``, ``rpm``, ``bank_angle_deg``, ``rod_ratio`` and ``hold`` move the
        page when they are set, and follow its reader.

        Parameters
        ----------
        rpm : float, default 3000.0
            Crank speed at first, rpm.
        inertia : float, optional
            Of a fired engine, the moment of inertia of all that turns with the crank, kg·m², as in
            :func:`crankpin.flywheel`; by default that with which the speed varies by 1 % at
            ``rpm``.
        spectrum : mapping of int to complex, optional
            … The page has no torque then.
        compact : bool, default False
            Whether to show the cross-section and one vector alone, with three controls: for a
            lecture, 640 by 360 pixels.
        controls : str or sequence of str, optional
            Names of the controls that are shown, in this order, or one name: ``"crank_angle"``,
            ``"rpm"``, ``"rod_ratio"``, ``"bank_angle"``, ``"rocking"``, ``"sound"``, and ``"view"``
            for the choices above the pictures. ``"none"`` or an empty sequence leaves the pictures
            alone, in which the crank can still be turned. By default all that the page has.

        Returns
        -------
        EngineWidget
            A widget of anywidget.

        Raises
        ------
        InputError
            If an argument is out of range.
        ImportError
            If anywidget is not installed.
        """
        from crankpin.view.widget import EngineWidget

        return EngineWidget(
            self, rpm, inertia=inertia, spectrum=spectrum, compact=compact, controls=controls
        )

    @documented(view)
    def save_html(
        self,
        path: str | Path,
        rpm: float = 3000.0,
        *,
        inertia: float | None = None,
        spectrum: Spectrum | None = None,
        compact: bool = False,
        controls: str | Sequence[str] | None = None,
    ) -> None:
        """Write the turning engine as a self-contained page for browsers.

        Parameters
        ----------
        path : str or pathlib.Path
            Name of the file, which ends in ``.html``.
        compact : bool, default False
            …; a compact page fills its window, such as a frame on a slide.

        Raises
        ------
        InputError
            If an argument is out of range, or the name ends otherwise.
        OSError
            If the file cannot be written.
        """
        from crankpin.view.page import save_html

        save_html(
            self,
            path,
            rpm=rpm,
            inertia=inertia,
            spectrum=spectrum,
            compact=compact,
            controls=controls,
        )

    # --- text and pictures ----------------------------------------------------------------------

    @property
    def table(self) -> Table:
        """Table of the cylinders."""
        names = {number: name for name, numbers in self.banks.items() for number in numbers}
        columns = {
            ("bore", "°"): self.bank_deg,
            ("TDC", "°"): self.tdc_deg,
            ("crankpin", "°"): self.pin_deg,
            ("z", "m"): self.z,
        }
        if self.rotating_mass.any():
            columns["rotating mass", "kg"] = self.rotating_mass
        numbered = [(number, names[number]) for number in range(1, len(self) + 1)]
        rows = np.stack(list(columns.values()), axis=1)
        title = units.joined("\n", self._summary())
        return Table.from_rows(title, ["cylinder", "bank", *columns], numbered, rows)

    def _summary(self) -> list[str]:
        """Return the lines above a table of the engine."""
        count, angle = len(self.banks), getattr(self, "bank_angle_deg", None)
        if angle is not None:
            banks = f"bank angle {angle:.6g}°"
        else:
            banks = f"{count} banks" if count > 1 else f"bores at {self.bank_deg[0]:.6g}°"
        name = labels.one_line(self.name) or "Engine"
        return [
            f"{labels.cut(name)}: {len(self)} cylinder{'s' * (len(self) > 1)}, {banks}",
            *(
                labels.cut(line, 100)
                for line in (
                    self._parts_text(),
                    self._throws_text(),
                    self.firing().summary if self.firing_order else "",
                    *rotating.lines(self._core),
                    self._gas_text(),
                )
                if line
            ),
        ]

    def _gas_text(self) -> str:
        """Return what is known of the pressure in the cylinders."""
        if self.crankcase is None or not self.fired:
            return ""
        return units.Text(self.loads_counted, "; crankcase ", units.figure(self.crankcase, "Pa", 6))

    def _parts_text(self) -> str:
        """Return stroke, rod and reciprocating mass of the cylinders, as ranges if they differ."""
        parts = np.array(self._core.cylinders)[:, :3] * [2.0, 1.0, 1.0]
        stroke, rod, mass = (
            units.figure(least, unit, 6, most)
            for least, unit, most in zip(
                parts.min(axis=0).tolist(),
                ("m", "m", "kg"),
                parts.max(axis=0).tolist(),
                strict=True,
            )
        )
        rod = units.Text("rod ", rod)
        rod = units.Text("infinite rod") if np.isinf(parts[:, 1]).all() else rod
        return units.Text("stroke ", stroke, ", ", rod, ", reciprocating mass ", mass)

    def _throws_text(self) -> str:
        """Return throws and pin split, where they are defined."""
        throws = ""
        try:
            throws = "throws " + "-".join(f"{angle:.6g}" for angle in self.throws_deg) + "°"
            splits = self.pin_split_deg
        except AbsentError:
            return throws if len(self.banks) == 1 else ""
        if not splits.any():
            return f"{throws}, shared pins"
        texts = [f"{split:.6g}" for split in splits]
        return f"{throws}, pins split by {texts[0] if len({*texts}) == 1 else ', '.join(texts)}°"

    def _repr_html_(self) -> str:
        """Return a picture above the table, where matplotlib is installed."""
        table, picture = super()._repr_html_() or "", self._picture()
        return table if picture is None else f"<div>{picture}</div>{table}"

    def _picture(self) -> str | None:
        return inline_svg(self)


# Errors of arguments name what people call.
for _base in (EngineData, Builders):
    for _name, _member in vars(_base).items():
        _function = getattr(_member, "__func__", _member)
        if isinstance(_function, FunctionType):
            _function.__qualname__ = f"{Engine.__name__}.{_name}"
