"""Textures: read within limits, reduced, given safe names, and equal after writing and reading."""

from __future__ import annotations

import io
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from app.formats.fbx.foreign import read_foreign_fbx
from app.formats.fbx.foreign_textures import FbxTextures
from app.formats.fbx.write import write_scene
from app.formats.gltf.read_scene import read_scene
from app.formats.gltf.write import write_glb
from app.formats.images import ImageReader, decoded, resized
from app.formats.scene import Material
from app.formats.texture_colors import without_textures
from app.formats.textures import NO_TEXTURES, MaterialTextures, TextureUse, texture_of
from app.formats.usd import write_usd
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


def read_back(path: Path) -> Material:
    """The material of an FBX file, converted by another program and read by the program's reader."""
    content = read_foreign_fbx(path)
    return FbxTextures(path, content).material(content.meshes[0].materials[0])


def test_an_fbx_file_has_its_textures_beside_it(tmp_path: Path) -> None:
    write_scene(tmp_path / "card.fbx", textured_scene())
    write_scene(tmp_path / "again.fbx", textured_scene())
    files = sorted(path.name for path in (tmp_path / "Textures").iterdir())
    assert [re.sub("_[0-9a-f]{8}", "", name) for name in files] == [
        *("card_color.png", "card_color_opacity.png", "card_normal.png", "card_orm_roughness.jpg"),
    ]
    material = read_back(tmp_path / "card.fbx")
    color, normal, packed = material.textures.color, material.textures.normal, material.textures.metallic_roughness
    assert color is not None
    assert normal is not None
    assert packed is not None
    shown, wanted = decoded(color.texture, 64), letter()
    assert shown is not None
    assert np.array_equal(shown[..., 3], wanted[..., 3])
    assert np.array_equal(shown[..., :3], wanted[..., :3])
    assert material.alpha_mode == "mask"
    # A tiled texture lies where it lay: within whole turns of the picture.
    meant = card_material().textures.normal
    assert meant is not None
    assert normal.texture.content == meant.texture.content
    assert normal.scale == pytest.approx(meant.scale)
    assert np.allclose((np.array(normal.offset) - meant.offset + 0.5) % 1.0, 0.5, atol=1e-5)
    assert material.textures.normal_scale == pytest.approx(0.5)
    rough = decoded(packed.texture, 8)
    assert rough is not None
    assert abs(int(rough[4, 4, 1]) - 64) <= 2
    # Without an image, metalness is a single number.
    assert material.metallic == 0.0


def test_a_colour_is_multiplied_into_an_fbx_files_image_and_an_opaque_one_has_no_alpha(tmp_path: Path) -> None:
    half = replace(card_material(), base_color=(0.5, 1.0, 1.0, 1.0), alpha=None)
    write_scene(tmp_path / "card.fbx", textured_scene(half))
    (file,) = (tmp_path / "Textures").glob("*tinted*")
    image = Image.open(file)
    assert image.mode == "RGB"
    # sRGB 188 is linear 0.5.
    assert image.getpixel((50, 10)) == (188, 255, 255)


def test_images_that_an_fbx_file_names_elsewhere_are_not_opened(tmp_path: Path) -> None:
    (tmp_path / "outside").mkdir()
    (tmp_path / "figure").mkdir()
    write_scene(tmp_path / "figure" / "card.fbx", textured_scene())
    (tmp_path / "figure" / "Textures").rename(tmp_path / "outside" / "Textures")
    assert read_back(tmp_path / "figure" / "card.fbx").textures == MaterialTextures(normal_scale=0.5)
    (tmp_path / "figure" / "Textures").symlink_to(tmp_path / "outside" / "Textures")
    assert read_back(tmp_path / "figure" / "card.fbx").textures == MaterialTextures(normal_scale=0.5)


def test_a_usd_file_shows_its_textures(tmp_path: Path) -> None:
    pxr = pytest.importorskip("pxr.UsdShade")
    from pxr import Usd

    write_usd(tmp_path / "card.usdc", textured_scene())
    stage = Usd.Stage.Open(str(tmp_path / "card.usdc"))
    shaders = {prim.GetName(): pxr.Shader(prim) for prim in stage.Traverse() if prim.IsA(pxr.Shader)}

    def inputs(name: str) -> dict[str, object]:
        return {one.GetBaseName(): one.Get() for one in shaders[name].GetInputs()}

    spaces = {name: inputs(name)["sourceColorSpace"] for name in ("Color", "Normal", "Roughness")}
    assert spaces == {"Color": "sRGB", "Normal": "raw", "Roughness": "raw"}
    for name in spaces:
        file = inputs(name)["file"].path  # type: ignore[attr-defined]
        assert file.startswith("./Textures/")
        assert (tmp_path / file).is_file()
    assert tuple(inputs("Normal_place")["scale"]) == pytest.approx((4.0, 3.0))
    assert inputs("Surface")["opacityThreshold"] == pytest.approx(0.4)
    surface = shaders["Surface"]
    linked = {one.GetBaseName() for one in surface.GetInputs() if one.HasConnectedSource()}
    assert linked == {"diffuseColor", "opacity", "normal", "roughness", "metallic", "occlusion"}


def test_the_alpha_of_a_tinted_picture_has_no_scale_in_usd(tmp_path: Path) -> None:
    """Blender takes the tinted color for the alpha of a picture that has a scale: heads were bald."""
    pxr = pytest.importorskip("pxr.UsdShade")
    from pxr import Usd

    write_usd(tmp_path / "card.usdc", textured_scene(replace(card_material(), base_color=(0.1, 0.05, 0.02, 1.0))))
    stage = Usd.Stage.Open(str(tmp_path / "card.usdc"))
    shaders = {prim.GetName(): pxr.Shader(prim) for prim in stage.Traverse() if prim.IsA(pxr.Shader)}
    assert tuple(shaders["Color"].GetInput("scale").Get()) == pytest.approx((0.1, 0.05, 0.02, 1.0))
    assert not shaders["Opacity"].GetInput("scale")
    (source, *_), *_ = shaders["Surface"].GetInput("opacity").GetConnectedSources()
    assert source.source.GetPrim().GetName() == "Opacity"
