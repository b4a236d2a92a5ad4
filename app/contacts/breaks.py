"""Spans in which contacts are broken, and the problems made from them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from app.arrays import BoolArray, FloatArray
from app.contacts.reach import OUT_OF_REACH
from app.errors import Message
from app.plan.model import FingeringEvent, Problem
from app.plan.music.spans import Spans

JUDGED_PER_S = 15
"""Rate in frames per second at which contacts are judged; no body part leaves and resumes a contact faster."""
APART_S = 0.5
"""Breaks of the same contact closer than this time in seconds count as one."""

Kind = Literal["hand", "short", "touch", "lips", "foot"]


@dataclass(frozen=True)
class Break:
    """A span in which a contact is broken.

    Attributes
    ----------
    kind : str
        Kind of contact, such as of the lips, a hand, a finger or a foot.
    part : str
        Side of a hand or foot, or touching part of a hand; empty for the lips.
    control : str
        Control that is touched, or that the hand moves along and that stops short; otherwise empty.
    start_s, end_s : float
        Start and end of the span in seconds.
    gap_m : float
        Largest distance in the span, in metres.
    """

    kind: Kind
    part: str
    control: str
    start_s: float
    end_s: float
    gap_m: float

    @property
    def contact(self) -> tuple[str, str, str]:
        """Key of the broken contact: kind, part of the body, control of the instrument."""
        return self.kind, self.part, self.control


def runs(contact: tuple[Kind, str, str], times_s: FloatArray, gaps_m: FloatArray, broken: BoolArray) -> Iterator[Break]:
    """Yield a break for each span of consecutive frames in which ``broken`` (F,) is true, with its largest gap."""
    if not broken.any():
        return
    indices = np.flatnonzero(broken)
    apart = np.flatnonzero(np.diff(times_s[indices]) > APART_S) + 1
    for run in np.split(indices, apart):
        yield Break(*contact, float(times_s[run[0]]), float(times_s[run[-1]]), float(gaps_m[run].max()))


def contact_problems(
    breaks: Iterable[Break], grips: Sequence[FingeringEvent], known: Iterable[Problem]
) -> tuple[Problem, ...]:
    """A problem for every span in which a contact is broken, by time.

    Parameters
    ----------
    breaks : iterable of Break
        Spans with broken contacts, in any order.
    grips : sequence of FingeringEvent
        Fingerings of the player's plan.
    known : iterable of Problem
        Problems reported before: a control that stops short at a note out of reach is already one of them
        (`app.contacts.reach`), and is not reported again.
    """
    problems = []
    spans_s = [
        (problem.start_s - APART_S, problem.end_s + APART_S) for problem in known if problem.message.id == OUT_OF_REACH
    ]
    reported = Spans(_united(spans_s))
    starts_s = np.array([event.start_s for event in grips])
    for found in joined(breaks):
        if found.kind == "short" and reported.hold(found.start_s, found.end_s):
            continue
        note_id = None
        if found.kind != "foot":
            index = max(int(np.searchsorted(starts_s, found.start_s + 1e-9, side="right")) - 1, 0)
            note_id = grips[index].note_id
        end_s = found.end_s + 1.0 / JUDGED_PER_S
        problems.append(Problem(_message(found), note_id, found.start_s, end_s))
    return by_time(problems)


def by_time(problems: Iterable[Problem]) -> tuple[Problem, ...]:
    """Return problems sorted by their start."""
    return tuple(sorted(problems, key=lambda problem: problem.start_s))


def _united(spans_s: list[tuple[float, float]]) -> list[tuple[float, float]]:
    result: list[tuple[float, float]] = []
    for start_s, end_s in sorted(spans_s):
        if result and start_s <= result[-1][1]:
            result[-1] = (result[-1][0], max(result[-1][1], end_s))
        else:
            result.append((start_s, end_s))
    return result


def joined(breaks: Iterable[Break]) -> list[Break]:
    """Merge breaks of the same contact that follow each other closely."""
    result: list[Break] = []
    for item in sorted(breaks, key=lambda item: (*item.contact, item.start_s)):
        last = result[-1] if result else None
        if last is not None and last.contact == item.contact and item.start_s - last.end_s <= APART_S:
            end_s, gap_m = max(last.end_s, item.end_s), max(last.gap_m, item.gap_m)
            result[-1] = Break(last.kind, last.part, last.control, last.start_s, end_s, gap_m)
        else:
            result.append(item)
    return result


def _message(found: Break) -> Message:
    gap_mm = round(1000.0 * found.gap_m)
    if found.kind == "hand":
        return Message("contact.hand_off", {"side": found.part, "gap_mm": gap_mm})
    if found.kind == "short":
        return Message("contact.stops_short", {"control": found.control, "side": found.part, "gap_mm": gap_mm})
    if found.kind == "lips":
        return Message("contact.lips_off", {"gap_mm": gap_mm})
    if found.kind == "foot":
        return Message("contact.foot_off", {"side": found.part, "gap_mm": gap_mm})
    if found.control:
        return Message("contact.finger_off", {"touch": found.part, "control": found.control, "gap_mm": gap_mm})
    return Message("contact.grip_off", {"touch": found.part, "gap_mm": gap_mm})
