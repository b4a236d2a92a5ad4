from __future__ import annotations

from dataclasses import replace

import msgspec
import numpy as np
import pytest

from app.errors import Message
from app.motion.faces.exertion import Lungs
from app.motion.faces.face_curves import FACE, FaceCurves, breath_opening
from app.motion.faces.gaze import GAZE, Watching, plan_gaze
from app.motion.faces.morph_weights import face_morphs, face_sizes, usual_morphs
from app.plan.acting import Acting
from app.plan.model import EmbouchureEvent, ExpressionEvent, PlayerPlan
from app.plan.parameters import PlayerParameters
from app.rig.grip.grip_pose import Lips
from metadata.load import load_body, load_expressions
from metadata.model import ARKIT_MORPHS
from tests.unit.motion.events import REASON, breath, cue, fingerings, plan_of

LIPS = Lips(np.zeros(3), {}, {}, np.zeros(3))
TIMES_S = np.arange(-2.0, 60.0, 1 / 240)


def plan(**changes: object) -> PlayerPlan:
    rows = [(0.5 * i, 0.5 * i + 0.5, {}) for i in range(20)] + [
        (14.0 + 0.2 * i, 14.2 + 0.2 * i, {}) for i in range(200)
    ]
    made = plan_of(fingerings(rows), breaths=(breath(-0.5, 0.0), breath(13.4, 14.0, 0.5)), cues=(cue(0.0), cue(14.0)))
    return msgspec.structs.replace(made, **changes)


def curves(made: PlayerPlan, tension: float = 1.0) -> FaceCurves:
    return FACE.begin(plan=made, embouchure_tension=tension, face_motion=load_body().face, lungs=Lungs(9.0)).of(
        FaceCurves
    )


def face(
    made: PlayerPlan, times_s: np.ndarray = TIMES_S, *, still: bool = False, **parameters: float
) -> dict[str, np.ndarray]:
    """Weights of a trumpeter; ``still`` for a face without idle motion."""
    body, settings = load_body(), PlayerParameters(**parameters)
    sizes = face_sizes(made.player_id, settings, Acting(), body, "cup", 0.6, recorded=False)
    if still:
        sizes = replace(sizes, own=replace(sizes.own, left_more=dict.fromkeys(sizes.own.left_more, 0.0)),
                        upper=0.0, lips=0.0, vibrato=0.0)  # fmt: skip
    shown = curves(made, settings.embouchure_tension).sample(times_s)
    look = GAZE.begin(plan=made, watching=Watching()).of(plan_gaze).sample(times_s)
    up = np.zeros(len(times_s))
    return face_morphs(shown, LIPS, load_expressions(), look, up, sizes, times_s)


def embouchure(tension: float, effort: float = 0.0, air: float = 0.0) -> tuple[EmbouchureEvent, ...]:
    return (EmbouchureEvent("n", 0.0, 5.0, tension, effort, air, Message("x")),)


def test_only_arkit_names_move_and_stay_within_0_and_1() -> None:
    morphs = face(plan(), embouchure_tension=2.0)
    assert set(morphs) <= set(ARKIT_MORPHS)
    for values in morphs.values():
        assert values.min() >= 0.0
        assert values.max() <= 1.0


def test_high_notes_are_tighter_than_low_ones() -> None:
    body = load_body().embouchure["cup"]
    middle = np.array([2.5])
    for tension in (0.0, 0.4, 1.0):
        morphs = face(plan(embouchures=embouchure(tension), tongues=(), breaths=()), middle, still=True)
        for name in set(body.relaxed) | set(body.tight):
            expected = (1 - tension) * body.relaxed.get(name, 0.0) + tension * body.tight.get(name, 0.0)
            expected += body.soft.get(name, 0.0)
            # Left and right still vary a little.
            assert morphs[name][0] == pytest.approx(min(expected, 1.0), rel=0.01, abs=1e-12)


