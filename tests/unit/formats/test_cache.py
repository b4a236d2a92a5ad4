"""Location of cached results."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.formats.cache import CACHE_VARIABLE, cache_folder


@pytest.mark.parametrize("named", ["", "elsewhere"])
def test_each_kind_has_its_own_folder(named: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / named) if named else "")
    holds, maps = cache_folder("holds"), cache_folder("maps")
    assert holds != maps
    assert holds.parent == maps.parent
    assert not named or holds.parent == tmp_path / named
