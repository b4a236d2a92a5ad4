"""Export of a dancer: the files are written, read back and measured."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.errors import Progress
from app.export.attachment import without_place
from app.export.figures import dancer_scene
from app.export.file_names import file_names
from app.export.formats import requested
from app.export.joint_playback import JointPlayback
from app.export.playback import ScenePlayback
from app.export.player import read_again, skeleton_report, write_options
from app.export.report import DancerMeasures, DancerReport, character_report, stage_place
from app.export.request import CastDancing, ExportRequest
from app.export.scene_keys import key_count
from app.export.target import TargetSkeleton
from app.formats.scene import Scene
from app.rig import quaternion
from app.rig.model import Character
from app.rig.sole import SIDES, foot_tip_m, roll_point_m, without_stiff_toes


def measure_dancer(scene: Scene, character: Character, target: TargetSkeleton, standing: BoolArray) -> DancerMeasures:
    """Measure an exported file that was read back: sliding of standing feet (of the point about which they roll),
    changes of bone lengths, and tips of feet below the floor.

    ``standing`` (F, 2) is whether left and right foot are planned to stand.
    """
    assert scene.clip is not None
    playback = ScenePlayback(scene, scene.clip)
    joints = JointPlayback(playback, target, character)
    rate, frames = float(scene.clip.fps), scene.clip.frames
    world = playback.world(0, frames)
    lengths = np.linalg.norm(playback.translations_m(0, frames), axis=-1)
    rest = np.linalg.norm(playback.rest_m, axis=-1)
    speeds: list[FloatArray] = []
    lowest, rolling = np.inf, without_stiff_toes(character).skeleton
    for foot, side in enumerate(SIDES):
        end = f"{side}Toes" if f"{side}Toes" in rolling.names else f"{side}Foot"
        bone, joint = joints.bone(end), character.skeleton.index(end)
        own = target.joint_from_bone[target.bone_of_joint[joint]]
        turned = quaternion.multiply(quaternion.from_matrix(world[:, bone, :3, :3]), quaternion.conjugate(own))
        roll, to_tip = roll_point_m(rolling, side), foot_tip_m(rolling, side)
        if end.endswith("Toes"):
            roll, to_tip = np.zeros(3), to_tip - roll
        stays = world[:, bone, :3, 3] + quaternion.rotate(turned, roll)
        tip = world[:, bone, :3, 3] + quaternion.rotate(turned, to_tip)
        lowest = min(lowest, float(tip[:, 1].min()))
        both = standing[1:frames, foot] & standing[: frames - 1, foot]
        speeds.append(np.linalg.norm(np.diff(stays, axis=0), axis=1)[both] * rate * 1000.0)
    slides = np.concatenate(speeds)
    return DancerMeasures(
        standing_s=round(len(slides) / rate, 2),
        slide_mm_s=round(float(slides.mean()) if len(slides) else 0.0, 3),
        slide_most_mm_s=round(float(slides.max(initial=0.0)), 3),
        bones_mm=round(1000.0 * float(np.abs(lengths - rest)[:, joints.rigid].max(initial=0.0)), 4),
        below_mm=round(1000.0 * max(0.0, -lowest), 3),
    )


def export_dancer(request: ExportRequest, cast: CastDancing, folder: Path, reported: Progress) -> DancerReport:
    """Write and measure the files of a dancer; see `app.export.player.export_player` for the parameters."""
    dancer, dancing, span = cast.dancer, cast.dancing, request.span
    files, rows = file_names(request.performance, request.formats)[dancer.id], requested(request.formats)
    reported(0.0)
    motion = dancing.motion(span.fps, span.first, span.count)
    reported(0.3)
    scenes: dict[bool, Scene] = {}
    options = write_options(request, cast.character, cast.target)
    for row in rows:
        if row.humanoid not in scenes:
            scenes[row.humanoid] = dancer_scene(request, cast, motion, row)
        row.write(folder / files[row.key("character")], (scenes[row.humanoid],), options)
    reported(0.8)
    measures = None
    for row in rows:
        if row.read is not None and measures is None:
            path = folder / files[row.key("character")]
            read = read_again(row, path, scenes[row.humanoid], options.meshes)
            standing, target = dancing.standing(span.fps, span.first, span.count), cast.target_in(row)
            measures = measure_dancer(without_place(read, target.place), dancing.character, target, standing)
    reported(1.0)
    return DancerReport(
        name=dancer.name,
        choreography=dancing.choreography_name,
        character=dancer.character_id,
        files=files,
        stage=stage_place(dancer.stage),
        steps=sum(span.first_frame_s <= start_s < span.end_s for start_s in dancing.starts_s(span.fps)),
        skeleton=skeleton_report(request, cast.checked),
        measures=measures,
        keys=key_count(scenes[rows[0].humanoid]),
        person=character_report(dancer),
    )
