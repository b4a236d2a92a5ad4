"""Test of a learned choreography: do its sounds show whose motion is danced to them?

Two thirds of the motions of each dancer are learned from; each motion of the last third is given to the dancer whose
sounds were most like those during it.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from app.choreography.drums_of_dancers import drums_of
from app.choreography.model import ChoreographyModel
from app.choreography.music_motion_dependence import LEARNED, report
from app.choreography.rhythm import SYMBOLS
from app.errors import Message

LEAST: Final = 5
"""Least number of motions with sounds that are held out of each dancer."""


def reports(model: ChoreographyModel) -> tuple[Message, ...]:
    """Return messages about what the music of a model predicts: the motion of a dancer, and the dancer, if it has
    several."""
    share = share_told_apart(model)
    if share is None:
        return (report(model),)
    by_chance = 1.0 / len(model.clips)
    id_ = "learn.dancers_told_apart" if share >= 0.5 * (1.0 + by_chance) else "learn.dancers_alike"
    said = Message(id_, {"share": round(100.0 * share), "chance": round(100.0 * by_chance)})
    return report(model), said


def share_told_apart(model: ChoreographyModel) -> float | None:
    """Return the share of the held-out motions that are given to their own dancer, the mean of the dancers'; None for
    fewer than two dancers or too few motions."""
    clips = np.array([one.clip for one in model.segments], np.int64)
    sounds = np.zeros((len(clips), len(SYMBOLS)))
    for at, one in enumerate(model.segments):
        np.add.at(sounds[at], list(one.sounds), 1.0)
    held_out = np.zeros(len(clips), bool)
    for clip in range(len(model.clips)):
        own = np.flatnonzero(clips == clip)
        held_out[own[round(LEARNED * len(own)) :]] = True
    learned = [() if held_out[at] else one.sounds for at, one in enumerate(model.segments)]
    shares = drums_of(clips, learned, len(model.clips)).shares
    fit = sounds @ np.log(np.maximum(shares, 1e-12)).T
    best = np.isclose(fit, fit.max(axis=1, keepdims=True))
    # Who is as likely as others is named by chance.
    own_share = best[np.arange(len(clips)), clips] / best.sum(axis=1)
    asked = [own_share[held_out & sounds.any(axis=1) & (clips == clip)] for clip in range(len(model.clips))]
    if len(asked) < 2 or min(map(len, asked)) < LEAST:
        return None
    return float(np.mean([own.mean() for own in asked]))
