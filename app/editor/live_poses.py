"""Poses of the performance in which live poses and a face being edited replace the planned ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from app.editor.poses import PoseSource, blended
from app.editor.session import Session
from app.performance.chunks import Pose


class LivePoses:
    """Source of poses that shows players in `session.live_players` live, and all others as in the performance.
    Thread-safe.
    """

    def __init__(self, session: Session, poses: PoseSource) -> None:
        self._session, self._poses = session, poses

    @property
    def is_live(self) -> bool:
        """Return whether a player is live, or is changing back gradually to the performance."""
        return self._session.live_players.is_shown

    def poses(self, player_ids: Sequence[str], time_s: float) -> Sequence[Pose | None]:
        """Return the pose of each player at a time; those who play live show what they play instead of the score."""
        found = self._poses.poses(player_ids, time_s)
        live = self._session.live_players
        if not live.is_shown:
            return found
        return [self._shown(player_id, pose, time_s) for player_id, pose in zip(player_ids, found, strict=True)]

    def _shown(self, player_id: str, performed: Pose | None, time_s: float) -> Pose | None:
        now = self._session.live_players.pose(player_id, time_s)
        if now is None:
            return self._beside(player_id, performed, time_s)
        live, share = now
        return live if performed is None or share >= 1.0 else blended(performed, live, share)

    def _beside(self, player_id: str, performed: Pose | None, time_s: float) -> Pose | None:
        """Return the pose of a player while the musician plays another of their instruments live: the live body, with
        this player's instrument laid aside.

        ``performed`` is the pose in the performance, which is returned if nothing is played live.
        """
        live, project = self._session.live_players, self._session.project
        own = next((player for player in project.players if player.id == player_id), None)
        for other in () if own is None or performed is None else project.played_by(own):
            now = live.pose(other.id, time_s) if other.id != player_id else None
            if now is None or performed is None:
                continue
            body, share = now
            found = live.lying(other.id, player_id)
            position_m, rotation = found or (performed.instrument_position_m, performed.instrument_rotation)
            beside = replace(
                body,
                controls=performed.controls,
                instrument_position_m=np.asarray(position_m, np.float32),
                instrument_rotation=np.asarray(rotation, np.float32),
            )
            return beside if share >= 1.0 else blended(performed, beside, share)
        return performed

    def pose_now(self, player_id: str, time_s: float) -> Pose | None:
        """Return the pose of a player in the performance, without live input; see `PoseSource.pose_now`."""
        return self._poses.pose_now(player_id, time_s)


class WornFaces:
    """Source of poses in which the active player's face shows the session's `preview_morphs`, if set.

    Parameters
    ----------
    session : Session
        Session with the selected players and the morphs.
    poses : PoseSource
        Source of the poses without the previewed face.
    """

    def __init__(self, session: Session, poses: PoseSource) -> None:
        self._session, self._poses = session, poses

    def poses(self, player_ids: Sequence[str], time_s: float) -> Sequence[Pose | None]:
        """Return the pose of each player at a time, with the expression that is being previewed."""
        found = self._poses.poses(player_ids, time_s)
        if self._session.preview_morphs is None:
            return found
        return [self._worn(player_id, pose) for player_id, pose in zip(player_ids, found, strict=True)]

    def pose_now(self, player_id: str, time_s: float) -> Pose | None:
        """Return one player's pose at a time (see `PoseSource.pose_now`), with the expression that is being
        previewed."""
        return self._worn(player_id, self._poses.pose_now(player_id, time_s))

    def _worn(self, player_id: str, pose: Pose | None) -> Pose | None:
        morphs = self._session.preview_morphs
        if pose is None or morphs is None or player_id != next(iter(self._session.players), None):
            return pose
        return replace(pose, morphs=morphs)
