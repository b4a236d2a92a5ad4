"""MakeHuman's assets on a body: bindings, skin weights and shapes compared with sums vertex by vertex."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

OBJ = """
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 9 9 9
vt 0.0 0.0
vt 0.5 0.0
vt 0.5 1.0
vt 0.0 1.0
vt 0.9 0.9
vt 0.8 0.8
f 1/1 2/2 3/3 4/4
f 1/6 3/3 5/5
"""
MHCLO = """# comment
name two words
obj_file thing.obj
x_scale 0 3 2.0
y_scale 1 4 0.5
z_scale 2 5 4.0
verts 0
material thing.mhmat
 0 1 2 0.2 0.3 0.5 0.1 -0.2 0.3
 5 4 3 -0.5 0.5 1.0 0.0 0.1 0.0
6
 1 3 5 0.25 0.25 0.5 0.0 0.0 0.0
 2 4 6 0.6 0.6 -0.2 0.5 0.5 0.5

delete_verts
1 3 - 6
"""
BOUND = (
    ((0, 1, 2), (0.2, 0.3, 0.5), (0.1, -0.2, 0.3)),
    ((5, 4, 3), (-0.5, 0.5, 1.0), (0.0, 0.1, 0.0)),
    ((6, 6, 6), (1.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
    ((1, 3, 5), (0.25, 0.25, 0.5), (0.0, 0.0, 0.0)),
    ((2, 4, 6), (0.6, 0.6, -0.2), (0.5, 0.5, 0.5)),
)
SCALES = ((0, 3, 2.0), (1, 4, 0.5), (2, 5, 4.0))


@pytest.fixture(scope="module")
def assets(build_module: Callable[[str], ModuleType]) -> ModuleType:
    return build_module("character_assets")


@pytest.fixture
def written(tmp_path: Path) -> Path:
    (tmp_path / "thing.obj").write_text(OBJ, encoding="utf-8")
    (tmp_path / "thing.mhmat").write_text(
        "name Paint\ndiffuseTexture paint.png\nnormalmapTexture missing.png\nopacity 1.0\n", encoding="utf-8"
    )
    (tmp_path / "paint.png").write_bytes(b"")
    path = tmp_path / "thing.mhclo"
    path.write_text(MHCLO, encoding="utf-8")
    return path


def _body(shapes: int = 2) -> tuple[SimpleNamespace, SimpleNamespace]:
    rng = np.random.default_rng(7)
    weights = rng.uniform(0, 1, (7, 3))
    weights[2] = (1.0, 0.0, 0.0)
    source = SimpleNamespace(
        vertices=rng.normal(0, 1, (7, 3)),
        morph_names=tuple(f"shape{number}" for number in range(shapes)),
        morph_deltas=rng.normal(0, 1, (shapes, 7, 3)),
    )
    return source, SimpleNamespace(weights=weights / weights.sum(axis=1, keepdims=True))


def _slow_place(vertices: np.ndarray, vertex: int) -> list[float]:
    """Position of a bound vertex, calculated directly."""
    corners, shares, offset = BOUND[vertex]
    place = []
    for axis in range(3):
        first, second, length = SCALES[axis]
        scale = abs(vertices[first][axis] - vertices[second][axis]) / length
        place.append(
            sum(share * vertices[corner][axis] for corner, share in zip(corners, shares, strict=True))
            + offset[axis] * scale
        )
    return place


def test_a_bound_vertex_follows_its_three_and_the_size_of_the_body(assets: ModuleType, written: Path) -> None:
    asset = assets.read_asset(written, 7)
    for scale in (1.0, 0.1):
        vertices = _body()[0].vertices * scale
        assert np.allclose(asset.binding.positions(vertices), [_slow_place(vertices, row) for row in range(5)])


def test_names_faces_and_hidden_skin_are_read(assets: ModuleType, written: Path) -> None:
    asset = assets.read_asset(written, 7)
    assert asset.name == "two words"
    assert asset.faces.tolist() == [[0, 1, 2, 3], [0, 2, 4, 4]]
    assert asset.uv_faces.tolist() == [[0, 1, 2, 3], [5, 2, 4, 4]]
    assert asset.deleted.tolist() == [1, 3, 4, 5, 6]
    material = assets.read_material(asset.material)
    assert (material.name, dict(material.textures)) == ("Paint", {"diffuseTexture": written.parent / "paint.png"})


def test_a_surface_has_the_weights_and_shapes_of_the_skin_below(assets: ModuleType, written: Path) -> None:
    source, fit = _body()
    surface = assets.asset_surface(assets.read_asset(written, 7), source, fit, "thing", "paint", morphs=True)
    assert surface.positions.shape == (6, 3), "the corner on the seam of the texture is there twice"
    assert sum(len(faces) for faces in surface.triangles.values()) == 3
    seen = set()
    for place, uv, weights, *moved in zip(
        surface.positions, surface.uvs, surface.weights, *surface.morphs.values(), strict=True
    ):
        vertex = min(range(5), key=lambda row: np.abs(place - _slow_place(source.vertices, row)).max())
        assert np.allclose(place, _slow_place(source.vertices, vertex))
        corners, shares, _ = BOUND[vertex]
        slow = [
            max(0.0, sum(share * fit.weights[corner][joint] for corner, share in zip(corners, shares, strict=True)))
            for joint in range(3)
        ]
        assert np.allclose(weights, np.array(slow) / sum(slow))
        for delta, base in zip(moved, source.morph_deltas, strict=True):
            assert np.allclose(delta, sum(share * base[corner] for corner, share in zip(corners, shares, strict=True)))
        seen.add((vertex, *uv))
    assert seen == {
        (0, 0.0, 0.0), (0, 0.8, 0.8), (1, 0.5, 0.0), (2, 0.5, 1.0), (3, 0.0, 1.0), (4, 0.9, 0.9)
    }  # fmt: skip


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("6\n 1 3 5", " 1 3 5", "binds 4 vertices"),
        ("y_scale", "y_size", "no scale along y"),
        (" 0 1 2 0.2", " 0 1 99 0.2", "does not have"),
        (" 0.1 -0.2 0.3\n", " 0.1\n", "not by 7"),
    ],
)
def test_a_file_that_fits_no_body_is_refused(assets: ModuleType, written: Path, old: str, new: str, said: str) -> None:
    assert old in MHCLO
    written.write_text(MHCLO.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ValueError, match=said):
        assets.read_asset(written, 7)
