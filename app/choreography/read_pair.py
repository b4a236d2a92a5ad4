"""Reading of the files of a motion, its music and its credits as a pair to learn from."""

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
    """A motion and its music as read for learning, with the notes about what was guessed in their files."""

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
    """Read a motion, its music and its credits from files, as a pair to learn from.

    Parameters
    ----------
    motion : Path
        A BVH, FBX or glTF file.
    music : Path
        MIDI file or score; without percussion, its melody, bass and accents are used.
    offset_s : float, optional
        Time of the motion file at the music's first tick in seconds; by default found automatically. The pair's clip
        may start later (`ReadMotion.start_s`).
    fps : Fraction, optional
        True frame rate of the motion, if its file's is wrong.
    credits : Path, optional
        Provenance and licence of the motion; by default a text file of the same name beside the motion, if there is
        one.
    cuts : Path, optional
        Cuts as times of the motion file (`app.choreography.cuts_by_hand.read_times`); by default found automatically.
    joints : mapping of str to str, optional
        Corrected bones by joint, see `app.choreography.raw_skeleton.JOINTS`; empty for none.
    figure : str
        Root of the motion's skeleton in a file with several; empty for the first that is a body.

    Raises
    ------
    AppError
        A file cannot be read, has another format, or contains cuts that do not fit the motion.
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
    """Return messages about what the user should check in a pair: guesses about the motion, and music without
    percussion.
    """
    music = [Message("learn.derived", {"music": read.pair.music_name})] if read.pair.rhythm.derived else []
    return [*guesses(read.motion), *music]


def _cut(pair: Pair, read: ReadMotion, times_s: Sequence[Sequence[float]]) -> Pair:
    """Add cuts to the pair, given as times of its motion file."""
    clip = stored(pair.motion)
    of_clip_s = [[time_s - read.start_s for time_s in group] for group in times_s]
    return replace(pair, cuts=cuts_at(of_clip_s, clip.fps, angular_acceleration(clip), pair.motion_name))
