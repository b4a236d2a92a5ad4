"""A pair of motion and music as filled in by the user, before learning."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path

import msgspec

from app.choreography.cuts_by_hand import Cuts
from app.choreography.learn import Analysis
from app.choreography.raw_skeleton import RawSkeleton
from app.choreography.read_pair import CREDITS_SUFFIX, ReadPair
from app.errors import Message
from app.rig.motion_file import SUFFIXES as MOTION_SUFFIXES
from app.score.suffixes import MUSIC


class PairDraft(msgspec.Struct, frozen=True):
    """The user's entries for a pair of motion and music.

    Attributes
    ----------
    motion, music, credits : Path or None
        Paths, None if not chosen; default credits are those next to the motion.
    offset_s : float or None
        Time in seconds of the motion file at which the music begins; None for automatic.
    fps : Fraction or None
        Frame rate; None for that of the motion file.
    cuts : tuple of Cut or None
        Cuts in frames of the analysed clip set by the user; None for automatic.
    joints : mapping of str to str
        Corrected bones by joint; empty for none.
    figure : str
        Skeleton to learn from in a file with several; empty for the first.
    """

    motion: Path | None = None
    music: Path | None = None
    credits: Path | None = None
    offset_s: float | None = None
    fps: Fraction | None = None
    cuts: Cuts | None = None
    joints: Mapping[str, str] = msgspec.field(default_factory=dict)
    figure: str = ""

    @property
    def files(self) -> tuple[Path | None, Path | None, Path | None, Fraction | None, Mapping[str, str], str]:
        """Return those fields of the pair whose change requires reading the files again."""
        return self.motion, self.music, self.credits, self.fps, self.joints, self.figure


class PairContents(msgspec.Struct, frozen=True):
    """Motion and music read from the files of a pair, or the error; with some errors the skeleton is available too."""

    read: ReadPair | None = None
    analysis: Analysis | None = None
    error: Message | None = None
    skeleton: RawSkeleton | None = None


def offset_s_of(draft: PairDraft, found: PairContents) -> float:
    """Return the time in seconds of the motion file at which the music begins: the user's, else the automatic one, else
    0.
    """
    if draft.offset_s is not None:
        return draft.offset_s
    if found.read is None or found.analysis is None:
        return 0.0
    return found.analysis.offset.offset_s + found.read.motion.start_s


def offset_range_s(found: PairContents) -> tuple[float, float] | None:
    """Return the least and greatest offset in seconds for which percussion sounds during the motion; None before the
    files are read.
    """
    if found.read is None or found.analysis is None:
        return None
    start_s, hits_s = found.read.motion.start_s, found.read.pair.rhythm.hits_s
    return start_s - float(hits_s[-1]), start_s + found.analysis.clip.length_s - float(hits_s[0])


def is_offset_outside(draft: PairDraft, found: PairContents) -> bool:
    """Return whether no music sounds during the motion with the user's offset, as after another file was chosen."""
    bounds = offset_range_s(found)
    return bounds is not None and draft.offset_s is not None and not bounds[0] <= draft.offset_s <= bounds[1]


def with_files(drafts: Sequence[PairDraft], paths: Sequence[Path]) -> tuple[tuple[PairDraft, ...], tuple[Path, ...]]:
    """Return the pairs with files added, and the files of unsupported kinds.

    A motion or piece is added to the first pair that lacks it and whose other file has the same name, else to the first
    pair that lacks it, else to a new pair; credits to the pair whose motion has the same name, else to the last one.
    """
    kinds = [path.suffix.lower() for path in paths]
    result = list(drafts)
    for field, other, suffixes in (("motion", "music", MOTION_SUFFIXES), ("music", "motion", MUSIC)):
        files = [path for path, kind in zip(paths, kinds, strict=True) if kind in suffixes]
        # A file whose name belongs to one pair is not assigned to another.
        for path in sorted(files, key=lambda path: not _lacking(result, field, other, path)):
            at = next(iter(_lacking(result, field, other, path) or _lacking(result, field)), len(result))
            result[at:] = result[at:] or [PairDraft()]
            result[at] = msgspec.structs.replace(result[at], **{field: path})
    for path in (path for path, kind in zip(paths, kinds, strict=True) if kind == CREDITS_SUFFIX and result):
        same = [at for at, one in enumerate(result) if one.motion is not None and one.motion.stem == path.stem]
        at = same[0] if same else len(result) - 1
        result[at] = msgspec.structs.replace(result[at], credits=path)
    known = (*MOTION_SUFFIXES, *MUSIC, *([CREDITS_SUFFIX] if result else []))
    return tuple(result), tuple(path for path, kind in zip(paths, kinds, strict=True) if kind not in known)


def _lacking(drafts: Sequence[PairDraft], field: str, other: str = "", path: Path = Path()) -> list[int]:
    """Return the indices of pairs without a file in ``field``. With ``other``, only pairs whose file there has the same
    name as ``path``.
    """
    lacking = [at for at, one in enumerate(drafts) if getattr(one, field) is None]
    if not other:
        return lacking
    return [at for at in lacking if (file := getattr(drafts[at], other)) is not None and file.stem == path.stem]
