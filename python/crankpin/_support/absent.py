"""The error of attributes that an object of this kind may lack."""

from __future__ import annotations

from crankpin._core import InputError


class AbsentError(InputError, AttributeError):
    """A quantity that this object does not have; ``hasattr`` is False for it."""
