"""Exported files appear all together or not at all."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.errors import FileError
from app.export.folder import files_into


def fill(target: Path, *names: str, error: type[BaseException] | None = None) -> None:
    with files_into(target) as partial:
        for name in names:
            (partial / name).write_text(f"new {name}")
        if error is not None:
            raise error


def test_files_appear_together_and_replace_old_ones(tmp_path: Path) -> None:
    target = tmp_path / "a" / "b"
    target.mkdir(parents=True)
    (target / "one").write_text("old")
    (target / "other").write_text("kept")
    with files_into(target) as partial:
        (partial / "one").write_text("new")
        (partial / "two").write_text("2")
        assert (target / "one").read_text() == "old"
    assert {path.name: path.read_text() for path in target.iterdir()} == {"one": "new", "two": "2", "other": "kept"}


@pytest.mark.parametrize("error", [KeyboardInterrupt, ValueError])
def test_nothing_remains_of_a_failure(tmp_path: Path, error: type[BaseException]) -> None:
    with pytest.raises(error):
        fill(tmp_path / "new" / "deep", "one", error=error)
    assert list(tmp_path.iterdir()) == []


def test_a_failure_keeps_what_was_there(tmp_path: Path) -> None:
    (tmp_path / "one").write_text("old")
    with pytest.raises(LookupError):
        fill(tmp_path, "one", error=LookupError)
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [("one", "old")]


def test_a_file_in_the_way_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError) as error, files_into(tmp_path / "file"):
        pass
    assert error.value.message.id == "file.cannot_write"
    assert "file" in str(error.value.message.arguments["file"])


def test_a_folder_in_the_way_is_found_before_anything_moves(tmp_path: Path) -> None:
    (tmp_path / "two").mkdir()
    with pytest.raises(FileError):
        fill(tmp_path, "one", "two")
    assert [path.name for path in tmp_path.iterdir()] == ["two"]


@pytest.mark.parametrize("error", [KeyboardInterrupt, PermissionError])
def test_a_late_failure_does_not_leave_half_of_the_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: type[BaseException]
) -> None:
    """Simulates Windows, where a file in use cannot be replaced."""
    for name in ("one", "two"):
        (tmp_path / name).write_text("old")
    replace = Path.replace

    def failing(source: Path, target: Path) -> Path:
        if target == tmp_path / "two" and source.parent.name == "new":
            raise error(13, "in use")
        return replace(source, target)

    monkeypatch.setattr(Path, "replace", failing)
    with pytest.raises((KeyboardInterrupt, FileError)):
        fill(tmp_path, "one", "two")
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {"one": "old", "two": "old"}
