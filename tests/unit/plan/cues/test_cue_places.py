"""Small pieces with the cues that musicians expect. Half of the rows (``HELD_OUT``) were written together with the
others and not used for developing the rules.

Half of the rows (``HELD_OUT``) were written with the others and not looked at while the rules were made.
"""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from app.plan.generate import MonophonicPart
from app.score.metre_map import Metre
from app.score.model import Note, sounding_spans
from app.score.tempo import TempoChange, TempoMap
from instrument_maps.load import bundled_maps
from tests.support.plan import make_plans, piece_of, time_frame

Q = 480
MAPS = bundled_maps()
Notes = list[tuple[float, float, int]]
"""Onset and length in quarters from the beginning, and pitch."""


def run(start: float, beats: int, pitch: int, step: float = 1.0) -> Notes:
    """Consecutive notes of one length, alternating by a tone."""
    count = round(beats / step)
    return [(start + step * index, step, pitch + (0, 2, 4, 2)[index % 4]) for index in range(count)]


@dataclass(frozen=True)
class Row:
    """A piece: players in score order as (name, map, notes), and tempi as (quarter, beats per minute)."""

    name: str
    players: tuple[tuple[str, str, Notes], ...]
    expected: tuple[tuple[float, str, float], ...]
    """Expected cues: quarter of the entry, giver, and seconds from the cue's peak to the entry."""
    tempi: tuple[tuple[float, float], ...] = ((0, 120),)
    unplayed: Notes = ()
    metre: tuple[int, int] = (4, 4)
    pickup: float = 0.0


TRUMPET, HORN, FLUTE, OBOE, CLARINET = "trumpet_Bb", "horn_double_F_Bb", "flute", "oboe", "clarinet_Bb"
TROMBONE, TUBA = "trombone_tenor_F_attachment", "tuba_CC"

