"""Widgets in which engines turn in a notebook; importing this needs anywidget."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

from crankpin._core import InputError
from crankpin._support import inputs, optional
from crankpin.view import mounted, page
from crankpin.view.figures import Settings, core_numbers, figures

if TYPE_CHECKING:
    from crankpin._support.inputs import Spectrum
    from crankpin.analysis.mounts.powertrain import Powertrain
    from crankpin.model.engine import Engine
    from crankpin.view.figures import Controls

optional.library("anywidget")  # says what to install, as the imports would not

import anywidget  # noqa: E402
import traitlets  # noqa: E402

MODULE, STYLE = page.module("widget.mjs"), page.style("compact", "mounted")
SETTINGS = tuple(field.name for field in dataclasses.fields(Settings))


class EngineWidget(anywidget.AnyWidget):
    """An engine that turns; made by :meth:`Engine.view`.

    Setting a trait moves the page, and the reader's changes arrive in the traits. Phasors and
    curves of the page are the core's, computed anew whenever a setting changes.
    """

    _esm = MODULE
    _css = STYLE

    figures = traitlets.Dict(read_only=True).tag(sync=True)
    """The engine as it was given, for the page."""
    core = traitlets.Dict(read_only=True).tag(sync=True)
    """The core's numbers at the present settings, for the page."""
    angle_deg = traitlets.Float(0.0).tag(sync=True)
    """Crank angle, degrees."""
    rpm = traitlets.Float(0.0).tag(sync=True)
    """Crank speed."""
    bank_angle_deg = traitlets.Float(None, allow_none=True).tag(sync=True)
    """Angle between the two banks, degrees; None for an engine that has not two."""
    rod_ratio = traitlets.Float(None, allow_none=True).tag(sync=True)
    """Crank radius over rod length of all cylinders; None while they differ."""
    hold = traitlets.Enum(["pins", "firing"], "pins").tag(sync=True)
    """Quantity held as the bank angle changes: ``"pins"`` or ``"firing"``."""

    def __init__(
        self,
        engine: Engine,
        rpm: float = 3000.0,
        *,
        inertia: float | None = None,
        spectrum: Spectrum | None = None,
        compact: bool = False,
        controls: Controls = None,
    ) -> None:
        self._engine = engine
        numbers = figures(
            engine, rpm, inertia=inertia, spectrum=spectrum, compact=compact, controls=controls
        )
        self._loads: dict[str, Any] = {"spectrum": spectrum, "inertia": numbers["flywheel"]}
        super().__init__(**dataclasses.asdict(Settings.of(engine, rpm)))
        self.set_trait("figures", numbers)
        self._recompute()
        self.observe(lambda _: self._recompute(), names=list(SETTINGS))

    @property
    def engine(self) -> Engine:
        """The engine at the present settings."""
        return self._settings().applied(self._engine)

    @traitlets.validate(*SETTINGS)
    def _check(self, proposal: dict[str, Any]) -> Any:  # noqa: ANN401 - of any trait
        """Reject a setting that the engine does not allow, with the library's own message."""
        name, value = proposal["trait"].name, proposal["value"]
        self._settings(**{name: value}).check(self._engine)
        return value

    def _settings(self, **changes: Any) -> Settings:  # noqa: ANN401 - of any trait
        return Settings(**{name: getattr(self, name) for name in SETTINGS} | changes)

    def _recompute(self) -> None:
        self.set_trait("core", core_numbers(self._engine, self._settings(), **self._loads))


class PowertrainWidget(anywidget.AnyWidget):
    """A powertrain on its mounts that turns; made by :meth:`Powertrain.view`.

    Setting a trait moves the page, and the reader's changes arrive in the traits. Modes and
    response are the core's, computed anew whenever a mount is moved.
    """

    _esm = MODULE
    _css = STYLE

    figures = traitlets.Dict(read_only=True).tag(sync=True)
    """The powertrain as it was given, for the page."""
    core = traitlets.Dict(allow_none=True, read_only=True).tag(sync=True)
    """The core's numbers at the present settings, for the page; None where there is no answer."""
    angle_deg = traitlets.Float(0.0).tag(sync=True)
    """Crank angle, degrees."""
    rpm = traitlets.Float(0.0).tag(sync=True)
    """Crank speed."""
    order = traitlets.Union([traitlets.Float(), traitlets.Unicode()]).tag(sync=True)
    """Order that moves the block, or ``"all"``."""
    mode = traitlets.Int(None, allow_none=True).tag(sync=True)
    """Mode whose shape is shown, from 0; None for the response."""
    mounts = traitlets.List(traitlets.Dict()).tag(sync=True)
    """Place (``"at"``) and dynamic stiffness (``"stiffness"``) of each mount."""

    def __init__(
        self,
        powertrain: Powertrain,
        rpm: float = 800.0,
        *,
        frequency: float | None = None,
        controls: Controls = None,
    ) -> None:
        self._powertrain, self._frequency = powertrain, frequency
        numbers = mounted.figures(powertrain, rpm, frequency=frequency, controls=controls)
        self._orders: list[Any] = numbers["mounted"]["orders"]
        states = [mounted.placed(mount) for mount in powertrain.mounts]
        order = mounted.largest_order(powertrain, numbers["rpm"])
        super().__init__(rpm=numbers["rpm"], order=order, mounts=states)
        self.set_trait("figures", numbers)
        self._recompute()
        self.observe(lambda _: self._recompute(), names=["rpm", "order", "mounts"])

    @property
    def powertrain(self) -> Powertrain:
        """The powertrain with its mounts as they stand."""
        return mounted.changed(self._powertrain, self.mounts)

    @traitlets.validate("rpm", "order", "mode", "mounts")
    def _check(self, proposal: dict[str, Any]) -> Any:  # noqa: ANN401 - of any trait
        """Reject what the powertrain does not allow, with the library's own message."""
        name, value = proposal["trait"].name, proposal["value"]
        if name == "rpm":
            mounted.speed(value)
        elif name == "order":
            if value not in (*self._orders, "all"):
                orders_text = ", ".join(map(str, self._orders))
                raise inputs.rejected("order", value, f'give "all", or one of {orders_text}')
        elif name == "mode":
            if value is not None and not 0 <= value < 6:
                raise inputs.rejected("mode", value, "give 0 to 5, or None")
        elif name == "mounts":
            mounted.changed(self._powertrain, value)
        return value

    def _recompute(self) -> None:
        try:
            core = mounted.core_numbers(self.powertrain, self.rpm, self.order, self._frequency)
        except InputError:  # The page says that there is no answer.
            core = None
        self.set_trait("core", core)
