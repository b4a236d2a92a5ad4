"""Dynamics in force on each staff and in the whole piece over time, for notes written without one."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import numpy as np

from app.arrays import IntArray
from app.plan.music.velocity_ladders import DYNAMICS, MF


class MarkChanges(msgspec.Struct, frozen=True):
    """Changes over time of the dynamic mark in force.

    Attributes
    ----------
    ticks : tuple of int
        Ticks of the changes, ascending.
    marks : tuple of int
        Mark from each tick on, as a row of `DYNAMICS`.
    """

    ticks: tuple[int, ...] = ()
    marks: tuple[int, ...] = ()

    def at(self, onsets: IntArray) -> IntArray:
        """Dynamic mark (N,) in force at each onset, as a row of `DYNAMICS`; -1 before the first."""
        return np.array((-1, *self.marks), np.int64)[np.searchsorted(self.ticks, onsets, side="right")]


class StaffLevels(msgspec.Struct, frozen=True):
    """Dynamics in force over time on every staff, and those in force on most staves."""

    staves: dict[int, MarkChanges]
    most: MarkChanges

    def at(self, staff: int, onsets: IntArray) -> IntArray:
        """Dynamic (N,) of a staff at each onset, as a row of `DYNAMICS`; before the staff's first dynamic that of most
        staves, and mezzoforte before any.
        """
        marks = self.staves.get(staff, MarkChanges()).at(onsets)
        marks = np.where(marks < 0, self.most.at(onsets), marks)
        return np.where(marks < 0, MF, marks)


def staff_levels(parts: Sequence[tuple[int, IntArray, IntArray]]) -> StaffLevels | None:
    """Return the dynamics in force in a piece; None if every note has its own.

    Players of one staff read the same dynamics, even if a program wrote them into the first voice only; a staff without
    any yet follows most others.

    Parameters
    ----------
    parts : sequence of (staff, onsets (N,) in ticks, marks (N,))
        Dynamics as rows of `DYNAMICS`; -1: none.
    """
    if not any((marks < 0).any() for _, _, marks in parts):
        return None
    staves = {
        staff: _changes(*(np.concatenate([part[row] for part in parts if part[0] == staff]) for row in (1, 2)))
        for staff in sorted({staff for staff, _, _ in parts})
    }
    times = np.unique(np.concatenate([np.array(changes.ticks, np.int64) for changes in staves.values()]))
    at = np.array([changes.at(times) for changes in staves.values()])
    most = np.array([(at == mark).sum(axis=0) for mark in range(len(DYNAMICS))]).argmax(axis=0)
    return StaffLevels(staves, _changes(times, most))


def _changes(ticks: IntArray, marks: IntArray) -> MarkChanges:
    known = np.flatnonzero(marks >= 0)
    known = known[np.argsort(ticks[known], kind="stable")]
    known = known[np.flatnonzero(np.diff(marks[known], prepend=-1))]
    return MarkChanges(tuple(ticks[known].tolist()), tuple(marks[known].tolist()))
