"""Bundled maps are parsed and validated once per version; the cached ones equal those that would be read."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from app.errors import MapError
from app.formats.cache import CACHE_VARIABLE
from app.formats.table_cache import digest_of
from instrument_maps import load
from instrument_maps.load import bundled_maps, named_map
from instrument_maps.model import InstrumentMap


@pytest.fixture
def maps(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder with two of the maps in place of the bundled ones."""
    folder = tmp_path / "maps"
    folder.mkdir()
    for name in ("trumpet_Bb", "cornet_Bb"):
        shutil.copy(load.FOLDER / f"{name}.toml", folder)
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    monkeypatch.setattr(load, "FOLDER", folder)
    return folder


def _again() -> dict[str, object]:
    """Maps as loaded by another start of the program, without changing those of this process."""
    digest_of.cache_clear()
    return dict(bundled_maps.__wrapped__())


def test_what_is_kept_is_what_is_read(maps: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    read = {path.stem: named_map(path) for path in sorted(maps.glob("*.toml"))}
    first = _again()
    monkeypatch.setattr(load, "named_map", lambda path: pytest.fail("it is kept"))
    assert first == read == _again()
    assert list(first) == sorted(read)


def test_a_map_that_changed_is_read_anew_and_what_was_kept_goes(maps: Path, tmp_path: Path) -> None:
    _again()
    [kept] = (tmp_path / "cache" / "maps").glob("maps-*")
    path = maps / "trumpet_Bb.toml"
    path.write_text(path.read_text(encoding="utf-8").replace('en = "Trumpet', 'en = "Tin trumpet', 1), encoding="utf-8")
    assert "Tin" in bundled_name(_again()["trumpet_Bb"])
    [other] = (tmp_path / "cache" / "maps").glob("maps-*")
    assert other != kept
    path.write_text(path.read_text(encoding="utf-8") + "\nnonsense = 1\n", encoding="utf-8")
    with pytest.raises(MapError):
        _again()


def bundled_name(instrument: object) -> str:
    assert isinstance(instrument, InstrumentMap)
    return instrument.name.en


def test_a_damaged_or_forbidden_cache_costs_time_and_nothing_else(
    maps: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = _again()
    [kept] = (tmp_path / "cache" / "maps").glob("maps-*")
    kept.write_bytes(kept.read_bytes()[:-9])
    assert _again() == first
    (tmp_path / "file").write_text("no folder")
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "file"))
    assert _again() == first
