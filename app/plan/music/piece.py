"""Inputs of a plan: the piece shared by all players, and one player's part with its times as arrays."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cached_property, lru_cache

import msgspec
import numpy as np

from app.arrays import BoolArray, FloatArray, IntArray
from app.chance import chance, partial_digest, share_of
from app.plan.acting import Acting
from app.plan.by_hand.corrections import Correction
from app.plan.music.dynamics_from_velocities import Velocities, read_dynamics
from app.plan.music.velocity_ladders import LEVELS
from app.plan.music.velocity_ladders import MEZZOFORTE as MEZZOFORTE
from app.plan.music.written_dynamics import loudness_of_rows, rows_of_loudness
from app.plan.music.written_marks import WrittenMarks, written_marks
from app.plan.parameters import PlayerParameters
from app.score.marks import Mark, Source
from app.score.metre_map import MetreMap
from app.score.model import Note
from app.score.tempo import TempoMap
from instrument_maps.model import InstrumentMap

EPSILON = 1e-6
"""Tolerance in seconds for the rounding of air summed over an hour of notes."""


def marked_loudness(loudness: FloatArray) -> FloatArray:
    """Round loudness values (N,) to the dynamic nearest to each; mezzoforte stays exact."""
    return np.asarray(LEVELS[np.searchsorted((LEVELS[1:] + LEVELS[:-1]) / 2.0, loudness)])


@dataclass(frozen=True, eq=False)
class ControllerSteps:
    """Values of a controller over time: a step function.

    Attributes
    ----------
    ticks, values : (K,) float64
        At least one step; ticks ascend.
    """

    ticks: FloatArray
    values: FloatArray

    def __eq__(self, other: object) -> bool:
        """Return whether all arrays are equal, for comparing parts."""
        if not isinstance(other, ControllerSteps):
            return NotImplemented
        return np.array_equal(self.ticks, other.ticks) and np.array_equal(self.values, other.values)

    def __hash__(self) -> int:
        return hash((self.ticks.tobytes(), self.values.tobytes()))


@dataclass(frozen=True)
class ControllerInput:
    """Recorded or drawn controller curves of a part; None: no curve.

    Attributes
    ----------
    breath : ControllerSteps or None
        Strength of the breath, 0..1.
    bite : ControllerSteps or None
        Bite force, 0..1.
    bend : ControllerSteps or None
        Pitch bend in whole tones.
    """

    breath: ControllerSteps | None = None
    bite: ControllerSteps | None = None
    bend: ControllerSteps | None = None


class MonophonicPart(msgspec.Struct, frozen=True):
    """One player's part with instrument, parameters and corrections.

    Attributes
    ----------
    notes : tuple of Note
        Notes, one at a time, ordered by onset; neighbours may overlap briefly (legato).
    loudness : tuple of float
        Mean loudness 0..1 of every note from a breath, volume or expression curve; empty: from velocities.
    controller : ControllerInput or None
        Those curves, and the lips' controllers.
    musician : str
        Id of the player whose body plays the part; empty: its own.
    actings : tuple of (str, Acting)
        The player's acting in each style that a span uses.
    name, styles_known : str
        Names of the player and of the available styles, for messages.
    muted, stopped : tuple of (start tick, end tick)
        Spans played with a mute, and the hand-stopped ones among them.
    mute_kinds : tuple of (tick, kind)
        Kind of mute from each tick on, where it is named.
    marks : tuple of Mark
        Marks written over the notes.
    source : {"sound", "score"}
        Origin of the notes.
    levels : tuple of float
        Loudness of the dynamic mark in force at every note; empty: unknown.
    """

    player_id: str
    notes: tuple[Note, ...]
    instrument_map: InstrumentMap
    parameters: PlayerParameters = PlayerParameters()
    corrections: tuple[Correction, ...] = ()
    loudness: tuple[float, ...] = ()
    controller: ControllerInput | None = None
    musician: str = ""
    actings: tuple[tuple[str, Acting], ...] = ()
    name: str = ""
    styles_known: str = ""
    muted: tuple[tuple[int, int], ...] = ()
    stopped: tuple[tuple[int, int], ...] = ()
    marks: tuple[Mark, ...] = ()
    source: Source = "sound"
    levels: tuple[float, ...] = ()
    mute_kinds: tuple[tuple[int, str], ...] = ()


class Piece(msgspec.Struct, frozen=True):
    """Data of a piece shared by all players.

    Attributes
    ----------
    metre_map : MetreMap
        Metre map with felt beats, and bars where they are felt to begin.
    accompaniment : tuple of (start tick, end tick)
        Spans in which parts without a player sound, in order, without overlap.
    """

    clock: TempoMap
    metre_map: MetreMap
    accompaniment: tuple[tuple[int, int], ...] = ()

    def beat_ticks_at(self, ticks: IntArray) -> IntArray:
        """Length (N,) in ticks of the felt beat at each tick."""
        return self.metre_map.felt_ticks_at(ticks)

    def bars(self, first_tick: int, last_tick: int) -> IntArray:
        """Return the ticks (N,) of the bar lines from ``first_tick`` to before ``last_tick``."""
        return self.metre_map.bars(first_tick, last_tick)


@dataclass(frozen=True, eq=False)
class NoteTimes:
    """Times of N notes as arrays (N,), in ticks and in seconds. ``played_end`` is the end of a note, not later than the
    next onset. Equal for players in rhythmic unison.
    """

    onset_tick: IntArray
    played_end_tick: IntArray
    onset_s: FloatArray
    played_end_s: FloatArray

    @property
    def duration_s(self) -> FloatArray:
        """Sounding time (N,) of each note in seconds."""
        return self.played_end_s - self.onset_s

    def __eq__(self, other: object) -> bool:
        """Return whether all arrays are equal, for comparing inputs of cached steps."""
        if self.__class__ is not other.__class__:
            return NotImplemented
        return all(np.array_equal(getattr(self, field.name), getattr(other, field.name)) for field in fields(self))

    __hash__ = None  # type: ignore[assignment]


@dataclass(frozen=True, eq=False)
class LineTimes(NoteTimes):
    """Times and loudness of the notes of a part.

    ``slurs_next``: whether the next note is slurred to it; ``silence_tick``: ticks of silence before each note (very
    many before the first, because of the pre-roll); ``loudness`` 0..1; ``level``: loudness of the dynamic in force,
    minus infinity where unknown.
    """

    slurs_next: BoolArray
    silence_tick: IntArray
    pitch: IntArray
    loudness: FloatArray
    level: FloatArray

    @cached_property
    def rhythm(self) -> NoteTimes:
        """Only the onsets and ends of the part's notes, without pitch and loudness."""
        return NoteTimes(self.onset_tick, self.played_end_tick, self.onset_s, self.played_end_s)

    @cached_property
    def leaps(self) -> BoolArray:
        """Mask (N-1,) of the notes from which the part leaps to the next."""
        return np.asarray(np.abs(np.diff(self.pitch)) >= LEAP_SEMITONES)

    @cached_property
    def contour(self) -> LineTimes:
        """Reduce the part to what its phrases depend on: the direction of each step and whether it is a leap, instead
        of pitches.
        """
        steps = np.sign(np.diff(self.pitch)) * np.where(self.leaps, LEAP_SEMITONES, 1)
        pitch = np.concatenate((np.zeros(min(len(self.pitch), 1), np.int64), np.cumsum(steps)))
        return replace(self, pitch=pitch)


