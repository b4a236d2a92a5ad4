r"""Paths on other computers are recognised from their text and not accessed without the user's consent."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from app.errors import FileError
from app.formats.files import open_file, read_file
from app.formats.other_computers import AGREED, agree, host_of, is_file, may_touch
from tests.support.touched import Touched


@pytest.mark.parametrize(
    ("path", "host"),
    [
        (r"\\host\share\take.wav", "host"),
        ("//host/share/take.wav", "host"),
        (r"\/HOST/share", "host"),
        (r"\\host", "host"),
        (r"\\10.0.0.7\c$\take.wav", "10.0.0.7"),
        (r"\\host@SSL\DavWWWRoot\take.wav", "host"),
        (r"\\host@8080\share", "host"),
        (r"\\?\UNC\host\share\take.wav", "host"),
        (r"\\?\unc\host\share", "host"),
        (r"\\.\UNC\host\share", "host"),
        ("//?/UNC/host/share", "host"),
        (r"\??\UNC\host\share", "host"),
        (r"\\?\GLOBALROOT\Device\Mup\host\share", "globalroot"),
        (r"\\.\pipe\name", "pipe"),
        (r"\\\host\share", "host"),
        ("file://host/share/take.wav", "host"),
        ("FILE://Host/share", "host"),
        ("file:////host/share", "host"),
        (r"file:\\host\share", "host"),
        ("http://host:8000/take.wav", "host"),
        ("smb://user@host/share", "host"),
    ],
)
def test_the_text_of_a_path_names_the_computer(path: str, host: str) -> None:
    assert host_of(path) == host
    assert not may_touch(path)


@pytest.mark.parametrize(
    "path",
    [
        *("", "take.wav", "/home/a/take.wav", r"C:\music\take.wav", "C:/music/take.wav", r"..\take.wav", r"\take.wav"),
        *(r"\\?\C:\music\take.wav", r"\\.\C:\take.wav", r"\\?\Volume{4c1b02c1}\take.wav", "file:///C:/take.wav"),
        *("file:///home/a/take.wav", "take: 1.wav", "C://music", "a//b", "take:1/2", "//", r"\\"),
    ],
)
def test_other_paths_are_on_this_computer(path: str) -> None:
    assert host_of(path) == ""
    assert may_touch(path)


def test_nothing_is_asked_of_a_computer_before_the_user_agrees(touched: Touched) -> None:
    path = r"\\host\share\take.wav"
    assert not is_file(path)
    for read in (open_file, lambda place: read_file(place, 10)):
        with pytest.raises(FileError) as caught:
            read(path)
        assert caught.value.message.id == "file.other_computer"
        assert caught.value.message.arguments == {"file": path, "host": "host"}
    assert touched.elsewhere == []
    agree(r"\\HOST\other\piece.suisou")
    assert may_touch(path)
    assert not is_file(path)
    assert touched.elsewhere == [path]


def test_agreeing_to_one_computer_agrees_to_no_other() -> None:
    agree("//one/share")
    agree("take.wav")
    agree("")
    assert may_touch("//one/x")
    assert not may_touch("//one.example.org/x")
    assert not may_touch("//two/x")
    assert os.environ[AGREED] == "one"


def test_a_file_of_this_computer_is_there(tmp_path: Path) -> None:
    (tmp_path / "take.wav").write_bytes(b"")
    assert is_file(tmp_path / "take.wav")
    assert not is_file(tmp_path)
    assert not is_file(tmp_path / "other.wav")
