"""Edits of tempo, metre and of the piece as a whole."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import msgspec
import pytest

from app.errors import AppError, UsageError
from app.performance.ensemble import Performance
from app.plan.by_hand.corrections import AddExpression, ChangeExpression
from app.project import storage
from app.project.check import faults
from app.project.edit import notes, tempo
from app.project.edit import piece as edit
from app.project.edit.corrections import with_corrections
from app.project.model import Project
from app.score.metre_map import Metre
from tests.unit.project.pieces import ANGRY, full_project, small_project


@pytest.fixture
def project() -> Project:
    return small_project()


def bpm(project: Project) -> list[tuple[int, float]]:
    return [(tick, pytest.approx(value)) for tick, value in project.score.tempo_map.bpm]


def test_tempi_are_set_moved_and_removed(project: Project) -> None:
    faster = tempo.set_tempo(project, 960, 144.0)
    assert bpm(faster) == [(0, 120.0), (960, 144.0)]
    assert faster.score.parts is project.score.parts
    assert faster.players is project.players
    assert bpm(tempo.set_tempo(faster, 960, 90.0)) == [(0, 120.0), (960, 90.0)]
    moved = tempo.move_tempo(faster, 960, 480)
    assert bpm(moved) == [(0, 120.0), (480, 144.0)]
    both = tempo.set_tempo(moved, 960, 60.0)
    assert bpm(tempo.move_tempo(both, 480, 960)) == [(0, 120.0), (960, 144.0)]
    assert tempo.remove_tempo(faster, 960) == project
    assert tempo.set_tempo(faster, 960, 144.0) is faster
    assert tempo.move_tempo(faster, 960, 960) is faster


@pytest.mark.parametrize(
    "edit",
    [
        lambda project: tempo.set_tempo(project, 0, 0.0),
        lambda project: tempo.set_tempo(project, 0, math.nan),
        lambda project: tempo.set_tempo(project, -1, 100.0),
        lambda project: tempo.set_tempo(project, 2**31, 100.0),
        lambda project: tempo.move_tempo(project, 0, 10),
        lambda project: tempo.move_tempo(project, 5, 10),
        lambda project: tempo.remove_tempo(project, 0),
        lambda project: tempo.remove_tempo(project, 7),
        lambda project: tempo.scale_tempo(project, 0.0),
        lambda project: tempo.scale_tempo(project, math.nan),
        lambda project: tempo.scale_tempo(tempo.scale_tempo(tempo.set_tempo(project, 0, 5.0), 0.25), 0.25),
        lambda project: tempo.set_metre(project, 0, 4, 3),
        lambda project: tempo.set_metre(project, 0, 0, 4),
        lambda project: tempo.set_metre(project, -480, 4, 4),
        lambda project: tempo.remove_metre(project, 0),
        lambda project: tempo.remove_metre(project, 10),
        lambda project: tempo.set_pickup(project, -1),
        lambda project: tempo.set_pickup(project, 1920),
        lambda project: tempo.set_metre(tempo.set_pickup(project, 480), 240, 3, 4),
        lambda project: tempo.set_metre(tempo.set_pickup(project, 480), 0, 1, 8),
    ],
)
def test_what_makes_no_sense_is_refused(project: Project, edit: object) -> None:
    with pytest.raises(UsageError):
        edit(project)


def test_scaling_keeps_the_shape_of_the_tempo(project: Project) -> None:
    shaped = tempo.set_tempo(project, 960, 90.0)
    scaled = tempo.scale_tempo(shaped, 1.02)
    for tick in (0.0, 480.0, 1000.0, 1920.0):
        assert scaled.score.tempo_map.seconds(tick) * 1.02 == pytest.approx(shaped.score.tempo_map.seconds(tick))
    assert tempo.scale_tempo(project, 1.0) is project
    assert scaled.score.parts is project.score.parts


def test_metres(project: Project) -> None:
    three = tempo.set_metre(project, 0, 3, 4)
    assert three.score.metres == (Metre(0, 3, 4),)
    assert three.score.bar_starts.tolist() == [0, 1440]
    changed = tempo.set_metre(three, 1440, 2, 4)
    assert changed.score.metres == (Metre(0, 3, 4), Metre(1440, 2, 4))
    assert tempo.remove_metre(changed, 1440) == three
    assert tempo.set_metre(three, 0, 3, 4) is three


def test_pickups(project: Project) -> None:
    picked = tempo.set_pickup(tempo.set_metre(project, 0, 3, 4), 480)
    assert picked.score.pickup_ticks == 480
    assert picked.score.metres == (Metre(0, 3, 4), Metre(480, 3, 4))
    assert picked.score.bar_starts.tolist() == [0, 480]
    assert picked.score.metre_map.bar_of_tick(0) == 0
    assert list(faults(picked)) == []
    longer = tempo.set_pickup(picked, 960)
    assert longer.score.metres == (Metre(0, 3, 4), Metre(960, 3, 4))
    four = tempo.set_metre(picked, 480, 4, 4)
    assert four.score.metres == (Metre(0, 4, 4), Metre(480, 4, 4))
    assert tempo.set_metre(picked, 0, 4, 4) == four
    none = tempo.remove_metre(four, 480)
    assert none.score.metres == (Metre(0, 4, 4),)
    assert none == tempo.set_pickup(four, 0) == project
    # A pickup that a file gave a metre of its own: what follows is the piece's.
    score = msgspec.structs.replace(project.score, metres=(Metre(0, 1, 4), Metre(480, 4, 4)), pickup_ticks=480)
    assert tempo.set_pickup(replace(project, score=score), 0) == project
    assert tempo.set_metre(replace(project, score=score), 480, 3, 4).score.metres == (Metre(0, 1, 4), Metre(480, 3, 4))


def test_no_edit_makes_a_piece_longer_than_can_be_saved(project: Project) -> None:
    part, quarter = project.score.parts[0], project.score.ticks_per_quarter
    ids = [part.notes[-1].id]
    far = 80_000 * quarter
    long = notes.move(project, ids, far, 0)
    for longer in (
        lambda: tempo.set_metre(long, 0, 1, 64),
        lambda: tempo.set_tempo(long, 0, 5.0),
        lambda: notes.move(long, ids, 2 * far, 0),
    ):
        with pytest.raises(UsageError, match=r"piece\.too_long"):
            longer()
    storage.decode(storage.encode(long, Path("long.suisou")), Path("long.suisou"))


def test_a_new_piece() -> None:
    new = edit.new_piece("  A\nmarch ", 96.0, (2, 4), 960)
    assert new.score.title == "A march"
    assert bpm(new) == [(0, 96.0)]
    assert (new.score.ticks_per_quarter, new.score.tempo_map.ticks_per_quarter) == (960, 960)
    assert new.score.metres == (Metre(0, 2, 4),)
    assert list(faults(new)) == []
    assert Performance(new).plans == {}
    for wrong in ({"bpm": 0.0}, {"metre": (4, 0)}, {"ticks_per_quarter": 0}):
        with pytest.raises(UsageError):
            edit.new_piece(**wrong)


def test_settings_of_the_piece(project: Project) -> None:
    assert edit.set_title(project, "x").score.title == "x"
    assert edit.set_fps(project, Fraction(24000, 1001)).fps == Fraction(24000, 1001)
    assert edit.set_preroll(project, 2).preroll_beats == 2.0
    assert edit.set_felt_beat(project, 1.5).felt_beat_quarters == 1.5
    assert edit.set_seed(project, 7).seed == 7
    for same in (
        edit.set_title(project, project.score.title),
        edit.set_fps(project, Fraction(60)),
        edit.set_preroll(project, project.preroll_beats),
        edit.set_felt_beat(project, None),
        edit.set_seed(project, 0),
        edit.set_audio(project, None),
    ):
        assert same is project
    for wrong in (
        lambda: edit.set_fps(project, Fraction(1000)),
        lambda: edit.set_preroll(project, math.inf),
        lambda: edit.set_felt_beat(project, 0.0),
        lambda: edit.set_seed(project, -1),
        lambda: edit.set_offset(project, 1.0),
        lambda: edit.set_audio(project, "a\0.wav"),
    ):
        with pytest.raises(UsageError):
            wrong()


def test_settings_at_once_are_those_one_by_one(project: Project) -> None:
    usual = edit.piece_settings(project)
    assert edit.set_piece_settings(project, usual) is project
    assert edit.piece_settings(edit.new_piece(usual.title)) == edit.usual_settings(usual.title)
    others = edit.PieceSettings(title="x", fps=Fraction(25), preroll_beats=2.0, felt_beat_quarters=1.5, seed=7)
    one_by_one = edit.set_seed(edit.set_felt_beat(edit.set_preroll(project, 2.0), 1.5), 7)
    one_by_one = edit.set_fps(edit.set_title(one_by_one, "x"), Fraction(25))
    assert edit.set_piece_settings(project, others) == one_by_one
    assert edit.piece_settings(one_by_one) == others
    odd = edit.set_piece_settings(project, msgspec.structs.replace(usual, title="  two \n words "))
    assert odd.score.title == "two words"
    # The stored name of a source file is never changed without the user's knowledge.
    read = replace(project, score=msgspec.structs.replace(project.score, title=" as read "))
    assert edit.set_piece_settings(read, edit.piece_settings(read)) is read
    for wrong in ({"fps": Fraction(0)}, {"preroll_beats": math.nan}, {"felt_beat_quarters": 0.0}, {"seed": 2**63}):
        with pytest.raises(UsageError):
            edit.set_piece_settings(project, msgspec.structs.replace(others, **wrong))


def test_recordings_and_their_offset(project: Project, tmp_path: Path) -> None:
    with_audio = edit.set_audio(project, tmp_path / "sub" / ".." / "take.wav")
    assert with_audio.audio.path == str(tmp_path / "take.wav")
    estimated = edit.set_offset(with_audio, -0.5, 0.9)
    assert (estimated.audio.offset_s, estimated.audio.confidence) == (-0.5, 0.9)
    by_hand = edit.set_offset(estimated, -0.5)
    assert by_hand.audio.confidence is None
    assert edit.set_offset(by_hand, -0.5) is by_hand
    assert edit.set_audio(by_hand, tmp_path / "take.wav") is by_hand
    assert edit.set_audio(by_hand, None) == project
    with pytest.raises(UsageError):
        edit.set_offset(by_hand, math.nan)


def test_own_expressions_reach_the_performance(project: Project) -> None:
    shown = with_corrections(project, "1.1.1", [AddExpression("mine", "angry", 0, 960)])
    plan = Performance(shown).plan(shown.players[0])
    assert [problem.message.id for problem in plan.problems].count("correction.unknown_expression") == 1
    known = edit.put_expression(shown, ANGRY)
    performance = Performance(known)
    events = [event for event in performance.plan(known.players[0]).expressions if event.expression == "angry"]
    assert [event.corrected for event in events] == [True]
    assert performance.expressions["angry"] is ANGRY or performance.expressions["angry"] == ANGRY
    assert edit.put_expression(known, ANGRY) is known


def test_an_own_expression_may_take_the_place_of_a_bundled_one(project: Project) -> None:
    strained = msgspec.structs.replace(ANGRY, name="strained")
    assert Performance(edit.put_expression(project, strained)).expressions["strained"] == strained


def test_renaming_an_expression_takes_corrections_along() -> None:
    project = full_project()
    furious = msgspec.structs.replace(ANGRY, name="  furious ")
    renamed = edit.put_expression(project, furious, former_name="angry")
    assert [item.name for item in renamed.expressions] == ["furious"]
    shown = [getattr(item, "expression", None) for item in renamed.corrections["1.1.1"]]
    assert shown.count("furious") == 2
    assert shown.count("angry") == 0
    assert renamed.corrections["1.1.1"][0] is project.corrections["1.1.1"][0]
    with pytest.raises(UsageError, match=r"expression\.name_taken"):
        edit.put_expression(project, msgspec.structs.replace(ANGRY, name="smile"), former_name="angry")
    with pytest.raises(UsageError, match=r"expression\.none_of_name"):
        edit.put_expression(project, ANGRY, former_name="gone")


def test_removing_an_expression_keeps_the_corrections() -> None:
    project = full_project()
    without = edit.remove_expression(project, "angry")
    assert without.expressions == ()
    assert without.corrections is project.corrections
    assert any(isinstance(item, ChangeExpression) for item in without.corrections["1.1.1"])
    with pytest.raises(UsageError):
        edit.remove_expression(without, "angry")


@pytest.mark.parametrize(
    "changes",
    [
        {"name": " \n "},
        {"weights": {"moustache": 0.5}},
        {"weights": {"browDownLeft": 1.5}},
        {"weights": {"browDownLeft": math.nan}},
        {"fade_in_s": 0.0},
        {"fade_out_s": math.inf},
    ],
)
def test_expressions_that_no_face_can_show(project: Project, changes: dict[str, object]) -> None:
    with pytest.raises(AppError):
        edit.put_expression(project, msgspec.structs.replace(ANGRY, **changes))