BEFORE_FIRST_TICK = 1 << 40
"""Length in ticks of the silence before a line's first note: longer than any threshold."""
LEAP_SEMITONES = 5
"""Size in semitones of a leap that may divide phrases."""


TOUCHING_GATE = 0.97
"""Share of the time to the next onset from which a note touches the next one; sequencers write 98 to 100 %."""
DETACHED_GATES = (0.80, 0.955)
"""Shares of the written length that notation programs play of notes that are neither slurred nor short: 80 to 95 %,
depending on the program and player.
"""
DETACHED_SHARE = 0.1
"""Share of notes shortened in this way above which notes without a gap are intentionally slurred."""


def slurs_next(onset_tick: IntArray, end_tick: IntArray) -> BoolArray:
    """Mask (N,) of notes slurred to the next: they overlap it, or touch it in a part that detaches other notes.

    If all notes touch (a rendered score, or one gate for everything), touching is no evidence.
    """
    following = np.append(onset_tick[1:], BEFORE_FIRST_TICK)
    between = np.maximum(following - onset_tick, 1)
    gates = (end_tick - onset_tick) / between
    low, high = DETACHED_GATES
    detached = np.count_nonzero((gates >= low) & (gates <= high))
    slurred: BoolArray = end_tick > following
    if detached >= max(DETACHED_SHARE * len(gates), 1):
        slurred |= gates >= TOUCHING_GATE
    return slurred


