"""Amounts of each layer for a player: the parameters, adjusted by style and habits."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import msgspec

from app.chance import chance
from app.plan.parameters import PlayerParameters
from metadata.acting import AMOUNTS, Habit, Style, names_in


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


LAYERS: Final[Mapping[str, str]] = {
    "phrase_motion": "phrase",
    "toe_taps": "tap",
    "breath_motion": "breath",
    "cue_size": "cue",
    "face_intensity": "face",
    "lip_motion": "lips",
    "blinks": "blink",
}
"""By parameter the field of `Acting` that it decides, where that is called otherwise."""
MOST: Final = 2.0
"""Largest amount, whatever style, habits and parameters multiply to: as far as a slider goes, and hands keep hold."""
_NOT_BY_SECTION: Final = frozenset({"stillness", "blinks"})
"""Less of the one is more acting, and the other is no acting."""


def acting_of(parameters: PlayerParameters) -> Acting:
    """Acting of a player with these parameters, in which style and habits are included already; see `with_style`."""
    usual = Acting()
    shown = {}
    for name in AMOUNTS:
        layer = LAYERS.get(name, name)
        shown[layer] = getattr(usual, layer) * getattr(parameters, name)
    return Acting(**{**shown, "stillness": min(shown["stillness"], 1.0)})


def with_style(
    parameters: PlayerParameters,
    player_id: str,
    section_intensity: float,
    styles: Mapping[str, Style],
    habits: Mapping[str, Habit],
) -> PlayerParameters:
    """The parameters with what style, habits, the player's own variation and the whole section make of the amounts;
    those of layers that are off are 0.

    To be done once. A style, habit or layer that is not there changes nothing.

    Parameters
    ----------
    section_intensity : float
        Multiplies what everybody shows.
    """
    style = styles.get(parameters.style)
    factors = [] if style is None else [style.factors]
    factors += [habits[name].factors for name in names_in(parameters.habits) if name in habits]
    variation = 0.0 if style is None else style.variation
    amounts = {}
    for name in AMOUNTS:
        amount: float = getattr(parameters, name)
        for factor in factors:
            amount *= getattr(factor, name)
        amount *= 1.0 + variation * (2.0 * chance("acting", name, parameters.seed, player_id) - 1.0)
        amounts[name] = min(amount if name in _NOT_BY_SECTION else amount * section_intensity, MOST)
    amounts |= {name: 0.0 for name in names_in(parameters.layers_off) if name in amounts}
    return msgspec.structs.replace(parameters, **amounts)
