"""Small ideal instruments, notes, clocks and whole plans for tests of planning, without files. The instruments follow
from acoustics alone (harmonics of tubes), independent of the bundled maps.

The instruments are made from acoustics alone (harmonics of tubes), so that they are independent of the bundled maps.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from app.plan.generate import EnsemblePlanning, frame_around
from app.plan.model import PlayerPlan, TimeFrame
from app.plan.music.piece import MonophonicPart, Piece
from app.score.metre_map import Metre, MetreMap
from instrument_maps.hold import Carriage, Hold, LoweredPlace
from instrument_maps.model import Control, ControlMotion, Fingering, InstrumentMap, InstrumentName, Range
from instrument_maps.wind import Embouchure, Mouthpiece


@dataclass(frozen=True)
class PlainNote:
    id: str
    onset_tick: int
    duration_tick: int
    pitch: int
    velocity: int = 80


@dataclass(frozen=True)
class PlainClock:
    """Clock with tempo changes as (tick, beats per minute), linear between and before them."""

    changes: tuple[tuple[int, float], ...] = ((0, 120.0),)
    ticks_per_quarter: int = 480

    def _knots(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        ticks = np.array([tick for tick, _ in self.changes], dtype=np.float64)
        per_tick = np.array([60.0 / (bpm * self.ticks_per_quarter) for _, bpm in self.changes])
        seconds = np.concatenate(([0.0], np.cumsum(np.diff(ticks) * per_tick[:-1])))
        return ticks, seconds + ticks[0] * per_tick[0], per_tick

    def seconds(self, ticks: Any) -> Any:
        knots, at, per_tick = self._knots()
        place = np.maximum(np.searchsorted(knots, ticks, side="right") - 1, 0)
        result = at[place] + (np.asarray(ticks, dtype=np.float64) - knots[place]) * per_tick[place]
        return result if np.ndim(ticks) else float(result)

    def ticks(self, seconds: Any) -> Any:
        knots, at, per_tick = self._knots()
        place = np.maximum(np.searchsorted(at, seconds, side="right") - 1, 0)
        result = knots[place] + (np.asarray(seconds, dtype=np.float64) - at[place]) / per_tick[place]
        return result if np.ndim(seconds) else float(result)


def piece_of(
    clock: Any,
    metres: tuple[Metre, ...] = (Metre(0, 4, 4),),
    felt_ticks: int | None = None,
    has_pickup: bool = False,
    accompaniment: tuple[tuple[int, int], ...] = (),
) -> Piece:
    """Piece with given metres and one felt beat throughout, by default the quarter."""
    felt = () if felt_ticks is None else ((0, felt_ticks),)
    return Piece(clock, MetreMap(clock.ticks_per_quarter, metres, has_pickup, felt), accompaniment)


def line_of(*notes: tuple[int, int, int] | tuple[int, int, int, int], track: int = 1) -> tuple[PlainNote, ...]:
    """Line of notes (onset, duration, pitch[, velocity]) in ticks."""
    return tuple(PlainNote(f"{track}:{index + 1}", *note) for index, note in enumerate(notes))


def even(pitches: list[int], step_tick: int = 240, start_tick: int = 0, track: int = 1) -> tuple[PlainNote, ...]:
    """Line of equally long notes without gaps."""
    return line_of(
        *((start_tick + index * step_tick, step_tick, pitch) for index, pitch in enumerate(pitches)), track=track
    )


_CARRIAGE = Carriage((0.0, 10.0, 20.0), (-5.0, 0.0, 5.0), (-5.0, 0.0, 5.0))
_LOWERED = LoweredPlace((0.0, -0.3, 0.1), 40.0, 0.0, 0.0)
FRAME: dict[str, Any] = {
    "schema_version": 1,
    "model": "none.glb",
    "embouchure": Embouchure("cup", 0.66),
    "mouthpiece": Mouthpiece((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 1.0, 0.0), 0.009, 0.013),
    "contacts": (),
    "hands": (),
    "proxy": (),
    "hold": Hold("left", _CARRIAGE, _CARRIAGE, _LOWERED, _LOWERED),
}
_HARMONIC_CENTS = {2: (12, 0.0), 3: (19, 2.0), 4: (24, 0.0), 5: (28, -14.0), 6: (31, 2.0), 8: (36, 0.0)}


def valves() -> InstrumentMap:
    """Instrument with three valves on a tube whose second harmonic is concert B flat 3 (58), notated a tone higher."""
    combos = {"0": 0, "2": 1, "1": 2, "12": 3, "23": 4, "13": 5, "123": 6, "3": 3}
    sharp = {"12": 11.0, "23": 16.0, "13": 30.0, "123": 54.0}
    found: dict[int, list[tuple[int, str, float]]] = {}
    for label, semitones in combos.items():
        for above, cents in _HARMONIC_CENTS.values():
            found.setdefault(46 + above - semitones + 2, []).append((semitones, label, cents + sharp.get(label, 0.0)))
    fingerings = []
    for written, ways in sorted(found.items()):
        ways.sort(key=lambda way: (way[1] == "3", way[0]))
        for rank, (_, label, cents) in enumerate(ways, 1):
            controls = {f"valve_{digit}": 1.0 for digit in label if digit != "0"}
            correction = {"ring": 0.5} if label in ("13", "123") else {}
            fingerings.append(Fingering(written, rank, label, controls, cents, correction))
    motion = ControlMotion(axis=(0.0, -1.0, 0.0), travel_m=0.016)
    fingers = ("index", "middle", "ring")
    controls_ = tuple(
        Control(f"valve_{n + 1}", "press", "pitch", f"right.{fingers[n]}", f"valve_{n + 1}", motion, str(n + 1))
        for n in range(3)
    )
    ring = Control(
        "ring", "slide", "intonation", "left.ring", "ring", ControlMotion(axis=(0.0, 0.0, 1.0), travel_m=0.03),
        used_with=("13", "123"), held_min_s=0.4,
    )  # fmt: skip
    return InstrumentMap(
        id="valves", name=InstrumentName("Valves", "Valves"), short_name="valves", plays=(), transposition_semitones=2,
        range=Range(52, 82, 58, 74), controls=(*controls_, ring), fingerings=tuple(fingerings), **FRAME,
    )  # fmt: skip


def slide() -> InstrumentMap:
    """Instrument with seven slide positions on a tube whose second harmonic is B flat 2 (46), with a thumb lever that
    lowers it by a fourth.
    """
    found: dict[int, list[tuple[float, str, dict[str, float], float]]] = {}
    for lever in (False, True):
        for position in range(1, 7 if lever else 8):
            out_m = 2.75 * (1.335 if lever else 1.0) * (2 ** ((position - 1) / 12) - 1) / 2
            if out_m > 0.62:
                continue
            for above, cents in _HARMONIC_CENTS.values():
                pitch = 34 + above - (position - 1) - (5 if lever else 0)
                controls = {"slide": out_m / 0.62} if out_m else {}
                if lever:
                    controls["trigger"] = 1.0
                label = f"{'T' if lever else ''}{position}"
                # Far places and the lever come later.
                found.setdefault(pitch, []).append((out_m + 0.4 * lever, label, controls, cents))
    fingerings = []
    for pitch, ways in sorted(found.items()):
        ways.sort(key=lambda way: way[0])
        for rank, (_, label, controls, cents) in enumerate(ways[:4], 1):
            fingerings.append(Fingering(pitch, rank, label, controls, cents))
    controls_ = (
        Control(
            "slide", "slide", "pitch", "right.hand", "slide", ControlMotion(axis=(0.0, 0.0, 1.0), travel_m=0.62),
            move_note_share=0.5, max_speed_m_s=2.5,
        ),
        Control(
            "trigger", "lever", "pitch", "left.thumb", "trigger",
            ControlMotion(axis=(1.0, 0.0, 0.0), angle_rad=0.3, pivot_m=(0.0, 0.0, 0.0)), "T",
        ),
    )  # fmt: skip
    return InstrumentMap(
        id="slide", name=InstrumentName("Slide", "Slide"), short_name="slide", plays=(), transposition_semitones=0,
        range=Range(40, 70, 46, 65), controls=controls_, fingerings=tuple(fingerings), **FRAME,
    )  # fmt: skip


def time_frame(lines: tuple[MonophonicPart, ...], clock: Any, *preroll_beats: float, **options: Any) -> TimeFrame:
    """Time range of a performance around the notes of all lines; around tick 0 without notes."""
    first = min((line.notes[0].onset_tick for line in lines if line.notes), default=0)
    last = max((note.onset_tick + note.duration_tick for line in lines for note in line.notes), default=0)
    return frame_around(first, last, clock, *preroll_beats, **options)


def make_plans(
    piece: Piece, lines: tuple[MonophonicPart, ...], frame: TimeFrame, seed: int = 0, **options: Any
) -> dict[str, PlayerPlan]:
    """Plan every line of the ensemble in order; options are those of `EnsemblePlanning`."""
    return EnsemblePlanning(piece, lines, frame, seed, **options).finished()
