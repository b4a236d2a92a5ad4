"""Cleaning of a capture for dancing: repeated frames, rest poses at its ends, damage."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

import numpy as np

from app.choreography.body_speeds import PARTS, part_speeds
from app.choreography.clip import MotionClip
from app.choreography.clip_ends import idle, proper
from app.choreography.damage import Damage
from app.choreography.held_frames import held_frames
from app.choreography.mending import mended
from app.errors import Message

NAMED: Final = 6
"""Greatest number of places listed in a message, which adds the number of others."""


@dataclass(frozen=True, eq=False)
class CleanedClip:
    """A clip with a description of its changes.

    Attributes
    ----------
    clip : MotionClip
        The actual motion, with damage repaired.
    held : Fraction
        Mean number of file frames for which each frame was repeated; only one of them remains.
    lead_in, trail : int
        Frames of rest poses removed at the start and at the end.
    idle : tuple of int
        Frames at the start and at the end of the clip in which the body stands idle.
    mended, left_out : tuple of Damage
        See `app.choreography.mending.Mended`; frames of the clip.
    """

    clip: MotionClip
    held: Fraction = Fraction(1)
    lead_in: int = 0
    trail: int = 0
    idle: tuple[int, int] = (0, 0)
    mended: tuple[Damage, ...] = ()
    left_out: tuple[Damage, ...] = ()

    @property
    def start_s(self) -> float:
        """Time in seconds in the original clip at which the cleaned clip starts."""
        return float(self.lead_in / self.clip.fps)

    @property
    def unfit(self) -> tuple[tuple[int, int], ...]:
        """Return the ascending spans (start, stop) of the clip that must not be learned from."""
        start, end = self.idle
        spans = [(one.start, one.stop) for one in self.left_out]
        spans += [(0, start)] if start else []
        spans += [(len(self.clip) - end, len(self.clip))] if end else []
        return tuple(sorted(spans))


def cleaned(clip: MotionClip) -> CleanedClip:
    """Clean a clip: remove repeated frames and rest poses, and repair damage; a clip that needs none of this is
    unchanged.
    """
    count, kept = held_frames(np.any(part_speeds(clip) > 0.0, axis=1))
    if count > 1:
        clip = replace(clip, fps=clip.fps / count, hips_m=clip.hips_m[kept], rotations=clip.rotations[kept])
    start, stop = proper(clip)
    done = mended(clip.span(start, stop))
    return CleanedClip(done.clip, count, start, len(clip) - stop, idle(done.clip), done.mended, done.left_out)


def remarks(done: CleanedClip) -> tuple[Message, ...]:
    """Return notes for the user about what was removed from a clip and changed in it; times are those of the file."""
    found = []
    if done.held > 1:
        even = done.held.denominator == 1
        kind, number = ("motion.held", {"n": int(done.held)}) if even else ("motion.held_unevenly", {})
        found.append(Message(kind, {**number, "rate": str(done.clip.fps)}))
    if done.lead_in:
        found.append(Message("motion.lead_in", {"n": done.lead_in}))
    if done.trail:
        found.append(Message("motion.trail", {"n": done.trail}))
    for where, frames in zip(("motion.idle_start", "motion.idle_end"), done.idle, strict=True):
        if frames:
            found.append(Message(where, {"length_s": float(frames / done.clip.fps)}))
    if done.mended:
        found.append(Message("motion.mended", {"n": len(done.mended), "places": _places(done.mended, done)}))
    if done.left_out:
        found.append(Message("motion.left_out", {"n": len(done.left_out), "places": _places(done.left_out, done)}))
    return tuple(found)


def _places(damage: Sequence[Damage], done: CleanedClip) -> str:
    """Return times and body parts of damage as text, such as "1.25-1.40 s (hips, leftHand)"."""
    fps = done.clip.fps

    def place(one: Damage) -> str:
        first, last = (done.start_s + float(Fraction(frame) / fps) for frame in (one.start, one.stop))
        named = [part for part in one.parts if part in PARTS[:-1]] or ["hips"]
        parts = ", ".join(named[:3]) + (", ..." if len(named) > 3 else "")
        return f"{first:.2f}-{last:.2f} s ({parts})"

    more = f"; +{len(damage) - NAMED}" if len(damage) > NAMED else ""
    return "; ".join(map(place, damage[:NAMED])) + more
