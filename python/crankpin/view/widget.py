"""The widget in which an engine turns in a notebook; importing this needs anywidget."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

from crankpin._support import optional
from crankpin.view import page
from crankpin.view.figures import Settings, core_numbers, figures

if TYPE_CHECKING:
    from crankpin._support.inputs import Spectrum
    from crankpin.model.engine import Engine

optional.library("anywidget")  # says what to install, as the imports would not

import anywidget  # noqa: E402
import traitlets  # noqa: E402

SETTINGS = tuple(field.name for field in dataclasses.fields(Settings))


class EngineWidget(anywidget.AnyWidget):
    """An engine that turns; made by :meth:`Engine.view`.

    Setting a trait moves the page, and the reader's changes arrive in the traits. Phasors and
    curves of the page are the core's, computed anew whenever a setting changes.
    """

    _esm = page.module("widget.mjs")
    _css = page.style("compact")

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
    """What is held as the bank angle changes: ``"pins"`` or ``"firing"``."""

    def __init__(
        self,
        engine: Engine,
        rpm: float = 3000.0,
        *,
        inertia: float | None = None,
        spectrum: Spectrum | None = None,
        compact: bool = False,
    ) -> None:
        self._engine = engine
        known = figures(engine, rpm, inertia=inertia, spectrum=spectrum, compact=compact)
        self._loads: dict[str, Any] = {"spectrum": spectrum, "inertia": known["flywheel"]}
        super().__init__(**dataclasses.asdict(Settings.of(engine, rpm)))
        self.set_trait("figures", known)
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
