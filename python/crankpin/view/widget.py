"""The widget in which an engine turns in a notebook; imports anywidget."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import anywidget
import traitlets

from crankpin.view import page
from crankpin.view.figures import core_numbers, figures
from crankpin.view.settings import Settings

if TYPE_CHECKING:
    from crankpin._support.inputs import Spectrum
    from crankpin.model.engine import Engine

SETTINGS = tuple(field.name for field in dataclasses.fields(Settings))


class EngineWidget(anywidget.AnyWidget):  # type: ignore[misc]
    """An engine that turns; made by :meth:`Engine.view`.

    Changing a trait moves the page, and the reader's changes arrive in the traits. The phasors and
    the curves of the page are the core's, computed anew whenever a setting changes.
    """

    _esm = page.module("widget.mjs")
    _css = page.style()

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
    """What is held as the banks turn."""

    def __init__(
        self,
        engine: Engine,
        rpm: float = 3000.0,
        *,
        reference_z: float | None = None,
        spectrum: Spectrum | None = None,
    ) -> None:
        self._engine = engine
        self._loads: dict[str, Any] = {"reference_z": reference_z, "spectrum": spectrum}
        known = figures(engine, rpm, **self._loads)
        settings = Settings.of(engine, rpm)
        super().__init__(**dataclasses.asdict(settings))
        self.set_trait("figures", known)
        self.observe(lambda _: self._recompute(), names=list(SETTINGS))
        self._recompute()

    @property
    def engine(self) -> Engine:
        """The engine at the present settings."""
        return self._settings().applied(self._engine)

    @traitlets.validate(*SETTINGS)
    def _check(self, proposal: dict[str, Any]) -> Any:  # noqa: ANN401 - of any trait
        """Reject a setting that the engine does not allow, with the library's own message."""
        settings = self._settings(**{proposal["trait"].name: proposal["value"]})
        core_numbers(self._engine, settings, **self._loads)
        return proposal["value"]

    def _settings(self, **changes: Any) -> Settings:  # noqa: ANN401 - of any trait
        return Settings(**{name: getattr(self, name) for name in SETTINGS} | changes)

    def _recompute(self) -> None:
        self.set_trait("core", core_numbers(self._engine, self._settings(), **self._loads))
