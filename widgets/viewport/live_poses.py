"""Poses, in which who is played now stands as it plays."""

from __future__ import annotations

from collections.abc import Sequence

from widgets.common.session import Session
from widgets.viewport.poses import Posed, Poses, blended


class LivePoses:
    """Poses of the performance, but of who is played now (`session.live_players`) those of now. May be asked by any
    thread.

    Parameters
    ----------
    session : Session
    poses : Poses
    """

    def __init__(self, session: Session, poses: Poses) -> None:
        self._session, self._poses = session, poses

    @property
    def is_live(self) -> bool:
        """Whether somebody is played now, or has just been."""
        return self._session.live_players.is_shown

    def poses(self, player_ids: Sequence[str], time_s: float) -> Sequence[Posed | None]:
        """See `Poses.poses`."""
        found = self._poses.poses(player_ids, time_s)
        live = self._session.live_players
        if not live.is_shown:
            return found
        return [self._shown(player_id, pose, time_s) for player_id, pose in zip(player_ids, found, strict=True)]

    def _shown(self, player_id: str, performed: Posed | None, time_s: float) -> Posed | None:
        now = self._session.live_players.pose(player_id, time_s)
        if now is None:
            return performed
        live, share = now
        return live if performed is None or share >= 1.0 else blended(performed, live, share)

    def pose_now(self, player_id: str, time_s: float) -> Posed | None:
        """See `Poses.pose_now`: pictures of the performance show the performance."""
        return self._poses.pose_now(player_id, time_s)
