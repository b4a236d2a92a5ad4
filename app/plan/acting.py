"""Amount of each layer of acting for a player: the parameters, scaled by style and habits."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import msgspec

from app.chance import chance
from app.plan.parameters import PlayerParameters
from metadata.acting import AMOUNTS, Habit, Style, names_in


class Acting(msgspec.Struct, frozen=True):
    """Amounts of a player's layers of acting; 1 is the level of a good concert, 0 switches the layer off.

    Attributes
    ----------
    sway, weight_shift, bell_height : float
        Leaning with the music, moving from foot to foot, the bell with the melody.
    phrase : float
        Motion of trunk and head with phrase, bar and accent.
    stillness : float
        Share 0..1 of the bars in which trunk and head keep still.
    footwork, tap : float
        Amount of heel lifts and steps to the other foot; frequency of toe taps with the beat.
    breath : float
        How visibly chest, belly and shoulders breathe.
    cue : float
        Size of nods and bell at an entry.
    face : float
        Brows, lids, cheeks and nostrils.
    lips : float
        Lip motion within a held note.
    gaze : float
        Frequency of looks away from the music.
    blink : float
        Frequency of blinks.
    gestures : float
        Amount of gestures before the first note, in long rests and after the last note.
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
"""Field of `Acting` that a parameter determines, for parameters with another name than the field."""
MOST: Final = 2.0
"""Greatest product of style, habits and parameters: the maximum of a slider, at which hands still keep hold."""
_NOT_BY_SECTION: Final = frozenset({"stillness", "blinks"})
"""Amounts that the section's intensity does not scale: less stillness is more acting, and blinks are no acting."""


def acting_of(parameters: PlayerParameters) -> Acting:
    """Convert a player's parameters to amounts of acting. The parameters must already include style and habits
    (`with_style`).
    """
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
    """Return the parameters with their amounts scaled by style, habits, the player's own variation and the section's
    intensity; amounts of disabled layers become 0.

    Apply only once. Unknown styles, habits and layers have no effect.

    Parameters
    ----------
    section_intensity : float
        Factor for the acting of all players.
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
