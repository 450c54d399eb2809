"""What tests of pictures share: nothing is shown, and no figure is left from another test."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator


@pytest.fixture(autouse=True)
def _clean_pyplot(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """No display, no figures or settings from elsewhere, and a failure for whoever shows one."""
    plt = pytest.importorskip("matplotlib.pyplot")

    def show(*_: object, **__: object) -> None:
        pytest.fail("a plot was shown")

    plt.switch_backend("agg")
    plt.close("all")
    monkeypatch.setattr(plt, "show", show)
    monkeypatch.setattr(plt.Figure, "show", show)
    with plt.rc_context():
        yield
    plt.close("all")
