"""Tongue strokes: the notes that are attacked, and the kind of stroke.

At moderate speed the tip of the tongue makes every stroke (*ta*). Faster, the back of the tongue makes every other one
(*ka*): double tonguing, *ta-ka-ta-ka*; in triplets the last of three, *ta-ta-ka*. Players change over at sixteenths
between 132 and 144 quarters per minute; reed players use the tip for longer, since the reed is in the way.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Final

import numpy as np

from app.arrays import BoolArray, IntArray
from app.errors import Message
from app.plan.model import Articulation, FingeringEvent, Stroke, TongueEvent
from app.plan.music.dynamics import ACCENT, louder_by
from app.plan.music.piece import DETACHED_GATES, EPSILON, TOUCHING_GATE, LineTimes, Piece, Seeds, staccato
from app.plan.music.rests import rest_ticks
from app.plan.music.written_marks import WrittenMarks, unwritten
from app.score.marks import MARK
from app.score.metre_map import Metre
from app.score.model import Note
from instrument_maps.model import InstrumentMap

TONGUE_S: Final = 0.0345
"""Seconds of the tongue's contact before an attack, independent of tempo (Hofmann 2012)."""
SMEAR_M: Final = 0.04
"""Distance in metres of a slide's move under a slur above which the note is tongued softly, since it would smear."""

SINGLE_BPM: Final = (132.0, 144.0)
"""Range of tempi, in quarters per minute, above which sixteenths are not single-tongued; the limit depends on the
player.
"""
REED_FASTER: Final = 1.08
"""Factor by which single strokes on a reed may be faster than on brass."""
REEDS: Final = frozenset({"single_reed", "double_reed"})
LEAST_FAST_STEPS: Final = 2
"""Number of consecutive fast steps from which double tonguing is used; two strokes (one step) are single at
any speed.
"""
EVEN: Final = 0.12
"""Relative difference of steps within an even run."""

STRENGTHS: Final[dict[Articulation, float]] = {
    "tongued": 1.0, "staccato": 1.0, "accent": 1.25, "marcato": 1.4, "tenuto": 0.6
}  # fmt: skip
"""Size of a stroke of the tongue's tip, by articulation."""
BACK: Final = 0.5
"""Size of a stroke of the tongue's back, which hardly moves jaw and lips."""
SMEAR: Final = 0.6
"""Size of the soft stroke that hides a slide's move."""
BEFORE_REST_S: Final = 0.5
"""Sounding seconds from which a note before a rest is not staccato, since its written length is as short."""
OF_MARK: Final[dict[str, Articulation]] = {
    "staccatissimo": "staccato", "staccato": "staccato", "tenuto": "tenuto", "accent": "accent", "marcato": "marcato"
}  # fmt: skip
"""Articulation of a note with a mark."""
WRITTEN: Final = "written:"
"""Prefix of the reason for a stroke that follows a written mark."""
BACK_IN: Final = {"double_tongue": 2, "triple_tongue": 3}
"""Number of strokes in a group, the last of which is by the tongue's back."""
MARCATO_GATE: Final = 0.8
"""Share of the time to the next note below which an accented note is marcato."""


def plan_tongues(
    notes: tuple[Note, ...],
    times: LineTimes,
    instrument: InstrumentMap,
    fingerings: tuple[FingeringEvent, ...],
    piece: Piece,
    seeds: Seeds,
    written: WrittenMarks | None = None,
) -> tuple[TongueEvent, ...]:
    """Plan the tongue stroke of every attacked note. Marks in the score override what the sound suggests.

    All notes are attacked except those slurred to (`app.plan.music.piece.slurs_next`) at another pitch without a long
    slide move.
    """
    if not notes:
        return ()
    slurred, smeared = _slurred(times, instrument, fingerings)
    attacked = np.flatnonzero(~slurred)
    written = written or unwritten(len(notes))
    kinds = _with_marks(
        written, ["tongued"] * len(notes) if written.is_score else _articulations(notes, times, slurred, piece)
    )
    limit_s = single_limit_s(instrument, seeds)
    strokes, why = _strokes(times, attacked, piece, limit_s)
    _write_strokes(written.tonguing, attacked, strokes, why)
    smears = smeared.tolist()
    onset_s = times.onset_s[attacked].tolist()
    by_hand = written.stroke_by_hand.tolist()
    events = []
    for at, start_s, stroke, (group, rate) in zip(attacked.tolist(), onset_s, strokes, why, strict=True):
        kind: Articulation = kinds[at]
        if kind == "tongued" and not group and not smears[at]:
            events.append(TongueEvent(notes[at].id, start_s - TONGUE_S, start_s))
            continue
        strength = STRENGTHS[kind]
        if stroke == "ka":
            strength *= BACK
        elif smears[at]:
            stroke, strength = "da", SMEAR
        elif kind == "tenuto" or written.divided[at]:
            stroke = "da"
        mark = WRITTEN + written.stroke[at] if written.stroke[at] else kind
        reason = _reason("slide" if smears[at] else group or mark, rate, round(1.0 / limit_s, 1), by_hand[at])
        events.append(TongueEvent(notes[at].id, start_s - TONGUE_S, start_s, stroke, kind, round(strength, 3), reason))
    return tuple(events)


