"""Learning of a choreography from pairs of motion and music.

Source: K. Kameda, I. Watanabe, M. Yamamoto, "Music Driven Computer Animation Based On HMM": motions are cut
(`app.choreography.cuts`) and classified (`app.choreography.basic_motions`); the states are then visible and their
probabilities counted (`app.choreography.hidden_markov`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from app.choreography.basic_motions import classify
from app.choreography.clip import MotionClip
from app.choreography.cuts import Cut, Segmentation, segment
from app.choreography.cuts_by_hand import check_cuts
from app.choreography.features import features
from app.choreography.hidden_markov import count
from app.choreography.model import ChoreographyModel, MotionSegment, TrainingPair
from app.choreography.music_offset import MusicOffset, find_offset
from app.choreography.resample import resampled
from app.choreography.rhythm import Rhythm
from app.encoding import shown
from app.errors import Message, UsageError
from app.formats.motion_limits import KEPT_FPS

FPS: Final = KEPT_FPS
"""Frame rate of the motion in a model."""
SMOOTHING: Final = 1.0
"""Observations added to every distribution, see `app.choreography.hidden_markov.count`."""
MOSTLY: Final = 0.5
"""Share of captures that cannot be learned from above which that is why there is no motion."""


@dataclass(frozen=True, eq=False)
class Pair:
    """A motion and the music to which it was danced.

    Attributes
    ----------
    motion_name : str
        Name of the motion file, without folders.
    offset_s : float or None
        Time of the motion at the music's first tick in seconds; None to find it.
    credits : str
        See `app.choreography.model.TrainingPair`.
    cuts : tuple of Cut or None
        Cuts in frames of the motion at `FPS` set by the user; None to find them (`app.choreography.cuts.segment`).
    unfit : tuple of (start, stop)
        Spans of the motion's frames not to learn from (`app.choreography.cleaning.CleanedClip.unfit`), even if the
        user's cuts include them.
    """

    motion: MotionClip
    motion_name: str
    rhythm: Rhythm
    music_name: str
    offset_s: float | None = None
    credits: str = ""
    cuts: tuple[Cut, ...] | None = None
    unfit: tuple[tuple[int, int], ...] = ()


@dataclass(frozen=True, eq=False)
class Analysis:
    """Analysis of a pair before learning.

    Attributes
    ----------
    clip : MotionClip
        Motion in the form of a model, at `FPS`.
    segmentation : Segmentation
        Cuts of this clip, without those in unfit spans.
    unfit : tuple of (start, stop)
        Frames of this clip not to learn from.
    offset : MusicOffset
        Start of the music as found automatically, even if the pair has one.
    """

    clip: MotionClip
    segmentation: Segmentation
    offset: MusicOffset
    unfit: tuple[tuple[int, int], ...] = ()


def analyse(pair: Pair) -> Analysis:
    """Cut a pair's motion into segments, and find the start of its music."""
    clip = stored(pair.motion)
    found, unfit = segment(clip), _unfit(pair)
    fit = replace(found, cuts=_fit(found.cuts, unfit))
    return Analysis(clip, fit, find_offset(clip, pair.rhythm), unfit)


def require_usable(pair: Pair) -> None:
    """Raise UsageError if nothing can be learned from a pair: there is no motion, music and motion do not overlap, or
    its cuts do not fit its motion.
    """
    clip = stored(pair.motion)
    cuts = _cuts(pair, clip)
    if not cuts:
        raise _no_motion([pair])
    _require_sounds(pair, _sounds(pair.rhythm, _source(pair, clip), [(cut.start, cut.end) for cut in cuts]))


def _no_motion(pairs: Sequence[Pair]) -> UsageError:
    """Return the error of pairs without motion to learn from; it says so if most of it cannot be used."""
    unfit = sum(stop - start for pair in pairs for start, stop in pair.unfit)
    share = unfit / max(1, sum(len(pair.motion) for pair in pairs))
    motions = ", ".join(pair.motion_name for pair in pairs)
    if share > MOSTLY:
        return UsageError("learn.no_sound_motion", motions=motions, percent=round(100.0 * share))
    return UsageError("learn.no_motion", motions=motions)


