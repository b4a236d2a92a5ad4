"""An unknown instrument from a map and a model alone: fitted, played, written and measured."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from app.contacts.judge import ContactJudge
from app.export.character import character_scene
from app.export.instrument import instrument_scene
from app.export.measure import PlayerJudge, PlayerMeasures
from app.export.report import PlaceReport, PlayerReport, failures
from app.motion.model import Motion
from app.motion.perform import PerformanceCurves, prepare
from app.performance.cast import Performer
from app.plan.model import PlayerPlan
from app.plan.parameters import PlayerParameters
from app.project.casting import StagePosition
from app.project.performers import Player
from app.rig.characters.character_library import character_named
from app.rig.grip.fitting.fit import fit_hold
from app.rig.instrument import load_instrument
from app.rig.model import Character, InstrumentModel
from app.steps import StepRuns
from instrument_maps.load import load_map
from instrument_maps.model import InstrumentMap
from metadata.load import load_body
from tests.support import pipe
from tests.unit.motion.events import fingerings, plan_of

FPS = Fraction(60)
NOTE_S = 0.3
LEAPS = (60, 75, 62, 81, 68, 67, 60, 72, 71, 64, 80)


class Played:
    """Every note of the range upwards, then leaps."""

    def __init__(self, folder: Path) -> None:
        path = pipe.add(folder)
        self.instrument: InstrumentMap = load_map(path)
        self.model: InstrumentModel = load_instrument(folder / self.instrument.model, self.instrument)
        self.character: Character = character_named("man_adult")
        self.hold = fit_hold(self.character, self.model, self.instrument, load_body())
        pitches = [*range(self.instrument.range.low, self.instrument.range.high + 1), *LEAPS]
        rows = [
            (NOTE_S * step, NOTE_S * (step + 1), self.instrument.fingerings_for(pitch)[0].controls)
            for step, pitch in enumerate(pitches)
        ]
        self.plan: PlayerPlan = plan_of(fingerings(rows, NOTE_S))
        parameters = PlayerParameters(seed=1)
        self.playing: PerformanceCurves = prepare(
            StepRuns(),
            self.plan,
            parameters,
            self.instrument,
            self.character,
            self.hold,
            load_body(),
            felt_beats=((0, 480),),
        )
        self.motion: Motion = self.playing.motion(FPS, 0, int((rows[-1][1] + 3.0) * FPS))
        self.measures = self._measured()

    def _measured(self) -> PlayerMeasures:
        player = character_scene(self.character, self.motion, "x", "test")
        held = instrument_scene(self.instrument, self.model, self.motion, "x", "test")
        nobody = Player("x", "X", "x", "x", self.character.id, PlayerParameters(seed=1), StagePosition(0.0, 0.0, 0.0))
        performer = Performer(nobody, self.character, load_body(), self.instrument, self.model, self.hold)
        return PlayerJudge(performer, self.plan).measure(player, held, self.motion.first_frame_s).measures


@pytest.fixture(scope="module")
def played(tmp_path_factory: pytest.TempPathFactory) -> Played:
    return Played(tmp_path_factory.mktemp("maps"))


def test_it_is_held_as_the_map_says(played: Played) -> None:
    for hand in played.hold.hands:
        for fit in hand.contacts:
            assert fit.distance_m <= 0.002, fit
            assert fit.waits_m <= 0.020, fit
            assert fit.control is None or fit.waits_m >= 0.004, fit
        assert hand.penetration_m <= 0.0035


def test_every_finger_is_on_its_control(played: Played) -> None:
    for name, spread in played.measures.contacts.items():
        assert spread.frames, name
        assert spread.kept, (name, spread)
    for name, control in played.measures.controls.items():
        assert control.right == control.judged > 0, (name, control)
        assert control.held_wrong == 0, (name, control)


def test_fingers_that_play_nothing_wait_over_their_keys(played: Played) -> None:
    assert set(played.measures.hovering) >= {"left.middle", "left.little", "right.index", "right.little"}
    for finger, spread in played.measures.hovering.items():
        assert spread.kept, (finger, spread)


def test_the_written_files_keep_the_bounds_of_any_instrument(played: Played) -> None:
    place = PlaceReport(0.0, 0.0, 0.0)
    report = PlayerReport("p", "p", "pipe", "man_adult", "standing", {}, place, 1, played.measures, None, None)
    # The embouchures of this plan are not those of a fipple's player: lips are judged elsewhere.
    assert set(failures(report)) <= {"lips"}


def test_the_editor_has_nothing_to_complain_of(played: Played) -> None:
    judge = ContactJudge(played.playing, played.character, played.model)
    assert [found for found in judge.breaks(played.motion) if found.kind != "lips"] == []


def test_a_part_of_the_motion_is_that_of_the_whole(played: Played) -> None:
    part = played.playing.motion(FPS, 333, 77)
    np.testing.assert_array_equal(part.rotations, played.motion.rotations[333:410])
