"""Requirements of ``./test --versions``: ends of the ranges in pyproject.toml."""

from __future__ import annotations

import importlib.util
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement

ROOT = Path(__file__).parents[3]
DEPENDENCIES = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["dependencies"]

spec = importlib.util.spec_from_file_location("versions", ROOT / "packaging" / "versions.py")
assert spec is not None
assert spec.loader is not None
versions = importlib.util.module_from_spec(spec)
spec.loader.exec_module(versions)


def test_the_oldest_versions_are_within_the_newest_ranges() -> None:
    oldest = [Requirement(line) for line in versions.requirements("oldest", DEPENDENCIES)]
    newest = [Requirement(line) for line in versions.requirements("newest", DEPENDENCIES)]
    assert [one.name for one in oldest] == [one.name for one in newest] == list(versions.LIBRARIES)
    for least, allowed in zip(oldest, newest, strict=True):
        [pin] = least.specifier
        assert pin.operator == "=="
        assert pin.version in allowed.specifier


def test_a_range_without_a_lower_bound_is_refused() -> None:
    with pytest.raises(ValueError, match="numpy<3"):
        versions.requirements("oldest", ["numpy<3"])
