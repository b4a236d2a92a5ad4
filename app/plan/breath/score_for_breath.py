"""Input of the breath planning: a part in notated timing, with its rests, its air use and recorded breaths."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from app.arrays import FloatArray
from app.plan.breath.breaths_in_rests import within_note
from app.plan.breath.lungs import air_used_s, lungful_s
from app.plan.breath.rests_for_breath import ALWAYS_S
from app.plan.event_id import EventId
from app.plan.model import BreathEvent
from app.plan.music.breath_controller import BreathEnvelope, BreathGaps, gaps_within, silences
from app.plan.music.notation import at_score_tempo, early_share, heard_rests_s, notated, usual_release
from app.plan.music.piece import EPSILON, LineTimes, Piece, gaps_s
from app.plan.music.rests import Rests, are_certain, rest_ticks
from app.plan.music.written_marks import WrittenMarks
from app.plan.parameters import PlayerParameters
from app.score.model import Note
from instrument_maps.wind import Air


class Breather(NamedTuple):
    """A player with the notes of one part, as input of the planning of breaths; ``index_of`` maps note ids to
    indices."""

    notes: tuple[Note, ...]
    times: LineTimes
    piece: Piece
    parameters: PlayerParameters
    index_of: dict[str, int]
    written: WrittenMarks

    @property
    def marked(self) -> list[int]:
        """Indices of the notes with a breath mark before them."""
        found: list[int] = (1 + np.flatnonzero(self.written.breath[:-1])).tolist()
        return found

    def number_of(self, event: BreathEvent) -> int:
        """Index of the note that a breath precedes or lies within."""
        return self.index_of[EventId.parse(event.id).of]


class BreathScore(NamedTuple):
    """Timing and air of a part that decide its breaths.

    Attributes
    ----------
    written, steady : LineTimes
        Notated timing, and the same without short tempo changes, which decides how much air is needed.
    sounded_s : (N,) float64
        Sounding length of each note at the tempo of the score.
    gaps : BreathGaps or None
        Gaps in the recorded breath, if it shows breaths.
    used, steady_used : (N + 1,) float
        `app.plan.breath.lungs.air_used_s` of both.
    lung_s : float
        `app.plan.breath.lungs.lungful_s`.
    within : tuple of BreathEvent
        Recorded breaths within notes.
    """

    written: LineTimes
    steady: LineTimes
    rests: Rests
    sounded_s: FloatArray
    gaps: BreathGaps | None
    used: FloatArray
    steady_used: FloatArray
    lung_s: float
    within: tuple[BreathEvent, ...]


def read_score(breather: Breather, air: Air | None, envelope: BreathEnvelope | None) -> BreathScore:
    times, piece = breather.times, breather.piece
    gaps = None if envelope is None or not envelope.has_breath_gaps(times) else silences(envelope, times)
    lung_s = lungful_s(breather.parameters, air)
    if gaps is not None:
        assert envelope is not None
        used = air_used_s(times, air, envelope)
        within = tuple(
            within_note(breather.notes[index], piece, *gap_s) for index, *gap_s in gaps_within(envelope, times)
        )
        rests = _rests(times, times, times, piece)
        return BreathScore(times, times, rests, times.duration_s, gaps, used, used, lung_s, within)
    written = notated(times, piece)
    steady = at_score_tempo(written, piece)
    used = air_used_s(written, air)
    steady_used = used if steady is written else air_used_s(steady, air)
    played = steady if written is times else at_score_tempo(times, piece)
    sounded_s = np.maximum(steady.duration_s, played.duration_s)
    return BreathScore(
        written, steady, _rests(steady, played, times, piece), sounded_s, None, used, steady_used, lung_s, ()
    )


def _rests(steady: LineTimes, played: LineTimes, times: LineTimes, piece: Piece) -> Rests:
    """Return the rests of the part; the notated timing decides what counts as a rest and how long it is.

    A rest is at least as long as the silence that is played. A rest that is long enough even for the slowest kind of
    breath counts at any tempo.

    Parameters
    ----------
    steady, played, times : LineTimes
        Times of the notes as notated and as played, both at the tempo of the score, and as they sound at the tempo of
        the performance.
    """
    beats = piece.beat_ticks_at(times.onset_tick)
    written = rest_ticks(steady, beats)
    early = early_share(played)
    certain = are_certain(played, beats, usual_release(early)) & (times.silence_tick > 0)
    written = np.where(certain, np.maximum(written, times.silence_tick), written)
    is_rest = (written > 0) & (times.silence_tick > 0)
    written_s, sounding_s = gaps_s(steady), gaps_s(times)
    lasts_s = np.where(certain, np.maximum(written_s, heard_rests_s(played, early)), written_s)
    lasts_s = np.where(sounding_s >= ALWAYS_S - EPSILON, np.maximum(lasts_s, sounding_s), lasts_s)
    return Rests(*(np.where(is_rest, column, 0) for column in (times.silence_tick, written, lasts_s)))
