"""What the reader of a page may change in an engine: speed, bank angle, rod ratio."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from crankpin._support import inputs

if TYPE_CHECKING:
    from crankpin.model.engine import Engine, Hold


@dataclasses.dataclass(frozen=True)
class Settings:
    """Settings of a page; their names are those in the page's state and in the widget's traits."""

    rpm: float
    """Crank speed."""
    bank_angle_deg: float | None
    """Angle between the two banks, degrees; None for an engine that has not two."""
    rod_ratio: float | None
    """Crank radius over rod length of all cylinders; None while they differ."""
    hold: Hold = "pins"
    """What is held as the banks turn: ``"pins"`` or ``"firing"``."""

    @classmethod
    def of(cls, engine: Engine, rpm: float) -> Settings:
        """Return the settings that leave an engine as it is."""
        ratios = {cylinder.rod_ratio for cylinder in engine.cylinders}
        return cls(
            rpm=inputs.number("rpm", rpm),
            bank_angle_deg=getattr(engine, "bank_angle_deg", None),
            rod_ratio=ratios.pop() if len(ratios) == 1 else None,
        )

    def check(self, engine: Engine) -> None:
        """Raise an InputError if the engine does not allow these settings."""
        inputs.angular_speed(self.rpm)
        self.applied(engine)

    def applied(self, engine: Engine) -> Engine:
        """Return the engine at these settings.

        Raises
        ------
        InputError
            If the engine has not two banks to set an angle between, the angle is out of range, or
            the crank could not turn.
        """
        changed = engine
        if self.bank_angle_deg is not None:
            changed = changed.with_bank_angle(self.bank_angle_deg, hold=self.hold)
        if self.rod_ratio is None:
            return changed
        ratio = inputs.number("rod_ratio", self.rod_ratio)
        cylinders = [
            cylinder
            if cylinder.rod_ratio == ratio
            else cylinder.replace(rod_length=cylinder.crank_radius / ratio)
            for cylinder in engine.cylinders
        ]
        return changed.replace(cylinder=cylinders)
