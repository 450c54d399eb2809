"""A page of each preset, and one that shows and links them all."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from crankpin.model import presets
from crankpin.view import page
from crankpin.view.figures import figures

HEAD = "<div class='crankpin'><header><h1>Engines</h1></header></div>"
EBOOK_RPM = 10.0
"""Speed of the presets with a crank radius of one metre, as in their source."""


def save_gallery(folder: str | Path, *, rpm: float = 3000.0) -> list[Path]:
    """Write a page of each preset and ``index.html``; return the files.

    Parameters
    ----------
    folder
        Where to write them; it is made if need be.
    rpm
        Crank speed of the pages; engines of the e-book, of one metre crank radius, run at 10.
    """
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    listed: list[dict[str, Any]] = []
    files = []
    for name, engine in presets.presets().items():
        speed = EBOOK_RPM if name.endswith(presets.OWN_PARTS) else rpm
        file = place / f"{name}.html"
        page.save_html(engine, file, rpm=speed)
        listed.append(
            {
                "href": file.name,
                "figures": figures(engine, speed, spectrum=None),
                "description": presets.presets().descriptions[name],
            }
        )
        files.append(file)
    index = place / "index.html"
    call = f"gallery({page.as_json(listed)});"
    index.write_text(page.document("Engines", "gallery.mjs", call, HEAD), encoding="utf-8")
    return [index, *files]
