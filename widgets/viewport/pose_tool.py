"""The pose tool: drags of handles become corrections of the active player."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from app.editor.session import Session
from app.errors import Message
from app.performance.bodies import body_of
from app.plan.by_hand.corrections import PoseCorrection
from app.plan.by_hand.pose_corrections import pose_limits
from app.plan.events_by_hand import PoseTarget
from app.project.model import Project
from widgets.viewport.camera import Camera
from widgets.viewport.handles import (
    FINER,
    Angle,
    Handle,
    Limits,
    correction_at,
    dragged,
    fresh_correction,
    span_of,
    turned,
    with_correction,
    without_corrections,
)

_NAMES: dict[PoseTarget, Message] = {
    "bell": Message("edit.hold_bell"),
    "head": Message("edit.hold_head"),
    "left_elbow": Message("edit.hold_left_elbow"),
    "right_elbow": Message("edit.hold_right_elbow"),
    "torso": Message("edit.hold_torso"),
}


@dataclass(eq=False)
class _Drag:
    """State of a drag of a pose handle: the project at its start, the correction before, and the present one."""

    handle: Handle
    player_id: str
    project: Project
    before: PoseCorrection
    token: object
    limits: Limits
    right_px: float = 0.0
    down_px: float = 0.0
    after: PoseCorrection | None = None


class PoseTool:
    """Converts drags of handles to edits of a session's document.

    Parameters
    ----------
    session : Session
        Session with the document.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._drag: _Drag | None = None

    @property
    def grasped(self) -> PoseTarget | None:
        """Target of the current drag; None without a drag."""
        return self._drag.handle.target if self._drag is not None else None

    @property
    def correction(self) -> PoseCorrection | None:
        """Correction made by the drag so far; None without a drag."""
        return self._drag.after if self._drag is not None else None

    def corrected(self, targets: Sequence[PoseTarget]) -> frozenset[PoseTarget]:
        """Return the targets with a pose correction at the playhead."""
        player_id = self._player_id()
        if player_id is None:
            return frozenset()
        return frozenset(target for target in targets if self._at(player_id, target) is not None)

    def grasp(self, handle: Handle) -> bool:
        """Start a drag, and return whether there is a player to pose."""
        player_id = self._player_id()
        if player_id is None:
            return False
        project = self._session.project
        before = self._at(player_id, handle.target)
        if before is None:
            span = span_of(project, self._session.selection.span, self._tick())
            before = fresh_correction(project, player_id, handle.target, span)
        player = project.player(player_id)
        instrument = self._session.performance.instrument(player)
        limits = pose_limits(handle.target, instrument, player.parameters, body_of(player))
        self._drag = _Drag(handle, player_id, project, before, object(), limits)
        return True

    def drag(self, camera: Camera, right_px: float, down_px: float, height_px: float, fine: bool, lean: bool) -> None:
        """Turn the dragged joints as the pointer moves on by ``right_px`` and ``down_px`` in a view ``height_px`` high;
        ``fine`` slows it down, ``lean`` (Alt) changes the angles in `Handle.leans`."""
        drag = self._drag
        if drag is None:
            return
        worth = FINER if fine else 1.0
        drag.right_px += worth * right_px
        drag.down_px += worth * down_px
        angles: dict[Angle, float] = dragged(drag.handle, camera, drag.right_px, drag.down_px, height_px, lean)
        after = turned(drag.before, angles, drag.limits)
        drag.after = after
        player_id, before, start = drag.player_id, drag.before, drag.project
        name = _NAMES[drag.handle.target]
        self._session.attempt(name, lambda project: with_correction(start, player_id, before, after), drag.token)

    def release(self) -> None:
        """End the drag as a single undo step."""
        if self._drag is not None:
            self._drag = None
            self._session.document.end_gesture()

    def cancel(self) -> bool:
        """Cancel the drag, and return whether there was one."""
        drag, self._drag = self._drag, None
        if drag is None:
            return False
        self._session.apply(_NAMES[drag.handle.target], drag.project, drag.token)
        self._session.document.end_gesture()
        return True

    def reset(self, target: PoseTarget) -> None:
        """Remove the pose correction of a target at the playhead."""
        player_id = self._player_id()
        found = self._at(player_id, target) if player_id is not None else None
        if player_id is not None and found is not None:
            owner, correction = player_id, found
            self._session.attempt(
                Message("edit.release_pose"),
                lambda project: without_corrections(project, owner, (correction,)),
            )

    def _player_id(self) -> str | None:
        player = self._session.player
        return player.id if player is not None else None

    def _at(self, player_id: str, target: PoseTarget) -> PoseCorrection | None:
        return correction_at(self._session.project, player_id, target, self._session.selection.span, self._tick())

    def _tick(self) -> int:
        return round(self._session.project.score.tempo_map.ticks(self._session.playhead_s))
