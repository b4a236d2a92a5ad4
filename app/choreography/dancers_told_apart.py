"""Test of a learned choreography: do its sounds show whose motion is danced to them?

Two thirds of the motions of each dancer are learned from; each motion of the last third is given to the dancer whose
sounds were most like those during it.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from app.choreography.copied_takes import takes_of
from app.choreography.drums_of_dancers import drums_of
from app.choreography.held_out import evidence_of, sounds_of
from app.choreography.model import ChoreographyModel
from app.choreography.music_motion_dependence import LEARNED, report
from app.errors import Message

LEAST: Final = 5
"""Least number of motions with sounds that are held out of each dancer."""
MOST_NAMED: Final = 4
"""Greatest number of copies that are named."""


def reports(model: ChoreographyModel) -> tuple[Message, ...]:
    """Return messages about what the music of a model predicts: the motion of a dancer, and the dancer, if it has
    several; and about sources that count once because they are copies of one take.
    """
    said = [report(model), *_copies(model)]
    share = share_told_apart(model)
    if share is not None:
        by_chance = 1.0 / (1 + int(takes_of(model.clips).takes.max()))
        id_ = "learn.dancers_told_apart" if share >= 0.5 * (1.0 + by_chance) else "learn.dancers_alike"
        said.insert(1, Message(id_, {"share": round(100.0 * share), "chance": round(100.0 * by_chance)}))
    return tuple(said)


def _copies(model: ChoreographyModel) -> list[Message]:
    takes = takes_of(model.clips).takes
    found = []
    for take in np.flatnonzero(np.bincount(takes) > 1).tolist():
        names = [model.sources[clip].motion_name for clip in np.flatnonzero(takes == take)]
        more = len(names) - MOST_NAMED
        listed = ", ".join([*names[:MOST_NAMED], *(["…"] if more > 0 else [])])
        found.append(Message("learn.copies_count_once", {"count": len(names), "motions": listed}))
    return found


def share_told_apart(model: ChoreographyModel) -> float | None:
    """Return the share of the held-out motions that are given to their own dancer, the mean of the dancers'; None for
    fewer than two dancers or too few motions. Copies of a take are one dancer.
    """
    found, sounds = evidence_of(model), sounds_of(model)
    dancers = 1 + int(found.takes.max(initial=-1))
    learned, held_out = (found.within(start, stop).tolist() for start, stop in ((0.0, LEARNED), (LEARNED, np.inf)))
    heard = [one.sounds for one in model.segments]
    shares = drums_of(found.takes[learned], [heard[at] for at in learned], dancers).shares
    held_out = [at for at in held_out if heard[at]]
    takes = found.takes[held_out]
    fit = sounds[held_out] @ np.log(np.maximum(shares, 1e-12)).T
    best = np.isclose(fit, fit.max(axis=1, keepdims=True))
    # Who is as likely as others is named by chance.
    own_share = best[np.arange(len(takes)), takes] / best.sum(axis=1)
    asked = [own_share[takes == dancer] for dancer in range(dancers)]
    if len(asked) < 2 or min(map(len, asked)) < LEAST:
        return None
    return float(np.mean([own.mean() for own in asked]))