def test_the_lips_are_formed_at_the_onset_and_let_go_in_a_long_rest() -> None:
    morphs = face(plan(), np.array([-1.5, 0.0, 12.0, 14.0]))
    lips = morphs["mouthPucker"] + morphs["mouthPressLeft"]
    assert lips[[0, 2]].max() == 0.0
    assert lips[[1, 3]].min() > 0.15


def test_the_mouth_opens_in_a_breath_and_is_shut_at_its_end() -> None:
    opening = breath_opening(plan())
    np.testing.assert_array_equal(opening.sample(np.array([-0.5, 0.0, 13.4, 14.0, 20.0])), 0.0)
    deep, shallow = opening.sample(np.array([-0.25, 13.7]))
    assert deep > shallow > 0.5


def test_the_mouth_is_wide_open_for_most_of_a_long_breath_and_for_a_moment_of_a_hasty_one() -> None:
    opening = breath_opening(plan(breaths=(breath(2.0, 4.0, 1.0), breath(6.0, 6.3, 1.0))))
    np.testing.assert_allclose(opening.sample(np.array([2.5, 3.0, 3.7, 6.15])), 1.0)
    assert opening.sample(np.array([3.9]))[0] < 1.0


def test_the_lips_let_go_for_a_breath_and_stay_formed_in_a_short_rest_without_one() -> None:
    rows = fingerings([(0.0, 2.0, {}), (2.6, 4.0, {})])
    pressed = [face(plan_of(rows, breaths=taken), np.array([1.0, 2.3]))["mouthPressLeft"]
               for taken in ((), (breath(2.0, 2.6, 1.0),))]  # fmt: skip
    assert pressed[0][0] > pressed[0][1] > 0.5 * pressed[0][0], "at ease, but formed"
    assert pressed[1][1] < 0.3 * pressed[1][0]


def test_the_tongue_is_up_just_before_the_attack_and_down_soon_after() -> None:
    tongue = curves(plan()).tongue.sample(np.array([13.90, 13.96, 13.99, 14.0, 14.04, 14.09]))
    np.testing.assert_allclose(tongue[[0, 2, 3, 5]], [0.0, 1.0, 1.0, 0.0], atol=1e-9)
    assert 0.0 < tongue[4] < tongue[1] < 1.0


def test_vowels_part_the_lips_no_further_than_the_mouthpiece_while_notes_sound() -> None:
    """A face whose shapes of the lips are mouths wide open, as those of vowels are."""
    opens = {"jawOpen": 0.03, "mouthFunnel": 0.02, "mouthPucker": 0.01}
    reed = replace(LIPS, apart_m=0.006, gap_deltas_m=opens, jaw="jawOpen", vowels=("mouthFunnel", "mouthPucker"))
    body, kind = load_body(), "single_reed"
    usual = usual_morphs(body.embouchure[kind], reed)
    assert reed.gap_m({name: np.array([weight]) for name, weight in usual.items()}, 1)[0] == pytest.approx(0.006)
    assert 0.0 < usual["mouthFunnel"] < body.embouchure[kind].usual["mouthFunnel"]
    shut = replace(reed, apart_m=0.0)
    assert usual_morphs(body.embouchure[kind], shut)["mouthFunnel"] == 0.0


def test_no_morph_jumps() -> None:
    for name, values in face(plan()).items():
        most = 40.0 if name.startswith("eye") else 15.0  # lids shut in 80 ms
        assert np.abs(np.diff(values)).max() * 240 < most, name


def test_what_is_not_for_playing_does_not_show_while_playing() -> None:
    smile = ExpressionEvent("x", "smile", 0, 0, 2.0, 13.0, 1.0, 0.2, 0.2, REASON)
    strained = msgspec.structs.replace(smile, id="y", expression="strained")
    morphs = face(plan(expressions=(smile, strained)), np.array([5.0, 12.0]))
    assert morphs["mouthSmileLeft"][0] == 0.0
    assert morphs["mouthSmileLeft"][1] > 0.4
    assert morphs["browDownLeft"][0] > 0.9 * load_expressions()["strained"].weights["browDownLeft"]
