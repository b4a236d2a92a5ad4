"""Performers: players of parts, and dancers."""

from __future__ import annotations

from typing import Annotated

import msgspec

from app.plan.parameters import SEED, Parameter, PlayerParameters
from app.project import limits
from app.project.casting import StagePosition
from app.rig.people.wardrobe import NO_CHOICE, OutfitChoice


class Player(msgspec.Struct, frozen=True):
    """A musician playing one part.

    Attributes
    ----------
    id : str
        Stays the same whatever the player is called.
    name : str
        Unique in the project, also where case does not count.
    colour : str
        ``"#rrggbb"``; empty: the theme's, by the player's place in the project.
    muted, soloed : bool
        Whether the player sounds; a muted player is still shown and exported.
    doubles : str
        Id of the player whose body plays this instrument too, as a flutist's plays the piccolo; empty: a body of its
        own. The character, parameters, place and outfit of the musician are stored with that player.
    outfit : OutfitChoice
        What the body wears.
    """

    id: str
    name: str
    part_id: str
    instrument_id: str
    character_id: str
    parameters: PlayerParameters
    stage: StagePosition
    colour: str = ""
    muted: bool = False
    soloed: bool = False
    doubles: str = ""
    outfit: OutfitChoice = NO_CHOICE


class Dancer(msgspec.Struct, frozen=True):
    """A performer who moves to the piece as a choreography has it.

    Attributes
    ----------
    id : str
        Stays the same whatever the dancer is called; unique among players and dancers.
    name : str
        Unique among players and dancers, also where case does not count.
    choreography : str
        Absolute path of a ``.choreography`` file as this machine knows it, or the name of a bundled one (see
        `app.project.choreography_files`); a project's file keeps a path relative to itself.
    stage : StagePosition
        Where the dance begins, and which way the dancer faces.
    delay_beats : float
        How much later than the music the dance begins, in felt beats: two dancers of one seed dance in canon.
    mirrored : bool
        Left and right are exchanged.
    source : int
        Index of the choreography's source whose segments are preferred; -1: none is.
    size : float
        Of the motion, 0..1.5; 1: as captured.
    weight : float
        -1..1, from light to heavy: how deep the knees bend; 0: as captured.
    melody : float
        0..1: how much melody, bass and accents count beside percussion; a piece without percussion is danced by them.
    colour : str
        ``"#rrggbb"``; empty: the theme's.
    outfit : OutfitChoice
        What the body wears.
    """

    id: str
    name: str
    choreography: str
    character_id: str
    stage: StagePosition
    # fmt: off
    seed: Annotated[int, Parameter(section="dancer", bounds=SEED, is_own=True)] = 0
    delay_beats: Annotated[float, Parameter(
        "unit.beats", bounds=(0.0, 10_000.0), usual=32.0, step=1.0, decimals=1, section="dancer", row=1,
    )] = 0.0
    mirrored: bool = False
    source: Annotated[int, Parameter(bounds=(-1, limits.CHOREOGRAPHY_INDEX[1]))] = -1
    size: Annotated[float, Parameter("unit.times", section="dancer", bounds=(0.0, 1.5))] = 1.0
    weight: Annotated[float, Parameter(section="dancer", bounds=(-1.0, 1.0), since=8)] = 0.0
    melody: Annotated[float, Parameter(section="dancer", bounds=(0.0, 1.0), since=16)] = 0.5
    # fmt: on
    colour: str = ""
    outfit: OutfitChoice = NO_CHOICE