STACCATO_GATE = 0.6
"""Share of the time to the next note up to which a note is staccato; notation programs play half. See
`STACCATO_QUARTERS`.
"""
STACCATO_QUARTERS = 1.0
"""Quarters to the next note within which `STACCATO_GATE` applies; beyond, there is a rest."""


def staccato(onset_tick: IntArray, end_tick: IntArray, quarter_ticks: int) -> BoolArray:
    """Mask (N,) of notes that are short relative to the time to the next; False for the last note."""
    between = np.append(np.diff(onset_tick), BEFORE_FIRST_TICK)
    short: BoolArray = end_tick - onset_tick <= STACCATO_GATE * between
    return short & (between <= STACCATO_QUARTERS * quarter_ticks)


def line_times(part: MonophonicPart, clock: TempoMap) -> LineTimes:
    """Times of a part's notes; empty arrays without notes."""
    written = written_marks(part.notes, part.marks, part.source, clock.ticks_per_quarter, part.corrections)
    return note_times(part.notes, part.loudness, clock, written, part.levels)


def note_times(
    notes: tuple[Note, ...],
    loudness: tuple[float, ...],
    clock: TempoMap,
    written: WrittenMarks | None = None,
    levels: tuple[float, ...] = (),
) -> LineTimes:
    """Times of notes, with given loudness and levels (see `MonophonicPart`).

    Parameters
    ----------
    written : WrittenMarks, optional
        Slurs and dynamics of the score, which override what the sound suggests.
    """
    count = len(notes)
    onset = np.fromiter((note.onset_tick for note in notes), np.int64, count)
    duration = np.fromiter((note.duration_tick for note in notes), np.int64, count)
    pitch = np.fromiter((note.pitch for note in notes), np.int64, count)
    velocity = np.fromiter((note.velocity for note in notes), np.int64, count)
    end = onset + np.maximum(duration, 1)
    following = np.append(onset[1:], BEFORE_FIRST_TICK)
    played_end = np.maximum(np.minimum(end, following), onset)
    reach = np.maximum.accumulate(end) if count else end
    silence = np.maximum(onset - np.concatenate(([-BEFORE_FIRST_TICK], reach[:-1]))[:count], 0)
    loud = np.asarray(loudness, np.float64) if loudness else read_dynamics(Velocities(velocity))[0]
    level = np.asarray(levels, np.float64) if levels else np.full(count, -np.inf)
    slurred = slurs_next(onset, end)
    if written is not None:
        level = np.where(np.isnan(written.level), level, np.where(written.struck, -np.inf, written.level))
        loud = np.where(np.isnan(written.level), _swelled(loud, written.swell), written.level)
        slurred = written.slurred if written.is_score else (slurred | written.slurred) & ~written.tongued_next
    return LineTimes(
        onset_tick=onset,
        played_end_tick=played_end,
        slurs_next=slurred,
        silence_tick=silence,
        onset_s=clock.seconds(onset.astype(np.float64)),
        played_end_s=clock.seconds(played_end.astype(np.float64)),
        pitch=pitch,
        loudness=np.clip(loud, 0.0, 1.0),
        level=level,
    )