def _with_marks(written: WrittenMarks, kinds: list[Articulation]) -> list[Articulation]:
    """Return the articulation of each note with its mark applied, if it has one; a sforzando is an accent."""
    marked = list(kinds)
    if any(written.stroke):
        marked = [OF_MARK.get(mark, kind) for mark, kind in zip(written.stroke, kinds, strict=True)]
    for index in np.flatnonzero(written.struck).tolist():
        marked[index] = "accent" if marked[index] == "tongued" else marked[index]
    return marked


def _write_strokes(
    tonguing: Sequence[str], attacked: IntArray, strokes: list[Stroke], why: list[tuple[str, float]]
) -> None:
    """Change ``strokes`` and their reasons ``why`` in place where the score prescribes double, triple or flutter
    tonguing.
    """
    since, before = 0, ""
    for place, at in enumerate(attacked.tolist()):
        mark = tonguing[at]
        since = since + 1 if mark == before else 0
        before = mark
        if mark:
            turn = BACK_IN.get(mark, 0)
            strokes[place] = "ka" if turn and since % turn == turn - 1 else "ta"
            why[place] = (WRITTEN + mark, 0.0)


def single_limit_s(instrument: InstrumentMap, seeds: Seeds) -> float:
    """Shortest time in seconds between strokes that a player makes with the tip of the tongue alone; faster strokes are
    double-tongued.
    """
    slow, fast = SINGLE_BPM
    bpm = slow + (fast - slow) * seeds.chance("tongue")
    if instrument.embouchure.kind in REEDS:
        bpm *= REED_FASTER
    return 60.0 / bpm / 4.0


@lru_cache(maxsize=1024)
def _reason(kind: str, rate: float, limit: float, by_hand: bool) -> Message:
    """Return the message that explains a tongue stroke, cached so that equal ones are one object."""
    if kind in ("double", "triple"):
        return Message(f"tongue.{kind}", {"rate": rate, "limit": limit})
    if kind.startswith(WRITTEN) and by_hand:
        return Message("tongue.by_hand", {"mark": f"{MARK}.{kind.removeprefix(WRITTEN)}"})
    if kind.startswith(WRITTEN):
        return Message(f"tongue.written_{kind.removeprefix(WRITTEN)}")
    return Message("tongue.attack" if kind == "tongued" else f"tongue.{kind}")


def _slurred(
    times: LineTimes, instrument: InstrumentMap, fingerings: tuple[FingeringEvent, ...]
) -> tuple[BoolArray, BoolArray]:
    """Masks (N,) of notes without a stroke, and of slurred notes that get one because the slide moves far."""
    slides = [(control.name, control.travel_m) for control in instrument.controls
              if control.role == "pitch" and control.kind == "slide"]  # fmt: skip
    slurred = np.zeros(len(times.pitch), dtype=bool)
    slurred[1:] = times.slurs_next[:-1] & (np.diff(times.pitch) != 0)
    smears = np.zeros(len(times.pitch), dtype=bool)
    for index in np.flatnonzero(slurred).tolist() if slides else ():
        if fingerings[index].glide_from_s is not None:
            continue
        before, here = fingerings[index - 1].controls, fingerings[index].controls
        smears[index] = any(
            abs(here.get(name, 0.0) - before.get(name, 0.0)) * travel_m > SMEAR_M for name, travel_m in slides
        )
    return slurred & ~smears, smears


