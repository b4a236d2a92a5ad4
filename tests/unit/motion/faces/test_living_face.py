"""Signs of life in a face: properties of curves, and measures on the bundled quartet."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from pathlib import Path

import msgspec
import numpy as np
import pytest
from scipy.stats import spearmanr

from app.motion.curves.spline import Spline
from app.motion.faces.exertion import Exertion, Lungs, exertion_of
from app.motion.faces.individual_face import PAIRS, own_face
from app.motion.faces.lips_within_notes import firmness, tension_release, vibrato_size
from app.motion.model import Motion
from app.performance.ensemble import Performance
from app.performance.span import whole_span
from app.plan.model import EmbouchureEvent, PlayerPlan
from app.plan.music.piece import line_times
from app.project.edit.players import set_parameters
from app.project.model import map_choices, project_from_score
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from metadata.load import load_body
from tests.support.performed import player_motion
from tests.unit.motion.events import REASON, breath, fingerings, plan_of
from tests.unit.motion.faces.test_face_curves import face

QUARTET = Path(__file__).parents[4] / "resources" / "examples" / "quartet.mid"
FPS = 60.0
TIMES_S = np.arange(-2.0, 60.0, 1 / FPS)
UPPER = ("brow", "eyeSquint", "eyeWide", "cheekSquint", "noseSneer")
LIPS = ("mouth", "jaw", "cheekPuff")


def plan(rows: list[tuple[float, float, float, float]], **changes: object) -> PlayerPlan:
    """Plan of notes (start_s, end_s, tension, air)."""
    made = plan_of(fingerings([(start_s, end_s, {}) for start_s, end_s, _, _ in rows]), breaths=(breath(-0.5, 0.0),))
    lips = tuple(
        EmbouchureEvent(f"n{i}", row[0], row[1], row[2], 0.5 * row[2], row[3], REASON) for i, row in enumerate(rows)
    )
    return msgspec.structs.replace(made, embouchures=lips, **changes)


def exertion(made: PlayerPlan, times_s: np.ndarray = TIMES_S) -> Exertion:
    return Exertion(*exertion_of(made, load_body().face, Lungs(9.0)).sample(times_s))


EASY, HARD = (0.2, 0.4), (0.95, 0.95)


def test_a_strain_grows_while_it_lasts_and_passes_more_slowly() -> None:
    rows = [(float(i), i + 1.0, *EASY) for i in range(5)] + [(5.0, 9.0, *HARD)]
    rows += [(9.0 + i, 10.0 + i, *EASY) for i in range(8)]
    strain = exertion(plan(rows)).strain
    at = {t: strain[np.searchsorted(TIMES_S, t)] for t in (4.5, 5.3, 6.0, 8.5, 9.5, 10.5, 13.0)}
    assert at[4.5] < 0.05
    assert at[4.5] < at[5.3] < at[6.0] <= at[8.5]
    assert at[8.5] > 0.7
    assert at[8.5] > at[9.5] > at[10.5] > at[13.0]
    rise_s = TIMES_S[np.argmax(strain > 0.6 * strain.max())] - 5.0
    fall_s = TIMES_S[len(strain) - 1 - np.argmax(strain[::-1] > 0.4 * strain.max())] - 9.0
    assert 0.2 < rise_s < fall_s


def test_the_contour_is_followed_to_both_sides_and_left_again() -> None:
    rows = [(0.5 * i, 0.5 * i + 0.5, 0.5 + 0.35 * np.sin(0.25 * np.pi * i), 0.6) for i in range(60)]
    found = exertion(plan(rows))
    asked = np.interp(TIMES_S, [row[0] + 0.25 for row in rows], [row[2] - 0.5 for row in rows])
    playing = (TIMES_S > 3.0) & (TIMES_S < 27.0)
    assert np.corrcoef(asked[playing], found.contour[playing])[0, 1] > 0.9
    assert found.contour.min() < -0.3 < 0.3 < found.contour.max()
    assert np.abs(found.swell[playing]).max() < 0.05, "as loud all the time"
    assert np.abs(found.contour[TIMES_S > 32.0]).max() < 0.02


def test_louder_than_before_shows_and_softer_too() -> None:
    rows = [(0.5 * i, 0.5 * i + 0.5, 0.4, 0.9 if 10 <= i < 16 else 0.4) for i in range(40)]
    swell = exertion(plan(rows)).swell
    louder = swell[(TIMES_S > 5.0) & (TIMES_S < 7.5)]
    assert louder.max() > 0.4
    assert louder.mean() > 0.2
    assert swell[(TIMES_S > 8.3) & (TIMES_S < 9.0)].max() < -0.1


def test_the_air_is_used_up_until_the_next_breath() -> None:
    rows = [(float(i), i + 1.0, 0.4, 0.7) for i in range(6)] + [(6.5 + i, 7.5 + i, 0.4, 0.7) for i in range(6)]
    made = plan(rows, breaths=(breath(-0.5, 0.0, 0.7), breath(6.0, 6.5, 0.7)))
    empty = exertion(made).emptying
    before, refilled = (empty[np.searchsorted(TIMES_S, t)] for t in (5.9, 7.2))
    rising = empty[(TIMES_S > 0.5) & (TIMES_S < 5.7)]
    assert np.all(np.diff(rising) > -1e-9)
    assert before > 0.4 > 0.1 > refilled


def test_a_phrase_has_its_peak_behind_its_middle() -> None:
    rows = [(0.5 * i, 0.5 * i + 0.5, 0.5, 0.7) for i in range(16)]
    phrase = exertion(plan(rows)).phrase
    assert 4.1 < TIMES_S[np.argmax(phrase)] < 5.8
    assert phrase[TIMES_S > 9.0].max() < 0.05 < 0.4 < phrase.max()


def test_lips_tire_without_a_rest_and_recover_in_one() -> None:
    rows = [(float(i), i + 1.0, 0.9, 0.9) for i in range(30)] + [(50.0, 51.0, 0.9, 0.9)]
    tired = exertion(plan(rows)).tired
    at = {t: tired[np.searchsorted(TIMES_S, t)] for t in (3.0, 7.0, 29.0, 45.0)}
    assert at[3.0] == 0.0
    assert 0.1 < at[7.0] < 0.8 * at[29.0]
    assert at[45.0] < 0.3 * at[29.0]


def test_only_what_is_near_an_edited_note_changes() -> None:
    rows = [(0.5 * i, 0.5 * i + 0.5, 0.2 + 0.1 * (i % 7), 0.6) for i in range(400)]
    spans = []
    for edit in ((200, 0.9), (200, 0.21)):
        changed = [(*row[:2], edit[1], row[3]) if i == edit[0] else row for i, row in enumerate(rows)]
        one, other = (exertion_of(plan(each), load_body().face, Lungs(9.0)) for each in (rows, changed))
        spans.append(one.changed_s(other))
    for found in spans:
        assert len(found)
        assert found.min() > 100.0 - 7.0
        assert found.max() < 100.5 + 17.0, "as long as lips stay tired"


def test_lips_set_by_hand_change_the_face_for_seconds_only() -> None:
    made = plan([(0.5 * i, 0.5 * i + 0.45, 0.6, 0.6) for i in range(60)])
    note = made.embouchures[20]
    by_hand = msgspec.structs.replace(note, tension=1.0, effort=1.0, planned=(note.tension, note.effort, note.air))
    lips = (*made.embouchures[:20], by_hand, *made.embouchures[21:])
    one, other = (
        exertion_of(each, load_body().face, Lungs(9.0))
        for each in (made, msgspec.structs.replace(made, embouchures=lips))
    )
    spans_s = one.changed_s(other)
    assert note.start_s - 1.0 < spans_s.min() < note.start_s
    assert note.end_s < spans_s.max() < note.end_s + 3.5


def test_lips_are_firmest_at_an_attack_and_settle() -> None:
    made = plan([(0.0, 2.0, 0.5, 0.8), (2.0, 4.0, 0.5, 0.8), (5.0, 7.0, 0.5, 0.8)])
    made = msgspec.structs.replace(made, tongues=tuple(t for t in made.tongues if t.end_s != 2.0))
    firm = firmness(made).sample(np.array([-0.2, -0.07, 0.0, 0.1, 0.3, 1.0, 2.0, 5.0]))
    assert firm[0] == 0.0
    assert 0.0 < firm[1] < firm[2]
    assert firm[2] > firm[3] > firm[4] == firm[5] == 0.0
    assert firm[6] < 0.6 * firm[2], "a slur is no attack"
    assert firm[7] > 0.8


def test_between_notes_the_tension_lets_go_and_is_back_at_the_next() -> None:
    eased = tension_release(plan([(0.0, 1.0, 0.5, 0.8), (1.5, 2.0, 0.5, 0.8), (2.05, 3.0, 0.5, 0.8)]))
    found = eased.sample(np.array([-1.0, 0.0, 0.9, 1.25, 1.5, 2.02, 4.0]))
    np.testing.assert_array_equal(found[[1, 2, 4, 5]], 0.0)
    assert found[3] > 0.3
    assert found[[0, 6]].min() > 0.5


TOO_SHORT = plan([(1.0, 1.0005, 0.5, 0.8)])


@pytest.mark.parametrize(
    "silent", [TOO_SHORT, msgspec.structs.replace(TOO_SHORT, embouchures=())], ids=["short", "none"]
)
def test_without_a_note_that_lasts_the_lips_stay_let_go(silent: PlayerPlan) -> None:
    times_s = np.array([-1.0, 1.0, 2.0])
    eased = tension_release(silent).sample(times_s)
    assert eased.min() == eased.max() > 0.5
    np.testing.assert_array_equal(firmness(silent).sample(times_s), 0.0)
    np.testing.assert_array_equal(vibrato_size(silent).sample(times_s), 0.0)


def test_a_vibrato_comes_in_on_held_notes_only() -> None:
    size = vibrato_size(plan([(0.0, 0.5, 0.5, 0.8), (1.0, 1.8, 0.5, 0.8), (3.0, 6.0, 0.5, 0.8)]))
    found = size.sample(np.array([0.4, 1.2, 1.65, 3.1, 3.6, 5.0, 6.0]))
    np.testing.assert_array_equal(found[[0, 3, 6]], 0.0)
    assert 0.0 < found[2] < found[5]
    assert 0.0 < found[4] < found[5]


def test_a_held_note_has_a_vibrato_of_its_rate() -> None:
    rates = []
    for name in ("a", "b", "c", "d"):
        made = msgspec.structs.replace(plan([(0.0, 12.0, 0.5, 0.8)]), player_id=name)
        times_s = np.arange(2.0, 11.0, 1 / FPS)
        lips = face(made, times_s)["mouthPucker"]
        power = np.square(np.abs(np.fft.rfft((lips - lips.mean()) * np.hanning(len(lips)))))
        hz = np.fft.rfftfreq(len(lips), 1 / FPS)
        quick = hz > 3.0
        rates.append(float(hz[quick][power[quick].argmax()]))
        assert np.sqrt(power[quick & (hz < 8.0)].sum()) / len(lips) > 0.001
    assert all(4.4 < rate < 6.1 for rate in rates)
    assert np.ptp(rates) > 0.05


def test_lips_live_within_a_held_note() -> None:
    made = plan([(0.0, 8.0, 0.5, 0.6), (8.5, 9.7, 0.3, 0.4)])
    times_s = np.arange(-1.0, 11.0, 1 / FPS)
    morphs = {name: values for name, values in face(made, times_s).items() if name.startswith(LIPS)}
    for from_s, to_s in [(t, t + 1.0) for t in np.arange(0.4, 6.8, 0.5)] + [(8.8, 9.5)]:
        here = (times_s >= from_s) & (times_s < to_s)
        assert max(np.ptp(values[here]) for values in morphs.values()) > 0.012, from_s
    for name, values in morphs.items():
        assert np.ptp(values[(times_s > 0.4) & (times_s < 7.8)]) < 0.35, name


@pytest.mark.parametrize("player_id", ["a", "b", "c"])
def test_left_and_right_differ_by_what_is_the_players_own(player_id: str) -> None:
    body = load_body().face
    own = own_face(player_id, 0, *body.left_right, (5.0, 5.5))
    made = msgspec.structs.replace(plan([(0.5 * i, 0.5 * i + 0.5, 0.8, 0.8) for i in range(80)]), player_id=player_id)
    morphs = face(made)
    for pair in PAIRS:
        left, right = morphs.get(f"{pair}Left"), morphs.get(f"{pair}Right")
        if left is None or right is None or pair == "eyeBlink":
            continue
        mean = 0.5 * (left + right)
        seen = mean > 0.05
        share = (left - right)[seen] / mean[seen]
        if len(share):
            assert np.all((np.abs(share) > 0.03) & (np.abs(share) < 0.12)), pair
            assert np.sign(share).min() == np.sign(share).max() == np.sign(own.left_more[pair])
    sides = [own_face(name, seed, *body.left_right, (5.0, 5.5)).left_more for name in "xyz" for seed in range(8)]
    assert len({round(side["mouthPress"], 6) for side in sides}) == 24
    assert min(side["mouthPress"] for side in sides) < 0.0 < max(side["mouthPress"] for side in sides)


def test_a_spline_is_smooth_and_depends_on_its_time_alone() -> None:
    random = np.random.default_rng(3)
    spline = Spline(-7, 0.05, random.random((2, 60)))
    times_s = np.arange(-0.3, 2.4, 0.001)
    whole = spline.sample(times_s)
    for index in (0, 517, 2000, len(times_s) - 1):
        np.testing.assert_array_equal(spline.sample(times_s[index : index + 1])[:, 0], whole[:, index])
    second = np.diff(whole, 2, axis=1) / 1e-6
    assert np.abs(np.diff(second, axis=1)).max() < 0.05 * np.abs(second).max()
    line = Spline(-7, 0.05, np.arange(60.0)[None] * 0.05 - 0.35)
    inside = times_s[(times_s > -0.2) & (times_s < 2.4)]
    np.testing.assert_allclose(line.sample(inside)[0], inside, atol=1e-12)


def test_a_spline_knows_where_it_differs() -> None:
    random = np.random.default_rng(5)
    values = random.random((3, 80))
    other = values.copy()
    other[1, 40] += 0.1
    one, two = Spline(4, 0.1, values), Spline(4, 0.1, other)
    times_s = np.arange(0.0, 9.0, 0.003)
    differ = np.any(one.sample(times_s) != two.sample(times_s), axis=0)
    ((from_s, to_s),) = one.changed_s(two)
    assert np.all((times_s[differ] >= from_s) & (times_s[differ] <= to_s))
    assert to_s - from_s < 0.41
    assert not len(one.changed_s(Spline(4, 0.1, values.copy())))
    longer = Spline(4, 0.1, np.concatenate((values, np.ones((3, 5))), axis=1))
    assert one.changed_s(longer)[-1, 1] == np.inf


@dataclass(frozen=True)
class Made:
    motion: Motion
    onset_s: np.ndarray
    end_s: np.ndarray
    pitch: np.ndarray
    loudness: np.ndarray

    @property
    def times_s(self) -> np.ndarray:
        return self.motion.first_frame_s + np.arange(self.motion.frames) / FPS

    @property
    def playing(self) -> np.ndarray:
        note = np.searchsorted(self.onset_s, self.times_s, side="right") - 1
        return (note >= 0) & (self.times_s < self.end_s[np.maximum(note, 0)])

    def weights(self, *parts: str) -> dict[str, np.ndarray]:
        return {name: values for name, values in self.motion.morphs.items() if name.startswith(parts)}


@cache
def quartet(amplitude: float = 0.5) -> tuple[Made, ...]:
    maps = bundled_maps()
    project = project_from_score(read_midi(QUARTET, maps=map_choices(maps.values())), maps)
    project = set_parameters(project, [player.id for player in project.players], amplitude=amplitude)
    performance = Performance(project)
    lines = {line.player_id: line for line in performance.parts}
    made = []
    for player in project.players:
        times = line_times(lines[player.id], performance.piece.clock)
        motion = player_motion(performance, player, whole_span(performance.time_frame, Fraction(60)))
        made.append(Made(motion, times.onset_s, times.played_end_s, times.pitch, times.loudness))
    return tuple(made)


def share_moving(made: Made) -> float:
    moving = np.zeros(made.motion.frames, bool)
    for values in made.weights(*UPPER).values():
        moving |= np.abs(np.gradient(values)) * FPS > 0.02
    return float(moving[made.playing].mean())


@pytest.mark.parametrize("number", range(4))
def test_the_upper_face_moves_in_much_of_the_playing_time(number: int) -> None:
    made = quartet()[number]
    assert share_moving(made) > 0.45
    for values in made.weights("brow", "eyeSquint", "cheekSquint").values():
        assert np.ptp(values[made.playing]) > 0.05
        assert np.mean(values > 0.85) < 0.02, "no mask"


@pytest.mark.parametrize("number", range(4))
def test_effort_shown_goes_with_loudness_and_register(number: int) -> None:
    made = quartet()[number]
    shown = sum(made.weights("browDown", "eyeSquint", "cheekSquint", "noseSneer").values())
    first, last = (np.searchsorted(made.times_s, at) for at in (made.onset_s, made.end_s))
    long = last - first >= 6
    means = np.array([np.mean(shown[a:b]) for a, b in zip(first[long], last[long], strict=True)])
    pitch, loudness = made.pitch[long], made.loudness[long]
    both = pitch.argsort().argsort() + loudness.argsort().argsort()
    assert spearmanr(means, both).statistic > 0.5


@pytest.mark.parametrize("number", range(4))
def test_no_held_note_is_a_plateau(number: int) -> None:
    made = quartet()[number]
    lips = np.array(list(made.weights(*LIPS).values()))
    for start_s, end_s in zip(made.onset_s, made.end_s, strict=True):
        if end_s - start_s > 1.0:
            here = (made.times_s >= start_s + 0.3) & (made.times_s < end_s - 0.2)
            assert np.ptp(lips[:, here], axis=1).max() > 0.01


def test_more_of_it_is_seen_at_a_larger_amplitude() -> None:
    sizes = [
        np.mean(
            [np.std(values[made.playing]) for made in quartet(amplitude) for values in made.weights("brow").values()]
        )
        for amplitude in (0.0, 0.5, 1.0)
    ]
    assert 0.0 < sizes[0] < 0.6 * sizes[1] < 0.9 * sizes[2]