TUNED = (
    Row(
        "the horn comes in alone after eight bars",
        (("tpt", TRUMPET, run(0, 64, 72)), ("hn", HORN, run(0, 8, 60) + run(40, 24, 60))),
        ((0, "tpt", 0.5), (40, "hn", 0.5)),
    ),
    Row(
        "a rest of two bars at this tempo needs no cue",
        (("tpt", TRUMPET, run(0, 32, 72)), ("hn", HORN, run(0, 8, 60) + run(16, 16, 60))),
        ((0, "tpt", 0.5),),
    ),
    Row(
        "the trombones come in together: their first gives it",
        (
            ("tpt", TRUMPET, run(0, 64, 72)),
            ("tbn 1", TROMBONE, run(32, 32, 55)),
            ("tbn 2", TROMBONE, run(32, 32, 57)),
            ("tbn 3", TROMBONE, run(33, 31, 48)),
        ),
        ((0, "tpt", 0.5), (32, "tbn 1", 0.5)),
    ),
    Row(
        "a canon of three voices, two bars apart",
        (("a", FLUTE, run(0, 40, 76)), ("b", OBOE, run(8, 32, 74)), ("c", CLARINET, run(16, 24, 64))),
        ((0, "a", 0.5), (8, "b", 0.5), (16, "c", 0.5)),
    ),
    Row(
        "a general pause of a bar",
        (("tpt", TRUMPET, run(0, 16, 72) + run(20, 16, 72)), ("hn", HORN, run(0, 16, 60) + run(20, 16, 60))),
        ((0, "tpt", 0.5), (20, "tpt", 0.5)),
    ),
    Row(
        "a beat's rest of all is no general pause",
        (("tpt", TRUMPET, run(0, 15, 72) + run(16, 16, 72)), ("hn", HORN, run(0, 15, 60) + run(16, 16, 60))),
        ((0, "tpt", 0.5),),
    ),
    Row(
        "a fermata in the tempo map: three times as long, then on",
        (("tpt", TRUMPET, run(0, 32, 72)), ("hn", HORN, run(0, 32, 60))),
        ((0, "tpt", 0.5), (16, "tpt", 0.5)),
        tempi=((0, 120), (15, 40), (16, 120)),
    ),
    Row(
        "a fermata of a whole bar is one cue, after it and in the tempo that follows",
        (
            ("tpt", TRUMPET, [*run(0, 12, 72), (12, 3.9, 72), *run(16, 16, 72)]),
            ("hn", HORN, [*run(0, 12, 60), (12, 3.9, 60), *run(16, 16, 60)]),
        ),
        ((0, "tpt", 0.5), (16, "tpt", 0.5)),
        tempi=((0, 120), (12, 40), (16, 120)),
    ),
    Row(
        "a fermata before a new tempo: one cue, in the new one",
        (
            ("tpt", TRUMPET, [*run(0, 12, 72), (12, 3.9, 72), *run(16, 16, 72)]),
            ("hn", HORN, [*run(0, 12, 60), (12, 3.9, 60), *run(16, 16, 60)]),
        ),
        ((0, "tpt", 0.75), (16, "tpt", 0.5)),
        tempi=((0, 80), (12, 30), (16, 120)),
    ),
    Row(
        "a slower tempo that begins with a long chord and stays",
        (("tpt", TRUMPET, [*run(0, 12, 72), (12, 4, 72), *run(16, 16, 72)]), ("hn", HORN, run(0, 32, 60))),
        ((0, "tpt", 0.5), (12, "tpt", 1.0)),
        tempi=((0, 120), (12, 60)),
    ),
    Row(
        "a fermata over a silence",
        (("tpt", TRUMPET, run(0, 15, 72) + run(16, 16, 72)), ("hn", HORN, run(0, 15, 60) + run(16, 16, 60))),
        ((0, "tpt", 0.5), (16, "tpt", 0.5)),
        tempi=((0, 120), (15, 30), (16, 120)),
    ),
    Row(
        "two beats of silence of all are counted",
        (("tpt", TRUMPET, run(0, 14, 72) + run(16, 16, 72)), ("hn", HORN, run(0, 14, 60) + run(16, 16, 60))),
        ((0, "tpt", 0.5), (16, "tpt", 0.5)),
    ),
    Row(
        "a beat of silence of all in a slow tempo is long enough to lose it",
        (("tpt", TRUMPET, run(0, 15, 72) + run(16, 16, 72)), ("hn", HORN, run(0, 15, 60) + run(16, 16, 60))),
        ((0, "tpt", 1.5), (16, "tpt", 1.5)),
        tempi=((0, 40),),
    ),
    Row(
        "the Allegro after the Adagio is given in its own tempo",
        (("fl", FLUTE, run(0, 48, 76)), ("cl", CLARINET, run(0, 48, 64))),
        ((0, "fl", 1.2), (24, "fl", 60 / 140)),
        tempi=((0, 50), (24, 140)),
    ),
    Row(
        "a ritardando is followed, not given",
        (("fl", FLUTE, run(0, 16, 76)), ("cl", CLARINET, run(0, 16, 64))),
        ((0, "fl", 0.5),),
        tempi=((0, 120), (10, 110), (11, 100), (12, 92), (13, 84), (14, 76), (15, 60)),
    ),
    Row(
        "who has the pickup does not lead, and the beat before it is shown",
        (
            ("tpt 1", TRUMPET, run(1, 24, 74)),
            ("tpt 2", TRUMPET, [(0.5, 0.5, 70), *run(1, 24, 70)]),
            ("tbn", TROMBONE, run(1, 24, 50)),
        ),
        ((0.5, "tpt 1", 0.75),),
        pickup=1.0,
    ),
    Row(
        "an organ that is not on stage has begun: the trumpet just comes in",
        (("tpt", TRUMPET, run(16, 16, 72) + run(48, 16, 72)),),
        (),
        unplayed=run(0, 64, 60),
    ),
    Row(
        "they begin together with unplayed parts",
        (("tpt", TRUMPET, run(0, 16, 72)),),
        ((0, "tpt", 0.5),),
        unplayed=run(0, 16, 60),
    ),
)

