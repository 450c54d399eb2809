"""Do six engines look as they did?

To keep new pictures on purpose, and look at each: CRANKPIN_KEEP_PICTURES=1 pytest -m '' this file.
"""

from __future__ import annotations

import io
import os
from pathlib import Path
from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from PIL import Image
from support.view_engines import everything, radial

if TYPE_CHECKING:
    from support.chromium import Open

pytestmark = pytest.mark.slow  # a browser

PICTURES = Path(__file__).parent / "pictures"
ENGINES = {
    "i4": (cp.Engine.preset("i4"), "light"),
    "v6-60": (cp.Engine.preset("v6-60"), "dark"),
    "v8-crossplane": (cp.Engine.preset("v8-crossplane"), "light"),
    "w12": (cp.Engine.preset("w12"), "light"),
    "radial": (radial(), "light"),
    "everything": (everything(), "dark"),
}
BLOCK = 8
"""Pixels over which differences are averaged: letters differ between machines, engines must not."""
LARGEST, MEAN = 48.0, 1.0
"""Differences allowed, of 255: in any block, which a line that moves by a pixel stays below and one
that moves by three does not, and on average."""


def blocks(picture: Image.Image) -> np.ndarray:
    """Return the brightness of blocks of pixels."""
    grey = np.asarray(picture.convert("L"), float)
    height, width = (size // BLOCK * BLOCK for size in grey.shape)
    shape = (height // BLOCK, BLOCK, width // BLOCK, BLOCK)
    return np.asarray(grey[:height, :width].reshape(shape).mean(axis=(1, 3)))


@pytest.mark.parametrize("name", ENGINES)
def test_picture_is_as_kept(open_engine: Open, name: str) -> None:
    engine, scheme = ENGINES[name]
    page = open_engine(engine, color_scheme=scheme)
    page.get_by_label("crank angle").fill("40")
    taken = page.locator(".views").screenshot()
    kept = PICTURES / f"{name}.png"
    if os.environ.get("CRANKPIN_KEEP_PICTURES") == "1":
        kept.parent.mkdir(exist_ok=True)
        Image.open(io.BytesIO(taken)).convert("P", palette=Image.Palette.ADAPTIVE, colors=64).save(
            kept, optimize=True
        )
    found, expected = (blocks(Image.open(source)) for source in (io.BytesIO(taken), kept))
    assert found.shape == expected.shape
    difference = np.abs(found - expected)
    assert difference.max() < LARGEST
    assert difference.mean() < MEAN
