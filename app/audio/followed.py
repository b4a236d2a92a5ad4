"""What a recording says about a piece, found beside the document and taken over in one edit."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from app.audio.decode import decode
from app.audio.dynamics import Loudness, dynamics, loudness
from app.audio.follow import beats_of, follow
from app.audio.track import RATE_HZ, Samples
from app.project.edit.dynamics import set_dynamics
from app.project.edit.follow import follow_recording, pins_for
from app.project.model import Project
from app.score.following import Following
from app.score.model import ControllerCurve


@dataclass(frozen=True)
class Wishes:
    """What is to be taken from a recording beside the beats.

    Attributes
    ----------
    dynamics : bool
        Its loudness becomes the players' dynamics.
    stems : mapping of str to str
        By player id the path of a recording of that player alone, which begins with that of everybody; players without
        one get their dynamics from the recording of everybody.
    """

    dynamics: bool = False
    stems: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Followed:
    """What was found.

    Attributes
    ----------
    curves : mapping of str to ControllerCurve
        Dynamics by part.
    """

    following: Following
    curves: Mapping[str, ControllerCurve] = field(default_factory=dict)


def listen(
    project: Project,
    samples: Samples,
    path: str | os.PathLike[str],
    wishes: Wishes,
    progress: Callable[[float], None] = lambda share: None,
    stop_requested: Callable[[], bool] = lambda: False,
    begins_s: float = 0.0,
) -> Followed:
    """Find in a recording what is wished for.

    Parameters
    ----------
    samples : int16 array, shape (n, channels)
        At `RATE_HZ`.
    path : path-like
        Of the recording.
    begins_s : float
        The second of the recording that the samples begin with; of the stems it is the same.

    Raises
    ------
    AppError
        Those of `follow`, of `decode` for the stems, of `dynamics` and of `follow_recording`.
    Cancelled
    """
    beats_share = 0.7 if wishes.dynamics else 1.0
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
    if not wishes.dynamics:
        return Followed(following)
    aligned = follow_recording(project, following, path)
    parts = {player.id: player.part_id for player in project.players}
    stems: dict[str, Loudness] = {}
    for number, (player_id, stem) in enumerate(wishes.stems.items()):
        heard = decode(stem, stop_requested=stop_requested).samples
        stems[parts[player_id]] = loudness(heard[round(begins_s * RATE_HZ) :], RATE_HZ)
        progress(beats_share + 0.2 * (number + 1) / len(wishes.stems))
    offset_s = begins_s - float(following.recording_s[0])
    mix = loudness(samples, RATE_HZ) if set(parts.values()) - set(stems) else None
    curves = dynamics(aligned.score, offset_s, mix, stems, set(parts.values()))
    progress(1.0)
    return Followed(following, curves)


def take_over(project: Project, followed: Followed, path: str | os.PathLike[str]) -> Project:
    """The piece as the recording has it. Raises UsageError: see `follow_recording`."""
    return set_dynamics(follow_recording(project, followed.following, path), followed.curves)
