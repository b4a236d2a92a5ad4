"""Excerpts of equal loudness as in ITU-R BS.1770-4, without gating since excerpts have no pauses."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.audio.track import RATE_HZ, Block

TARGET_LUFS: Final = -20.0
PEAK: Final = 0.89
"""Peak amplitude, -1 dB of full scale, so that encoding does not exceed full scale."""
_SILENT_LUFS: Final = -70.0
"""Absolute gate of BS.1770: sounds below it are silence and not amplified."""

# Tables 1 and 2 of BS.1770-4, for 48 kHz.
_HEAD: Final = ((1.53512485958697, -2.69169618940638, 1.19839281085285), (1.0, -1.69065929318241, 0.73248077421585))
_LOW: Final = ((1.0, -2.0, 1.0), (1.0, -1.99004745483398, 0.99007225036621))


def loudness_lufs(sound: Block) -> float:
    """Return the loudness of a sound in LUFS.

    Parameters
    ----------
    sound : (N, 2) float32
        Samples at 48 kHz, -1..1.
    """
    from scipy.signal import lfilter  # slow to import and used only here

    if RATE_HZ != 48_000:
        raise ValueError("the filters are those for 48 kHz")
    if not len(sound):
        return -np.inf
    weighted: FloatArray = lfilter(*_LOW, lfilter(*_HEAD, sound.astype(np.float64), axis=0), axis=0)
    power = float((weighted**2).mean(axis=0).sum())
    return -0.691 + 10.0 * float(np.log10(power)) if power > 0.0 else -np.inf


def equally_loud(sounds: Sequence[Block]) -> list[Block]:
    """Scale sounds to equal loudness: `TARGET_LUFS`, or less to avoid clipping; silence is unchanged."""
    levels = [loudness_lufs(sound) for sound in sounds]
    audible = [index for index, level in enumerate(levels) if level > _SILENT_LUFS]
    target = TARGET_LUFS
    for index in audible:
        room_db = 20.0 * float(np.log10(PEAK / float(np.abs(sounds[index]).max())))
        target = min(target, levels[index] + room_db)
    found = []
    for index, sound in enumerate(sounds):
        gain = 10.0 ** ((target - levels[index]) / 20.0) if index in audible else 1.0
        found.append(np.asarray(sound * np.float32(gain), np.float32))
    return found
