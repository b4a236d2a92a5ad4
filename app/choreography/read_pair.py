"""Files of a motion, of its music and of who made it, as a pair to learn from."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Final

from app.choreography.cuts import angular_acceleration
from app.choreography.cuts_by_hand import cuts_at, read_times
from app.choreography.derived_rhythm import audible_rhythm
from app.choreography.learn import Pair, stored
from app.choreography.read_motion import ReadMotion, guesses, read_motion
from app.encoding import guessed, shown
from app.errors import FileError, Message
from app.formats.files import read_file
from app.score.contents import uncast_score
from app.score.model import Score
from app.score.read import read_contents

CREDITS_SUFFIX: Final = ".txt"
MOST_CREDITS_BYTES: Final = 2**20


@dataclass(frozen=True, eq=False)
class ReadPair:
    """A pair, what was guessed about its motion's file, and its music as it is heard."""

    pair: Pair
    motion: ReadMotion
    score: Score


def read_pair(
    motion: Path,
    music: Path,
    *,
    offset_s: float | None = None,
    fps: Fraction | None = None,
    credits: Path | None = None,
    cuts: Path | None = None,
    joints: Mapping[str, str] | None = None,
    figure: str = "",
) -> ReadPair:
    """Read a pair.

    Parameters
    ----------
    motion : Path
        A BVH, FBX or glTF file.
    music : Path
        A MIDI file or a score; without percussion its melody, bass and accents are heard.
    offset_s : float, optional
        The music's first tick is at this time of the motion's file, of which the pair's clip may be a later part
        (`ReadMotion.start_s`); without it the offset is to be found.
    fps : Fraction, optional
        The true frame rate of the motion, where its file's is wrong.
    credits : Path, optional
        Provenance and licence of the motion; without it a text file beside the motion is taken that has its name, if
        there is one.
    cuts : Path, optional
        Where the motion is cut, as times of its file (`app.choreography.cuts_by_hand.read_times`); without it the cuts
        are to be found.
    joints : mapping of str to str, optional
        Corrections of the motion's bones by joint, see `app.choreography.raw_skeleton.JOINTS`; empty: none.
    figure : str
        Root of the motion's skeleton where its file has several; empty: the first that is a body.

    Raises
    ------
    AppError
        A file cannot be read, is none of the kind, or has cuts that do not fit the motion.
    """
    read = read_motion(motion, fps, joints, figure)
    score = uncast_score(read_contents(music))
    rhythm = audible_rhythm(score)
    if not len(rhythm.hits_s):
        raise FileError("learn.no_notes", file=str(music))
    beside = motion.with_suffix(CREDITS_SUFFIX)
    if credits is None and os.path.isfile(beside):
        credits = beside
    text = "" if credits is None else guessed(read_file(credits, MOST_CREDITS_BYTES)).strip()
    of_clip_s = None if offset_s is None else offset_s - read.start_s
    pair = Pair(read.clip, shown(motion.name), rhythm, shown(music.name), of_clip_s, text, unfit=read.cleaned.unfit)
    return ReadPair(pair if cuts is None else _cut(pair, read, read_times(cuts)), read, score)


def to_check(read: ReadPair) -> list[Message]:
    """Guesses about the motion, and the note that its music has no percussion."""
    music = [Message("learn.derived", {"music": read.pair.music_name})] if read.pair.rhythm.derived else []
    return [*guesses(read.motion), *music]


def _cut(pair: Pair, read: ReadMotion, times_s: Sequence[Sequence[float]]) -> Pair:
    """The pair, cut at times of its motion's file."""
    clip = stored(pair.motion)
    of_clip_s = [[time_s - read.start_s for time_s in group] for group in times_s]
    return replace(pair, cuts=cuts_at(of_clip_s, clip.fps, angular_acceleration(clip), pair.motion_name))