def _articulations(notes: tuple[Note, ...], times: LineTimes, slurred: BoolArray, piece: Piece) -> list[Articulation]:
    """Return the articulation (such as staccato) of each note, by its sounding length and its loudness among its
    neighbours."""
    onset = times.onset_tick
    end = onset + np.array([note.duration_tick for note in notes], np.int64)
    quarter = piece.clock.ticks_per_quarter
    between = np.append(np.diff(onset), 1 << 40)
    gates = (end - onset) / np.maximum(between, 1)
    joined = between <= 2 * quarter
    short = staccato(onset, end, quarter)
    # An eighth note before an eighth rest sounds for half its value, as a staccato quarter does.
    doubtful = short & (times.duration_s >= BEFORE_REST_S - EPSILON)
    if doubtful.any():
        short &= ~(doubtful & np.append(rest_ticks(times, piece.beat_ticks_at(onset))[1:] > 0, False))
    accented = louder_by(times) >= ACCENT
    follows = np.append(~slurred[1:], False)
    # Held until the next stroke, in a line of detached notes.
    held = joined & follows & (gates >= TOUCHING_GATE)
    if held.any():
        low, high = DETACHED_GATES
        held &= low <= float(np.median(gates[joined])) <= high
    marcato = accented & joined & (gates <= MARCATO_GATE)
    kinds: list[Articulation] = ["tongued"] * len(notes)
    rules: tuple[tuple[Articulation, BoolArray], ...] = (
        ("tenuto", held), ("staccato", short), ("accent", accented), ("marcato", marcato)
    )  # fmt: skip
    for kind, where in rules:
        for index in np.flatnonzero(where).tolist():
            kinds[index] = kind
    return kinds


def _strokes(
    times: LineTimes, attacked: IntArray, piece: Piece, limit_s: float
) -> tuple[list[Stroke], list[tuple[str, float]]]:
    """Choose the stroke of each attacked note; also return for each the tonguing pattern it belongs to (empty: none)
    and the strokes per second.
    """
    strokes: list[Stroke] = ["ta"] * len(attacked)
    why = [("", 0.0)] * len(attacked)
    onset_s, ticks = times.onset_s[attacked], times.onset_tick[attacked]
    fast = np.concatenate(([False], np.diff(onset_s) < limit_s, [False]))
    edges = np.flatnonzero(fast[1:] != fast[:-1]).tolist()
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        if last - first < LEAST_FAST_STEPS:
            continue
        steps = np.diff(ticks[first : last + 1])
        step = float(np.median(steps))
        even = bool((np.abs(steps - step) <= EVEN * step).all())
        metre = piece.metre_map.metre_at(int(ticks[first]))
        triple = even and _in_threes(metre, step, piece.clock.ticks_per_quarter)
        rate = round(float((last - first) / (onset_s[last] - onset_s[first])), 1)
        places = np.arange(first, last + 1) - last
        if even:
            bars = piece.bars(int(ticks[first]), int(ticks[last]) + 1)
            starts = bars[np.maximum(np.searchsorted(bars, ticks[first : last + 1], side="right") - 1, 0)]
            places = np.round((ticks[first : last + 1] - starts) / step).astype(np.int64)
        back = places % 3 == 2 if triple else places % 2 == 1
        # The first stroke uses the tip of the tongue in any case.
        back[0] = False
        for place, is_back in enumerate(back.tolist()):
            strokes[first + place] = "ka" if is_back else "ta"
            why[first + place] = ("triple" if triple else "double", rate)
    return strokes, why


def _in_threes(metre: Metre, step: float, quarter: int) -> bool:
    """Return whether notes at a distance of ``step`` ticks are in groups of three: three or six in a beat, or the three
    of a dotted beat.
    """
    unit = 4.0 * quarter / metre.denominator
    if metre.numerator % 3 == 0 and metre.denominator >= 8:
        return abs(unit - step) <= EVEN * step
    return any(abs(unit - count * step) <= EVEN * unit for count in (3, 6))
