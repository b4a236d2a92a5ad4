"""Computes parts of a motion in forked copies of the process."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from fractions import Fraction
from functools import partial
from itertools import pairwise
from typing import Final

import msgspec
import numpy as np

from app.child import ForkedChild, MessageChannel, can_fork
from app.errors import AppError
from app.motion.model import Motion

_WORTH_FRAMES: Final = 4096
"""Number of frames above which copying is faster than computing."""
_MOST: Final = 8


def shares(count: int, cores: int) -> list[range]:
    """Divide ``count`` frames into ranges of equal length, one for each usable core."""
    parts = max(1, min(cores, count // _WORTH_FRAMES, _MOST)) if cores > 1 and can_fork() else 1
    ends = [count * number // parts for number in range(parts + 1)]
    return [range(first, last) for first, last in pairwise(ends)]


@contextmanager
def made_by_copies(make: Callable[[range], Motion], parts: Sequence[range]) -> Iterator[Callable[[], list[Motion]]]:
    """Start copies of this process that compute parts of a motion, for the duration of the block.

    Yields
    ------
    callable
        Function that waits for the results; unfinished parts are computed here.
    """
    children: list[ForkedChild[_Sent]] = []

    def results() -> list[Motion]:
        found = []
        for number, part in enumerate(parts):
            try:
                found.append(_received(children[number].receive()))
            except (BrokenPipeError, IndexError):
                found.append(make(part))
        return found

    try:
        with contextlib.suppress(OSError):  # if no process can be started, this one does all the work
            for part in parts:
                children.append(ForkedChild(_Sent, partial(_make, make, part), tuple(children)))
        yield results
    finally:
        for child in children:
            child.end()


def _make(make: Callable[[range], Motion], part: range, channel: MessageChannel[None]) -> None:
    # On failure the parent process repeats the work and reports the error.
    with contextlib.suppress(BrokenPipeError, AppError):
        channel.send(_sent(make(part)))


_Array = tuple[str, list[int], bytes]
"""Type, shape and bytes of an array."""


class _Sent(msgspec.Struct, frozen=True):
    """A `Motion` as sent between the processes that compute motion: arrays as bytes."""

    fps: tuple[int, int]
    first_frame_s: float
    arrays: dict[str, _Array]
    morphs: dict[str, _Array]
    controls: dict[str, _Array]


_ARRAYS: Final = ("rotations", "hips_m", "instrument_position_m", "instrument_rotation")


def _sent(motion: Motion) -> _Sent:
    arrays, morphs, controls = (
        {name: (values.dtype.str, list(values.shape), values.tobytes()) for name, values in group.items()}
        for group in ({name: getattr(motion, name) for name in _ARRAYS}, motion.morphs, motion.controls)
    )
    return _Sent(motion.fps.as_integer_ratio(), motion.first_frame_s, arrays, morphs, controls)


def _received(sent: _Sent) -> Motion:
    arrays, morphs, controls = (
        {name: np.frombuffer(values, kind).reshape(shape) for name, (kind, shape, values) in group.items()}
        for group in (sent.arrays, sent.morphs, sent.controls)
    )
    return Motion(Fraction(*sent.fps), sent.first_frame_s, morphs=morphs, controls=controls, **arrays)
