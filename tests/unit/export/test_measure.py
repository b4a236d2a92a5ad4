"""Measurements detect errors: files are damaged in known ways, and the numbers must show it."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from app.export.character import character_scene
from app.export.face_curves import (
    CURVE_NAMES,
    DEFAULT_FACE,
    CurveNames,
    FaceOptions,
    with_curve_names,
    written_weights,
)
from app.export.instrument import instrument_scene
from app.export.measure import PlayerJudge, PlayerMeasurement, greatest_correlations
from app.formats.scene import Scene
from app.performance.cast import performer_of
from app.performance.ensemble import Performance
from app.performance.span import cut_span
from app.project.model import map_choices, project_from_score
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from tests.support.performed import player_motion

QUARTET = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"
FPS = Fraction(30)


class Case:
    """A few seconds of one player as scenes without files."""

    def __init__(self, index: int) -> None:
        maps = bundled_maps()
        project = project_from_score(read_midi(QUARTET, maps=map_choices(maps.values())), maps)
        self.performance = Performance(project)
        self.player = project.players[index]
        self.span = cut_span(self.performance.time_frame, FPS, -1.5, 3.0)
        motion = player_motion(self.performance, self.player, self.span)
        self.performer = performer_of(self.performance, self.player)
        self.instrument, self.character = self.performer.instrument, self.performer.character
        self.player_scene = character_scene(self.character, motion, "x", "test")
        self.held_scene = instrument_scene(self.instrument, self.performer.model, motion, "x", "test")

    def measure(
        self, player_scene: Scene | None = None, held_scene: Scene | None = None, face: FaceOptions = DEFAULT_FACE
    ) -> PlayerMeasurement:
        judge = PlayerJudge(self.performer, self.performance.plan(self.player), face=face)
        return judge.measure(player_scene or self.player_scene, held_scene or self.held_scene, self.span.first_frame_s)


@pytest.fixture(scope="module", params=[0, 2], ids=["first", "third"])
def case(request: pytest.FixtureRequest) -> Case:
    return Case(request.param)


def moved(scene: Scene, bone: int, offset_cm: np.ndarray, frames: slice = slice(None)) -> Scene:
    translations = dict(scene.clip.translations_cm)
    translations[bone] = np.array(translations[bone], np.float64)
    translations[bone][frames] += offset_cm
    return replace(scene, clip=replace(scene.clip, translations_cm=translations))


def test_what_we_made_is_within_its_bounds(case: Case) -> None:
    measures = case.measure().measures
    assert measures.sounding_frames > 30
    assert all(spread.kept for spread in measures.contacts.values()), measures.contacts
    assert measures.lips.kept
    assert all(spread.kept for spread in measures.feet.values())
    assert measures.bones.kept
    assert all(control.right == control.judged > 0 for control in measures.controls.values())


def test_a_displaced_instrument_is_seen_by_every_contact(case: Case) -> None:
    before = case.measure().measures
    after = case.measure(held_scene=moved(case.held_scene, 0, np.array([0.0, 0.5, 0.0]))).measures
    for name, spread in after.contacts.items():
        assert spread.max_mm == pytest.approx(5.0, abs=before.contacts[name].max_mm + 0.01)
        assert not spread.kept
    assert after.lips.max_mm == pytest.approx(5.0, abs=0.05)
    assert after.controls == before.controls
    assert after.feet == before.feet


def test_one_bad_frame_is_enough(case: Case) -> None:
    before = case.measure().measures
    after = case.measure(held_scene=moved(case.held_scene, 0, np.array([0.0, 0.0, 1.0]), slice(75, 76))).measures
    assert after.lips.max_mm == pytest.approx(10.0, abs=0.05)
    assert after.lips.p99_mm <= after.lips.max_mm
    assert before.lips.max_mm < 1.0


def test_a_rim_that_slips_across_the_upper_lip_in_a_breath_is_seen(case: Case) -> None:
    fps, first_s = float(FPS), case.span.first_frame_s
    breath = next(event for event in case.performance.plan(case.player).breaths if event.kind == "breath")
    during = slice(round((breath.start_s - first_s) * fps) + 1, round((breath.end_s - first_s) * fps) - 1)
    before = case.measure().measures.upper_lip_in_breaths
    # Sideways: at a right angle to the air.
    slipped = moved(case.held_scene, 0, np.array([0.4, 0.0, 0.0]), during)
    after = case.measure(held_scene=slipped).measures.upper_lip_in_breaths
    assert before.kept
    assert before.frames > 0
    assert not after.kept


def test_a_raised_body_leaves_the_floor(case: Case) -> None:
    hips = [bone.name for bone in case.player_scene.bones].index("hips")
    after = case.measure(
        player_scene=moved(case.player_scene, hips, np.array([0.0, 2.0, 0.0]), slice(30, None))
    ).measures
    assert all(spread.max_mm == pytest.approx(20.0, abs=0.2) for spread in after.feet.values())


def test_a_hand_thrust_into_the_instrument_is_found(case: Case) -> None:
    before = case.measure().measures.penetration.max_mm
    away = case.measure(held_scene=moved(case.held_scene, 0, np.array([0.0, 200.0, 0.0]))).measures
    assert away.penetration.max_mm == 0.0
    deeper = [
        case.measure(held_scene=moved(case.held_scene, 0, offset)).measures.penetration.max_mm
        for offset in 1.0 * np.concatenate([np.eye(3), -np.eye(3)])
    ]
    assert max(deeper) > before + 3.0


def test_a_control_out_of_place_is_found(case: Case) -> None:
    control = case.instrument.controls[0]
    bone = [bone.name for bone in case.held_scene.bones].index(control.name)
    off_cm = np.asarray(control.motion.axis) * 0.012 * 100.0
    after = case.measure(held_scene=moved(case.held_scene, bone, off_cm)).measures.controls[control.name]
    assert after.right < after.judged
    assert after.held_wrong > 0


def test_a_bent_and_a_jerked_joint_are_found(case: Case) -> None:
    names = [bone.name for bone in case.player_scene.bones]
    clip = case.player_scene.clip
    rotations = np.array(clip.rotations_xyzw, np.float64)
    knee = names.index("leftLowerLeg")
    rotations[20, knee] = [np.sin(-0.5), 0.0, 0.0, np.cos(-0.5)]  # the wrong way, for one frame
    spoilt = replace(case.player_scene, clip=replace(clip, rotations_xyzw=rotations))
    measures = case.measure(player_scene=spoilt).measures
    assert measures.limits.beyond >= 1
    assert measures.acceleration.joint == "leftLowerLeg"
    assert measures.acceleration.beyond >= 1


def test_a_breath_without_a_jaw_is_missed(case: Case) -> None:
    before = case.measure().measures.breaths
    assert before.planned > 0
    assert before.shown == before.planned
    clip = case.player_scene.clip
    shut = {**clip.morph_weights, "jawOpen": np.zeros(clip.frames)}
    after = case.measure(player_scene=replace(case.player_scene, clip=replace(clip, morph_weights=shut)))
    assert after.measures.breaths.jaw_open == 0
    assert after.measures.breaths.shown == 0
    assert after.measures.breaths.torso_back == before.torso_back


@pytest.mark.parametrize("names", CURVE_NAMES)
def test_breaths_are_seen_by_any_names_of_the_curves(case: Case, names: CurveNames) -> None:
    before = case.measure().measures.breaths
    assert before.shown == before.planned > 0
    renamed = case.measure(with_curve_names(case.player_scene, names), face=FaceOptions(names))
    assert renamed.measures.breaths == before


def test_a_mouth_that_is_left_out_of_a_file_is_not_judged(case: Case) -> None:
    before = case.measure().measures.breaths
    clip = case.player_scene.clip
    brows = replace(clip, morph_weights=written_weights(clip.morph_weights, ("brows",)))
    after = case.measure(replace(case.player_scene, clip=brows), face=FaceOptions(parts=("brows",))).measures
    assert after.breaths.jaw_open is None
    assert after.breaths.shown == after.breaths.torso_back == before.planned
    assert after.lips.frames == after.upper_lip_in_breaths.frames == 0


def test_sway_of_twins_and_of_strangers() -> None:
    random = np.random.default_rng(1)
    one, other = random.normal(size=500), random.normal(size=500)
    alike = greatest_correlations({"a": one, "b": one * 2.0, "c": other})
    assert alike["a"] == alike["b"] == pytest.approx(1.0)
    assert alike["c"] < 0.3
    assert greatest_correlations({"a": one, "still": np.zeros(500)}) == {"a": 0.0, "still": 0.0}