def learn(
    pairs: Sequence[Pair],
    *,
    states: int | None,
    seed: int,
    name: str,
    progress: Callable[[float, str], None] = lambda fraction, label: None,
) -> ChoreographyModel:
    """Learn a choreography from pairs of motion and music.

    Parameters
    ----------
    states : int or None
        Number of basic motions; None to choose it (`app.choreography.basic_motions.SPREAD`).
    seed : int
        Seed of k-means. Equal pairs, states and seed give a bitwise equal model.
    progress : callable
        Called with the completed share of the work and the current step; an exception raised by it stops the work.

    Raises
    ------
    UsageError
        There is no motion, there are fewer motions than states, music and motion of a pair do not overlap, or its cuts
        do not fit its motion.
    """
    clips, sources, cuts = [], [], []
    for number, pair in enumerate(pairs):
        progress(number / (len(pairs) + 1), pair.motion_name)
        clip = stored(pair.motion)
        clips.append(clip)
        sources.append(_source(pair, clip))
        cuts.append(_cuts(pair, clip))
    classifying = len(pairs) / (len(pairs) + 1)
    progress(classifying, name)
    total = sum(map(len, cuts))
    if not total:
        raise _no_motion(pairs)
    if states is not None and states > total:
        raise UsageError("learn.states", states=states, segments=total)
    found = classify(
        np.concatenate([features(*each) for each in zip(clips, cuts, strict=True)]),
        states,
        seed,
        lambda: progress(classifying, name),
    )
    segments = tuple(
        MotionSegment(clip, cut.start, cut.accent, cut.end, int(state))
        for (clip, cut), state in zip(
            ((clip, cut) for clip, those in enumerate(cuts) for cut in those), found, strict=True
        )
    )
    of_clips = [
        _sounding(pair, source, [one for one in segments if one.clip == clip])
        for clip, (pair, source) in enumerate(zip(pairs, sources, strict=True))
    ]
    transition, emission, initial = count(
        [np.array([one.state for one in those], np.int64) for those in of_clips],
        [[np.array(one.sounds, np.int64) for one in those] for those in of_clips],
        int(found.max()) + 1,
        smoothing=SMOOTHING,
    )
    progress(1.0, name)
    every = tuple(one for those in of_clips for one in those)
    return ChoreographyModel(name, tuple(sources), tuple(clips), every, transition, emission, initial)


def summary(model: ChoreographyModel, file: Path) -> Message:
    """Return a message about the size of a learned model."""
    return Message(
        "learn.done",
        {
            "file": shown(str(file)),
            "states": model.states,
            "segments": len(model.segments),
            "length_s": sum(clip.length_s for clip in model.clips),
            "frames": sum(map(len, model.clips)),
        },
    )


def stored(motion: MotionClip) -> MotionClip:
    """Convert a motion to the precision of a file (at `FPS`, float32), so that a model is equal before and after
    writing.
    """
    clip = resampled(motion, FPS)
    return replace(
        clip,
        hips_m=clip.hips_m.astype(np.float32).astype(np.float64),
        rotations=clip.rotations.astype(np.float32).astype(np.float64),
    )


def _cuts(pair: Pair, clip: MotionClip) -> tuple[Cut, ...]:
    if pair.cuts is not None:
        check_cuts(pair.cuts, len(clip), pair.motion_name)
    return _fit(segment(clip).cuts if pair.cuts is None else pair.cuts, _unfit(pair))


def _unfit(pair: Pair) -> tuple[tuple[int, int], ...]:
    """Return the spans (start, stop) of frames at `FPS` that the user excluded from learning."""
    rate = FPS / pair.motion.fps
    return tuple((math.floor(start * rate), math.ceil(stop * rate)) for start, stop in pair.unfit)


def _fit(cuts: Sequence[Cut], unfit: Sequence[tuple[int, int]]) -> tuple[Cut, ...]:
    """Return the cuts that do not overlap the spans of frames excluded by the user."""
    return tuple(cut for cut in cuts if all(cut.end <= start or stop <= cut.start for start, stop in unfit))


def _source(pair: Pair, clip: MotionClip) -> TrainingPair:
    given = pair.cuts is not None
    if pair.offset_s is not None:
        return TrainingPair(pair.motion_name, pair.music_name, pair.offset_s, None, pair.credits, given)
    found = find_offset(clip, pair.rhythm)
    return TrainingPair(pair.motion_name, pair.music_name, found.offset_s, found.confidence, pair.credits, given)


def _sounding(pair: Pair, source: TrainingPair, segments: Sequence[MotionSegment]) -> list[MotionSegment]:
    """Add to the segments of a clip the drum sounds during each of them."""
    spans = [(one.start, one.end) for one in segments]
    sounds = _sounds(pair.rhythm, source, spans)
    _require_sounds(pair, sounds)
    melody = [()] * len(segments) if pair.rhythm.melody is None else _sounds(pair.rhythm.melody, source, spans)
    return [replace(one, sounds=own, melody=tune) for one, own, tune in zip(segments, sounds, melody, strict=True)]


def _sounds(rhythm: Rhythm, source: TrainingPair, spans: Sequence[tuple[int, int]]) -> list[tuple[int, ...]]:
    """Return the symbols of the drum hits during each span of a clip's frames, in order."""
    bounds = np.array(spans, np.float64).reshape(-1, 2) / float(FPS)
    symbols = rhythm.symbols.tolist()
    within = np.searchsorted(rhythm.hits_s, bounds - source.offset_s).tolist()
    return [tuple(symbols[start:stop]) for start, stop in within]


def _require_sounds(pair: Pair, sounds: Sequence[tuple[int, ...]]) -> None:
    if sounds and not any(sounds):
        raise UsageError("learn.no_overlap", motion=pair.motion_name, music=pair.music_name)
