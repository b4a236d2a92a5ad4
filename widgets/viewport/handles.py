"""Draggable handles on a player for the pose of bell, head, elbows or trunk, and the effect of drags."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal, cast

import msgspec
import numpy as np

from app.arrays import FloatArray
from app.plan.by_hand.corrections import Correction, PoseCorrection
from app.plan.events_by_hand import PoseTarget
from app.project.edit import corrections as edit
from app.project.model import Project
from app.rig.model import InstrumentModel
from instrument_maps.model import ROOT
from widgets.viewport.camera import Camera
from widgets.viewport.cast import Stage

Angle = Literal["up_deg", "left_deg", "roll_deg"]

TARGETS: tuple[PoseTarget, ...] = ("bell", "head", "left_elbow", "right_elbow", "torso")
HEAD_ARM_M, ROLL_ARM_M = 0.25, 0.25
"""Distances in metres of a drag that equal one radian if the handle itself hardly moves."""
_SMALL, _DAMPING = 1e-4, 0.06
FINER = 0.25
"""Factor of a drag with Shift."""


@dataclass(frozen=True, eq=False)
class Handle:
    """A handle that rotates a part about a point.

    Attributes
    ----------
    target : PoseTarget
    at_m : (3,) float64
        Displayed position in the world.
    turns : tuple of (Angle, (3,) float64)
        Motion of the handle in metres per radian of each angle that a drag changes.
    leans : tuple of (Angle, (3,) float64)
        Likewise for a drag with Alt.
    """

    target: PoseTarget
    at_m: FloatArray
    turns: tuple[tuple[Angle, FloatArray], ...]
    leans: tuple[tuple[Angle, FloatArray], ...]


def handles(stage: Stage, row: int) -> tuple[Handle, ...]:
    """Return the handles by which the present pose of the player in ``row`` can be dragged; empty if the player is not
    drawn.
    """
    if not stage.shown[row]:
        return ()
    frame = stage.members[row].world_from_player
    left, up, ahead = frame[:, 0], frame[:, 1], frame[:, 2]
    assets = stage.members[row].assets
    held = stage.node_matrix(row)
    bell_m = held[:, :3] @ _bell(assets.instrument) + held[:, 3]
    rim_m = held[:, :3] @ np.asarray(assets.map.mouthpiece.position_m) + held[:, 3]
    head = stage.joints[row, assets.character.skeleton.index("head")]
    crown_m = head[:, :3] @ np.array([0.0, 0.2, 0.02]) + head[:, 3]
    hips_m = stage.joint_m(row, "hips")
    chest = "upperChest" if "upperChest" in assets.character.skeleton.names else "spine"
    breast_m = stage.joint_m(row, chest) + 0.12 * ahead
    return (
        Handle("bell", bell_m, _turns(bell_m - rim_m, up_deg=-left, left_deg=up), (("roll_deg", ROLL_ARM_M * left),)),
        Handle(
            "head",
            crown_m,
            (("up_deg", HEAD_ARM_M * up), ("left_deg", HEAD_ARM_M * left)),
            (("roll_deg", HEAD_ARM_M * left),),
        ),
        _elbow(stage, row, "left_elbow", left, up),
        _elbow(stage, row, "right_elbow", -left, up),
        Handle(
            "torso",
            breast_m,
            _turns(breast_m - hips_m, up_deg=-left, roll_deg=-ahead),
            (("left_deg", HEAD_ARM_M * left),),
        ),
    )


def _turns(arm_m: FloatArray, **axes: FloatArray) -> tuple[tuple[Angle, FloatArray], ...]:
    """Return for each named angle the motion (3,) of an arm's end, metres per radian, when it turns about the angle's
    axis through its other end."""
    return tuple((cast(Angle, angle), np.cross(axis, arm_m)) for angle, axis in axes.items())


def _elbow(stage: Stage, row: int, target: PoseTarget, outwards: FloatArray, up: FloatArray) -> Handle:
    """Return the handle of an elbow, which rotates about the line from shoulder to wrist."""
    side = target.split("_")[0]
    shoulder, elbow, wrist = (stage.joint_m(row, side + name) for name in ("UpperArm", "LowerArm", "Hand"))
    line = (wrist - shoulder) / max(float(np.linalg.norm(wrist - shoulder)), 1e-6)
    arm = elbow - shoulder - line * float((elbow - shoulder) @ line)
    swing = np.cross(line, arm)
    if swing @ (outwards + up) < 0.0:
        swing = -swing
    return Handle(target, elbow, (("up_deg", swing),), ())


@lru_cache(maxsize=64)
def _bell(model: InstrumentModel) -> FloatArray:
    """Return the far end (3,) of the instrument's fixed part in its own frame: usually the middle of the bell."""
    root = model.node_names.index(ROOT)
    places = np.concatenate([mesh.positions_m[mesh.joints[:, 0] == root] for mesh in model.meshes])
    far = places[:, 2] > places[:, 2].max() - 0.01
    end: FloatArray = places[far].astype(np.float64).mean(axis=0)
    return end


