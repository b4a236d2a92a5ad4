"""A dancer's files, and what is measured on them once they are read back."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from app.choreography.contacts import BoolArray
from app.choreography.feet import SIDES
from app.choreography.retarget import foot_tip_m
from app.export.joint_playback import JointPlayback
from app.export.playback import Playback
from app.export.report import DancerMeasures
from app.export.target import TargetSkeleton
from app.formats.scene import Scene
from app.performance.dancers import Dancing
from app.performance.span import FrameSpan
from app.rig import quaternion
from app.rig.model import Character

FloatArray = npt.NDArray[np.float64]


def standing_frames(dancing: Dancing, span: FrameSpan) -> BoolArray:
    """(F, 2) in which frames of a span the left and the right foot stand."""
    result = np.zeros((span.first + span.count, 2), bool)
    for stand in dancing.dance(span.fps).standing:
        result[stand.start : stand.stop, stand.foot] = True
    return result[span.first :]


def measure_dancer(scene: Scene, character: Character, target: TargetSkeleton, standing: BoolArray) -> DancerMeasures:
    """Measure a file that was read back."""
    assert scene.clip is not None
    playback = Playback(scene, scene.clip)
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
