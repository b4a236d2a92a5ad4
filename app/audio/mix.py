"""Mix of a project: its recording, or players and percussion by the synthesiser, and the metronome."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final

import numpy as np
import soxr

from app.audio.decode import AudioRecording, decode
from app.audio.synth import RenderedPhrase, Synthesiser, drum_phrases, phrases, program_of
from app.audio.track import RATE_HZ, AudioSegment, Block, Mix, MixTrack
from app.errors import Progress, StopRequested, raise_if_stopped
from app.plan.parameters import PlayerParameters
from app.project.casting import StagePosition
from app.project.model import Project
from app.project.performers import Player
from app.score.model import Score
from instrument_maps.library import all_maps

_LEVEL: Final = 4.5
"""Gain of the synthesiser, since its tones are about 30 dB below full scale; ensembles of any size then reach about -18
dB.
"""
PERCUSSION: Final = ""
"""Key of the percussion in mappings by player id."""
_PERCUSSION_LEVEL: Final = 0.5
"""Level of the percussion relative to the players, since the loudest strokes of a drum kit far exceed a wind
instrument.
"""
_SIDE: Final = 0.6
"""Pan of the outermost player; 1 is a single channel."""


def project_to_hear(score: Score) -> Project:
    """Create a project for listening only, in which every part of a score sounds; its players have no instruments and
    characters.
    """
    place = StagePosition(0.0, 0.0, 0.0)
    return Project(
        score, tuple(Player(part.id, part.name, part.id, "", "", PlayerParameters(), place) for part in score.parts)
    )


def player_phrases(project: Project, player: Player) -> tuple[RenderedPhrase, ...]:
    """Return the phrases that the synthesiser renders for a player, even if the instrument's map is missing."""
    part = project.part(player)
    return phrases(part, project.score.tempo_map, program_of(part, all_maps().get(player.instrument_id)))


def percussion_phrases(project: Project) -> tuple[RenderedPhrase, ...]:
    """Return the phrases that the synthesiser renders for percussion without a player."""
    return drum_phrases(project.score.percussion, project.score.tempo_map)


def player_tracks(project: Project, pieces: Mapping[str, Iterable[AudioSegment]]) -> tuple[MixTrack, ...]:
    """Return the tracks of the audible players.

    Parameters
    ----------
    pieces : mapping of str to iterable of AudioSegment
        Rendered sound by player id or `PERCUSSION`.
    """
    return tuple(
        MixTrack(pieces[player_id], *gains) for player_id, gains in player_gains(project).items() if player_id in pieces
    )


def player_gains(project: Project) -> dict[str, tuple[float, float]]:
    """Return the left and the right gain of each audible player, by id: of soloed players if there are any, else of
    `PERCUSSION` and all that are not muted. Positions on stage determine the balance.
    """
    players = project.players
    soloed = any(player.soloed for player in players)
    width_m = max((abs(player.stage.x_m) for player in players), default=0.0)
    level = _LEVEL / float(np.sqrt(max(len(players), 1)))
    gains = {}
    for player in players:
        if player.soloed if soloed else not player.muted:
            left, right = place_gains(player.stage.x_m, width_m)
            gains[player.id] = (level * left, level * right)
    if project.score.percussion and not soloed:
        gains[PERCUSSION] = (_PERCUSSION_LEVEL * level, _PERCUSSION_LEVEL * level)
    return gains


def recording_track(recording: AudioRecording, offset_s: float) -> MixTrack:
    """Make a track of the mix from a recording, shifted by its offset in seconds."""
    return MixTrack([AudioSegment(round(offset_s * RATE_HZ), recording.samples)])


def place_gains(x_m: float, width_m: float) -> tuple[float, float]:
    """Return left and right gains at equal power for a place on the stage; both are 1 in the middle.

    Parameters
    ----------
    x_m : float
        Sideways position in metres; +X is at the right of a listener facing the stage.
    width_m : float
        Half the width of the ensemble in metres.
    """
    side = _SIDE * x_m / width_m if width_m > 0.0 else 0.0
    angle = (min(max(side, -1.0), 1.0) + 1.0) * np.pi / 4.0
    return float(np.sqrt(2.0) * np.cos(angle)), float(np.sqrt(2.0) * np.sin(angle))


def mixdown(
    project: Project,
    start_s: float,
    end_s: float,
    rate_hz: int = RATE_HZ,
    progress: Progress = lambda share: None,
    stop_requested: StopRequested = lambda: False,
) -> Block:
    """Return the sound of a span of the performance for films and files: the recording if there is one, else the
    synthesiser.

    Parameters
    ----------
    project : Project
        Project whose muted players are silent.
    start_s, end_s : float
        Seconds of the performance; may be negative.
    progress : callable
        Called with the share 0..1 that is done.
    stop_requested : callable
        Called regularly; true cancels the work.

    Returns
    -------
    float32 array, shape (n, 2)
        ``round((end_s - start_s) * rate_hz)`` samples within -1..1.

    Raises
    ------
    FileError
        The recording cannot be read.
    Cancelled
        ``stop_requested`` returned true.
    """
    if project.audio is not None:
        recording = decode(project.audio.path, lambda share: progress(0.9 * share), stop_requested)
        mix = Mix([recording_track(recording, project.audio.offset_s)])
    else:
        mix = _synthesised(project, start_s, end_s, progress, stop_requested)
    start, count = round(start_s * RATE_HZ), max(round((end_s - start_s) * RATE_HZ), 0)
    block = mix.read(start, count)
    if rate_hz != RATE_HZ and count:
        block = soxr.resample(block, RATE_HZ, rate_hz)
    requested = max(round((end_s - start_s) * rate_hz), 0)
    result = np.zeros((requested, 2), np.float32)
    result[: len(block)] = np.clip(block[:requested], -1.0, 1.0)
    progress(1.0)
    return result


def _synthesised(
    project: Project, start_s: float, end_s: float, progress: Progress, stop_requested: StopRequested
) -> Mix:
    """Return the mix of phrases of players and percussion within a span."""
    synthesiser = Synthesiser()
    everything = [(player.id, player_phrases(project, player)) for player in project.players]
    requested = [
        (player_id, phrase)
        for player_id, own in (*everything, (PERCUSSION, percussion_phrases(project)))
        for phrase in own
        if phrase.start < end_s * RATE_HZ and phrase.end > start_s * RATE_HZ
    ]
    pieces: dict[str, list[AudioSegment]] = {}
    for index, (player_id, phrase) in enumerate(requested):
        raise_if_stopped(stop_requested)
        pieces.setdefault(player_id, []).append(synthesiser.render(phrase))
        progress(index / len(requested))
    return Mix(player_tracks(project, pieces))
