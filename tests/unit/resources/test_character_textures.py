"""Textures of the bundled characters: noise that tiles, the skin's layout, eyes, strands, and their storage
in a file.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pygltflib as gltf
import pytest
from PIL import Image

Module = Callable[[str], ModuleType]


HAIR = Path(__file__).parents[3] / "resources" / "characters" / "hair"
PAINTED = {
    "afro01": 0.245,
    "bob02": 0.345,
    "braid01": 0.507,
    "long01": 0.577,
    "short02": 0.390,
    "short04": 0.379,
}
"""Share of each style's picture that is opaque as MakeHuman's authors painted it, where faces use it (of `afro01` and
`short04` without their locks).
"""


def _pixels(content: bytes) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(content)), dtype=np.float64) / 255.0


def test_noise_and_normals_go_on_across_the_edge_of_a_tile(build_module: Module) -> None:
    textures = build_module("character_textures")
    waves = textures.noise(64, 6, 24, 1)
    assert abs(waves.mean()) < 1e-9
    assert waves.std() == pytest.approx(1.0)
    for axis in (0, 1):
        within = np.abs(np.diff(waves, axis=axis)).max()
        assert np.abs(np.take(waves, 0, axis) - np.take(waves, -1, axis)).max() < 1.2 * within
    near, following = textures.cells(48, 8.0, 2)
    assert (near <= following).all()
    assert np.abs(near[0] - near[-1]).max() < 2.0
    # A slope that rises to the right leans the normal to the left; one that rises downwards leans it up (green).
    ramp = np.tile(np.arange(8.0), (8, 1))
    right = textures.normals_of(ramp, 1.0)[4, 4] * 2 - 1
    assert right == pytest.approx(np.array([-1, 0, 1]) / np.sqrt(2))
    down = textures.normals_of(ramp.T, 1.0)[4, 4] * 2 - 1
    assert down == pytest.approx(np.array([0, 1, 1]) / np.sqrt(2))


def test_pictures_are_sampled_spread_and_stored_alike(build_module: Module) -> None:
    textures = build_module("character_textures")
    picture = np.random.default_rng(3).uniform(0, 1, (8, 8, 3))
    centres = (np.arange(8) + 0.5) / 8
    u, v = np.meshgrid(centres, centres[::-1])
    assert np.allclose(textures.sampled(picture, u, v), picture)
    inside = np.zeros((8, 8), dtype=bool)
    inside[2, 3] = True
    assert (textures.spread(picture, inside) == picture[2, 3]).all()
    stored = textures.png("a", picture)
    assert stored == textures.png("a", picture)
    assert stored.mime_type == "image/png"
    assert textures.jpeg("a", picture).mime_type == "image/jpeg"
    assert np.abs(_pixels(stored.content) - picture).max() < 1 / 255
    assert np.allclose(textures.to_srgb(textures.to_linear(picture)), picture)


def _squares(spots: list[tuple[float, float]], half: float) -> tuple[np.ndarray, np.ndarray]:
    """One square around each point."""
    corners = np.array([(-half, -half), (half, -half), (half, half), (-half, half)])
    uvs = np.concatenate([np.asarray(spot) + corners for spot in spots])
    return uvs, np.arange(len(uvs)).reshape(-1, 4)


def test_parts_of_the_skin_get_new_places_of_their_own(build_module: Module) -> None:
    skin, surface = build_module("character_skin"), build_module("character_surface")
    uvs, faces = _squares([spot for spot, _, _ in skin.ISLANDS], 0.03)
    layout = skin.skin_layout(uvs, faces)
    assert layout.inside.sum() == pytest.approx(
        sum((0.06 * scale * skin.SKIN_PX) ** 2 for _, _, scale in skin.ISLANDS), rel=0.05
    ), "no two lie on one another"
    assert layout.uvs.min() > 0
    assert layout.uvs.max() < 1
    # A picture in which every place has a colour of its own shows the same colour at both coordinates of a corner.
    u, v = np.meshgrid((np.arange(256) + 0.5) / 256, 1 - (np.arange(256) + 0.5) / 256)
    moved = layout.picture(np.stack([u, v], axis=-1))
    middles, old = layout.uvs[faces].mean(axis=1), uvs[faces].mean(axis=1)
    rows = ((1 - middles[:, 1]) * skin.SKIN_PX).astype(int)
    assert np.allclose(moved[rows, (middles[:, 0] * skin.SKIN_PX).astype(int)], old, atol=2e-3)
    body = surface.modelled(
        "body", np.eye(4)[:, :3], np.ones((4, 1)), {"a": [[0, 1, 2]], "b": [[0, 2, 3]]}, uvs=uvs[[5, 9, 2, 30]]
    )
    dressed = layout.dressed(body)
    assert np.array_equal(dressed.uvs, layout.uvs[[5, 9, 2, 30]])
    assert dressed.triangles["skin"].tolist() == [[0, 1, 2], [0, 2, 3]]


def test_lips_shine_and_the_face_is_as_bright_as_its_tint_takes(build_module: Module) -> None:
    skin, textures = build_module("character_skin"), build_module("character_textures")
    uvs, faces = _squares([(0.84, 0.48)], 0.15)
    layout = skin.skin_layout(uvs, faces)
    lips = np.zeros((64, 64))
    lips[:, 57:59] = 1.0
    masks = {"lips": lips, "fingernails": np.zeros((64, 64)), "inside-mouth": np.zeros((64, 64))}
    painted = np.full((64, 64, 3), (0.8, 0.6, 0.5))
    colour = _pixels(skin.skin_colour("skin", painted, layout, masks).content)
    assert np.allclose(textures.to_linear(colour)[layout.inside].mean(axis=0), skin.SKIN_MEAN_LINEAR, rtol=0.12)
    rough = _pixels(skin.skin_roughness("orm", layout, masks).content)[..., 1]
    mouth = layout.picture(lips)[::2, ::2] > 0.9
    assert rough[mouth].mean() < 0.42
    assert rough[(layout.picture(lips)[::2, ::2] < 0.05) & layout.inside[::2, ::2]].mean() > 0.5


def test_eyes_have_a_pupil_an_iris_for_any_colour_and_a_white(build_module: Module) -> None:
    eyes, textures = build_module("character_eyeballs"), build_module("character_textures")
    iris, wet = (
        textures.to_linear(_pixels(made(name).content))
        for made, name in ((eyes.iris_colour, "i"), (eyes.wet_colour, "w"))
    )

    def ring(picture: np.ndarray, middle: float, radius: float, upto: float = 2 * np.pi) -> np.ndarray:
        angle = np.linspace(0, upto, 60)
        rows, columns = ((1 - middle - radius * np.sin(angle)), middle + radius * np.cos(angle))
        return picture[(rows * len(picture)).astype(int), (columns * len(picture)).astype(int)].mean(axis=0)

    assert ring(iris, 0.5, 0.06).max() < 0.02
    middle = ring(iris, 0.5, 0.38)
    assert np.ptp(middle) < 0.08, "grey"
    assert middle.mean() == pytest.approx(eyes.IRIS_MEAN_LINEAR, rel=0.4)
    assert ring(iris, 0.5, 0.485).max() < 0.1, "the limbus is dark"
    assert ring(wet, eyes.WHITE_MIDDLE, eyes.WHITE_SHARE * eyes.IRIS_SHARE).max() < 0.15, "on its outer side too"
    white, under_lid = (ring(wet, eyes.WHITE_MIDDLE, eyes.WHITE_SHARE * 0.65, upto) for upto in (-np.pi, np.pi))
    assert white.min() > 0.4
    assert under_lid.max() < 0.75 * white.min(), "the upper lid's shadow"


def test_eyeballs_have_a_cornea_and_turn_with_their_joints(build_module: Module) -> None:
    eyes = build_module("character_eyeballs")
    names, centres = ("head", "leftEye", "rightEye"), np.array([[0, 0, 0], [0.03, 0, 0], [-0.03, 0, 0]])
    frames = np.tile(np.eye(4), (3, 1, 1))
    frames[:, :3, 3] = centres
    fit = SimpleNamespace(names=names, index=names.index, world_from_joint_rest=frames)
    ends = 0.012 * np.array([[1, 0, 0], [-1, 0, 0]])
    groups = {f"helper-{side}-eye": SimpleNamespace(vertices=rows) for side, rows in (("l", [0, 1]), ("r", [2, 3]))}
    body = SimpleNamespace(vertices=np.concatenate([centres[1] + ends, centres[2] + ends]), groups=groups)
    surface = eyes.eyeballs(body, fit)
    iris, white = (np.unique(surface.triangles[name]) for name in ("iris", eyes.WET))
    assert not set(iris) & set(white)
    for joint in (1, 2):
        assert {1.0, 0.0} == set(surface.weights[:, joint])
        own = np.flatnonzero(surface.weights[:, joint])
        off = surface.positions - centres[joint]
        distance, outwards = np.linalg.norm(off, axis=1), np.einsum("ij,ij->i", surface.normals, off)
        assert (outwards[own] > 0).all()
        share = np.linalg.norm(surface.uvs - 0.5, axis=1) / 0.49
        seen = np.intersect1d(iris, own)
        assert np.allclose(distance[seen[share[seen] < 0.01]], 0.012 + eyes.BULGE_M)
        edge = seen[share[seen] > 0.99]
        assert np.hypot(off[edge, 0], off[edge, 1]) == pytest.approx(eyes.IRIS_M, rel=0.05)
        # The white begins where the iris ends, in space and in its picture.
        share = np.linalg.norm(surface.uvs - eyes.WHITE_MIDDLE, axis=1) / eyes.WHITE_SHARE
        around = np.intersect1d(white, own)
        edge = around[share[around] < eyes.IRIS_SHARE * 1.01]
        assert np.hypot(off[edge, 0], off[edge, 1]) == pytest.approx(eyes.IRIS_M, rel=0.05)
        assert np.allclose(distance[around[share[around] > 0.6]], 0.012)


def test_strands_run_along_what_is_painted(build_module: Module) -> None:
    strands = build_module("character_strands")
    rows, columns = np.mgrid[:96, :96]
    for turn in np.radians([0, 30, 75, 120]):
        stripes = np.sin(0.8 * (columns * np.sin(turn) + rows * np.cos(turn)))
        along, clear = strands.directions(stripes, 4.0)
        expected = np.array([-np.sin(turn), np.cos(turn)])
        assert abs(along[48, 48] @ expected) > 0.99
        assert clear[48, 48] > 0.95
    checks = np.sin(0.8 * rows) + np.sin(0.8 * columns)
    assert strands.directions(checks, 6.0)[1][48, 48] < 0.2
    fine = strands.strands(np.broadcast_to([0.0, 1.0], (96, 96, 2)).copy(), 5)
    assert np.abs(np.diff(fine, axis=1)).mean() < 0.4 * np.abs(np.diff(fine, axis=0)).mean()


def _textures(
    strands: ModuleType, style: str, painted: np.ndarray, used: np.ndarray, ends: tuple[np.ndarray, np.ndarray]
) -> tuple[SimpleNamespace, SimpleNamespace]:
    large = strands.enlarged(painted, len(used))
    return strands.hair_textures(style, strands.hair_strands(large, used, ends))


def test_hair_is_grey_with_alpha_where_it_is_used_alone(build_module: Module) -> None:
    strands, textures = build_module("character_strands"), build_module("character_textures")
    painted = np.zeros((64, 64, 4))
    painted[8:56, 8:56] = (0.5, 0.2, 0.1, 1.0)
    painted[2:4, 20:22] = (0.5, 0.2, 0.1, 1.0)
    painted[8:56, 8:56, :3] *= np.random.default_rng(4).uniform(0.6, 1, (48, 48, 1))
    used = np.zeros((128, 128), dtype=bool)
    used[:, :64] = True
    none = np.zeros_like(used)
    colour, normals = _textures(strands, "bob", painted, used, (none, none))
    assert (colour.name, normals.name) == ("hair_bob_color", "hair_bob_normal")
    pixels = _pixels(colour.content)
    assert np.array_equal(pixels[..., 0], pixels[..., 2])
    assert (pixels[:, 64:, 3] == 0).all()
    assert (pixels[40:88, 24:60, 3] > 0.8).all()
    assert (pixels[3:9, 39:45, 3] < strands.ALPHA_CUTOFF).all(), "a fleck by itself"
    middle = textures.to_linear(pixels[40:88, 24:60, 0]).mean()
    assert middle == pytest.approx(strands.STRANDS_MEAN_LINEAR, rel=0.25)


def test_a_hairline_has_no_pale_edge_and_no_scraps_before_it(build_module: Module) -> None:
    strands, textures = build_module("character_strands"), build_module("character_textures")
    rows, columns = np.mgrid[:256, :256]
    painted = np.zeros((256, 256, 4))
    painted[..., :3] = np.where(columns < 124, 0.5, 0.9)[..., None]
    painted[..., 3] = np.where(columns < 128, 1.0, np.where((columns < 144) & (rows % 6 < 3), 0.12, 0.0))
    painted[:6, :, 3] = 0.0
    used = np.ones((1024, 1024), dtype=bool)
    colour, _ = _textures(strands, "cap", painted, used, (~used, ~used))
    pixels = _pixels(colour.content)
    shade = textures.to_linear(pixels[200:900, :, 0])
    assert shade[:, 508:516].mean() < 1.2 * shade[:, 300:450].mean()
    assert (pixels[200:900, 300:475, 3] == 1).all()
    assert (pixels[200:900, 530:, 3] > 0).mean() < 0.035


def test_hair_dissolves_where_its_mesh_ends_but_not_along_a_seam(build_module: Module) -> None:
    strands, assets = build_module("character_strands"), build_module("character_assets")
    # Two quads that meet in space, whose parts of the texture do not.
    uvs = np.array([(0, 0), (0.45, 0), (0.45, 1), (0, 1), (0.55, 0), (1, 0), (1, 1), (0.55, 1)], dtype=float)
    places = np.array([(0, 0, 0), (0.1, 0, 0), (0.1, 0.1, 0), (0, 0.1, 0)] * 2, dtype=float)
    places[4:, 0] += 0.1
    faces = np.arange(8).reshape(2, 4)
    asset = assets.Asset("a", None, faces, faces, uvs, np.zeros(0), None)
    ends, roots = strands.mesh_ends(asset, places, np.arange(8) < 4, 200)
    assert ends[100, 0:2].any()
    assert ends[100, -2:].any()
    assert not ends[100, 80:120].any()
    assert roots[100, 0:2].any()
    assert not roots[100, -2:].any()
    painted = np.ones((64, 64, 4))
    used = np.ones((1024, 1024), dtype=bool)
    edge = np.zeros_like(used)
    edge[:, :2] = True
    alpha = _pixels(_textures(strands, "cap", painted, used, (edge, ~used))[0].content)[100:900, :, 3]
    shown = (alpha > strands.ALPHA_CUTOFF).mean(axis=0)
    assert shown[2:4].mean() < 0.3 < shown[4:10].mean() < 0.8
    assert (shown[strands.FRINGE_PX + 4 :] == 1.0).all()


def test_a_band_of_hair_does_not_dissolve(build_module: Module) -> None:
    strands = build_module("character_strands")
    used, ends = np.zeros((256, 256), dtype=bool), np.zeros((256, 256), dtype=bool)
    used[:, 80:176] = True
    ends[:, [80, 81, 174, 175]] = True
    colour, _ = _textures(strands, "band", np.ones((64, 64, 4)), used, (ends, np.zeros_like(used)))
    assert (_pixels(colour.content)[..., 3] > strands.ALPHA_CUTOFF).sum() > 0.9 * used.sum()


def test_fine_hairs_bridge_from_the_edge_of_hair_to_the_skin(build_module: Module) -> None:
    fine, surface = build_module("character_fine_hair"), build_module("character_surface")
    # A cap of hair, 4 mm over a flat scalp, whose picture ends at a line across its middle.
    steps = np.linspace(0.0, 1.0, 9)
    x, z = (0.2 * grid.ravel() for grid in np.meshgrid(steps, steps))
    places = np.stack([x, np.full(81, 0.004), z], axis=1)
    first = (np.arange(8)[:, None] * 9 + np.arange(8)).reshape(-1, 1)
    quads = first + np.array([0, 9, 10, 1])
    cap = surface.modelled(
        "hair", places, np.ones((81, 1)), {"hair": surface.triangulate(quads, places)}, uvs=places[:, [0, 2]] / 0.2
    )
    ground = places - [0.0, 0.004, 0.0]
    skin = fine.skin_of(SimpleNamespace(vertices=ground, groups={"body": SimpleNamespace(vertices=quads)}))
    rows, _ = np.mgrid[:512, :512]
    along = np.broadcast_to([1.0, 0.0], (512, 512, 2))
    made = fine.with_fine_hairs(cap, skin, along, rows < 256, rows >= 256, (400, 10))
    cards = made.positions[81:].reshape(-1, 6, 3)
    assert len(made.triangles["hair"]) == len(cap.triangles["hair"]) + 4 * len(cards)
    edge = cards[np.abs(cards[:, 2:4, 2].mean(axis=1) - 0.1) < 0.001]
    assert 40 < len(edge) < fine.MOST
    # The picture's lower rows, where the skin is bare, lie towards z = 0.
    beyond_m = 0.7 * fine.OUTSIDE * fine.LENGTH_M[0] - 0.001
    assert (edge[:, 4:, 2].mean(axis=1) < 0.1 - beyond_m).all()
    assert (edge[:, :2, 2].mean(axis=1) > 0.1025).all()
    assert edge[:, 4:, 1] == pytest.approx(fine.ABOVE_SKIN_M, abs=1e-6), "on the skin"
    assert (edge[:, :2, 1] > 0.004).all(), "on the hair"
    gaps = np.diff(np.sort(edge[:, 2:4, 0].mean(axis=1)))
    assert gaps.max() < 0.012, "no part of the edge is left out"
    drawn = made.uvs[81:]
    u, v = drawn[:, 0] * 512, (1.0 - drawn[:, 1]) * 512
    assert u.min() >= 10
    assert u.max() <= 10 + fine.PATCH_PX[1]
    assert v.min() >= 400
    assert v.max() <= 400 + fine.PATCH_PX[0]
    # Normals of cards are those of the hair beneath, so that no card is lit apart.
    assert made.normals[81:] == pytest.approx(np.tile([0.0, 1.0, 0.0], (6 * len(cards), 1)))


def test_tufts_are_lit_like_the_cap_that_they_stand_on(build_module: Module) -> None:
    strands, surface = build_module("character_strands"), build_module("character_surface")
    cap = np.array([(0, 0, 0), (0, 0, 0.2), (0.2, 0, 0.2), (0.2, 0, 0)], dtype=float)
    tuft = np.array([(0.1, 0.005, 0.1), (0.11, 0.008, 0.1), (0.11, 0.008, 0.11)], dtype=float)
    faces = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6]])
    for turned in (faces, np.array([[0, 1, 2], [0, 2, 3], [4, 6, 5]])):
        whole = surface.modelled("hair", np.concatenate([cap, tuft]), np.ones((7, 1)), {"hair": turned})
        made = strands.lit_like_the_cap(whole)
        assert made.normals == pytest.approx(np.tile([0.0, 1.0, 0.0], (7, 1)))
        a, b, c = made.positions[made.triangles["hair"][2]]
        assert np.cross(b - a, c - a)[1] > 0


def test_single_hairs_are_drawn_where_nothing_else_is(build_module: Module) -> None:
    fine = build_module("character_fine_hair")
    used = np.ones((512, 512), dtype=bool)
    assert fine.free_patch(used) is None
    used[300:450, 100:400] = False
    row, column = fine.free_patch(used)
    assert not used[row : row + fine.PATCH_PX[0], column : column + fine.PATCH_PX[1]].any()
    shade, alpha = fine.drawn_hairs()
    assert shade.shape == alpha.shape == fine.PATCH_PX
    outer, middle, inner = (alpha[rows].mean() for rows in (slice(0, 8), slice(40, 60), slice(-4, None)))
    assert outer < 0.5 * middle, "thin towards the skin"
    assert inner < middle
    assert np.abs(fine.drawn_hairs(curled=True)[1] - alpha).max() > 0.5


@pytest.mark.parametrize("style", PAINTED)
def test_a_style_keeps_the_hair_that_is_painted(style: str) -> None:
    (path,) = HAIR.glob(f"*/{style}.glb")
    stored = gltf.GLTF2().load(str(path))
    view = stored.bufferViews[next(one.bufferView for one in stored.images if one.name == f"hair_{style}_color")]
    start = view.byteOffset or 0
    alpha = _pixels(bytes(stored.binary_blob()[start : start + view.byteLength]))[..., 3]
    assert (alpha > stored.materials[0].alphaCutoff).mean() > 0.8 * PAINTED[style]


def test_brows_and_lashes_share_a_picture_and_lower_lashes_are_thin(build_module: Module, tmp_path: Path) -> None:
    strands, assets = build_module("character_strands"), build_module("character_assets")
    lashes = build_module("character_lashes")
    picture = np.zeros((64, 64, 4), dtype=np.uint8)
    picture[16:48, 16:48, 3] = 255
    Image.fromarray(picture).save(tmp_path / "a.png")
    material = tmp_path / "a.mhmat"
    material.write_text("name a\ndiffuseTexture a.png\n", encoding="utf-8")
    corners = np.arange(8)[:, None].repeat(3, axis=1)
    binding = assets.Binding(corners, np.full((8, 3), 1 / 3), np.zeros((8, 3)), np.zeros((3, 2)), np.ones(3))
    # Two quads, the left and the right half of the picture; the right one is the lower lid's.
    uvs = np.array([(0, 0), (0.5, 0), (0.5, 1), (0, 1), (0.5, 0), (1, 0), (1, 1), (0.5, 1)], dtype=float)
    faces = np.arange(8).reshape(2, 4)
    asset = assets.Asset("a", binding, faces, faces, uvs, np.zeros(0), material)
    texture, brow, lash = lashes.brow_textures(
        "x", replace(asset, name="b"), asset, np.array([4, 5, 6, 7]), np.array([False, True])
    )
    # Both halves show one strip, the right one from the other side.
    assert np.allclose(brow.uvs[faces[1], 0], 1.0 - brow.uvs[faces[0], 0], atol=0.01)
    assert brow.uvs[:, 1].min() >= 0.5
    assert lash.uvs[:, 1].max() <= 0.5
    alpha = _pixels(texture.content)[..., 3]
    height, width = alpha.shape
    assert (alpha[: height // 2] > strands.ALPHA_CUTOFF).any()
    below = alpha[3 * height // 4]
    assert below[3 * width // 8] > 0.9
    assert below[5 * width // 8] < 0.7
    assert alpha[0].max() == 0


def test_brows_are_hairs_between_which_skin_is_seen(build_module: Module) -> None:
    brows = build_module("character_brow_hairs")
    painted = np.zeros((256, 1024))
    painted[90:160, 40:980] = 1.0
    painted[200:215, 900:1024] = 1.0
    shade, alpha = brows.brow_hairs(painted)
    assert shade.shape == alpha.shape == painted.shape
    seen = alpha > build_module("character_strands").ALPHA_CUTOFF
    number = [seen[100:150, column : column + 60].mean() for column in (45, 200, 500, 900)]
    assert 0.4 < number[2] < 0.9, "closed, or bald"
    assert number[0] < 0.8 * number[2], "the inner end is open"
    assert number[3] < 0.8 * number[2], "the outer end thins out"
    assert 0.0 < seen[80:90, 200:800].mean() < 0.6 * number[2], "no edge"
    upright = [
        np.abs(np.diff(alpha[:, place], axis=1)).mean() / np.abs(np.diff(alpha[:, place], axis=0)).mean()
        for place in (slice(60, 120), slice(400, 600))
    ]
    assert upright[0] > 2.0 * upright[1], "hairs of the inner end stand up"
    assert alpha[195:, 960:].max() == 0.0, "the tail of the brow beside it"
    assert np.array_equal(brows.brow_hairs(painted)[1], alpha)
    assert brows.brow_hairs(np.zeros((64, 64)))[1].max() == 0.0


def test_teeth_gums_and_tongue_have_patches_of_their_own(build_module: Module) -> None:
    mouth, surface, textures = (build_module(f"character_{name}") for name in ("mouth", "surface", "textures"))
    picture = textures.to_srgb(mouth.mouth_patches(128))
    points = np.random.default_rng(6).normal(0, 1, (9, 3))
    triangles = {name: np.array([[3 * row, 3 * row + 1, 3 * row + 2]]) for row, name in enumerate(mouth.PATCHES)}
    inside = mouth.with_wet_material(surface.modelled("mouth", points, np.ones((9, 1)), triangles))
    assert list(inside.triangles) == [mouth.WET]
    assert (inside.uvs[:, 0] > mouth.PATCHES_LEFT).all()
    colours = picture[((1 - inside.uvs[:, 1]) * 128).astype(int), (inside.uvs[:, 0] * 128).astype(int)]
    teeth = np.repeat([name == "teeth" for name in mouth.PATCHES], 3)
    assert (colours[teeth, 1] > 0.7).all(), "teeth are pale"
    assert (colours[~teeth, 1] < 0.55).all()
    assert (colours[~teeth, 0] > 0.55).all(), "gums and tongue are red"


def test_a_file_holds_each_picture_once_with_tiles_and_cut_alpha(build_module: Module, tmp_path: Path) -> None:
    glb, surface, textures = (build_module(f"character_{name}") for name in ("glb", "surface", "textures"))
    colour = textures.png("hair_color", np.full((4, 4, 4), 0.5))
    normal = textures.png("skin_normal", np.full((4, 4, 3), 0.5))
    orm = textures.jpeg("skin_orm", np.full((4, 4, 3), 0.5))
    materials = {
        "skin": glb.Material(
            (1.0, 1.0, 1.0), 1.0, normal_texture=normal, normal_scale=0.5, normal_tiles=9.0, orm_texture=orm
        ),
        "hair": glb.Material((0.2, 0.1, 0.05), 0.6, two_sided=True, colour_texture=colour, alpha_cutoff=0.4),
        "brows": glb.Material((0.2, 0.1, 0.05), 0.6, colour_texture=colour),
        "unused": glb.Material((0.0, 0.0, 0.0), 0.6, colour_texture=textures.png("no", np.zeros((2, 2, 3)))),
    }
    body = surface.modelled(
        "body", np.eye(3), np.ones((3, 1)), {name: np.array([[0, 1, 2]]) for name in ("skin", "hair", "brows")}
    )
    fit = SimpleNamespace(names=("hips",), parents=(-1,), world_from_joint_rest=np.eye(4)[None])
    path = tmp_path / "character.glb"
    meta = {"name": "x", "copyrightInformation": "y"}
    glb.write_character(path, fit, np.zeros((1, 3)), [body], materials, meta, {})
    stored = gltf.GLTF2().load(str(path))
    assert [image.name for image in stored.images] == ["skin_normal", "skin_orm", "hair_color"]
    for image, texture in zip(stored.images, (normal, orm, colour), strict=True):
        view = stored.bufferViews[image.bufferView]
        assert stored.binary_blob()[view.byteOffset : view.byteOffset + view.byteLength] == texture.content
        assert image.mimeType == texture.mime_type
    assert stored.extensionsUsed == ["VRMC_vrm", "KHR_texture_transform"]
    skin, hair, brows = stored.materials
    assert (skin.normalTexture.index, skin.normalTexture.scale) == (0, 0.5)
    assert skin.normalTexture.extensions["KHR_texture_transform"]["scale"] == [9.0, 9.0]
    assert skin.pbrMetallicRoughness.metallicRoughnessTexture.index == skin.occlusionTexture.index == 1
    assert hair.pbrMetallicRoughness.baseColorTexture.index == brows.pbrMetallicRoughness.baseColorTexture.index == 2
    assert (hair.alphaMode, hair.alphaCutoff, brows.alphaMode) == ("MASK", 0.4, "OPAQUE")
