"""Paths in Qt: characters that Qt drops, and bytes preserved in URLs."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from PySide6.QtCore import QByteArray, QDir, QFileInfo, QMimeData, QUrl

from tests.support.odd_names import byte_names, odd, on_bytes
from widgets.common.paths import path_of, url_of

pytestmark = on_bytes


@given(byte_names, byte_names)
def test_bytes_come_through_urls(folder: str, name: str) -> None:
    path = Path("/home") / folder / name
    assert path_of(url_of(path)) == path
    # As a file manager drops it.
    dropped = QMimeData()
    dropped.setData("text/uri-list", QByteArray(url_of(path).toEncoded().data() + b"\r\n"))
    assert [path_of(url) for url in dropped.urls()] == [path]


@pytest.mark.parametrize("name", ["a b.mid", "100%.mid", "曲#1?.mid", "é.mid", "a;b&c.mid", "e\u0301.mid"])
def test_usual_names(name: str) -> None:
    path = Path("/home/me") / name
    assert url_of(path).toLocalFile() == str(path)
    assert path_of(QUrl.fromLocalFile(str(path))) == path


def test_what_is_no_file() -> None:
    assert path_of(QUrl()) is None
    assert path_of(QUrl("https://example.org/x.mid")) is None
    assert path_of(QUrl("file://server/share/x.mid")) == Path("//server/share/x.mid")


def test_what_qt_itself_makes_of_such_names(tmp_path: Path) -> None:
    """If this fails, Qt supports such names and `widgets.common.paths` can be simplified."""
    path = odd(tmp_path, ".mid")
    path.write_bytes(b"x")
    assert QDir(str(tmp_path)).entryList(QDir.Filter.Files) == []
    assert not QFileInfo(str(path)).exists()
    assert QFileInfo(str(path)).filePath() != str(path)
    assert list(tmp_path.iterdir()) == [path]
