"""A face that is being made, worn by the player in front."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from app.editor.poses import PoseSource
from app.editor.session import Session
from app.performance.chunks import Pose


class WornFaces:
    """Poses, in which the player in front wears the session's `preview_morphs` while there are some.

    Parameters
    ----------
    session : Session
    poses : PoseSource
    """

    def __init__(self, session: Session, poses: PoseSource) -> None:
        self._session, self._poses = session, poses

    def poses(self, player_ids: Sequence[str], time_s: float) -> Sequence[Pose | None]:
        """See `PoseSource.poses`."""
        found = self._poses.poses(player_ids, time_s)
        if self._session.preview_morphs is None:
            return found
        return [self._worn(player_id, pose) for player_id, pose in zip(player_ids, found, strict=True)]

    def pose_now(self, player_id: str, time_s: float) -> Pose | None:
        """See `PoseSource.pose_now`."""
        return self._worn(player_id, self._poses.pose_now(player_id, time_s))

    def _worn(self, player_id: str, pose: Pose | None) -> Pose | None:
        morphs = self._session.preview_morphs
        if pose is None or morphs is None or player_id != next(iter(self._session.players), None):
            return pose
        return replace(pose, morphs=morphs)
