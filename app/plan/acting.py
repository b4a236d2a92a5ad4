"""How much of each layer a player shows: the parameters, and what style and habits make of them."""

from __future__ import annotations

import msgspec

from app.plan.parameters import PlayerParameters


class Acting(msgspec.Struct, frozen=True):
    """Amounts of a player's layers; 1 is what a good concert shows, 0 nothing of the layer.

    Attributes
    ----------
    sway, weight_shift, bell_height : float
        Leaning with the music, moving from foot to foot, the bell with the melody.
    phrase : float
        What trunk and head do by phrase, bar and accent.
    stillness : float
        Share 0..1 of the bars in which trunk and head keep still.
    footwork, tap : float
        Heels, steps to the other foot; how often toes tap with the beat.
    breath : float
        How much chest, belly and shoulders show the air.
    cue : float
        Size of nods and bell at an entry.
    face : float
        Brows, lids, cheeks and nostrils.
    lips : float
        What the lips do within a held note.
    gaze : float
        How much the eyes leave the music.
    blink : float
        How often the lids close.
    gestures : float
        What is done before the first note, in long rests and after the last.
    """

    sway: float = 1.0
    weight_shift: float = 1.0
    bell_height: float = 1.0
    phrase: float = 1.0
    stillness: float = 0.25
    footwork: float = 1.0
    tap: float = 1.0
    breath: float = 1.0
    cue: float = 1.0
    face: float = 1.0
    lips: float = 1.0
    gaze: float = 1.0
    blink: float = 1.0
    gestures: float = 1.0


def acting_of(parameters: PlayerParameters) -> Acting:
    """What a player with these parameters shows."""
    return Acting(sway=parameters.sway, weight_shift=parameters.weight_shift, bell_height=parameters.bell_height)
