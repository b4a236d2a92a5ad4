"""A user's folder over the bundled tables: after any edits, the last valid version of each file is used."""

from __future__ import annotations

import os
from pathlib import Path

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.errors import MapError
from app.formats.user_folder import Named, Read, Shelf, UserFolder

BUNDLED = {"a": ["ours"], "b": ["ours too"]}
"""Bundled tables as lists, so that equal ones can be distinguished by identity."""


def read(path: Path) -> Read[list[str]]:
    text = path.read_text()
    if text == "bad":
        raise MapError("table.invalid", file=str(path), place="", detail="bad")
    return Read([text], (path.with_suffix(".part"),))


edits = st.lists(
    st.tuples(st.sampled_from(["a", "b", "c"]), st.sampled_from(["one", "two", "bad", "gone", "part", "touched"])),
    max_size=12,
)


@given(edits)
@settings(deadline=None, max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_the_last_good_version_is_in_use(tmp_path_factory: object, done: list[tuple[str, str]]) -> None:
    folder = tmp_path_factory.mktemp("own")  # type: ignore[attr-defined]
    library: UserFolder[list[str], Shelf[list[str]]] = UserFolder("x", (".part",), Shelf, lambda: BUNDLED, read)
    good: dict[str, str] = {}
    shelf = library.read(folder)
    for clock, (id, edit) in enumerate(done, 1):
        path = folder / f"{id}.toml"
        before, revisions = shelf, dict(shelf.revisions)
        if edit == "gone":
            path.unlink(missing_ok=True)
        elif edit in ("part", "touched"):
            touched = path.with_suffix(".part") if edit == "part" else path
            if edit == "part" or path.exists():
                touched.touch()
                os.utime(touched, ns=(clock * 10**9, clock * 10**9))
        else:
            path.write_text(edit)
            os.utime(path, ns=(clock * 10**9, clock * 10**9))
        shelf = library.read(folder, before)
        held = path.read_text() if path.exists() else None
        if held is None:
            good.pop(id, None)
        elif held != "bad":
            good[id] = held
        expected = {name: [good[name]] if name in good else BUNDLED.get(name) for name in "abc"}
        assert shelf.items == {name: value for name, value in expected.items() if value is not None}
        assert {path.stem for path in shelf.problems} == {
            path.stem for path in folder.glob("*.toml") if path.read_text() == "bad"
        }
        for name in "abc":
            same = shelf.items.get(name) is before.items.get(name)
            assert shelf.revisions.get(name, 0) == revisions.get(name, 0) + (not same)
            if name != id or edit == "touched":
                assert same, "nothing happened to it"
        assert library.read(folder, shelf) is shelf
    assert all(shelf.items[name] is value for name, value in BUNDLED.items() if name not in good)


def test_tables_go_by_the_names_in_them(tmp_path: Path) -> None:
    for file, text in {"1": "zoe", "2": "bad", "3": "anna"}.items():
        (tmp_path / f"{file}.toml").write_text(text)
    named = Named(lambda path: (read(path).value or [""])[0], str)
    items, (problem,) = named.found(tmp_path)
    assert list(items) == ["anna", "zoe"]
    assert problem.arguments["file"] == str(tmp_path / "2.toml")
    assert named.path_of(tmp_path, "zoe") == tmp_path / "1.toml"
    assert named.path_of(tmp_path, "bad") is None
    assert named.found(tmp_path / "none") == ({}, ())
