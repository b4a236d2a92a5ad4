"""While a long piece is being planned, players move according to an excerpt around the playhead, afterwards according
to the whole.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from app.errors import Cancelled, raise_if_stopped
from app.performance.ensemble import Performance
from app.performance.excerpt import AFTER_S, BEFORE_S, PerformanceExcerpt, is_worth_it
from app.performance.live import LiveMotion
from app.plan.model import GestureEvent
from app.project.edit.piece import new_piece
from app.project.edit.players import set_parameters
from app.project.model import Project, project_from_score
from app.score.model import MOST_VOICES, Note, Part, Score
from app.score.tempo import TempoMap
from instrument_maps.load import bundled_maps

QUARTER = 480
INSTRUMENTS = ("trumpet_Bb", "clarinet_Bb", "clarinet_Bb", "trombone_tenor_F_attachment")
LOW = (60, 60, 60, 48)
END_S = 300.0
CHANGED_S = (150.0, 250.0)
"""Range in seconds in which the second musician plays the piccolo."""


def notes(track: int, low: int, seed: int, of: range = range(1, 600)) -> tuple[Note, ...]:
    """Notes of half a second with occasional rests."""
    random = np.random.default_rng(seed)
    row = []
    for beat in of:
        pitch, rests = low + int(random.integers(0, 12)), random.random() < 0.15
        if not rests:
            row.append(Note(f"{track}:{beat}", beat * QUARTER, QUARTER - 60 * int(random.integers(0, 3)), pitch, 70))
    return tuple(row)


@cache
def piece() -> Project:
    """Five minutes for trumpet, two clarinets in unison, trombone, and a flutist who plays the piccolo in the end."""
    parts = [
        Part(f"{n + 1}.1.1", f"P{n}", n, 0, 0, None, None, kind, notes(n + 1, LOW[n], min(n, 1) + n // 3))
        for n, kind in enumerate(INSTRUMENTS)
    ]
    flute, piccolo = notes(5, 72, 7, range(4, 40)), notes(5, 84, 8, range(48, 560))
    for change, kind, played in ((0, "flute", flute), (1, "piccolo", piccolo)):
        voice = change * MOST_VOICES
        parts.append(Part(f"5.1.{voice + 1}", kind, 5, voice, 0, None, kind, kind, played))
    return project_from_score(Score("Long", QUARTER, TempoMap(QUARTER), parts=tuple(parts)), bundled_maps())


def begun(around_s: float, project: Project | None = None) -> tuple[Performance, PerformanceExcerpt]:
    """Performance whose first player is planned, and an excerpt of it."""
    performance, made = Performance(project or piece()), list[PerformanceExcerpt]()

    def planned(player_ids: tuple[str, ...]) -> None:
        made.append(PerformanceExcerpt(performance, around_s))
        made[0].prepare()
        raise_if_stopped(lambda: True)

    with pytest.raises(Cancelled):
        performance.prepare(planned=planned)
    return performance, made[0]


def near(events: tuple[GestureEvent, ...], around_s: float) -> list[GestureEvent]:
    return [event for event in events if around_s - 4.0 <= event.start_s < around_s + 8.0]


def judged(live: LiveMotion, around_s: float) -> set[tuple[str, int]]:
    """Players and chunks around a time whose contacts are judged."""
    here = int((around_s + 2.0) // 4.0)
    tracks = live._shown.tracks
    return {(one, index) for one, track in tracks.items() for index in track.judged if abs(index - here) <= 1}


@pytest.mark.parametrize("around_s", [0.0, 100.0, 296.0])
def test_most_is_planned_as_in_the_whole(around_s: float) -> None:
    performance, excerpt = begun(around_s)
    assert is_worth_it(performance)
    whole = Performance(piece()).plans
    same = 0
    for player in piece().players:
        plan, full = excerpt.plan(player), whole[player.id]
        assert len(plan.fingerings) <= (BEFORE_S + AFTER_S) * 2 + 2
        same += all(
            near(getattr(plan, kind), around_s) == near(getattr(full, kind), around_s)
            for kind in ("cues", "gestures", "breaths")
        )
    # At the beginning nothing is cut off that anything there depends on.
    assert same == len(piece().players) if around_s == 0.0 else same >= 2


def test_everyone_moves_before_the_others_are_planned_and_then_as_planned() -> None:
    at_s = 20.0
    performance, excerpt = begun(at_s)
    live = LiveMotion(Performance(new_piece()))
    first, *others = [player.id for player in piece().players]
    live.show_first(performance, (first,))
    live.show_excerpt(performance, excerpt)
    live.request(at_s, 4.0, (first,))
    assert not live.is_moving
    while live.work():
        pass
    assert live.is_moving
    assert not live.is_seen, "it is not planned yet"
    assert not live.judge()
    assert all(live.pose(one, at_s) is not None for one in (first, *others))
    live.request(200.0, 4.0, (first,))
    while live.work():
        pass
    # Outside the excerpt only planned players are shown; the others would be in their final poses.
    assert [live.pose(one, 200.0) is not None for one in (first, *others)] == [True, *(False for _ in others)]
    assert live.is_moving
    assert live.pose_now(others[0], 200.0) is None
    assert not live.broken
    # Brought to the front, a player who is planned moves everywhere.
    performance.prepare()
    live.show_first(performance, (others[0],))
    while live.work():
        pass
    assert live.pose(others[0], 200.0) is not None

    live.show(performance)
    live.request(at_s, 4.0, (first,))
    made = live.made
    while not live.is_seen:
        live.work()
    assert live.made - made < len(others) * 2, "what proves to be the same is kept"
    fresh = LiveMotion(Performance(piece()))
    for player_id in (first, *others):
        for time_s in (at_s, at_s + 3.0, at_s + 5.0):
            shown, anew = live.pose(player_id, time_s), fresh.pose_now(player_id, time_s)
            assert shown is not None
            assert anew is not None
            # Between two frames; a joint is mixed in a chunk in which it moves at all.
            assert np.allclose(shown.rotations, anew.rotations, rtol=0.0, atol=1e-6)
            assert {name: value for name, value in shown.morphs.items() if value} == {
                name: value for name, value in anew.morphs.items() if value
            }
            assert shown.controls == anew.controls
    # Contacts are judged for cached motion as for recomputed motion.
    plain = LiveMotion(Performance(piece()))
    plain.request(at_s, 4.0, (first,))
    while not plain.is_seen:
        plain.work()
    for one in (live, plain):
        one.work()
    assert judged(live, at_s) == judged(plain, at_s) != set()


def test_who_moves_by_a_choreography_waits_for_the_plans() -> None:
    dancing = piece().players[2]
    project = set_parameters(piece(), [dancing.id], choreography="waltz")
    _, excerpt = begun(0.0, project)
    assert dancing.id not in {player.id for player in excerpt.shown_players}
    assert len(excerpt.shown_players) == len(project.players) - 1


def test_a_short_piece_is_planned_at_once() -> None:
    short = project_from_score(
        Score(
            "Short",
            QUARTER,
            TempoMap(QUARTER),
            parts=(Part("1.1.1", "A", 1, 0, 0, None, None, "flute", notes(1, 72, 1, range(1, 200))),),
        ),
        bundled_maps(),
    )
    assert not is_worth_it(Performance(short))


def test_planning_an_excerpt_stops_on_request() -> None:
    performance, excerpt = begun(0.0)
    with pytest.raises(Cancelled):
        excerpt.prepare(lambda: True)
    assert not performance.planned
