"""A dancer's files, written and then measured as a reader plays them back."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.export.attachment import without_place
from app.export.character import character_scene
from app.export.file_names import figure_stems, file_names
from app.export.formats import FILE_FORMATS
from app.export.joint_playback import JointPlayback
from app.export.keyed import key_count, keyed_character
from app.export.playback import ScenePlayback
from app.export.player import skeleton_report, write_options
from app.export.report import DancerMeasures, DancerReport, stage_place
from app.export.request import ExportCast, ExportRequest
from app.export.target import TargetSkeleton
from app.formats.fbx.read import read_scene
from app.formats.scene import Scene
from app.performance.dances import Dancing
from app.rig import quaternion
from app.rig.model import Character
from app.rig.sole import SIDES, foot_tip_m


def measure_dancer(scene: Scene, character: Character, target: TargetSkeleton, standing: BoolArray) -> DancerMeasures:
    """Measure a file that was read back."""
    assert scene.clip is not None
    playback = ScenePlayback(scene, scene.clip)
    joints = JointPlayback(playback, target, character)
    rate, frames = float(scene.clip.fps), scene.clip.frames
    world = playback.world(0, frames)
    lengths = np.linalg.norm(playback.translations_m(0, frames), axis=-1)
    rest = np.linalg.norm(playback.rest_m, axis=-1)
    speeds: list[FloatArray] = []
    lowest = np.inf
    for foot, side in enumerate(SIDES):
        bone = joints.bone(f"{side}Foot")
        joint = character.skeleton.index(f"{side}Foot")
        own = target.joint_from_bone[target.bone_of_joint[joint]]
        turned = quaternion.multiply(quaternion.from_matrix(world[:, bone, :3, :3]), quaternion.conjugate(own))
        tip = world[:, bone, :3, 3] + quaternion.rotate(turned, foot_tip_m(character.skeleton, side))
        lowest = min(lowest, float(tip[:, 1].min()))
        both = standing[1:frames, foot] & standing[: frames - 1, foot]
        speeds.append(np.linalg.norm(np.diff(tip, axis=0), axis=1)[both] * rate * 1000.0)
    slides = np.concatenate(speeds)
    return DancerMeasures(
        standing_s=round(len(slides) / rate, 2),
        slide_mm_s=round(float(slides.mean()) if len(slides) else 0.0, 3),
        slide_most_mm_s=round(float(slides.max(initial=0.0)), 3),
        bones_mm=round(1000.0 * float(np.abs(lengths - rest)[:, joints.rigid].max(initial=0.0)), 4),
        below_mm=round(1000.0 * max(0.0, -lowest), 3),
    )


def export_dancer(
    request: ExportRequest, cast: ExportCast, dancing: Dancing, folder: Path, reported: Callable[[float], None]
) -> DancerReport:
    """Write and measure the files of a dancer; parameters as of `app.export.player.export_player`."""
    dancer = next(one for one in request.dancers if one.id == dancing.dancer.id)
    checked, stem = cast.targets[dancer.id], figure_stems(request.performance)[dancer.id]["character"]
    files = file_names(request.performance, request.formats)[dancer.id]
    reported(0.0)
    character, target, span = dancing.character, checked.target, request.span
    motion = dancing.motion(span.fps, span.first, span.count)
    reported(0.3)
    scene = character_scene(character, motion, stem, request.creator, target)
    scene = keyed_character(scene, request.keys, request.formats, character, target)
    beside = write_options(request, character, target)
    for name, kind in FILE_FORMATS.items():
        if name in request.formats:
            kind.write(folder / files[f"character_{name}"], scene, beside)
    reported(0.8)
    measures = None
    if "fbx" in request.formats:
        read = read_scene(folder / files["character_fbx"])
        standing = dancing.standing(span.fps, span.first, span.count)
        measures = measure_dancer(without_place(read, target.place), character, target, standing)
    reported(1.0)
    return DancerReport(
        name=dancer.name,
        choreography=dancing.choreography_name,
        character=dancer.character_id,
        files=files,
        stage=stage_place(dancer.stage),
        steps=sum(span.first_frame_s <= start_s < span.end_s for start_s in dancing.starts_s(span.fps)),
        skeleton=skeleton_report(request, checked),
        measures=measures,
        keys=key_count(scene),
    )
