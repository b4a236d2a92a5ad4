"""Values that follow live input: they continue from their current state without jumps.

`Reach` is a minimum-jerk move from a moving state (Flash & Hogan 1985), `Spring` follows a changing value, `Journey`
moves between discrete places. They store only their state, so memory is constant.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

LEAST_MOVE_S = 1e-3
"""Shortest move in seconds."""
SETTLED = 5.83
"""Time constants after which a critically damped spring is within 2 % of its target."""
HURRIES = 0.6
"""Share of the available time for finishing or reversing the current move if another one must follow; the other move
gets the remaining time.
"""


@dataclass(frozen=True)
class Reach:
    """A move of a value to ``target`` that ends at ``end_s``; it begins at ``start_s`` with the given ``value``,
    ``speed`` and ``push`` (second derivative).
    """

    start_s: float
    end_s: float
    value: float
    speed: float
    push: float
    target: float

    @classmethod
    def at_rest(cls, value: float) -> Reach:
        """Create a motion that stays at a value."""
        return cls(0.0, LEAST_MOVE_S, value, 0.0, 0.0, value)

    def at(self, now_s: float) -> float:
        """Value at a time; it may overshoot if the motion was reversed at speed."""
        return self._state(now_s)[0]

    def speed_at(self, now_s: float) -> float:
        """Return the value's rate of change per second at a time."""
        return self._state(now_s)[1]

    def toward(self, now_s: float, target: float, length_s: float) -> Reach:
        """Begin a move to a new target, continuing from the value and speed at ``now_s``."""
        value, speed, push = self._state(now_s)
        return Reach(now_s, now_s + max(length_s, LEAST_MOVE_S), value, speed, push, target)

    def ended(self, now_s: float) -> bool:
        """Return whether the move has reached its target at a time."""
        return now_s >= self.end_s

    def _state(self, now_s: float) -> tuple[float, float, float]:
        if now_s >= self.end_s:
            return self.target, 0.0, 0.0
        if now_s <= self.start_s:
            return self.value, self.speed, self.push
        length_s = self.end_s - self.start_s
        way, v, a = self.target - self.value, self.speed * length_s, self.push * length_s * length_s
        third, fourth = 10.0 * way - 6.0 * v - 1.5 * a, -15.0 * way + 8.0 * v + 1.5 * a
        fifth = 6.0 * way - 3.0 * v - 0.5 * a
        u = (now_s - self.start_s) / length_s
        value = self.value + u * (v + u * (0.5 * a + u * (third + u * (fourth + u * fifth))))
        speed = v + u * (a + u * (3.0 * third + u * (4.0 * fourth + u * 5.0 * fifth)))
        push = a + u * (6.0 * third + u * (12.0 * fourth + u * 20.0 * fifth))
        return value, speed / length_s, push / (length_s * length_s)


class Spring:
    """A value that follows another, critically damped: no jumps, no oscillation.

    Parameters
    ----------
    settles_s : float
        Seconds until it has practically arrived.
    """

    def __init__(self, value: float, settles_s: float) -> None:
        self.value, self.speed = value, 0.0
        self._rate = SETTLED / settles_s

    def follow(self, target: float, elapsed_s: float) -> float:
        """Advance the value by ``elapsed_s`` seconds towards ``target``, and return it."""
        off = self.value - target
        drive = self.speed + self._rate * off
        left = math.exp(-self._rate * elapsed_s)
        self.value = target + (off + drive * elapsed_s) * left
        self.speed = (self.speed - self._rate * drive * elapsed_s) * left
        return self.value


class Journey:
    """An object that moves between discrete places along given ways.

    If another place is requested on the way, the object first continues to the nearer end, since ways only connect
    places.
    """

    def __init__(self) -> None:
        self.before = self.after = self.goal = 0
        self._share = Reach.at_rest(1.0)
        self._length_s = LEAST_MOVE_S

    def go(self, now_s: float, goal: int, length_s: float) -> None:
        """Start moving to the place ``goal`` (an index), arriving after ``length_s``; no effect if that is the goal
        already."""
        self._arrive(now_s)
        if goal == self.goal:
            return
        self.goal, self._length_s = goal, length_s
        if self.before == self.after:
            self._depart(now_s)
            return
        if goal in (self.before, self.after):
            end, hurried = float(goal == self.after), False
        else:
            end, hurried, length_s = float(self._share.at(now_s) >= 0.5), True, HURRIES * length_s
        if end != self._share.target or (hurried and self._share.end_s > now_s + length_s):
            self._share = self._share.toward(now_s, end, length_s)

    def at(self, now_s: float) -> tuple[int, int, float]:
        """Position at a time: the indices of the place left last and of the place reached next, and the share 0..1 of
        the way between them.
        """
        self._arrive(now_s)
        if self.before == self.after:
            return self.after, self.after, 1.0
        return self.before, self.after, min(max(self._share.at(now_s), 0.0), 1.0)

    def _arrive(self, now_s: float) -> None:
        while self.before != self.after and self._share.ended(now_s):
            here, ended_s = (self.after if self._share.target else self.before), self._share.end_s
            self.before = self.after = here
            if here != self.goal:
                self._depart(ended_s)

    def _depart(self, now_s: float) -> None:
        self.after = self.goal
        if self.after == self.before:
            return
        self._share = Reach.at_rest(0.0).toward(now_s, 1.0, self._length_s)
