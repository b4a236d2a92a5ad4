"""A folder tree changes as a whole, whatever happens meanwhile."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from app.errors import FileError
from app.export.tree import clean_up, recover, tree_into
from app.formats.cache import CACHE_VARIABLE
from app.formats.locks import lock

BEFORE = {"src/a/one": "old one", "src/a/two": "old two", "src/gone/three": "old three", "src/theirs": "theirs"}
AFTER = {"src/a/one": "new one", "src/a/two": "new two", "src/b/four": "new four", "src/theirs": "theirs"}


posix = pytest.mark.skipif(os.name != "posix", reason="links need a privilege elsewhere")


def contents(root: Path) -> dict[str, str]:
    return {path.relative_to(root).as_posix(): path.read_text() for path in root.rglob("*") if path.is_file()}


def folders(root: Path) -> set[str]:
    return {path.relative_to(root).as_posix() for path in root.rglob("*") if path.is_dir()}


@pytest.fixture(autouse=True)
def _own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))


@pytest.fixture
def root(tmp_path: Path) -> Path:
    root = tmp_path / "project"
    for name, text in BEFORE.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    return root


def change(root: Path, error: type[BaseException] | None = None) -> None:
    with tree_into(root, root / "src") as tree:
        for name in ("src/a/one", "src/a/two", "src/b/four"):
            (tree.new / name).parent.mkdir(parents=True, exist_ok=True)
            (tree.new / name).write_text(f"new {Path(name).name}")
        tree.removed.append(Path("src/gone/three"))
        tree.last.append(Path("src/a/one"))
        if error is not None:
            raise error


def test_it_changes_as_a_whole(root: Path) -> None:
    change(root)
    assert contents(root) == AFTER
    assert folders(root) == {"src", "src/a", "src/b"}


@pytest.mark.parametrize("error", [KeyboardInterrupt, ValueError])
def test_an_error_changes_nothing(root: Path, error: type[BaseException]) -> None:
    with pytest.raises(error):
        change(root, error)
    assert contents(root) == BEFORE


@pytest.mark.parametrize("folder", ["äöü", "演奏"])
def test_an_error_names_the_file_at_its_place_and_not_in_the_temporary_folder(tmp_path: Path, folder: str) -> None:
    root = tmp_path / folder
    root.mkdir()
    with pytest.raises(FileError) as caught, tree_into(root, root) as tree:
        raise FileError("file.cannot_write", file=str(tree.new / "a" / "one"), reason="no space")
    assert caught.value.message.arguments == {"file": str(root / "a" / "one"), "reason": "no space"}
    with pytest.raises(FileError) as caught, tree_into(root, root):
        raise FileError("file.cannot_read", file=str(tmp_path / "two"), reason="gone")
    assert caught.value.message.arguments["file"] == str(tmp_path / "two")


def test_a_folder_made_for_a_failure_goes_again(tmp_path: Path) -> None:
    (tmp_path / "project").mkdir()
    with pytest.raises(LookupError), tree_into(tmp_path / "project", tmp_path / "project" / "src"):
        raise LookupError
    assert list((tmp_path / "project").iterdir()) == []


@pytest.mark.parametrize("refused", range(1, 4))
def test_what_is_refused_halfway_is_given_back(root: Path, monkeypatch: pytest.MonkeyPatch, refused: int) -> None:
    """Simulates Windows, where a file in use cannot be replaced."""
    replace, moved = Path.replace, []

    def refusing(source: Path, target: Path) -> Path:
        if "new" in source.parts:
            moved.append(target)
            if len(moved) == refused:
                raise PermissionError(13, "in use", str(target))
        return replace(source, target)

    monkeypatch.setattr(Path, "replace", refusing)
    with pytest.raises(FileError) as caught:
        change(root)
    assert caught.value.message.id == "tree.refused"
    assert caught.value.message.arguments["file"] == str(moved[-1])
    assert contents(root) == BEFORE
    assert folders(root) == {"src", "src/a", "src/gone"}


def test_what_cannot_be_given_back_is_kept_for_the_next(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    replace, in_use = Path.replace, []

    def refusing(source: Path, target: Path) -> Path:
        if target.name == "one" and "new" in source.parts:
            in_use.append(root / "src/a")
        if target.parent in in_use:
            raise PermissionError(13, "in use", str(target))
        return replace(source, target)

    monkeypatch.setattr(Path, "replace", refusing)
    with pytest.raises(FileError) as caught:
        change(root)
    assert caught.value.message.id == "tree.not_restored"
    in_use.clear()
    monkeypatch.undo()
    recover(root, root / "src")
    assert contents(root) == BEFORE


def test_a_folder_in_the_way_is_found_before_anything_moves(root: Path) -> None:
    (root / "src/b/four").mkdir(parents=True)
    with pytest.raises(FileError) as caught:
        change(root)
    assert caught.value.message.id == "tree.refused"
    assert contents(root) == BEFORE


KILLED = """
import os, sys
from pathlib import Path
sys.path.insert(0, sys.argv[3])
from tests.unit.export import test_tree
replace, unlink, left = Path.replace, Path.unlink, [int(sys.argv[2])]
def dying(call):
    def wrapped(path, *arguments, **named):
        if "new" in path.parts or path.name == "three":
            left[0] -= 1
            if left[0] == 0:
                os._exit(9)
        return call(path, *arguments, **named)
    return wrapped
