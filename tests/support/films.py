"""Films whose pictures contain their index, so that a test can identify a displayed picture."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np

from app.arrays import SingleArray
from app.export.video import video_into
from app.formats.video import Picture

BITS = 8
SIZE = (8 * BITS, 48)


def numbered(number: int) -> Picture:
    """Picture with a number, one column per bit."""
    bits = [255 * (number >> bit & 1) for bit in range(BITS)]
    return np.broadcast_to(np.repeat(bits, 8).astype(np.uint8)[None, :, None], (SIZE[1], SIZE[0], 3)).copy()


def number_of(picture: Picture) -> int:
    """Number contained in a picture."""
    columns = picture[8:-8].mean(axis=(0, 2)).reshape(BITS, -1).mean(axis=1)
    return sum(1 << bit for bit in range(BITS) if columns[bit] > 127)


def written(path: Path, rate: Fraction, pictures: int, sound: SingleArray | None = None) -> Path:
    """Write a film of pictures numbered from 0, with sound (n, 2) at 48 kHz."""
    with video_into(path, SIZE, rate, sound) as film:
        for number in range(pictures):
            film.write(numbered(number))
    return path