HELD_OUT = (
    Row(
        "six eighths at a dotted quarter of 80: the felt beat is shown",
        (("fl", FLUTE, run(0, 24, 76, 1.5)), ("ob", OBOE, run(0, 24, 71, 1.5))),
        ((0, "fl", 0.75),),
        tempi=((0, 120),),
        metre=(6, 8),
    ),
    Row(
        "the melody is in the trombones: their first leads, not the trumpet",
        (
            ("tpt", TRUMPET, run(0, 16, 60)),
            ("tbn 1", TROMBONE, run(0, 16, 64)),
            ("tbn 2", TROMBONE, run(0, 16, 66)),
        ),
        ((0, "tbn 1", 0.5),),
    ),
    Row(
        "the second clarinet comes in after ten bars while the first plays",
        (("cl 1", CLARINET, run(0, 64, 74)), ("cl 2", CLARINET, run(0, 8, 65) + run(48, 16, 65))),
        ((0, "cl 1", 0.5), (48, "cl 2", 0.5)),
    ),
    Row(
        "a long rest of everybody",
        (("tpt", TRUMPET, run(0, 16, 72) + run(32, 8, 72)), ("tba", TUBA, run(0, 16, 40) + run(32, 8, 40))),
        ((0, "tpt", 0.5), (32, "tpt", 0.5)),
    ),
    Row(
        "all hold a last chord of four beats, and go on after a breath",
        (
            ("tpt", TRUMPET, [*run(0, 12, 72), (12, 4, 76), *run(17, 12, 72)]),
            ("hn", HORN, [*run(0, 12, 60), (12, 4, 64), *run(17, 12, 60)]),
        ),
        ((0, "tpt", 60 / 72), (17, "tpt", 60 / 72)),
        tempi=((0, 72),),
    ),
    Row(
        "all hold a chord of two bars, no one counts it, and they go on without a breath",
        (
            ("tpt", TRUMPET, [*run(0, 8, 72), (8, 8, 76), *run(16, 12, 72)]),
            ("hn", HORN, [*run(0, 8, 60), (9, 7, 64), *run(16, 12, 60)]),
            ("tba", TUBA, [*run(0, 7, 40), *run(16, 12, 40)]),
        ),
        ((0, "tpt", 60 / 66), (16, "tpt", 60 / 66)),
        tempi=((0, 66),),
    ),
    Row(
        "one of them moves in the long chord, and so counts for all",
        (
            ("tpt", TRUMPET, [*run(0, 8, 72), (8, 8, 76), *run(16, 12, 72)]),
            ("hn", HORN, run(0, 28, 60)),
        ),
        ((0, "tpt", 60 / 66),),
        tempi=((0, 66),),
    ),
    Row(
        "a fermata in a tempo that was played and is never steady",
        (("tpt", TRUMPET, run(0, 32, 72)), ("hn", HORN, run(0, 32, 60))),
        ((0, "tpt", 60 / 104), (16, "tpt", 60 / 112)),
        tempi=(
            *((at, 120 if at % 2 else 104) for at in range(14)),
            (14, 90),
            (15, 44),
            (16, 112),
            *((at, 106 if at % 2 else 120) for at in range(17, 32)),
        ),
    ),
    Row(
        "beats that come and go in a tempo that was played are no fermata",
        (("tpt", TRUMPET, run(0, 32, 72)), ("hn", HORN, run(0, 32, 60))),
        ((0, "tpt", 0.5),),
        tempi=tuple((at, (120, 104, 88, 112)[at % 4]) for at in range(32)),
    ),
    Row(
        "the old tempo after a ritardando",
        (("fl", FLUTE, run(0, 32, 76)), ("cl", CLARINET, run(0, 32, 64))),
        ((0, "fl", 0.5), (16, "fl", 0.5)),
        tempi=((0, 120), (11, 108), (12, 98), (13, 88), (14, 78), (15, 68), (16, 120)),
    ),
    Row(
        "a lingering last beat of a bar is no fermata",
        (("fl", FLUTE, run(0, 32, 76)), ("cl", CLARINET, run(0, 32, 64))),
        ((0, "fl", 0.5),),
        tempi=((0, 120), (15, 92), (16, 120)),
    ),
    Row(
        "a new tempo after a long rest is one cue, in the new tempo",
        (("fl", FLUTE, run(0, 16, 76) + run(32, 16, 76)), ("cl", CLARINET, run(0, 16, 64) + run(32, 16, 64))),
        ((0, "fl", 1.0), (32, "fl", 0.5)),
        tempi=((0, 60), (32, 120)),
    ),
    Row(
        "half a beat of upbeat by one voice alone",
        (("ob", OBOE, [(3.5, 0.5, 74), *run(4, 16, 76)]), ("bsn", "bassoon", run(4, 16, 50))),
        ((3.5, "ob", 0.75),),
        pickup=4.0,
    ),
    Row(
        "horns come in after a long rest while only a piano plays that is not on stage",
        (("hn 1", HORN, run(0, 8, 65) + run(40, 8, 65)), ("hn 2", HORN, run(0, 8, 60) + run(40, 8, 60))),
        ((0, "hn 1", 0.5),),
        unplayed=run(0, 64, 48),
    ),
    Row(
        "the piano stops as well: they need a cue",
        (("hn 1", HORN, run(0, 8, 65) + run(40, 8, 65)), ("hn 2", HORN, run(0, 8, 60) + run(40, 8, 60))),
        ((0, "hn 1", 0.5), (40, "hn 1", 0.5)),
        unplayed=run(0, 32, 48),
    ),
    Row(
        "a fugue in a quick two: voices four bars apart",
        (
            ("a", TRUMPET, run(0, 48, 74, 0.5)),
            ("b", TRUMPET, run(8, 40, 69, 0.5)),
            ("c", TROMBONE, run(16, 32, 57, 0.5)),
            ("d", TUBA, run(24, 24, 40, 0.5)),
        ),
        ((0, "a", 0.6), (8, "b", 0.6), (16, "c", 0.6), (24, "d", 0.6)),
        tempi=((0, 100),),
        metre=(2, 4),
    ),
)


