"""Problems of a player's body with its instrument: missing features and notes out of reach."""

from __future__ import annotations

from typing import Final, NamedTuple

from app.contacts.missed_contacts import missed_message
from app.contacts.reach import Holding, Reached, hand_reach
from app.errors import AppError, Message
from app.performance.bodies import body_of, character_of, hidden_on, hold_of, is_held, is_strained, suited_to
from app.performance.hats import left_off_message
from app.plan.model import FingeringEvent, Problem
from app.plan.parameters import PlayerParameters
from app.project.casting import StagePosition
from app.project.performers import Player
from app.rig.characters.character_library import character_revision, our_characters
from app.rig.grip.whole_hands import slid_message
from app.rig.people.bundled_people import not_cast_for
from app.steps import StepRuns, StepTable
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap


class BodyProblems(NamedTuple):
    """Problems of one player's body.

    Attributes
    ----------
    lacking : tuple of Message
        Messages about features that the body lacks for the instrument, for the whole performance.
    unreached : tuple of Problem
        Notes out of reach.
    unseen : Message or None
        Reason why the player cannot be shown.
    """

    lacking: tuple[Message, ...]
    unreached: tuple[Problem, ...] = ()
    unseen: Message | None = None


def body_problems(
    player: Player,
    instrument: InstrumentMap,
    fingerings: tuple[FingeringEvent, ...],
    waiting: bool,
    runs: StepRuns,
) -> BodyProblems:
    """Find the problems of a player's body with its instrument.

    Parameters
    ----------
    instrument : InstrumentMap
        Map of the instrument library.
    waiting : bool
        Whether another task is computing the grip.
    runs : StepRuns
        Cache of earlier results.
    """
    try:
        held, lacking = suited_to(player, instrument)
        # Bundled holds meet all contacts of bundled instruments; for others it is reported when known.
        ours = player.character_id in our_characters() and bundled_maps().get(instrument.id) is instrument
        known = not ours and not waiting and is_held(player, instrument)
        if instrument.id in not_cast_for(player.character_id) or (known and is_strained(character_of(player), held)):
            lacking = (*lacking, Message("character.not_cast", {}))
        if waiting:
            return BodyProblems((*lacking, Message("character.hold_waiting", {})))
        grip = hold_of(player, held) if known else None
        found = () if grip is None else (missed_message(grip), slid_message(grip.slid_m), hidden_on(player, held))
        if is_held(player, instrument):
            found = (*found, left_off_message(player, held))
        revision = character_revision(player.character_id)
        given = {"instrument": held, "revision": revision, "fingerings": fingerings}
        unreached = runs.begin(REACH, player.id, player=_posed(player), **given).of(_reached).problems
        return BodyProblems((*lacking, *(one for one in found if one is not None)), unreached)
    except AppError as error:
        # A model or character that cannot be read is a problem of this player only; the others are shown.
        return BodyProblems((error.message,), unseen=error.message)


def _posed(player: Player) -> Player:
    """Return the player with only the data that affect reach (character, instrument and posture), as key of a cache."""
    posture = PlayerParameters(posture=player.parameters.posture)
    return Player(player.id, "", "", player.instrument_id, player.character_id, posture, StagePosition(0.0, 0.0, 0.0))


def _reached(
    player: Player,
    instrument: InstrumentMap,
    revision: int,
    fingerings: tuple[FingeringEvent, ...],
    before: Reached | None,
) -> Reached:
    def holding() -> Holding:
        posture = player.parameters.posture
        return Holding(player.id, character_of(player), hold_of(player, instrument), body_of(player), posture)

    return hand_reach(before, (player, revision), instrument, fingerings, holding)


REACH: Final = StepTable(reached=_reached)