Path.replace, Path.unlink = dying(replace), dying(unlink)
test_tree.change(Path(sys.argv[1]))
"""


@pytest.mark.parametrize("moment", range(1, 5))
def test_what_a_killed_process_had_begun_is_given_back(root: Path, moment: int) -> None:
    here = Path(__file__).parents[3]
    done = subprocess.run([sys.executable, "-c", KILLED, str(root), str(moment), str(here)], check=False)
    assert done.returncode == 9
    assert contents(root) != AFTER
    # As the next start of the program does, without a reference to this tree.
    clean_up()
    assert contents(root) == BEFORE
    assert folders(root) == {"src", "src/a", "src/gone"}
    change(root)
    assert contents(root) == AFTER


def test_cleaning_up_leaves_what_is_under_way_alone(root: Path) -> None:
    with tree_into(root, root / "src") as tree:
        (tree.new / "src").mkdir()
        (tree.new / "src" / "theirs").write_text("new")
        clean_up()
    assert contents(root)["src/theirs"] == "new"


@pytest.mark.skipif(os.name != "posix", reason="a second handle of one process shares the lock elsewhere")
def test_two_at_once_are_reported(root: Path) -> None:
    partial = root / "src" / f".{'0' * 16}.partial"
    partial.mkdir()
    with (partial / "lock").open("wb") as stream:
        assert lock(stream)
        with pytest.raises(FileError) as caught:
            change(root)
    assert caught.value.message.id == "tree.busy"
    assert partial.is_dir()


@pytest.mark.parametrize("line", ["../precious", "{outside}", "src/../../precious", "..\\precious"])
def test_a_list_that_came_with_a_project_leads_nowhere_else(tmp_path: Path, root: Path, line: str) -> None:
    outside = tmp_path / "precious"
    outside.write_text("kept")
    partial = root / "src" / ".0123456789abcdef.partial"
    partial.mkdir()
    (partial / "coming.txt").write_text(line.format(outside=outside.as_posix()))
    recover(root, root / "src")
    assert outside.read_text() == "kept"
    assert contents(root) == BEFORE


# A project comes from anywhere, with whatever links in it.


@pytest.fixture
def outside(tmp_path: Path) -> Path:
    """Folder beside the project that must not be changed."""
    folder = tmp_path / "home"
    folder.mkdir()
    for name in ("one", "two", "three", "precious"):
        (folder / name).write_text("kept")
    return folder


def linked(root: Path, name: str, target: Path) -> None:
    """Replace a folder of the project by a link."""
    folder = root / name
    if folder.is_dir():
        shutil.rmtree(folder)
    folder.symlink_to(target, target_is_directory=True)


@posix
@pytest.mark.parametrize("name", ["src/a", "src/gone", "src"])
def test_nothing_is_written_or_removed_through_a_link_out_of_the_tree(root: Path, outside: Path, name: str) -> None:
    before = contents(outside)
    linked(root, name, outside)
    with pytest.raises(FileError) as caught:
        change(root)
    assert caught.value.message.id == "tree.leads_outside"
    assert caught.value.message.arguments == {"file": str(root / name), "target": str(outside)}
    assert contents(outside) == before
    assert (root / name).is_symlink()


@posix
@pytest.mark.parametrize("what", ["removes", "replaces"])
def test_what_a_killed_process_is_said_to_have_left_leads_nowhere_else(root: Path, outside: Path, what: str) -> None:
    before = contents(outside)
    linked(root, "src/a", outside)
    partial = root / "src" / ".0123456789abcdef.partial"
    (partial / "old/src/a").mkdir(parents=True)
    (partial / "coming.txt").write_text("src/a/precious" if what == "removes" else "src/b")
    if what == "replaces":
        (partial / "old/src/a/precious").write_text("of a stranger")
    with pytest.raises(FileError) as caught:
        recover(root, root / "src")
    assert caught.value.message.id == "tree.leads_outside"
    assert contents(outside) == before


@posix
def test_a_link_is_no_leftover_of_ours(root: Path, outside: Path) -> None:
    """Neither its target nor a note there is followed."""
    (outside / "coming.txt").write_text("src/a/one")
    before = contents(outside)
    linked(root, "src/.0123456789abcdef.partial", outside)
    recover(root, root / "src")
    assert contents(outside) == before
    assert contents(root) == BEFORE


@posix
def test_links_within_the_tree_and_a_linked_tree_work(tmp_path: Path, root: Path) -> None:
    (root / "src/b").symlink_to(root / "src/a", target_is_directory=True)
    (tmp_path / "link").symlink_to(root, target_is_directory=True)
    change(tmp_path / "link")
    assert (root / "src/a/one").read_text() == "new one"
    assert (root / "src/a/four").read_text() == "new four"
    assert not (root / "src/gone/three").exists()
