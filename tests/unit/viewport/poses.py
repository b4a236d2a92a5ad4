"""Poses of the bundled quartet for tests."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from app.performance.chunks import Pose
from app.performance.ensemble import Performance
from app.performance.live import LiveMotion
from app.project.model import Project, map_choices, project_from_score
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from widgets.viewport.cast import Stage, kit_of, member_of

QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
AT_S = 6.0


@cache
def quartet() -> Project:
    """The bundled quartet."""
    maps = bundled_maps()
    return project_from_score(read_midi(QUARTET, maps=map_choices(maps.values())), maps)


@cache
def live() -> LiveMotion:
    """Live motion of the quartet."""
    return LiveMotion(Performance(quartet()))


@cache
def pose(player: int, time_s: float = AT_S) -> Pose:
    """Pose of a player."""
    result = live().pose_now(quartet().players[player].id, time_s)
    assert result is not None
    return result


def posed_stage() -> Stage:
    """Stage with all players at `AT_S`."""
    project = quartet()
    stage = Stage([member_of(player, kit_of(player)) for player in project.players])
    stage.pose({player.id: pose(index) for index, player in enumerate(project.players)})
    return stage