def _swelled(loudness: FloatArray, rows: FloatArray) -> FloatArray:
    """Raise loudness (N,) 0..1 by a number of dynamic levels (N,): 1 raises p to mp."""
    if not rows.any():
        return loudness
    return np.where(rows == 0.0, loudness, loudness_of_rows(rows_of_loudness(loudness) + rows))


def without_sound(notes: tuple[Note, ...]) -> tuple[Note, ...]:
    """Return the notes with pitch and velocity 0, so that only their times matter."""
    return tuple(Note(note.id, note.onset_tick, note.duration_tick, 0, 0) for note in notes)


@lru_cache(maxsize=64)
def _digests(parts: tuple[str | int, ...], places: bytes) -> bytes:
    """Hash ``parts`` together with each place: one digest per int64 in ``places``, joined as bytes; cached, since an
    edit of a pitch moves no note.
    """
    head = partial_digest(parts)
    digests = []
    for place in np.frombuffer(places, np.int64).tolist():
        digest = head.copy()
        digest.update(b"%d" % place)
        digests.append(digest.digest())
    return b"".join(digests)


class Seeds(msgspec.Struct, frozen=True):
    """Seeds of one player's random choices.

    Attributes
    ----------
    names : tuple of str or int
        Seeds, and the player's id.
    varied : tuple of (start_tick, end_tick, seed)
        Spans with another random variation; of several overlapping ones the last counts.
    """

    names: tuple[str | int, ...] = ()
    varied: tuple[tuple[int, int, int], ...] = ()

    def chance(self, *purpose: str | int) -> float:
        """Return a random number in [0, 1) for a purpose that has no position in the score."""
        return chance(*self.names, *purpose)

    def chance_at(self, purpose: str, tick: int) -> float:
        """Return a random number in [0, 1) for a purpose at a tick of the score."""
        for start_tick, end_tick, seed in reversed(self.varied):
            if start_tick <= tick < end_tick:
                return chance(*self.names, "varied", seed, purpose, tick)
        digest = partial_digest((*self.names, purpose)).copy()
        digest.update(b"%d" % tick)
        return share_of(digest.digest())

    def chances_at(
        self, purpose: str, ticks: IntArray, places: IntArray | None = None, ends: IntArray | None = None
    ) -> FloatArray:
        """Random numbers (N,) for many places at once, equal to those of `chance_at`.

        Parameters
        ----------
        places : (N,) int64, optional
            Places used for drawing instead of ``ticks``, except to select variations.
        ends : (N,) int64, optional
            End of the effect of each value: a variation also applies if this is within its span.
        """
        drawn = np.asarray(ticks if places is None else places, np.int64)
        shares: FloatArray = np.frombuffer(_digests((*self.names, purpose), drawn.tobytes()), ">u8") / 2.0**64
        if not self.varied:
            return shares
        last = ticks + 1 if ends is None else ends
        # From the last span backwards, so that one random number is drawn for each place, however many spans contain
        # it.
        undecided = np.arange(len(ticks))
        for start_tick, end_tick, seed in reversed(self.varied):
            within = (ticks[undecided] >= start_tick) & (last[undecided] <= end_tick)
            for place in undecided[within].tolist():
                shares[place] = chance(*self.names, "varied", seed, purpose, int(ticks[place]))
            undecided = undecided[~within]
            if not len(undecided):
                break
        return shares


def gaps_s(times: LineTimes) -> FloatArray:
    """Silence (N,) in seconds before each note; 0 before the first."""
    return np.concatenate(([0.0], np.maximum(times.onset_s[1:] - times.played_end_s[:-1], 0.0)))
