"""Every file that ever broke a reader is read or refused now, within the bounds on CPU and memory."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.fuzz.harness.campaign import Child, Result
from tests.fuzz.harness.readers import KINDS
from tests.fuzz.harness.seeds import HOSTILE, MADE, hostile

FOUND = [(kind, name) for kind in KINDS for name in hostile(kind)]


@pytest.fixture(scope="module")
def children() -> Iterator[dict[str, Child]]:
    """A process for each group of readers, begun when it is first needed."""
    started: dict[str, Child] = {}
    yield started
    for child in started.values():
        child.close()


@pytest.mark.parametrize(("kind", "name"), FOUND, ids=[f"{kind}-{name}" for kind, name in FOUND])
def test_a_found_file(kind: str, name: str, children: dict[str, Child]) -> None:
    result = _read(kind, name, children)
    assert not result.failure, f"{result.failure}: {result.cpu_s:.1f} s, {result.peak_mb:.0f} MB\n{result.detail}"


@pytest.mark.parametrize(
    ("kind", "name", "refusal"),
    [
        ("gltf", "glb_deep", "gltf.too_deep"),
        ("gltf", "glb_zeros", "gltf.too_large"),
        ("foreign_fbx", "fbx_instances", "fbx.too_large"),
        ("bvh", "bvh_still", "bvh.too_large"),
        ("motion", "bvh_days", "motion.rate_impossible"),
        ("motion", "bvh_slow", "motion.too_long"),
        ("gltf_motion", "glb_hours_of_motion", "motion.too_long"),
        ("fbx_motion", "fbx_half_an_hour", "motion.too_long"),
        ("fbx_motion", "fbx_polygon", "fbx.motion_too_large"),
        ("audio", "flac_silence", "audio.too_dense"),
    ],
)
def test_a_file_that_costs_too_much_is_refused(kind: str, name: str, refusal: str, children: dict[str, Child]) -> None:
    result = _read(kind, name, children)
    assert (result.outcome, result.place) == ("refused", refusal), result.detail


def _read(kind: str, name: str, children: dict[str, Child]) -> Result:
    group = KINDS[kind].group
    if group not in children:
        children[group] = Child([other for other, spec in KINDS.items() if spec.group == group]).start()
    return children[group].run(kind, hostile(kind)[name]())


def test_every_found_file_has_a_reader() -> None:
    folders = {path.name for path in HOSTILE.iterdir()} if HOSTILE.is_dir() else set()
    assert folders | set(MADE) <= set(KINDS)
