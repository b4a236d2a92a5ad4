"""Names of bundled choreographies and paths of files are distinguishable."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.project.choreography_files import bundled_choreographies, choreography_path, is_bundled_name, is_choreography


@pytest.mark.parametrize("name", ["salsa", "slow_waltz-2", "0"])
def test_a_bundled_name_is_a_file_of_the_program(name: str) -> None:
    assert is_bundled_name(name)
    assert is_choreography(name)
    assert choreography_path(name).name == f"{name}.choreography"
    assert choreography_path(name).parent.parent.name == "resources"


@pytest.mark.parametrize("path", ["/a/b.choreography", "C:\\a\\b.choreography", "/踊り.CHOREOGRAPHY"])
def test_a_path_is_the_file_itself(path: str) -> None:
    assert not is_bundled_name(path)
    assert is_choreography(path)
    assert choreography_path(path) == Path(path)


@pytest.mark.parametrize(
    "text", ["", ".", "..", "../salsa", "Salsa", "a.b", "a b", "salsa\n", "b.choreography", "/etc/passwd",
             "/a\0.choreography", "x" * 61],
)  # fmt: skip
def test_anything_else_names_none(text: str) -> None:
    assert not is_choreography(text)


def test_bundled_choreographies_are_there() -> None:
    assert all(choreography_path(name).is_file() for name in bundled_choreographies())
