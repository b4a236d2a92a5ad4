"""FBX files of other programs if the library for reading them is missing, since some Python versions have no wheel."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from app.cli import main
from app.errors import FileError
from app.formats.fbx.foreign import read_foreign_fbx, read_foreign_motion

FIGURE = Path(__file__).parents[3] / "data" / "characters" / "child_mixamo.fbx"
BLOCKED = ("No module named 'ufbx'", "DLL load failed while importing ufbx")


@pytest.fixture(params=BLOCKED)
def blocked(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Make the library impossible to import in this process and its children."""
    (tmp_path / "ufbx.py").write_text(f"raise ImportError({request.param!r})\n")
    monkeypatch.syspath_prepend(str(tmp_path))


@pytest.mark.usefixtures("blocked")
def test_what_is_missing_is_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for read in (read_foreign_fbx, read_foreign_motion):
        with pytest.raises(FileError) as caught:
            read(FIGURE)
        assert caught.value.message.id == "fbx.no_reader"
    # A different name, since the content read before may be cached.
    file = tmp_path / "figure.fbx"
    shutil.copy(FIGURE, file)
    assert main(["characters", "check", str(file)]) == 1
    reported = capsys.readouterr().err
    assert "figure.fbx" in reported
    assert "Python package ufbx" in reported
