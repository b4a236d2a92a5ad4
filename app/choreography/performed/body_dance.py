"""Dances of players while they play: a body layer from the dance of a dancer with the same choreography and variation
(`app.choreography.performed.dancers`), or from one of the player's own.

If the choreography is missing or damaged, the player moves as generated, and the plan reports the reason.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Final, TypeAlias

from app.chance import performed_seed, seed_of
from app.choreography.body_layer import FPS, body_layer
from app.choreography.generate import Choreographer
from app.choreography.performed.choreographers import choreographer_of, unfit_choreography
from app.choreography.performed.dancers import GeneratedDance, dance_frame, rhythm_of
from app.choreography.player_steps import danced_feet
from app.choreography.rhythm import Rhythm
from app.identity_cache import IdentityCache
from app.motion.gestures.dance_layer import BodyLayer
from app.motion.model import frame_count
from app.performance.bodies import character_of
from app.performance.ensemble import Performance
from app.plan.model import TimeFrame
from app.project.casting import StagePosition
from app.project.performers import Dancer, Player
from app.rig.ik import leg
from app.rig.model import Character
from app.score.tempo import TempoMap

_Inputs: TypeAlias = tuple[Dancer, Choreographer, Rhythm, TempoMap, Character, TimeFrame]
ADULT_LEG_M: Final = 0.82
"""Length of the legs in metres for which the step sizes in `app.choreography.player_steps` apply."""
_LAYERS: IdentityCache[BodyLayer] = IdentityCache(64)


def layer_of(performance: Performance, player: Player) -> BodyLayer | None:
    """Return the dance that a player performs while playing, as a layer of body motion; None if none is selected, its
    amount is 0, or its file cannot be read. Cached for players with the same body and dance; making it may take
    seconds.
    """
    inputs = _inputs(performance, player)
    return None if inputs is None else _LAYERS.step(_layer, *inputs)


def layer_is_made(performance: Performance, player: Player) -> bool:
    """Return whether a player's layer is available without computing it."""
    inputs = _inputs(performance, player)
    return inputs is None or _LAYERS.has(*inputs)


def _layer(
    dancer: Dancer,
    choreographer: Choreographer,
    rhythm: Rhythm,
    tempo_map: TempoMap,
    character: Character,
    frame: TimeFrame,
) -> BodyLayer:
    dancing = GeneratedDance(dancer, choreographer, rhythm, (), tempo_map, character, frame)
    legs = leg(character.skeleton, "left").length_m / ADULT_LEG_M
    feet = danced_feet(dancing.dance(FPS), rhythm, dancer.seed, legs)
    return body_layer(dancing.motion(FPS, 0, frame_count(frame, FPS)), character, feet)


def _inputs(performance: Performance, player: Player) -> _Inputs | None:
    """Collect the inputs of a player's dance layer; equal ones are returned as the same object, for caching."""
    parameters = player.parameters
    if not parameters.choreography or parameters.dance_amount == 0.0:
        return None
    if unfit_choreography(player, performance.time_frame) is not None:
        return None
    variation = parameters.dance_variation or seed_of("dance", parameters.seed, player.id)
    seed = performed_seed(variation, performance.project.seed)
    return (
        _dancer(parameters.choreography, player.character_id, seed),
        choreographer_of(parameters.choreography),
        rhythm_of(performance),
        performance.project.score.tempo_map,
        character_of(player),
        dance_frame(performance),
    )


@lru_cache(maxsize=256)
def _dancer(choreography: str, character_id: str, seed: int) -> Dancer:
    """Return a dancer with a choreography, character and seed; the same object for equal ones."""
    return Dancer("", "", choreography, character_id, StagePosition(0.0, 0.0, 0.0), seed)
