"""Beats, dynamics and offset that a recording gives to a piece, computed in the background and applied in one edit."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from app.audio.decode import decode
from app.audio.dynamics import RecordingLoudness, dynamics, loudness
from app.audio.follow import beats_of, follow
from app.audio.note_onsets import note_onsets
from app.audio.track import RATE_HZ, Samples
from app.errors import Progress, StopRequested, stoppable
from app.project.edit.dynamics import set_dynamics
from app.project.edit.follow import follow_recording, pins_for
from app.project.edit.note_times import shift_onsets
from app.project.model import Project
from app.score.beat_following import Following
from app.score.model import ControllerCurve, Score


@dataclass(frozen=True)
class FollowOptions:
    """Options for following a recording: properties taken from it in addition to the times of the beats.

    Attributes
    ----------
    notes : bool
        Whether single notes with clear onsets are shifted too.
    dynamics : bool
        Whether the loudness becomes the players' dynamics.
    stems : mapping of str to str
        Path of a recording of a single player by player id, with the same start as the main recording; other players'
        dynamics are taken from the main recording.
    """

    notes: bool = False
    dynamics: bool = False
    stems: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Followed:
    """Result of following a recording.

    Attributes
    ----------
    curves : mapping of str to ControllerCurve
        Dynamics by part.
    shifts_s : mapping of str to float
        Delay in seconds of notes against their beats, by note id.
    """

    following: Following
    curves: Mapping[str, ControllerCurve] = field(default_factory=dict)
    shifts_s: Mapping[str, float] = field(default_factory=dict)


def listen(
    project: Project,
    samples: Samples,
    path: str | os.PathLike[str],
    options: FollowOptions,
    progress: Progress = lambda share: None,
    stop_requested: StopRequested = lambda: False,
    begins_s: float = 0.0,
) -> Followed:
    """Follow a recording, and compute the requested properties.

    Parameters
    ----------
    samples : int16 array, shape (n, channels)
        Samples of the recording at `RATE_HZ`.
    path : path-like
        Path of the recording.
    begins_s : float
        Second of the recording, and of the stems, at which the samples begin.

    Raises
    ------
    AppError
        The recording cannot be followed or gives no dynamics, a stem cannot be decoded, or the result cannot be
        applied.
    Cancelled
        ``stop_requested`` returned true.
    """
    beats_share = 0.6 if options.dynamics or options.notes else 1.0

    reached = stoppable(progress, stop_requested)
    pinned = {pin.tick: pin.recording_s - begins_s for pin in pins_for(project, path)}
    following = follow(
        samples,
        RATE_HZ,
        project.score,
        beats_of(project.metre_map, project.score.end_tick, pinned),
        lambda share: progress(beats_share * share),
        stop_requested,
        pinned,
    ).later(begins_s)
    if not options.dynamics and not options.notes:
        return Followed(following)
    aligned = follow_recording(project, following, path).score
    offset_s = begins_s - float(following.recording_s[0])
    shifts: dict[str, float] = {}
    if options.notes:
        shifts = note_onsets(samples, RATE_HZ, aligned, offset_s, lambda share: reached(0.6 + 0.2 * share))
    curves = _curves(project, aligned, samples, offset_s, begins_s, options, reached) if options.dynamics else {}
    reached(1.0)
    return Followed(following, curves, shifts)


def _curves(
    project: Project,
    aligned: Score,
    samples: Samples,
    offset_s: float,
    begins_s: float,
    options: FollowOptions,
    reached: Callable[[float], None],
) -> dict[str, ControllerCurve]:
    """Return the expression curve of every part by part id, measured from the recording, or from the recordings of
    single players in `FollowOptions.stems`."""
    parts = {player.id: player.part_id for player in project.players}
    stems: dict[str, RecordingLoudness] = {}
    for number, (player_id, stem) in enumerate(options.stems.items()):
        reached(0.8 + 0.15 * number / len(options.stems))
        stems[parts[player_id]] = loudness(decode(stem).samples[round(begins_s * RATE_HZ) :], RATE_HZ)
    mix = loudness(samples, RATE_HZ) if set(parts.values()) - set(stems) else None
    return dynamics(aligned, offset_s, mix, stems, set(parts.values()))


def take_over(project: Project, followed: Followed, path: str | os.PathLike[str]) -> Project:
    """Apply the result of following a recording to the project. Raises UsageError as `follow_recording` does."""
    project = follow_recording(project, followed.following, path)
    return set_dynamics(shift_onsets(project, followed.shifts_s), followed.curves)
