"""Files are written whole or not at all, whatever writes them."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import stat
import sys
import threading
from pathlib import Path
from typing import TYPE_CHECKING

import crankpin as cp
import numpy as np
import pytest
from crankpin import cli
from crankpin._support import files
from support import in_turn
from support.engines import I4

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

posix = pytest.mark.skipif(os.name == "nt", reason="limits, permissions and pipes of POSIX")
CYCLE = cp.Cycle.example()


def shell(*words: str) -> None:
    """Run a command; its error is printed with the name of the file."""
    if code := cli.main(words):
        raise OSError(errno.EFBIG, "failed", words[-1] if code == 2 else "")


WRITERS: dict[str, tuple[str, Callable[[Path], object]]] = {
    "TOML": ("e.toml", I4.save),
    "JSON": ("e.json", I4.save),
    "cycle": ("c.csv", CYCLE.save),
    "cycle, tabs": ("c.tsv", CYCLE.save),
    "table": ("t.csv", I4.balance(3000).table.to_csv),
    "page": ("p.html", I4.save_html),
    "view": ("p.html", lambda file: shell("view", "i4", "--out", str(file))),
    "new": ("n.toml", lambda file: shell("new", "i4", "--force", "--out", str(file))),
    "save": (
        "s.toml",
        lambda file: shell("bob-weight", "v8-crossplane", "--force", "--save", str(file)),
    ),
}
PICTURES: dict[str, tuple[str, Callable[[Path], object]]] = {
    kind: (f"b.{kind}", lambda file: shell("balance", "i4", "--plot", str(file)))
    for kind in ("pdf", "png", "svg")
}


@contextlib.contextmanager
def full_disk(after: int) -> Iterator[None]:
    """Let files grow to so many bytes: further ones are refused as on a full disk."""
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (after, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def check_whole(writer: tuple[str, Callable[[Path], object]], folder: Path, after: int) -> None:
    """Fail to write over a file, and where there is none."""
    name, write = writer
    file = folder / name
    for old in (None, b"old"):
        if old is not None:
            file.write_bytes(old)
        with full_disk(after), pytest.raises(OSError, match=name) as raised:
            write(file)
        assert raised.value.errno == errno.EFBIG
        assert raised.value.filename == str(file)
        assert [each.name for each in folder.iterdir()] == ([] if old is None else [name])
        assert old is None or file.read_bytes() == old
    write(file)
    assert len(file.read_bytes()) > after


@posix
@pytest.mark.parametrize("after", [0, 100])
@pytest.mark.parametrize("what", WRITERS)
def test_a_full_disk_leaves_the_old_file(
    what: str, after: int, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    check_whole(WRITERS[what], tmp_path, after)
    assert capfd.readouterr().err.count(WRITERS[what][0]) in (0, 2)


@posix
@pytest.mark.parametrize("kind", PICTURES)
def test_a_full_disk_leaves_the_old_picture(kind: str, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    check_whole(PICTURES[kind], tmp_path, 100)


def test_nothing_else_in_the_package_writes_files() -> None:
    writes = re.compile(
        r'\.write_(?:text|bytes)\(|open\((?:"[wxa]|.*, "[wxa])|savefig\(path|\.tofile\('
    )
    package = Path(cp.__file__).parent
    found = [
        (file.name, line.strip())
        for file in package.rglob("*.py")
        if file.name != "files.py"
        for line in file.read_text(encoding="utf-8").splitlines()
        if writes.search(line)
    ]
    assert not found


@in_turn("seed", range(30))
def test_what_is_written_reads_back_over_any_old_file(seed: int, tmp_path: Path) -> None:
    rng = np.random.default_rng(seed)
    file = tmp_path / "a"
    if rng.integers(2):
        file.write_bytes(rng.bytes(int(rng.integers(0, 10_000))))
    data = rng.bytes(int(rng.integers(0, 10_000)))
    files.write(file, data)
    assert file.read_bytes() == data
    files.write(file, "°\n\r\n")
    assert file.read_bytes() == "°\n\r\n".encode()
    assert [each.name for each in tmp_path.iterdir()] == ["a"]


@posix
@pytest.mark.parametrize("mode", [0o600, 0o644, 0o664, 0o755])
def test_permissions_stay(mode: int, tmp_path: Path) -> None:
    file = tmp_path / "e.toml"
    I4.save(file)
    plain = tmp_path / "plain"
    plain.touch()
    assert file.stat().st_mode == plain.stat().st_mode
    file.chmod(mode)
    I4.save(file)
    assert stat.S_IMODE(file.stat().st_mode) == mode


@posix
def test_a_link_stays_and_what_it_leads_to_is_written(tmp_path: Path) -> None:
    (tmp_path / "far").mkdir()
    target, link = tmp_path / "far" / "e.toml", tmp_path / "link.toml"
    link.symlink_to(target)
    for _ in range(2):
        I4.save(link)
        assert link.is_symlink()
        assert cp.Engine.load(target) == I4
    assert [each.name for each in (tmp_path / "far").iterdir()] == ["e.toml"]


@posix
def test_pipes_and_devices_are_written_to_as_they_are(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.toml"
    os.mkfifo(pipe)
    found: list[str] = []
    reader = threading.Thread(target=lambda: found.append(pipe.read_text(encoding="utf-8")))
    reader.start()
    I4.save(pipe)
    reader.join()
    assert cp.Engine.from_toml(found[0]) == I4
    assert stat.S_ISFIFO(pipe.stat().st_mode)


@pytest.mark.skipif(sys.platform != "linux", reason="/dev/full is of Linux")
def test_a_device_that_is_full_is_named(tmp_path: Path) -> None:
    link = tmp_path / "full.csv"
    link.symlink_to("/dev/full")
    with pytest.raises(OSError, match=r"No space left on device: .*full\.csv"):
        CYCLE.save(link)


@pytest.mark.parametrize("place", ["missing/e.toml", "folder.toml"])
def test_places_that_take_no_file_are_named(place: str, tmp_path: Path) -> None:
    (tmp_path / "folder.toml").mkdir()
    with pytest.raises(OSError, match=place) as raised:
        I4.save(tmp_path / place)
    assert raised.value.filename == str(tmp_path / place)


def test_a_file_that_may_not_be_written_to_is_not_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "e.toml"
    I4.save(file)
    monkeypatch.setattr(os, "access", lambda *_: False)  # root may write to any
    with pytest.raises(PermissionError, match=r"e\.toml"):
        I4.replace(name="other").save(file)
    assert cp.Engine.load(file) == I4


@pytest.mark.parametrize(
    "words",
    [
        ("new", "i4", "--out"),
        ("bob-weight", "v8-crossplane", "--save"),
        ("counterweights", "v8-crossplane", "--save"),
        ("shafts", "i4", "--ratios=-2,2", "--save"),
        ("rank", "ijesc-v6", "--save"),
        ("design", "i2-360", "--save"),
    ],
    ids=lambda words: words[0],
)
def test_a_command_replaces_an_engine_file_by_force_alone(
    words: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "e.toml"
    assert cli.main([*words, str(file)]) == 0
    file.write_text("mine", encoding="utf-8")
    assert cli.main([*words, str(file)]) == 2
    assert "it is there already; give another name, or --force" in capsys.readouterr().err
    assert file.read_text(encoding="utf-8") == "mine"
    assert cli.main([*words, str(file), "--force"]) == 0
    assert cp.Engine.load(file) != I4
