"""Recognition of Unreal projects, and messages about other folders."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from app.errors import FileError
from app.export.unreal.project import find_project, require_writable
from app.messages import text


def write(path: Path, **content: object) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"FileVersion": 3, "EngineAssociation": "5.6", **content}), encoding="utf-8")
    return path


def refused(path: Path) -> str:
    with pytest.raises(FileError) as caught:
        find_project(path)
    assert text(caught.value.message)
    return caught.value.message.id


def test_by_file_and_by_folder(tmp_path: Path) -> None:
    file = write(tmp_path / "My Game.uproject")
    for path in (file, tmp_path):
        project = find_project(path)
        assert (project.file, project.folder, project.name) == (file, tmp_path, "My Game")
        assert (project.engine, project.version) == ("5.6", (5, 6))


@pytest.mark.parametrize("engine", ["", "{2B2F0C1A-4D1E-8A5C-9B1F-0F4C7D3E6A11}", "StudioEngine"])
def test_an_engine_of_their_own(tmp_path: Path, engine: str) -> None:
    assert find_project(write(tmp_path / "a.uproject", EngineAssociation=engine)).version is None


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_as_unreal_writes_it(tmp_path: Path, encoding: str) -> None:
    file = tmp_path / "曲.uproject"
    content = {"FileVersion": 3, "EngineAssociation": "5.4", "Description": "吹奏"}
    file.write_text(json.dumps(content, ensure_ascii=False), encoding=encoding)
    assert find_project(tmp_path).version == (5, 4)


def test_what_is_none(tmp_path: Path) -> None:
    assert refused(tmp_path) == "unreal.no_project"
    assert refused(tmp_path / "missing.uproject") == "unreal.not_found"
    (tmp_path / "notes.txt").write_text("{}")
    assert refused(tmp_path / "notes.txt") == "unreal.no_project"
    for content in ("", "{", "[]", "{}", '{"FileVersion": "3"}', "\x00"):
        (tmp_path / "bad.uproject").write_text(content)
        assert refused(tmp_path) == "unreal.not_a_project"
    write(tmp_path / "bad.uproject", EngineAssociation=5.6)
    assert refused(tmp_path) == "unreal.not_a_project"
    write(tmp_path / "other.uproject")
    assert refused(tmp_path) == "unreal.several"
    assert find_project(tmp_path / "other.uproject").name == "other"


@pytest.mark.parametrize("engine", ["4.27", "5.1"])
def test_an_engine_that_is_too_old(tmp_path: Path, engine: str) -> None:
    assert refused(write(tmp_path / "a.uproject", EngineAssociation=engine)) == "unreal.too_old"


def test_a_read_only_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    project = find_project(write(tmp_path / "a.uproject"))
    project.file.chmod(0o444)  # as version control leaves it: nothing is written to it
    require_writable(project)
    # The user who runs the tests may have all permissions.
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    with pytest.raises(FileError) as caught:
        require_writable(project)
    assert caught.value.message.id == "unreal.read_only"
