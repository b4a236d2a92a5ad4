"""Dancers of a project: their motion over the piece next to the players, and the display if one cannot dance."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path

import msgspec
import numpy as np
import pytest

from app.choreography.dance import Manner
from app.choreography.generate import Choreographer
from app.choreography.model_file import write_model
from app.choreography.performed import dancers
from app.choreography.performed.dancers import assignments_of, dancing_of, visible_faults
from app.errors import AppError
from app.performance.ensemble import Performance
from app.performance.live import LiveMotion
from app.performance.span import whole_span
from app.plan.model import TimeFrame
from app.project.casting import StagePosition
from app.project.dance_corrections import ForbidState, PinState, UseSegment
from app.project.edit.generation import vary_everyone
from app.project.model import Project
from app.project.performers import Dancer
from app.rig import quaternion
from tests.support.dances import beaten, model
from tests.unit.project.pieces import small_project

pytestmark = pytest.mark.slow

FPS = Fraction(30)


@pytest.fixture(scope="module")
def choreography(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("dances") / "steps.choreography"
    write_model(path, model())
    return str(path)


@cache
def played() -> Project:
    """A performance of some bars."""
    project = small_project()
    part = project.score.parts[0]
    notes = tuple(
        msgspec.structs.replace(part.notes[0], id=f"9:{number}", onset_tick=480 * number, duration_tick=400)
        for number in range(32)
    )
    parts = (msgspec.structs.replace(part, notes=notes), *project.score.parts[1:])
    return replace(project, score=msgspec.structs.replace(project.score, parts=parts), fps=FPS)


def with_dancers(choreography: str, **fields: object) -> Project:
    one = Dancer("dancer:1", "One", choreography, "woman_adult", StagePosition(0.0, 2.0, 0.0))
    return replace(played(), dancers=(msgspec.structs.replace(one, **fields),))


def frames(project: Project) -> tuple[Performance, np.ndarray]:
    performance = Performance(project)
    span = whole_span(performance.time_frame, FPS)
    motion = dancing_of(performance, project.dancers[0]).motion(FPS, span.first, span.count)
    assert motion.frames == span.count
    assert motion.first_frame_s == span.first_frame_s
    return performance, motion.rotations


def test_hours_are_not_danced_to(choreography: str) -> None:
    """Dances are generated as a whole; one of twelve hours would take 27 GB."""
    project = played()
    part = project.score.parts[0]
    last = msgspec.structs.replace(part.notes[-1], id="9:999", onset_tick=480 * 3600 * 2)
    long = msgspec.structs.replace(part, notes=(*part.notes, last))
    score = msgspec.structs.replace(project.score, parts=(long, *project.score.parts[1:]))
    performance = Performance(replace(project, score=score))
    with pytest.raises(AppError) as caught:
        dancing_of(performance, Dancer("dancer:1", "A", choreography, "man_adult", StagePosition(0.0, 0.0, 0.0)))
    assert caught.value.message.id == "dance.too_long"
    assert caught.value.message.arguments["most"] == 15


def test_a_dancer_dances_the_whole_performance(choreography: str) -> None:
    performance, rotations = frames(with_dancers(choreography))
    dancing = dancing_of(performance, performance.project.dancers[0])
    steps = dancing.dance(FPS).steps
    assert len(steps) > 15
    assert steps[0].start_s > performance.time_frame.first_frame_s
    part = dancing.motion(FPS, 40, 20)
    assert np.array_equal(part.rotations, rotations[40:60])
    assert part.first_frame_s == pytest.approx(performance.time_frame.first_frame_s + 40 / 30)
    assert part.morphs["eyeBlinkLeft"].shape == (20,)


def test_who_dances_alike_is_made_once(choreography: str) -> None:
    project = with_dancers(choreography)
    dancer = project.dancers[0]
    elsewhere = msgspec.structs.replace(dancer, name="Two", stage=StagePosition(3.0, 1.0, 0.5))
    other = msgspec.structs.replace(dancer, seed=5)
    one, same, different = (dancing_of(Performance(project), who) for who in (dancer, elsewhere, other))
    assert one is same
    assert one is not different
    # After the edit of players' notes, the percussion and thus the dance are the same.
    assert len(one.changed_s(one)) == 0
    assert len(one.changed_s(different)) == 1


def test_a_canon_comes_in_later(choreography: str) -> None:
    first = dancing_of(Performance(with_dancers(choreography)), with_dancers(choreography).dancers[0]).dance(FPS)
    project = with_dancers(choreography, delay_beats=4.0)
    second = dancing_of(Performance(project), project.dancers[0]).dance(FPS)
    tempo = project.score.tempo_map
    beat_s = tempo.seconds(480.0 * 40) - tempo.seconds(480.0 * 39)
    later = [two.accent_s - one.accent_s for one, two in zip(first.steps[-5:], second.steps[-5:], strict=True)]
    assert [one.segment for one in first.steps] == [two.segment for two in second.steps]
    assert later == pytest.approx([4.0 * beat_s] * 5, abs=0.2)


def test_corrections_hold_at_their_ticks(choreography: str) -> None:
    project = with_dancers(choreography)
    performance = Performance(project)
    dancing = dancing_of(performance, project.dancers[0])
    step = dancing.dance(FPS).steps[6]
    tick = round(project.score.tempo_map.ticks(step.accent_s) / 240) * 240
    requested = (step.state + 1) % 4
    corrected = replace(project, dance_corrections={"dancer:1": (PinState(tick, requested),)})
    again = dancing_of(Performance(corrected), corrected.dancers[0]).dance(FPS)
    time_s = project.score.tempo_map.seconds(float(tick))
    nearest = min(again.steps, key=lambda one: abs(one.accent_s - time_s))
    assert nearest.state == requested
    forbidden = replace(project, dance_corrections={"dancer:1": (ForbidState(0, 480 * 40, requested),)})
    without = dancing_of(Performance(forbidden), forbidden.dancers[0]).dance(FPS)
    assert all(one.state != requested for one in without.steps)


@pytest.mark.parametrize(
    ("corrections", "problems"),
    [
        pytest.param((PinState(4800, 2), UseSegment(9600, 3), ForbidState(0, 2400, 1)), [], id="held"),
        pytest.param((ForbidState(2400, 9600, 2), PinState(4800, 2)), [], id="pinned where it is forbidden"),
        pytest.param((PinState(4800, 99),), ["dance.state_not_held"], id="no such state"),
        pytest.param((UseSegment(4800, 999),), ["dance.segment_not_held"], id="no such segment"),
        pytest.param((PinState(4800, 0), PinState(4801, 1)), ["dance.state_not_held"], id="two at one place"),
        pytest.param(
            tuple(ForbidState(4800, 9600, state) for state in range(4)), ["dance.state_not_avoided"] * 4, id="all"
        ),
    ],
)
def test_corrections_that_do_not_hold_are_problems(
    choreography: str, corrections: tuple[object, ...], problems: tuple[str, ...]
) -> None:
    project = replace(with_dancers(choreography), dance_corrections={"dancer:1": corrections})
    live = LiveMotion(Performance(project))
    while live.work():
        pass
    # These few synthetic motions do not always join well.
    flaws = ("dance.seam_shows", "dance.jolts")
    found = [one for one in live.broken.get("dancer:1", ()) if one.message.id not in flaws]
    # Some motions may be absent even if none is forbidden.
    assert [problem.message.id for problem in found] == problems[: len(found) or None]
    seconds = project.score.tempo_map.seconds
    assert all(seconds(4000.0) < problem.start_s <= problem.end_s < seconds(11_000.0) for problem in found)
    live.show(Performance(replace(project, dance_corrections={})))
    while live.work():
        pass
    assert "dancer:1" not in live.broken


def test_corrections_go_to_the_nearest_place() -> None:
    from app.choreography.accent_grid import AccentGrid

    grid = AccentGrid(np.arange(9) * 0.25, np.arange(9) % 2 == 0)
    tempo = played().score.tempo_map
    tick = round(tempo.ticks(0.55))
    found = assignments_of(
        (PinState(tick, 3), UseSegment(tick + 1, 7), ForbidState(0, round(tempo.ticks(0.5)), 1)), grid, tempo
    )
    assert found.pinned == {2: 3}
    assert found.segments == {2: 7}
    assert found.forbidden == {(0, 1), (1, 1)}
    # A basic motion that there is not need not be forbidden at every place.
    many = [ForbidState(0, round(tempo.ticks(9.0)), state) for state in (*range(1, 900), 1)]
    assert assignments_of(many, grid, tempo, states=3).forbidden == {(at, state) for at in range(9) for state in (1, 2)}


def test_dancers_are_seen_beside_the_players(choreography: str) -> None:
    project = with_dancers(choreography)
    live = LiveMotion(Performance(project))
    time_s = 2.0
    live.request(time_s)
    while live.work():
        pass
    pose = live.pose("dancer:1", time_s)
    assert len(pose.rotations) > 50
    player = project.players[0].id
    assert live.pose(player, time_s) is not None
    # An edit of a player does not affect the dance; another seed generates another one.
    moved = replace(project, players=(msgspec.structs.replace(project.players[0], muted=True), *project.players[1:]))
    live.show(Performance(moved))
    assert live.pose("dancer:1", time_s) is not None
    other = replace(moved, dancers=(msgspec.structs.replace(project.dancers[0], seed=9),))
    live.show(Performance(other))
    while live.work():
        pass
    changed = live.pose("dancer:1", time_s)
    assert not np.array_equal(changed.rotations, pose.rotations)


def test_without_its_choreography_a_dancer_is_a_problem_and_the_others_play_on(tmp_path: Path) -> None:
    project = with_dancers(str(tmp_path / "gone.choreography"))
    live = LiveMotion(Performance(project))
    while live.work():
        pass
    assert live.pose("dancer:1", 1.0) is None
    assert live.error("dancer:1") is not None
    assert [problem.message.id for problem in live.broken["dancer:1"]] == [live.error("dancer:1").id]
    assert live.pose(project.players[0].id, 1.0) is not None
    with pytest.raises(AppError):
        dancing_of(Performance(project), project.dancers[0])


def test_the_performance_lasts_as_long_as_the_percussion(choreography: str) -> None:
    project = with_dancers(choreography)
    assert isinstance(Performance(project).time_frame, TimeFrame)
    without = replace(project, dancers=())
    assert Performance(project).time_frame.end_s >= Performance(without).time_frame.end_s


def test_another_performance_by_everyone_is_another_dance_in_unison_still(choreography: str) -> None:
    project = with_dancers(choreography)
    double = msgspec.structs.replace(project.dancers[0], id="dancer:2", name="Two")
    project = replace(project, dancers=(*project.dancers, double))

    def danced(project: Project) -> list[list[int]]:
        performance = Performance(project)
        dances = (dancing_of(performance, dancer).dance(FPS) for dancer in project.dancers)
        return [[step.segment for step in dance.steps] for dance in dances]

    first, again = danced(project), danced(vary_everyone(project))
    assert first[0] == first[1]
    assert again[0] == again[1]
    assert first[0] != again[0]


def test_a_choreography_that_is_not_there_is_named_with_what_to_do(tmp_path: Path) -> None:
    for choreography, id in (
        ("gone_dance", "project.choreography_missing"),
        (str(tmp_path / "gone.choreography"), "project.choreography_file_missing"),
    ):
        project = with_dancers(choreography)
        with pytest.raises(AppError) as raised:
            dancing_of(Performance(project), project.dancers[0])
        assert raised.value.message.id == id


def test_what_can_be_seen_of_a_dance_is_a_problem() -> None:
    choreographer = Choreographer(model())
    dance = choreographer.dance(beaten(48, 0.55), Manner(), Fraction(60), first_s=-1.0)
    usual = choreographer.usual_change_rad_s(Fraction(60))
    assert visible_faults(dance, usual) == ()
    seam, stand = dance.seams[1], dance.standing[6]
    rotations, hips = dance.clip.rotations.copy(), dance.clip.hips_m.copy()
    turn = quaternion.from_axis_angle(np.array([0.0, 1.0, 0.0]), 0.4)
    rotations[seam:, 2] = quaternion.multiply(turn, rotations[seam:, 2])
    hips[stand.start : stand.stop, 0] += np.linspace(0.0, 0.02, stand.stop - stand.start)
    broken = replace(dance, clip=replace(dance.clip, hips_m=hips, rotations=rotations))
    found = {(one.message.id, one.start_s): one.message.arguments for one in visible_faults(broken, usual)}
    states = [step.state + 1 for step in dance.steps]
    at = next(number for number, step in enumerate(dance.steps) if abs(step.start_s - (seam / 60.0 - 1.0)) < 0.02)
    assert found["dance.seam_shows", seam / 60.0 - 1.0] == {"before": states[at - 1], "after": states[at]}
    assert found["dance.foot_slides", stand.start / 60.0 - 1.0] == {"side": ("left", "right")[stand.foot]}


def test_dances_take_no_more_memory_than_allowed(choreography: str, monkeypatch: pytest.MonkeyPatch) -> None:
    project = with_dancers(choreography)
    some = tuple(msgspec.structs.replace(project.dancers[0], id=f"dancer:{at}", seed=at) for at in range(4))
    performance = Performance(replace(project, dancers=some))
    dancings = [dancing_of(performance, one) for one in some]
    size_bytes = dancings[0]._whole(FPS).size_bytes
    monkeypatch.setattr(dancers._REMEMBERED, "most_bytes", 2 * size_bytes)
    first = [one.motion(FPS, 0, 40) for one in dancings]
    assert [one._made is not None for one in dancings] == [False, False, True, True]
    assert dancings[0].steps()
    again = dancings[0].motion(FPS, 0, 40)
    np.testing.assert_array_equal(again.rotations, first[0].rotations)
    assert [one._made is not None for one in dancings] == [True, False, False, True]


def test_a_large_dance_is_kept_alone(choreography: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dancers._REMEMBERED, "most_bytes", 1)
    performance = Performance(with_dancers(choreography, seed=77))
    dancing = dancing_of(performance, performance.project.dancers[0])
    made = dancing._whole(FPS)
    assert dancing._whole(FPS) is made