def dragged(
    handle: Handle, camera: Camera, right_px: float, down_px: float, height_px: float, lean: bool
) -> dict[Angle, float]:
    """Return the change of each joint angle, degrees, when a handle is dragged by ``right_px`` and ``down_px`` in a
    picture ``height_px`` high; ``lean`` (Alt) changes the angles in `Handle.leans`, if any.

    The handle follows the pointer as well as its rotations allow: least squares in the picture, excluding rotations
    towards the viewer.
    """
    turns = handle.leans if lean and handle.leans else handle.turns
    depth_m = float((camera.eye_m - handle.at_m) @ camera.backward)
    scale = camera.pixels_per_metre(height_px, max(depth_m, 0.05))
    # Pixels per radian, including perspective when a handle comes nearer.
    places, _ = camera.project([handle.at_m, *(handle.at_m + _SMALL * turn for _, turn in turns)], height_px, height_px)
    columns = (places[1:] - places[0]).T / _SMALL
    lengths = np.linalg.norm(columns, axis=0)
    fullest = max((float(np.linalg.norm(turn)) for _, turn in turns), default=0.0) * scale
    # A rotation seen along its axis would need huge angles for small drags.
    seen = lengths > 0.3 * max(fullest, 1e-9)
    result: dict[Angle, float] = {angle: 0.0 for angle, _ in turns}
    if seen.any():
        own = columns[:, seen]
        # Rotations that look alike from here share the drag instead of opposing each other.
        damped = own.T @ own + (_DAMPING * fullest) ** 2 * np.eye(own.shape[1])
        solved = np.linalg.solve(damped, own.T @ np.array([right_px, down_px]))
        for index, value in zip(np.flatnonzero(seen), solved, strict=True):
            result[turns[int(index)][0]] = math.degrees(float(value))
    return result


@dataclass(frozen=True)
class CorrectionSpan:
    """Span in ticks in which a pose correction holds, with the length of its fades."""

    start_tick: int
    end_tick: int
    fade_ticks: int


def span_of(project: Project, chosen: tuple[int, int] | None, playhead_tick: int) -> CorrectionSpan:
    """Return the chosen span, else the bar at the playhead, with fades of a felt beat."""
    if chosen is not None:
        return CorrectionSpan(chosen[0], chosen[1], project.metre_map.felt_ticks_at(chosen[0]))
    metre_map = project.metre_map
    start, end = metre_map.span_of_bar(metre_map.bar_of_tick(max(playhead_tick, 0)))
    return CorrectionSpan(start, end, metre_map.felt_ticks_at(start))


def correction_at(
    project: Project, player_id: str, target: PoseTarget, chosen: tuple[int, int] | None, playhead_tick: int
) -> PoseCorrection | None:
    """Return the correction that a handle changes: the one of the chosen span, or in effect at the playhead."""
    own = [
        item
        for item in project.corrections.get(player_id, ())
        if isinstance(item, PoseCorrection) and item.target == target
    ]
    for item in reversed(own):
        if chosen is not None:
            if (item.start_tick, item.end_tick) == chosen:
                return item
        elif item.start_tick <= playhead_tick < item.end_tick:
            return item
    return None


def fresh_correction(project: Project, player_id: str, target: PoseTarget, span: CorrectionSpan) -> PoseCorrection:
    """Return a pose correction without effect, with an unused name."""
    taken = {item.name for item in project.corrections.get(player_id, ()) if isinstance(item, PoseCorrection)}
    number = 1
    while f"{target}_{number}" in taken:
        number += 1
    return PoseCorrection(
        name=f"{target}_{number}",
        target=target,
        start_tick=span.start_tick,
        end_tick=span.end_tick,
        fade_in_ticks=span.fade_ticks,
        fade_out_ticks=span.fade_ticks,
    )


Limits = Mapping[str, tuple[float, float]]
"""Lowest and highest degrees of every angle, as of `app.plan.by_hand.pose_corrections.pose_limits`."""


def turned(correction: PoseCorrection, angles_deg: dict[Angle, float], limits: Limits) -> PoseCorrection:
    """Return the correction with angles added within the limits of body and grip, rounded to a tenth of a degree."""
    changes = {}
    for angle, value in angles_deg.items():
        low, high = limits.get(angle, (0.0, 0.0))
        requested = min(max(getattr(correction, angle) + value, low), high)
        changes[angle] = math.trunc(10.0 * requested) / 10.0 if requested in (low, high) else round(requested, 1)
    return msgspec.structs.replace(correction, **changes)


def with_correction(project: Project, player_id: str, before: PoseCorrection, after: PoseCorrection) -> Project:
    """Return the project with a pose correction; one without effect is removed."""
    if _is_nothing(after):
        return edit.take_back(project, player_id, (before,))
    return edit.with_corrections(project, player_id, (after,))


def without_corrections(project: Project, player_id: str, corrections: Sequence[Correction]) -> Project:
    """Return the project without the given pose corrections of a player."""
    return edit.take_back(project, player_id, corrections)


def _is_nothing(correction: PoseCorrection) -> bool:
    return correction.up_deg == correction.left_deg == correction.roll_deg == 0.0
