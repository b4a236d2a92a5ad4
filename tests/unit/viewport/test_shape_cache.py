"""Shapes read from the user's cache."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from app.formats.cache import CACHE_VARIABLE
from app.rig.mesh import Mesh
from widgets.viewport.shape_cache import kept
from widgets.viewport.shape_model import SHAPE, SURFACE, Geometry, MorphTargets


def level(count: int, face: bool, shared: bool) -> Geometry:
    random = np.random.default_rng(count)
    shape = random.random((count, 6), np.float32).view(SHAPE).reshape(-1)
    surfaces = random.random((3 if shared else count, SURFACE.itemsize // 4), np.float32).view(SURFACE).reshape(-1)
    vertices, deltas = np.arange(5, dtype=np.int32), random.random((5, 6), np.float32)
    made = MorphTargets(
        6, ("a", "b"), ((vertices, deltas), (vertices[:0], deltas[:0])), random.random((6, 6), np.float32)
    )
    triangles = random.integers(0, count, (2 * count, 3)).astype(np.uint16 if shared else np.uint32)
    return Geometry(
        shape,
        surfaces,
        triangles,
        7,
        made if face else None,
        random.integers(0, 3, count).astype(np.uint16) if shared else None,
    )


LEVELS = (level(40, True, False), level(21, False, True))
MESH = Mesh(  # type: ignore[call-arg]
    "thing",
    *(np.zeros((3, size), np.float32) for size in (3, 3, 2)),
    np.array([[0, 1, 2]], np.int32),
    np.zeros(1, np.int32),
    (),
    np.zeros((3, 1), np.int32),
    np.ones((3, 1), np.float32),
)


def arrays(levels: tuple[Geometry, ...]) -> list[object]:
    found: list[object] = []
    for one in levels:
        found += [one.shape.tobytes(), one.surfaces.tobytes(), one.triangles.tobytes(), one.one_sided]
        found.append(None if one.surface_of is None else one.surface_of.tobytes())
        if one.face is not None:
            found += [one.face.count, one.face.names, one.face.rest.tobytes()]
            found += [part.tobytes() for target in one.face.targets for part in target]
    return found


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    return tmp_path / "shapes"


def never() -> tuple[Geometry, ...]:
    raise AssertionError("it was kept")


def test_shapes_are_made_once_and_come_back_as_they_were(cache: Path) -> None:
    assert arrays(kept([MESH], (1,), lambda: LEVELS)) == arrays(LEVELS)
    again = kept([MESH], (1,), never)
    assert arrays(again) == arrays(LEVELS)
    assert [one.triangles.dtype for one in again] == [np.uint32, np.uint16]
    assert not again[0].shape.flags.owndata
    other = (level(9, False, False),)
    assert arrays(kept([MESH], (2,), lambda: other)) == arrays(other)
    assert len(list(cache.iterdir())) == 2


@pytest.mark.parametrize("damage", ["cut", "empty", "turned", "longer"])
def test_a_damaged_file_is_made_again(cache: Path, damage: str) -> None:
    kept([MESH], (), lambda: LEVELS)
    (path,) = cache.iterdir()
    content = bytearray(path.read_bytes())
    content[-9] ^= 1
    whole = path.read_bytes()
    path.write_bytes({"cut": whole[:-64], "empty": b"", "turned": bytes(content), "longer": whole + b"x"}[damage])
    assert arrays(kept([MESH], (), lambda: LEVELS)) == arrays(LEVELS)
    assert arrays(kept([MESH], (), never)) == arrays(LEVELS)


def test_without_a_cache_shapes_are_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_bytes(b"")
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "file"))
    assert arrays(kept([MESH], (), lambda: LEVELS)) == arrays(LEVELS)
