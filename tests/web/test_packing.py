"""Does the workbench unpack, to the byte, what its build packs?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.building import SITE, builder

if TYPE_CHECKING:
    from pathlib import Path

    from support.chromium import Open

pytestmark = pytest.mark.slow  # a browser

KEPT = "globalThis.begin = (bytes) => { globalThis.kept = [...bytes]; };"
"""What the workbench's modules do there."""


def noise(count: int, most: int = 256) -> bytes:
    return np.random.default_rng(5).integers(0, most, count).astype(np.uint8).tobytes()


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\0",
        bytes(range(256)) * 3,
        b"ab" * 40_000,  # the longest matches, and the nearest
        noise(30_000),  # literals
        noise(30_000, 3),  # short matches, repeated ones and bytes at the last distance
        noise(300_000, 16) + noise(70_000, 200) + noise(300_000, 16),  # distances of all lengths
        (SITE / "build.py").read_bytes(),
    ],
    ids=["none", "zero", "all", "runs", "noise", "few", "far", "text"],
)
def test_bytes_come_out_as_they_went_in(open_file: Open, tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "page.html"
    file.write_bytes(builder().unpacking([("script", "", "", KEPT)], content).encode())
    page = open_file(file)
    page.wait_for_function("globalThis.kept")
    assert bytes(page.evaluate("kept")) == content
    assert KEPT in page.locator("head script").all_text_contents()


def test_what_is_packed_is_valid_html() -> None:
    """Browsers read neither zero nor carriage return as written, and end a script at a tag."""
    letters = builder().packed(noise(100_000))
    assert not set("\0\r<") & set(letters)
    assert max(letters) <= "\xff"
    # Noise, which LZMA makes a seventieth longer, and 3 letters of 128 take two bytes.
    assert len(letters.encode()) < 8 / 7 * (1 + 3 / 128) * (1 + 1 / 70) * 100_000
