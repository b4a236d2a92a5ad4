"""Checks of the recording and the reference video of a project."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from app.project import limits
from app.project.fault import Fault, faults_of_bounds, path_faults
from app.project.recording import AudioTrack
from app.project.video import VideoTrack


def track_faults(track: AudioTrack | VideoTrack) -> Iterator[Fault]:
    """Faults of a path, an offset and its confidence."""
    if not track.path:
        yield "path", "must be the path of a file"
    yield from path_faults("path", track.path)
    yield from faults_of_bounds("offset_s", track.offset_s, limits.OFFSET_S)
    if track.confidence is not None:
        yield from faults_of_bounds("confidence", track.confidence, (0.0, 1.0))


def audio_faults(audio: AudioTrack) -> Iterator[Fault]:
    """Faults of a recording, with what following it found."""
    yield from track_faults(audio)
    for index, pin in enumerate(audio.pins):
        yield from faults_of_bounds(f"pins[{index}].tick", pin.tick, (0, limits.LAST_TICK))
        yield from faults_of_bounds(f"pins[{index}].recording_s", pin.recording_s, limits.OFFSET_S)
    if any(one.tick >= two.tick or one.recording_s >= two.recording_s for one, two in pairwise(audio.pins)):
        yield "pins", "ticks and seconds must rise"
    for index, doubt in enumerate(audio.doubts):
        yield from faults_of_bounds(f"doubts[{index}].confidence", doubt.confidence, (0.0, 1.0))
        if not 0 <= doubt.start_tick < doubt.end_tick <= limits.LAST_TICK:
            yield f"doubts[{index}].start_tick", "must be before the end"
    if any(one.end_tick > two.start_tick for one, two in pairwise(audio.doubts)):
        yield "doubts", "must be in order and apart"
