"""Small scores and sounds for tests of audio."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import msgspec
import numpy as np

from app.audio.track import RATE_HZ, AudioSegment, MixTrack, Samples
from app.project.model import Project, map_choices, project_from_score
from app.score.metre_map import Metre
from app.score.model import Note, Part, Score
from app.score.read import read_midi
from app.score.tempo import TempoMap
from instrument_maps.load import bundled_maps

EXAMPLE = Path(__file__).parents[3] / "resources" / "examples" / "quartet.mid"


@cache
def quartet() -> Project:
    """The bundled quartet."""
    maps = bundled_maps()
    return project_from_score(read_midi(EXAMPLE, maps=map_choices(maps.values())), maps)


def melody(*notes: tuple[int, int, int], program: int | None = 56, **more: object) -> Part:
    """Part of notes (onset, duration, pitch) in ticks, 480 per quarter."""
    made = tuple(Note(f"1:{i}", on, length, pitch, 90) for i, (on, length, pitch) in enumerate(notes, 1))
    part = Part("1.1.1", "Trumpet", 0, 0, 0, program, "trumpet", "trumpet_Bb", made)
    return msgspec.structs.replace(part, **more)


def piece(*parts: Part, metres: tuple[Metre, ...] = (Metre(0, 4, 4),), pickup_ticks: int = 0) -> Project:
    """A piece at 120 quarters a minute."""
    numbered = tuple(msgspec.structs.replace(part, id=f"{i}.1.1") for i, part in enumerate(parts, 1))
    score = Score("", 480, TempoMap(480), metres, pickup_ticks, numbered)
    return project_from_score(score, bundled_maps())


def steady_run(seed: int, ticks: int = 240, count: int = 80) -> Project:
    """Equally long notes without rests at 120 quarters a minute, which differ only in pitch."""
    pitches = np.random.default_rng(seed).choice([60, 62, 64, 65, 67, 69, 71, 72, 74], count)
    notes = [(number * ticks, ticks - 20, int(pitch)) for number, pitch in enumerate(pitches)]
    return piece(melody(*notes))


def with_players(project: Project, **changes: dict[str, object]) -> Project:
    """Change fields of players by their number (``p0=...``)."""
    players = list(project.players)
    for key, fields in changes.items():
        players[int(key[1:])] = msgspec.structs.replace(players[int(key[1:])], **fields)
    return replace(project, players=tuple(players))


def ramp_track(seconds: float = 20.0, start_s: float = 0.0) -> MixTrack:
    """Track whose samples encode their own time: the amplitude rises by 1000 a second."""
    samples: Samples = np.round(np.arange(round(seconds * RATE_HZ)) / RATE_HZ * 1000).astype(np.int16)
    return MixTrack([AudioSegment(round(start_s * RATE_HZ), samples)])


def times_s(block: np.ndarray) -> np.ndarray:
    """Times in seconds encoded in such samples."""
    return block[:, 0] * 32768 / 1000
