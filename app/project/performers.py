"""The performers of a project: players, who play parts, and dancers."""

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
        Constant id; unlike the name, it cannot be changed by the user.
    name : str
        Unique in the project, ignoring case.
    colour : str
        ``"#rrggbb"``; empty for a colour of the theme that depends on the player's place in the project.
    muted, soloed : bool
        Whether the player is silent, or sounds alone; a muted player is still shown and exported.
    doubles : str
        Id of the player whose body plays this instrument too, as a flutist also plays the piccolo; empty for a body of
        its own. Character, parameters, place and outfit are stored with the player of that id.
    outfit : OutfitChoice
        Clothes of the body.
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
    """A performer who dances to the piece by a choreography.

    Attributes
    ----------
    id : str
        Constant id, unique among players and dancers.
    name : str
        Unique among players and dancers, ignoring case.
    choreography : str
        Absolute path of a ``.choreography`` file as this machine knows it, or the name of a bundled one (see
        `app.project.choreography_files`); a project's file keeps a path relative to itself.
    stage : StagePosition
        Place and direction at the start of the dance.
    delay_beats : float
        Delay of the dance against the music in felt beats: two dancers with the same seed then dance in canon.
    mirrored : bool
        Whether left and right are exchanged.
    source : int
        Index of the choreography's source whose segments are preferred; -1 for none.
    size : float
        Size of the motion, 0..1.5; 1 as captured.
    weight : float
        Bending of the knees, -1 (light) to 1 (heavy); 0 as captured.
    melody : float
        Weight of melody, bass and accents against percussion, 0..1; a piece without percussion is danced to them alone.
    colour : str
        ``"#rrggbb"``; empty for the theme's colour.
    outfit : OutfitChoice
        Clothes of the body.
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
