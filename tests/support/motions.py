"""Cache of motion and contacts of known plans for all tests of a process, since the quartet takes seconds of processor
time.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, Final
from weakref import WeakKeyDictionary

import pytest

from app.contacts.breaks import Break
from app.contacts.judge import ContactJudge
from app.identity_cache import IdentityCache
from app.motion.model import Motion
from app.motion.perform import PerformanceCurves
from app.plan.model import PlayerPlan

MOST_FRAMES: Final = 500
"""Number of frames above which motion is not cached, as in exports."""

_CURVES: Final = IdentityCache[PerformanceCurves](16)


@dataclass(eq=False)
class _Known:
    """Computed motion of some curves.

    Attributes
    ----------
    made : dict of (rate, first frame, frames) to Motion
    breaks : dict of (identity of the motion, of the instrument's model) to tuple of Break
    """

    made: dict[tuple[Fraction, int, int], Motion] = field(default_factory=dict)
    breaks: dict[tuple[int, int], tuple[Break, ...]] = field(default_factory=dict)


_KNOWN: Final = WeakKeyDictionary[PerformanceCurves, _Known]()


class _Prepared(IdentityCache[PerformanceCurves]):
    """Keeps the curves of known plans, whatever else is computed."""

    def __init__(self, plans: Callable[[], Collection[PlayerPlan]], size: int) -> None:
        super().__init__(size)
        self._plans = plans

    def helped(self, function: Any, help: Any, *inputs: Any, **named: Any) -> Any:
        """Same as in any other cache."""
        if any(inputs[0] is plan for plan in self._plans()):
            made = _CURVES.helped(function, help, *inputs, **named)
            _KNOWN.setdefault(made, _Known())
            return made
        return super().helped(function, help, *inputs, **named)


def know_motion(monkeypatch: pytest.MonkeyPatch, plans: Callable[[], Collection[PlayerPlan]]) -> None:
    """Compute and judge motion only if it is new. The same frames of the same curves are equal to the bit, as
    tests/unit/motion/test_perform checks; code that changes them in place fails.

    The same frames of the same curves are the same bits, as tests/unit/motion/test_perform says; whoever changes them
    in place fails.
    """
    make, judge = PerformanceCurves.motion, ContactJudge.breaks

    def made(curves: PerformanceCurves, fps: Fraction, first_frame: int, frames: int, every: int = 1) -> Motion:
        known, key = _KNOWN.get(curves), (fps, first_frame, frames)
        if known is None or frames > MOST_FRAMES or every != 1:
            return make(curves, fps, first_frame, frames, every)
        if key not in known.made:
            known.made[key] = _locked(make(curves, fps, first_frame, frames))
        return known.made[key]

    def judged(judging: ContactJudge, motion: Motion) -> tuple[Break, ...]:
        known, key = _KNOWN.get(judging._curves), (id(motion), id(judging._model))
        if known is None or not any(motion is one for one in known.made.values()):
            return judge(judging, motion)
        if key not in known.breaks:
            known.breaks[key] = judge(judging, motion)
        return known.breaks[key]

    monkeypatch.setattr(PerformanceCurves, "motion", made)
    monkeypatch.setattr(ContactJudge, "breaks", judged)
    monkeypatch.setattr("app.performance.motion._PLAYING", _Prepared(plans, 8))


def _locked(motion: Motion) -> Motion:
    tracks = (motion.rotations, motion.hips_m, motion.instrument_position_m, motion.instrument_rotation)
    for values in (*tracks, *motion.morphs.values(), *motion.controls.values()):
        values.setflags(write=False)
    return motion
