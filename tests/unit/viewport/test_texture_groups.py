"""Textured meshes for the graphics card: materials, texture coordinates and colours at a distance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.formats.scene import Material
from app.formats.textures import MaterialTextures, TextureUse, texture_of
from app.rig.mesh import Mesh
from tests.support.textured import card_material, encoded
from widgets.viewport.geometry import _levels as levels
from widgets.viewport.geometry import crowd
from widgets.viewport.texture_groups import uv_islands

SIDE = 21


def sheet(materials: tuple[Material, ...], apart: bool = False) -> Mesh:
    """Slanting square of one metre with 800 triangles; its right half has the second material, if there are two."""
    across, up = np.meshgrid(np.linspace(0.0, 1.0, SIDE), np.linspace(0.0, 1.0, SIDE))
    points = np.stack([across.ravel(), up.ravel(), 0.6 * across.ravel()], axis=1).astype(np.float32)
    first = (np.arange(SIDE - 1)[:, None] * SIDE + np.arange(SIDE - 1)).ravel()
    triangles = np.concatenate(
        [np.stack([first, first + 1, first + SIDE], 1), np.stack([first + 1, first + SIDE + 1, first + SIDE], 1)]
    )
    right = points[triangles].mean(axis=1)[:, 0] > 0.5
    if apart:
        triangles = np.where(right[:, None], triangles + len(points), triangles)
        points = np.concatenate([points, points])
    uvs = np.stack([points[:, 0], 1.0 - points[:, 1]], axis=1)
    return Mesh(
        name="sheet",
        positions_m=points,
        normals=np.tile(np.float32([0.0, 0.0, 1.0]), (len(points), 1)),
        uvs=uvs,
        triangles=triangles.astype(np.int32),
        triangle_materials=(right & (len(materials) > 1)).astype(np.int32),
        materials=materials,
        joints=np.zeros((len(points), 2), np.int32),
        weights=np.tile(np.float32([1.0, 0.0]), (len(points), 1)),
    )


def test_near_levels_have_groups_of_one_texture_and_the_far_one_colours() -> None:
    plain = Material("plain", (0.2, 0.3, 0.4, 1.0))
    near, middle, far = levels([sheet((card_material(), plain))], (0.0, 0.05, 0.2), 1.0)
    for level in (near, middle):
        assert level.uvs is not None
        assert level.groups is not None
        assert level.looks == (card_material(),)
        assert level.groups[:, 1].sum() == len(level.triangles)
        for first, count, look in level.groups:
            right = level.shape["a_position"][level.triangles[first : first + count]].mean(axis=1)[:, 0] > 0.5
            assert right.all() == (look == -1)
            # Cards of hair are seen from both sides.
            assert (first >= level.one_sided) == (look == 0)
    # Vertices keep the texture coordinates of their places.
    places = middle.shape["a_position"]
    assert middle.uvs is not None
    assert np.allclose(middle.uvs, np.stack([places[:, 0], 1.0 - places[:, 1]], axis=1))
    assert far.uvs is None
    assert far.groups is None
    assert len(crowd([(0, far)]).shape) == len(far.shape)


def test_a_far_figure_has_the_colours_of_its_texture() -> None:
    pixels = np.zeros((8, 8, 3), np.uint8)
    pixels[:, :4] = (255, 0, 0)
    pixels[:, 4:] = (0, 0, 255)
    use = TextureUse(texture_of("halves", encoded(pixels)))
    halves = Material("halves", (1.0, 1.0, 1.0, 1.0), textures=MaterialTextures(color=use))
    *_, far = levels([sheet((halves,))], (0.0, 0.05, 0.1), 1.0)
    colors, left = far.surface["a_color"], far.shape["a_position"][:, 0] < 0.45
    assert np.allclose(colors[left][:, :3], (1.0, 0.0, 0.0), atol=0.02)
    assert np.allclose(colors[~left & (far.shape["a_position"][:, 0] > 0.55)][:, :3], (0.0, 0.0, 1.0), atol=0.02)


def test_a_far_figure_has_the_mean_colours_of_what_it_merges() -> None:
    pixels = np.zeros((20, 20, 3), np.uint8)
    pixels[:, ::2] = 255
    use = TextureUse(texture_of("stripes", encoded(pixels)))
    stripes = Material("stripes", (1.0, 1.0, 1.0, 1.0), textures=MaterialTextures(color=use))
    mesh = sheet((stripes,))
    # Slanting upwards, it has vertices of four stripes in each cell.
    upwards = np.float32([[1.0, 0.0, 0.0], [0.0, 1.0, 0.6], [0.0, 0.0, 0.0]])
    mesh = replace(mesh, positions_m=mesh.positions_m @ upwards + np.float32(0.01))
    fine, _, far = levels([mesh], (0.0, 0.05, 0.2), 1.0)
    assert np.ptp(fine.surface["a_color"][:, 0]) > 0.9
    inside = np.abs(far.shape["a_position"][:, :2] - 0.5).max(axis=1) < 0.35
    assert inside.sum() >= 4
    assert np.abs(far.surface["a_color"][inside][:, :3] - 0.5).max() < 0.3


def test_a_far_figure_lacks_what_is_mostly_cut_out() -> None:
    pixels = np.full((8, 8, 4), 255, np.uint8)
    pixels[:, :4, 3] = 40
    pixels[4:, :, 1:3] = 0
    use = TextureUse(texture_of("hair", encoded(pixels)))
    hair = Material("hair", (1.0, 1.0, 1.0, 1.0), textures=MaterialTextures(color=use), alpha="mask")
    near, middle, far = levels([sheet((hair,))], (0.0, 0.05, 0.1), 1.0)
    for level in (near, middle):
        assert level.shape["a_position"][:, 0].min() < 0.05
    assert far.shape["a_position"][:, 0].min() > 0.4
    assert far.shape["a_position"][:, 0].max() > 0.9
    # The picture is white above and red below.
    inside = far.shape["a_position"][:, 0] > 0.6
    above, below = (inside & (np.sign(far.shape["a_position"][:, 1] - 0.5) == side) for side in (1.0, -1.0))
    assert far.surface["a_color"][above][:, 1].mean() > 0.8
    assert far.surface["a_color"][below][:, 1].mean() < 0.2


def test_a_far_head_is_finer_than_the_rest_and_whole_with_it() -> None:
    plain = Material("plain", (0.2, 0.3, 0.4, 1.0))
    mesh = sheet((plain,))
    joints = np.zeros_like(mesh.joints)
    joints[:, 0] = mesh.positions_m[:, 0] > 0.5
    mesh = replace(mesh, joints=joints)
    *_, even = levels([mesh], (0.0, 0.05, 0.2), 1.0)
    *_, far = levels([mesh], (0.0, 0.05, 0.2), 1.0, (1,))
    head = far.shape["a_position"][:, 0] > 0.5
    assert head.sum() > 2 * (even.shape["a_position"][:, 0] > 0.5).sum()
    assert abs((~head).sum() - (even.shape["a_position"][:, 0] <= 0.5).sum()) < 5
    # Every edge inside the sheet belongs to two triangles: there is no gap between the two.
    corners = np.sort(far.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2).astype(int), axis=1)
    pairs, counts = np.unique(corners, axis=0, return_counts=True)
    middles = far.shape["a_position"][pairs].mean(axis=1)[counts == 1]
    assert (np.abs(middles[:, :2] - 0.5).max(axis=1) > 0.35).all()


def test_vertices_of_different_parts_of_a_texture_stay_apart() -> None:
    apart = sheet((card_material(),), apart=True)
    parts = uv_islands(apart.triangles, np.ones(len(apart.positions_m), bool))
    assert len(set(parts[np.unique(apart.triangles)].tolist())) == 2
    assert not uv_islands(apart.triangles, np.zeros(len(apart.positions_m), bool)).any()
    _, middle, _ = levels(
        [replace(apart, uvs=apart.uvs + np.repeat([[0.0, 0.0], [3.0, 0.0]], SIDE * SIDE, axis=0))], (0.0, 0.2, 0.4), 1.0
    )
    assert middle.uvs is not None
    assert np.ptp(middle.uvs[middle.triangles.astype(int)], axis=1).max() < 1.0


def test_a_far_figure_has_no_gap_between_parts_of_a_texture() -> None:
    use = TextureUse(texture_of("white", encoded(np.full((8, 8, 3), 255, np.uint8))))
    white = Material("white", (1.0, 1.0, 1.0, 1.0), textures=MaterialTextures(color=use))
    *_, middle, far = levels([sheet((white,), apart=True)], (0.0, 0.1, 0.2), 1.0)
    for level, count in ((middle, 2), (far, 1)):
        assert len(set(uv_islands(level.triangles, np.ones(len(level.shape), bool)).tolist())) == count
