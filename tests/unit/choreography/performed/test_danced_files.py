"""Exported files of players who dance: joint positions by forward kinematics over the BVH."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.arrays import FloatArray
from app.export.report import PlayerReport
from app.export.request import ExportRequest
from app.export.run import export
from app.formats.bvh.read import read_bvh
from app.messages import text
from app.performance.ensemble import Performance
from app.performance.span import bars_span
from app.plan.parameters import PlayerParameters
from app.project.edit.dancers import set_body_dance
from app.project.edit.players import set_parameters
from tests.unit.choreography.performed.test_body_dance import piece, player_of

pytestmark = pytest.mark.slow

TRIO = "reed_trio_mozart_k229_mv1"
FPS = Fraction(60)
BARS = (3, 10)
LOW_M = 0.0003
"""Height in metres of the ball of a foot above the floor below which the foot stands."""


class Played:
    """World positions (F, 3) of joints, and times of the frames."""

    def __init__(self, path: Path, first_s: float) -> None:
        clip = read_bvh(path)
        self.times_s = first_s + np.arange(len(clip.root_translation_cm)) / float(clip.fps)
        self._turned: list[Rotation] = []
        self._at_m: list[FloatArray] = []
        for joint, parent in enumerate(clip.parents):
            own = Rotation.from_quat(clip.rotations_xyzw[:, joint])
            if parent < 0:
                self._turned.append(own)
                self._at_m.append(0.01 * clip.root_translation_cm)
                continue
            self._turned.append(self._turned[parent] * own)
            offset_m = 0.01 * clip.offsets_cm[joint]
            self._at_m.append(self._at_m[parent] + self._turned[parent].apply(offset_m))
        self._joint = {name: joint for joint, name in enumerate(clip.names)}

    def at_m(self, joint: str) -> FloatArray:
        return self._at_m[self._joint[joint]]

    def bend_deg(self, joint: str) -> FloatArray:
        parent = {"leftLowerLeg": "leftUpperLeg", "rightLowerLeg": "rightUpperLeg"}[joint]
        turned = self._turned[self._joint[parent]].inv() * self._turned[self._joint[joint]]
        return np.rad2deg(turned.magnitude())

    def tip_m(self, side: str) -> FloatArray:
        """Position (F, 3) of the tip of a foot: beyond the ball by a third of the distance from the ankle."""
        toes = self._joint[f"{side}Toes"]
        stands = int(self.at_m(f"{side}Toes")[:, 1].argmin())
        ahead_m = (self.at_m(f"{side}Toes") - self.at_m(f"{side}Foot"))[stands] / 3.0
        ahead_m[1] = -self.at_m(f"{side}Toes")[stands, 1]
        return np.asarray(self._at_m[toes] + (self._turned[toes] * self._turned[toes][stands].inv()).apply(ahead_m))

    def heel_m(self, side: str) -> FloatArray:
        """Position (F, 3) of the heel on the sole: behind the ankle by a quarter of the distance to the ball."""
        foot, ankle_m = self._joint[f"{side}Foot"], self.at_m(f"{side}Foot")
        stands = int(self.at_m(f"{side}Toes")[:, 1].argmin())
        behind_m = -0.25 * (self.at_m(f"{side}Toes") - ankle_m)[stands]
        behind_m[1] = -ankle_m[:, 1].min()
        return np.asarray(ankle_m + (self._turned[foot] * self._turned[foot][stands].inv()).apply(behind_m))


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, PlayerReport], FloatArray, float]:
    """Export of a standing clarinettist and a seated bassoonist with the default amount of new dances."""
    project = piece(TRIO)
    clarinet, bassoon = player_of(project, "clarinet"), player_of(project, "bassoon")
    project = set_body_dance(project, (clarinet.id, bassoon.id), "salsa")
    project = set_parameters(project, (clarinet.id,), posture="standing")
    performance = Performance(set_parameters(project, (bassoon.id,), posture="seated"))
    players = tuple(performance.project.player(one.id) for one in (clarinet, bassoon))
    assert {player.parameters.dance_amount for player in players} == {PlayerParameters().dance_amount}
    span = bars_span(performance, FPS, BARS, 0.0)
    folder = tmp_path_factory.mktemp("dancing")
    request = ExportRequest(
        performance, players, folder / "out", frozenset(("bvh", "fbx")), span, BARS, "piece.mid", "test"
    )
    report = export(request, text)
    clock = project.score.tempo_map
    beats_s = clock.seconds(np.arange(0.0, 60.0 * 480.0, 0.5) * project.score.tempo_map.ticks_per_quarter)
    found = {player.instrument: player for player in report.players}
    return folder / "out", found, np.asarray(beats_s), span.first_frame_s


def test_steps_are_on_the_beat_and_feet_stand_still_between_them(
    written: tuple[Path, dict[str, PlayerReport], FloatArray, float],
) -> None:
    folder, players, beats_s, first_s = written
    played = Played(folder / players["clarinet_Bb"].files["character_bvh"], first_s)
    seconds = played.times_s[-1] - played.times_s[0]
    lifted = {}
    for side in ("left", "right"):
        ball_m = played.at_m(f"{side}Toes")
        stands = ball_m[:, 1] < ball_m[:, 1].min() + LOW_M
        lifted[side] = ~stands
        both = stands[1:] & stands[:-1]
        speeds = np.linalg.norm(np.diff(played.tip_m(side), axis=0), axis=1)[both] * float(FPS)
        # A frame may hold the last tenth of a millimetre of a landing.
        assert np.quantile(speeds, 0.98) < 0.005
        assert speeds.max() < 0.03
        assert 0.02 < np.ptp(ball_m[:, 1]) < 0.10
        assert min(ball_m[:, 1].min(), played.tip_m(side)[:, 1].min()) > -0.001
        lands_s = played.times_s[1:][stands[1:] & ~stands[:-1]]
        assert len(lands_s) > 0.4 * seconds
        # The last 0.3 mm are within two frames of the beat.
        assert np.abs(beats_s[:, None] - lands_s).min(axis=0).max() < 2.0 / float(FPS) + 1e-6
    assert not np.any(lifted["left"] & lifted["right"])


def test_a_standing_player_taps_with_the_toes_while_the_heel_stays(
    written: tuple[Path, dict[str, PlayerReport], FloatArray, float],
) -> None:
    folder, players, beats_s, first_s = written
    played = Played(folder / players["clarinet_Bb"].files["character_bvh"], first_s)
    taps_s = list[float]()
    for side in ("left", "right"):
        heel_m, ball_m = played.heel_m(side)[:, 1], played.at_m(f"{side}Toes")[:, 1]
        up = (ball_m > ball_m.min() + 0.01) & (heel_m < heel_m.min() + 0.01)
        down = np.flatnonzero(up[:-1] & ~up[1:])
        taps_s += played.times_s[down[down > 0]].tolist()
    assert len(taps_s) >= 3
    assert np.abs(beats_s[:, None] - np.array(taps_s)).min(axis=0).max() < 0.15


def test_hips_legs_and_chest_dance_and_no_knee_snaps(
    written: tuple[Path, dict[str, PlayerReport], FloatArray, float],
) -> None:
    folder, players, _, first_s = written
    played = Played(folder / players["clarinet_Bb"].files["character_bvh"], first_s)
    across = np.median(played.at_m("leftUpperLeg") - played.at_m("rightUpperLeg"), axis=0)
    across /= np.linalg.norm(across)
    assert np.ptp(played.at_m("hips") @ across) > 0.07
    assert np.ptp(played.at_m("hips")[:, 1]) > 0.015
    # Legs do not cross.
    assert ((played.at_m("leftFoot") - played.at_m("rightFoot")) @ across).min() > 0.12
    for knee in ("leftLowerLeg", "rightLowerLeg"):
        bend = played.bend_deg(knee)
        assert 5.0 < bend.min() < 25.0
        assert 35.0 < bend.max() < 90.0
        assert np.abs(np.diff(np.deg2rad(bend), 2)).max() * float(FPS) ** 2 < 200.0


def test_a_seated_player_taps_on_the_beat_and_stays(
    written: tuple[Path, dict[str, PlayerReport], FloatArray, float],
) -> None:
    folder, players, _, first_s = written
    played = Played(folder / players["bassoon"].files["character_bvh"], first_s)
    assert np.ptp(played.at_m("hips"), axis=0).max() < 0.01
    taps = 0
    for side in ("left", "right"):
        # Where the heel is lifted, the ankle goes ahead over the tip, farther on longer feet.
        assert np.ptp(played.at_m(f"{side}Foot")[:, [0, 2]], axis=0).max() < 0.04
        tip_m, ankle_m = played.tip_m(side), played.at_m(f"{side}Foot")
        up = (tip_m[:, 1] > tip_m[:, 1].min() + 0.005) | (ankle_m[:, 1] > ankle_m[:, 1].min() + 0.005)
        taps += int(np.sum(up[:-1] & ~up[1:]))
        assert tip_m[:, 1].min() > -0.001
    assert taps > 0.5 * (played.times_s[-1] - played.times_s[0])


def test_contacts_and_bones_are_those_of_players_who_do_not_dance(
    written: tuple[Path, dict[str, PlayerReport], FloatArray, float],
) -> None:
    _, players, _, _ = written
    for player in players.values():
        measures = player.measures
        assert measures is not None
        assert [name for name, touch in measures.contacts.items() if touch.max_mm > 2.0] == []
        assert measures.lips.max_mm < 0.1
        assert all(foot.max_mm < 0.1 for foot in measures.feet.values())
        assert measures.bones.kept
        assert measures.penetration.kept
        assert all(control.right == control.judged for control in measures.controls.values())
