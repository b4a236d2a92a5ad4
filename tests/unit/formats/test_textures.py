"""Textures: read within bounds, made smaller, named safely, and written so that they come back."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from app.formats.gltf.read_scene import read_scene
from app.formats.gltf.write import write_glb
from app.formats.images import ImageReader, decoded, resized
from app.formats.scene import Material
from app.formats.texture_colors import without_textures
from app.formats.textures import NO_TEXTURES, MaterialTextures, TextureUse, texture_of
from tests.support.textured import card_material, encoded, letter, textured_scene


def test_a_glb_file_holds_all_that_a_textured_material_is(tmp_path: Path) -> None:
    scene = textured_scene()
    write_glb(tmp_path / "card.glb", scene)
    (mesh,) = read_scene(tmp_path / "card.glb", scene.meshes).meshes
    (material,) = mesh.materials
    assert material == card_material()
    color = material.textures.color
    assert color is not None
    assert color.texture.content == encoded(letter())
    assert mesh.uvs is not None
    assert np.allclose(mesh.uvs[0], [0.0, 0.0])
    assert np.allclose(mesh.uvs[2], [1.0, 1.0])


def test_an_image_of_several_materials_is_once_in_a_glb_file(tmp_path: Path) -> None:
    noise = np.random.default_rng(1).integers(0, 255, (64, 64, 3), np.uint8)
    use = TextureUse(texture_of("noise", encoded(noise)))
    one = Material("one", (1.0, 1.0, 1.0, 1.0), textures=MaterialTextures(color=use))
    write_glb(tmp_path / "one.glb", textured_scene(one))
    write_glb(tmp_path / "two.glb", textured_scene(one, replace(one, name="two")))
    grown = (tmp_path / "two.glb").stat().st_size - (tmp_path / "one.glb").stat().st_size
    assert grown < len(use.texture.content) / 4


@pytest.mark.parametrize("name", ["../../x", "C:\\x", "con", "", "顔", "a" * 300, "a/b.png\0"])
def test_the_name_of_a_textures_file_is_no_path(name: str) -> None:
    made = texture_of(name, encoded(letter())).file_name
    assert Path(made).name == made
    assert len(made) < 60
    assert made.isascii()
    assert set(made[:-4]) <= set("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-")
    assert made.endswith(".png")
    assert Path(made).stem.lower() not in ("con", "nul", "aux")


def test_textures_are_made_smaller_and_keep_colours_of_what_is_cut_out() -> None:
    pixels = letter()
    pixels[32:, 32:] = (10, 200, 30, 0)
    use = TextureUse(texture_of("leaf", encoded(pixels)))
    fitted = resized(MaterialTextures(color=use), 16).color
    assert fitted is not None
    assert fitted.texture != use.texture
    small = np.asarray(Image.open(io.BytesIO(fitted.texture.content)))
    assert small.shape == (16, 16, 4)
    assert small[-1, -1].tolist() == [10, 200, 30, 0]
    assert resized(MaterialTextures(color=use), 64).color == use


def test_images_that_other_programs_may_not_read_are_written_again() -> None:
    pixels = letter()
    for kind in ("WEBP", "BMP", "TGA"):
        content = encoded(pixels[..., :3] if kind == "BMP" else pixels, kind)
        texture = ImageReader(len(content)).texture("x", content)
        assert texture is not None
        assert texture.mime_type == "image/png"
        shown = decoded(texture, 64)
        assert shown is not None
        assert np.abs(shown[6, 6].astype(int) - (220, 10, 10, 255)).max() < 30
    stream = io.BytesIO()
    Image.fromarray(pixels[..., :3]).convert("CMYK").save(stream, "JPEG")
    texture = ImageReader(1000).texture("x", stream.getvalue())
    assert texture is not None
    assert texture.mime_type == "image/png"


def test_images_without_end_are_refused() -> None:
    whole = encoded(letter())
    assert ImageReader(1000).texture("x", whole) is not None
    assert ImageReader(1000).texture("x", whole[:-30]) is None
    assert ImageReader(1000).texture("x", b"\xff\xd8" + b"\xff\xda" * 100) is None
    stream = io.BytesIO()
    Image.new("1", (9000, 10)).save(stream, "PNG")
    assert ImageReader(1000).texture("x", stream.getvalue()) is None
    # A file's images together may have so many pixels as its bytes let expect.
    reader, found = ImageReader(0), 0
    for shade in range(6):
        stream = io.BytesIO()
        Image.new("L", (2048, 2048), shade).save(stream, "PNG")
        found += reader.texture("x", stream.getvalue()) is not None
    assert found == 4


def test_a_mesh_without_textures_has_their_mean_colours() -> None:
    (mesh,) = textured_scene().meshes
    inside = replace(mesh, uvs=np.full((4, 2), (0.09, 0.92)))
    (plain,) = without_textures(inside).materials
    assert plain.textures == NO_TEXTURES
    assert plain.alpha_mode == "opaque"
    red, green, _, _ = plain.base_color
    assert red == pytest.approx(0.716, abs=0.01)
    assert green < 0.01
    assert plain.roughness == pytest.approx(64 / 255, abs=0.02)
