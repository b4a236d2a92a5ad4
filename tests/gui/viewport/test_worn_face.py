"""Only the first selected player shows the expression being edited."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.editor.live_poses import WornFaces
from app.editor.poses import same
from app.editor.session import Session
from app.performance.chunks import Pose


class Standing:
    """Poses in which all players are motionless with an open mouth."""

    def poses(self, player_ids: Sequence[str], time_s: float) -> list[Pose | None]:
        return [self.pose_now(player_id, time_s) for player_id in player_ids]

    def pose_now(self, player_id: str, time_s: float) -> Pose | None:
        if player_id == "unknown":
            return None
        return Pose(
            rotations=np.zeros((2, 4), np.float32),
            hips_m=np.zeros(3, np.float32),
            morphs={"jawOpen": 1.0},
            controls={"valve_1": 0.5},
            instrument_position_m=np.zeros(3, np.float32),
            instrument_rotation=np.zeros(4, np.float32),
        )


def test_only_the_player_in_front_wears_it(session: Session) -> None:
    first, second = (player.id for player in session.project.players[:2])
    poses = WornFaces(session, Standing())
    plain = poses.poses((first,), 0.0)[0]
    assert plain.morphs == {"jawOpen": 1.0}
    session.set_preview_morphs({"browInnerUp": 0.5})
    for pose in (poses.poses((first,), 0.0)[0], poses.pose_now(first, 0.0)):
        assert pose.morphs == {"browInnerUp": 0.5}
        assert pose.controls == plain.controls
        assert not same(pose, plain)
    other = poses.poses((second,), 0.0)[0]
    assert other.morphs == {"jawOpen": 1.0}
    session.set_players((second, first))
    worn = poses.poses((second,), 0.0)[0]
    assert worn.morphs == {"browInnerUp": 0.5}
    assert poses.poses(("unknown",), 0.0)[0] is None
    session.set_preview_morphs(None)
    assert same(poses.poses((second,), 0.0)[0], plain)
