"""Rendering of MIDI files by midirenderer with the bundled soundfonts."""

from __future__ import annotations

import io
from functools import cache
from pathlib import Path
from typing import Final

import midirenderer
import numpy as np
import soundfile

from app.audio.track import RATE_HZ, Samples
from app.score.channel_sound import DRUM_CHANNEL

FOLDER: Final = Path(__file__).parents[2] / "resources" / "soundfont"
_FIRST_STATUS: Final = 23
"""Index of the status byte of the first event in a file of one track, after the chunk heads and a delta of 0."""


@cache
def soundfont(of_drums: bool = False) -> bytes:
    """Return the bundled soundfont of wind instruments, or of the drum kit."""
    return (FOLDER / ("drums.sf2" if of_drums else "winds.sf2")).read_bytes()


def rendered(midi: bytes) -> Samples:
    """Render a MIDI file to sound: int16, mono, without silence at the end.

    A file of one track whose first event is at tick 0 on channel 10 is played by the drum kit.

    Takes about 20 ms for a phrase, during which midirenderer 0.1.3 blocks all Python code of the process.
    """
    wave = midirenderer.render_wave_from(soundfont(midi[_FIRST_STATUS] & 15 == DRUM_CHANNEL), midi)
    stereo, rate_hz = soundfile.read(io.BytesIO(wave), dtype="int16", always_2d=True)
    if rate_hz != RATE_HZ:
        raise RuntimeError(f"the synthesiser renders at {rate_hz} Hz")
    mono = (stereo.astype(np.int32).sum(axis=1) // 2).astype(np.int16)
    audible = np.flatnonzero(np.abs(mono) > 1)
    sound: Samples = mono[: int(audible[-1]) + 1 if len(audible) else 0].copy()
    return sound
