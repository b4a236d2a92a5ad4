"""Conversion of journals to takes."""

from __future__ import annotations

from app.capture.journal import Journal, JournalHeader, SyncPoint
from app.capture.journal_to_takes import takes_of
from app.score.take import ControllerMapping
from app.score.tempo import TempoMap

HEADER = JournalHeader("piece.suisou", "1.1.1", "EWI5000", "ewi_5000", 0.1, "2026-11-21T10:00:00+00:00")
S = 10**9


def journal(events: list[tuple[float, str]], syncs: list[tuple[float, float, int]], **more: object) -> Journal:
    values: dict[str, object] = {"gaps": (), "complete": True, **more}
    return Journal(
        header=HEADER,
        times_ns=tuple(round(at * S) for at, _ in events),
        messages=tuple(bytes.fromhex(raw) for _, raw in events),
        syncs=tuple(SyncPoint(round(at * S), position_s, pass_) for at, position_s, pass_ in syncs),
        **values,
    )


def test_the_latency_is_taken_off_and_the_count_in_is_before_the_take() -> None:
    found = journal([(10.9, "903c40"), (12.1, "903e40"), (12.6, "803e00")], [(10.0, -2.0, 0), (14.0, 2.0, 0)])
    (take,) = takes_of(found, TempoMap(480), ControllerMapping(), "Take {number}", start_s=0.0)
    assert take.times_us == (-1_200_000, 0, 500_000)
    assert (take.start_us, take.end_us, take.name) == (0, 2_000_000, "Take 1")


def test_a_take_begins_where_the_recording_was_requested() -> None:
    found = journal([(12.6, "903e40")], [(10.0, -0.5, 0), (14.0, 3.5, 0)])
    (take,) = takes_of(found, TempoMap(480), ControllerMapping(), "Take", start_s=1.25)
    assert (take.start_us, take.end_us) == (1_250_000, 3_500_000)


def test_every_pass_in_which_a_user_played_is_a_take() -> None:
    syncs = [(10.0, 0.0, 0), (12.0, 2.0, 0), (12.0, 0.0, 1), (14.0, 2.0, 1), (14.0, 0.0, 2), (15.0, 1.0, 2)]
    found = journal([(10.6, "903c40"), (11.6, "803c00"), (13.0, "b00240"), (14.6, "903e40")], syncs)
    takes = takes_of(found, TempoMap(480), ControllerMapping(), "{number}")
    assert [(take.name, take.played.pitches.tolist()) for take in takes] == [("1", [60]), ("2", [62])]
    assert takes[1].times_us == (500_000,)


def test_what_sounded_when_the_device_went_away_ends_there() -> None:
    found = journal([(11.1, "923c40")], [(10.0, 0.0, 0), (14.0, 4.0, 0)], gaps=((round(12.1 * S), round(13.1 * S)),))
    (take,) = takes_of(found, TempoMap(480), ControllerMapping(channel=3), "Take")
    assert take.played.ends_s.tolist() == [2.0]
