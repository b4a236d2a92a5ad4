"""MIDI files like those of wind controllers."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import mido

Q: Final = 480
MELODY: Final = (60, 62, 64, 65, 67, 65, 64, 62)


def take_file(
    path: Path,
    name: str = "Alto Sax",
    control: int = 2,
    floor: int = 0,
    late: int = 17,
    sampled: int = 10,
    chord: bool = False,
    fault: bool = True,
) -> Path:
    """Melody of detached quarters at 120 with a breath for each; the third note is struck twice within one breath."""
    file = mido.MidiFile(ticks_per_beat=Q)
    events: list[tuple[int, mido.Message]] = []
    for place, pitch in enumerate(MELODY):
        begin = Q * (place + 1) + late * (place % 3)
        end = begin + 330
        cuts = [(begin, begin + 150), (begin + 180, end)] if place == 2 and fault else [(begin, end)]
        for one, other in cuts:
            for key in (pitch, pitch + 4) if chord else (pitch,):
                events += [
                    (one, mido.Message("note_on", note=key, velocity=90)),
                    (other, mido.Message("note_off", note=key)),
                ]
        for tick in range(begin - 20, end + 20, sampled):
            events.append((tick, mido.Message("control_change", control=control, value=80 + tick % 3)))
        events.append((end + 20, mido.Message("control_change", control=control, value=floor)))
    track = mido.MidiTrack([mido.MetaMessage("track_name", name=name)])
    before = 0
    for tick, message in sorted(events, key=lambda event: event[0]):
        track.append(message.copy(time=tick - before))
        before = tick
    file.tracks.append(mido.MidiTrack())
    file.tracks.append(track)
    file.save(path)
    return path
