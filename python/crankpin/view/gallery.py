"""A folder of pages, of every preset, and a page that lists them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from crankpin._support import files
from crankpin.model import presets
from crankpin.view.figures import places
from crankpin.view.page import as_json, document, save_html

HEAD = "<div class='crankpin'><header><h1>Engines</h1></header></div>"


def save_gallery(folder: str | Path, *, rpm: float = 3000.0) -> list[Path]:
    """Write a page of each preset and ``index.html``; return the files.

    Parameters
    ----------
    folder
        Where to write them; it is made if need be.
    rpm
        Crank speed of the pages; engines that turn slowly run at their own.
    """
    root = Path(folder)
    root.mkdir(parents=True, exist_ok=True)
    entries: list[dict[str, Any]] = []
    pages = []
    for name, engine in presets.presets().items():
        speed = presets.usual_speed(name, rpm)
        file = root / f"{name}.html"
        save_html(engine, file, rpm=speed)
        entries.append(
            {
                "href": file.name,
                "figures": places(engine, speed),
                "description": presets.presets().descriptions[name],
            }
        )
        pages.append(file)
    index = root / "index.html"
    call = f"gallery({as_json(entries)});"
    text = document("Engines", ("gallery.mjs",), call, styles=["gallery"], body=HEAD)
    files.write(index, text)
    return [index, *pages]
