"""Scenes as USD are valid according to OpenUSD's validators, and its own skinning gives the intended vertices."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.errors import FileError, UsageError
from app.formats.scene import Scene
from app.formats.usd import UsdSound, write_usd
from app.formats.usd_package import usd_installed
from app.messages import text
from tests.support.skinned import UsdFile
from tests.unit.export.scenes import random_scene, slow_positions_m
from tests.unit.formats import scenes

needs_usd = pytest.mark.skipif(not usd_installed(), reason="usd-core is not installed")


def _stage(path: Path, scene: Scene, sound: UsdSound | None = None) -> Any:
    from pxr import Usd

    write_usd(path, scene, sound)
    return Usd.Stage.Open(str(path))


@needs_usd
@pytest.mark.parametrize("seed", range(3))
def test_usd_deforms_the_mesh_as_meant(seed: int, tmp_path: Path) -> None:
    scene = random_scene(seed)
    write_usd(tmp_path / "scene.usdc", scene)
    file = UsdFile(tmp_path / "scene.usdc")
    for frame in (0, 3, 6):
        found_m = file.points_cm("/clip/cloud", frame) * 0.01
        np.testing.assert_allclose(found_m, slow_positions_m(scene, frame), atol=1e-6)


@needs_usd
@pytest.mark.parametrize("make", [scenes.character, scenes.instrument])
def test_the_validators_find_nothing(make: Any, tmp_path: Path) -> None:
    validation = pytest.importorskip("pxr.UsdValidation")
    (tmp_path / "song.wav").write_bytes(b"")
    stage = _stage(tmp_path / "scene.usdc", make(Fraction(24)), UsdSound("song.wav", 1.0))
    validators = validation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) > 10
    errors = validation.ValidationContext(validators).Validate(stage)
    assert [f"{error.GetName()}: {error.GetMessage()}" for error in errors] == []


@needs_usd
def test_what_the_stage_says(tmp_path: Path) -> None:
    from pxr import UsdGeom, UsdShade, UsdSkel

    scene = scenes.character(Fraction(30000, 1001), frames=31)
    stage = _stage(tmp_path / "scene.usdc", scene)
    assert UsdGeom.GetStageMetersPerUnit(stage) == 0.01
    assert UsdGeom.GetStageUpAxis(stage) == "Y"
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (0.0, 30.0)
    assert stage.GetTimeCodesPerSecond() == stage.GetFramesPerSecond() == 30000 / 1001
    motion = UsdSkel.Animation.Get(stage, "/Performance/Performance_motion")
    for attribute in (motion.GetRotationsAttr(), motion.GetTranslationsAttr(), motion.GetBlendShapeWeightsAttr()):
        assert attribute.GetTimeSamples() == list(map(float, range(31)))
    body = stage.GetPrimAtPath("/Performance/Body")
    subsets = UsdShade.MaterialBindingAPI(body).GetMaterialBindSubsets()
    mesh = scene.meshes[0]
    assert mesh.face_materials is not None
    for number, subset in enumerate(subsets):
        np.testing.assert_array_equal(subset.GetIndicesAttr().Get(), np.flatnonzero(mesh.face_materials == number))
        material, _ = UsdShade.MaterialBindingAPI(subset.GetPrim()).ComputeBoundMaterial()
        shader, *_ = material.ComputeSurfaceSource()
        given = mesh.materials[number]
        assert tuple(shader.GetInput("diffuseColor").Get()) == pytest.approx(given.base_color[:3])
        for name, value in (
            ("metallic", given.metallic),
            ("roughness", given.roughness),
            ("opacity", given.base_color[3]),
        ):
            assert shader.GetInput(name).Get() == pytest.approx(value)


@needs_usd
def test_names_stay_whole_where_usd_allows_other_ones_only(tmp_path: Path) -> None:
    from pxr import UsdSkel

    scene = scenes.character(Fraction(24), frames=3)
    assert scene.clip is not None
    bones = list(scene.bones)
    bones[1], bones[2] = replace(bones[1], name="mixamorig:Hips"), replace(bones[2], name="mixamorig Hips")
    mesh = replace(scene.meshes[0], name="Materials")
    morphs = tuple(replace(morph, name=name) for morph, name in zip(mesh.morphs, ("Body_front", "あ!"), strict=True))
    odd = replace(
        scene,
        bones=tuple(bones),
        meshes=(replace(mesh, morphs=morphs),),
        clip=replace(scene.clip, name="Trumpet 1 / B♭ 🎺", morph_weights={"あ!": np.array([0.0, 0.5, 1.0])}),
    )
    stage = _stage(tmp_path / "scene.usdc", odd)
    root = stage.GetDefaultPrim()
    assert root.GetDisplayName() == "Trumpet 1 / B♭ 🎺"
    skeleton = UsdSkel.Skeleton(root.GetChild(f"{root.GetName()}_skeleton"))
    assert list(skeleton.GetJointNamesAttr().Get()) == [bone.name for bone in bones]
    joints = list(skeleton.GetJointsAttr().Get())
    assert joints[:3] == ["root", "root/mixamorig_Hips", "root/mixamorig_Hips/mixamorig_Hips_2"]
    valid, reason = UsdSkel.Topology(skeleton.GetJointsAttr().Get()).Validate()
    assert valid, reason
    renamed = root.GetChild("Materials_2")
    assert renamed.GetDisplayName() == "Materials"
    binding = UsdSkel.BindingAPI(renamed)
    assert list(binding.GetBlendShapesAttr().Get()) == ["Body_front", "あ!"]
    assert len(binding.GetBlendShapeTargetsRel().GetTargets()) == 2
    assert UsdFile(tmp_path / "scene.usdc").shown(1).weights == {"あ!": 0.5}


@needs_usd
@pytest.mark.parametrize("start_s", [1.5, -1.5])
def test_the_sound_plays_along(start_s: float, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    from pxr import UsdMedia

    (tmp_path / "song one.wav").write_bytes(b"")
    stage = _stage(tmp_path / "scene.usdc", scenes.instrument(Fraction(24)), UsdSound("song one.wav", start_s))
    sound = UsdMedia.SpatialAudio(stage.GetDefaultPrim().GetChild("Sound"))
    assert sound.GetFilePathAttr().Get().path == "./song one.wav"
    assert Path(sound.GetFilePathAttr().Get().resolvedPath) == tmp_path / "song one.wav"
    assert sound.GetStartTimeAttr().Get().GetValue() == max(start_s, 0) * 24
    assert sound.GetMediaOffsetAttr().Get() == max(-start_s, 0)
    assert sound.GetAuralModeAttr().Get() == "nonSpatial"
    assert sound.GetPlaybackModeAttr().Get() == "onceFromStart"
    assert capfd.readouterr() == ("", "")


@needs_usd
def test_the_same_scene_gives_the_same_bytes_and_text_says_the_same(tmp_path: Path) -> None:
    for name in ("one.usdc", "two.usdc"):
        write_usd(tmp_path / name, scenes.character(Fraction(25)))
    assert (tmp_path / "one.usdc").read_bytes() == (tmp_path / "two.usdc").read_bytes()
    write_usd(tmp_path / "text.usda", scenes.character(Fraction(25)))
    assert (tmp_path / "text.usda").read_text(encoding="utf-8").startswith("#usda 1.0")


@needs_usd
def test_a_still_scene_and_a_bare_skeleton(tmp_path: Path) -> None:
    from pxr import UsdSkel

    scene = scenes.character(Fraction(24))
    still = _stage(tmp_path / "still.usdc", replace(scene, clip=None), UsdSound("song.wav", 0.0))
    assert [child.GetName() for child in still.GetDefaultPrim().GetChildren()] == [
        "root_skeleton", "Body", "Materials", "Teeth", "Shirt",
    ]  # fmt: skip
    bare = _stage(tmp_path / "bare.usdc", replace(scene, clip=None, meshes=()))
    binds = UsdSkel.Skeleton(bare.GetDefaultPrim().GetChild("root_skeleton")).GetBindTransformsAttr().Get()
    offsets = np.array([bone.translation_cm for bone in scene.bones])
    rotations = np.array([bone.rotation_xyzw for bone in scene.bones])
    world = scenes.world_from_bones(scene.bones, offsets[None], rotations[None])[0]
    np.testing.assert_allclose(np.array(binds).transpose(0, 2, 1), world, atol=1e-12)


@needs_usd
def test_a_folder_that_is_not_there_is_reported(tmp_path: Path) -> None:
    with pytest.raises(FileError) as reported:
        write_usd(tmp_path / "nowhere" / "scene.usdc", scenes.instrument(Fraction(24)))
    assert reported.value.message.id == "file.cannot_write"


def test_without_usd_core_the_remedy_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.formats.usd_package.importlib.util.find_spec", lambda name: None)
    with pytest.raises(UsageError) as reported:
        write_usd(tmp_path / "scene.usdc", scenes.instrument(Fraction(24)))
    assert "pip install usd-core" in text(reported.value.message)
    assert not list(tmp_path.iterdir())


@needs_usd
@pytest.mark.skipif(sys.platform != "linux", reason="numpy asks the system's loader on Linux only")
def test_the_package_is_loaded_while_another_thread_asks_the_loader(tmp_path: Path) -> None:
    """The other thread holds the interpreter's lock, like numpy when it looks up its caller."""
    script = f"""
import ctypes, faulthandler, threading
from fractions import Fraction
from app.formats.usd import write_usd
from tests.unit.formats import scenes

faulthandler.dump_traceback_later(60, exit=True)
python, answer = ctypes.PyDLL(None), ctypes.create_string_buffer(64)
place = ctypes.cast(python.PyNumber_Or, ctypes.c_void_p)
thread = threading.Thread(target=write_usd, args=({str(tmp_path / "scene.usdc")!r}, scenes.instrument(Fraction(24))))
thread.start()
while thread.is_alive():
    python.dladdr(place, answer)
"""
    root = Path(__file__).parents[3]
    done = subprocess.run([sys.executable, "-c", script], cwd=root, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "scene.usdc").stat().st_size > 0
