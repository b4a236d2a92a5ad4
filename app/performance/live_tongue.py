"""Tongue of a live player: strokes of tip and back, and breath pushes of hard attacks."""

from __future__ import annotations

import math
from collections import deque
from typing import Final

import numpy as np

from app.motion.curves.live_values import Reach
from app.motion.faces.tongue_strokes import PUSH_UNTIL_S, PUSHED
from app.motion.perform import PerformanceCurves
from app.plan.lips.tonguing import BACK, LEAST_FAST_STEPS, STRENGTHS, single_limit_s
from app.plan.music.dynamics import ACCENT, ACCENT_NOTES
from app.plan.music.piece import Seeds

TONGUE_UP_S, TONGUE_DOWN_S = 0.015, 0.06
"""Seconds in which the tongue rises, and in which it visibly leaves the reed or the teeth."""
PUSH_UP_S: Final = 0.25 * PUSH_UNTIL_S
"""Seconds in which the breath's push rises, since the note has already begun."""


class _Stroke:
    """State of one part of the tongue: a value that jumps up at a stroke and falls again."""

    def __init__(self, up_s: float, down_s: float) -> None:
        self._up_s, self._down_s = up_s, down_s
        self._value, self._falls_s = Reach.at_rest(0.0), math.inf

    def begin(self, now_s: float, height: float) -> None:
        self._value = self._value.toward(now_s, height, self._up_s)
        self._falls_s = now_s + self._up_s

    def at(self, now_s: float) -> float:
        if now_s >= self._falls_s:
            self._value = self._value.toward(self._falls_s, 0.0, self._down_s)
            self._falls_s = math.inf
        return max(self._value.at(now_s), 0.0)


class LiveTongue:
    """The tongue of one player who plays live.

    Two quick strokes use the tip; in a longer run the back makes every other one. Triple tonguing is not detected,
    since later notes are unknown. An attack louder than those before it gets a push.
    """

    def __init__(self, curves: PerformanceCurves) -> None:
        self._limit_s = single_limit_s(curves.instrument_map, Seeds((curves.parameters.seed, curves.player_id)))
        self._tip, self._back = _Stroke(TONGUE_UP_S, TONGUE_DOWN_S), _Stroke(TONGUE_UP_S, TONGUE_DOWN_S)
        self._push = _Stroke(PUSH_UP_S, PUSH_UNTIL_S - PUSH_UP_S)
        self._struck_s, self._quick, self._was_back = -math.inf, 0, False
        self._before: deque[float] = deque(maxlen=ACCENT_NOTES)

    def strike(self, now_s: float, loudness: float) -> None:
        """Start the tongue stroke of a note that is attacked with a loudness 0..1."""
        self._quick = self._quick + 1 if now_s - self._struck_s < self._limit_s else 0
        self._was_back = self._quick >= LEAST_FAST_STEPS and not self._was_back
        self._struck_s = now_s
        hard = bool(self._before) and loudness - float(np.median(self._before)) >= ACCENT
        self._before.append(loudness)
        height = STRENGTHS["accent" if hard else "tongued"]
        if self._was_back:
            self._back.begin(now_s, height * BACK)
        else:
            self._tip.begin(now_s, height)
        if hard:
            self._push.begin(now_s, PUSHED["accent"])

    def at(self, now_s: float) -> tuple[float, float, float]:
        """Return the height of the tongue's tip and back (1 in a plain stroke of the tip), and the strength of the
        breath push.
        """
        return self._tip.at(now_s), self._back.at(now_s), self._push.at(now_s)