def cues_of(row: Row) -> list[tuple[float, str, float]]:
    clock = TempoMap(Q, tuple(TempoChange(round(at * Q), 60e6 / bpm) for at, bpm in row.tempi))
    numerator, denominator = row.metre
    first = round(row.pickup * Q)
    metres = (Metre(0, numerator, denominator), *((Metre(first, numerator, denominator),) if first else ()))
    felt = 3 * Q // 2 if denominator == 8 else Q
    lines = []
    for track, (name, map_id, notes) in enumerate(row.players, 1):
        made = (
            Note(f"{track}:{number}", round(onset * Q), round(length * Q), pitch, 80)
            for number, (onset, length, pitch) in enumerate(notes, 1)
        )
        lines.append(MonophonicPart(name, tuple(made), MAPS[map_id]))
    spans = sounding_spans(((round(at * Q), round((at + length) * Q)) for at, length, _ in row.unplayed), Q)
    piece = piece_of(clock, metres, felt, bool(first), spans)
    plans = make_plans(piece, tuple(lines), time_frame(tuple(lines), clock))
    cues = sorted((cue for plan in plans.values() for cue in plan.cues), key=lambda cue: cue.end_tick)
    return [(cue.end_tick / Q, cue.player_id, cue.end_s - cue.peak_s) for cue in cues]


@pytest.mark.parametrize("row", TUNED + HELD_OUT, ids=lambda row: row.name)
def test_cues_are_where_musicians_expect_them(row: Row) -> None:
    found = cues_of(row)
    assert [(at, who) for at, who, _ in found] == [(at, who) for at, who, _ in row.expected]
    assert [lead_s for _, _, lead_s in found] == pytest.approx([lead_s for _, _, lead_s in row.expected])
