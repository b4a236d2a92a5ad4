"""The hips lead, the chest follows them, and the head follows the chest: measured on the bundled quartet's motion."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import butter, sosfiltfilt
from scipy.spatial.transform import Rotation

from app.motion.gestures.summed_angles import RESIDUE_SHARE, Sizes
from app.performance.ensemble import Performance
from app.plan.acting import Acting
from app.plan.parameters import PlayerParameters
from app.project.edit.players import set_parameters
from app.project.model import map_choices, project_from_score
from app.rig.skeleton import forward
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from metadata.load import load_body
from tests.support.performed import performance_curves

FPS = 60
QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
MAPS = bundled_maps()


def aside_rad(turns: np.ndarray) -> np.ndarray:
    """Sideways lean of a joint relative to its mean pose in each frame in radians, filtered from 0.15 to 3 Hz."""
    rotations = Rotation.from_quat(turns)
    aside = -(rotations * rotations.mean().inv()).as_rotvec()[:, 2]
    return sosfiltfilt(butter(2, (0.15, 3.0), "band", fs=FPS, output="sos"), aside)


def lag_ms(one: np.ndarray, other: np.ndarray) -> float:
    reach = round(0.3 * FPS)
    inner = slice(reach, len(one) - reach)
    found = [np.corrcoef(one[inner], np.roll(other, -lag)[inner])[0, 1] for lag in range(-reach, reach + 1)]
    return 1000.0 * (int(np.argmax(found)) - reach) / FPS


@pytest.mark.parametrize("weight_shift", [0.0, 1.3])
def test_the_chest_follows_the_hips_and_the_head_the_chest(weight_shift: float) -> None:
    """Holds for any share of the hips in shifts of weight, which begin at other times than the sway."""
    project = project_from_score(read_midi(QUARTET, maps=map_choices(MAPS.values())), MAPS)
    # Not the slide, nor gestures of single joints.
    trumpets = [player.id for player in project.players[:2]]
    performance = Performance(set_parameters(project, trumpets, weight_shift=weight_shift, gestures=0.0))
    for player in performance.project.players[:2]:
        playing = performance_curves(performance, player)
        begins = round((playing.plan.embouchures[0].start_s - playing.start_s) * FPS)
        motion = playing.motion(Fraction(FPS), begins, 70 * FPS)
        skeleton = playing.player.skeleton
        joints = [skeleton.index(name) for name in ("hips", "upperChest", "head")]
        placed = forward(skeleton, motion.rotations, motion.hips_m, joints)
        hips, chest, head = (aside_rad(placed.of(joint)[1]) for joint in joints)
        assert 40.0 <= lag_ms(hips, chest) <= 120.0
        assert 40.0 <= lag_ms(chest, head) <= 120.0


def test_a_player_who_shows_less_wanders_less() -> None:
    body, times_s = load_body(), np.arange(0.0, 60.0, 0.1)
    sizes = Sizes(body, PlayerParameters(), "player", Acting(), body.postures["standing"])
    usual, reserved, none = (sizes.wander("side", body.sway.side_deg, times_s, shown) for shown in (1.0, 0.4, 0.0))
    assert 0.4 * usual.std() < reserved.std() < 0.6 * usual.std()
    assert none.std() == pytest.approx(RESIDUE_SHARE * body.sway.side_deg[0], rel=0.2)
