"""Prepares the visible players one by one; a player that lacks something is excluded with the reason."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Generic, TypeVar

import msgspec

from app.errors import AppError, Cancelled, FileError, Message, StopRequested, raise_if_stopped
from app.performance.bodies import body_of, character_of, dressed_character, hold_of, model_of
from app.performance.dances import Dancing, dancing_of
from app.performance.ensemble import Performance
from app.project.performers import Dancer, Player
from app.rig.grip.grip_pose import GripPose
from app.rig.model import Character, InstrumentModel
from instrument_maps.model import InstrumentMap
from metadata.model import Body

T = TypeVar("T")
P = TypeVar("P", bound="Player | Dancer")
Wording = Callable[[Message], str]


class LeftOut(msgspec.Struct, frozen=True):
    """A player or dancer that cannot be shown, with the reason."""

    player: Player | Dancer
    reason: Message

    def message(self, wording: Wording) -> Message:
        """Return the message for the user that the player is left out, with the reason."""
        return Message("player.left_out", {"player": self.player.name, "reason": wording(self.reason)})


@dataclass(frozen=True)
class Attempt(Generic[T]):
    """Result of preparing some players.

    Attributes
    ----------
    made : dict of str to T
        Results by player id, in the order of the players.
    left_out : tuple of LeftOut
        Excluded players in the same order.
    """

    made: dict[str, T]
    left_out: tuple[LeftOut, ...]


@dataclass(frozen=True, eq=False)
class Performer:
    """A player with all inputs of its motion.

    Attributes
    ----------
    instrument : InstrumentMap
        Instrument fitted to the body (`app.performance.bodies.suited_to`).
    """

    player: Player
    character: Character
    body: Body
    instrument: InstrumentMap
    model: InstrumentModel
    grip: GripPose

    @cached_property
    def dressed(self) -> Character:
        """Return the character in the outfit chosen for the player; a character from the user's own file keeps the
        clothes of its file.
        """
        return self.character if self.character.own is not None else dressed_character(self.player)


def attempt(players: Iterable[P], make: Callable[[P], T], stop_requested: StopRequested = lambda: False) -> Attempt[T]:
    """Call ``make`` for every player or dancer; one for which it raises an `AppError` is left out, with its message as
    the reason.

    Raises
    ------
    Cancelled
        ``stop_requested`` returned true.
    """
    made, left_out = dict[str, T](), list[LeftOut]()
    for player in players:
        raise_if_stopped(stop_requested)
        try:
            made[player.id] = make(player)
        except Cancelled:
            raise
        except AppError as error:
            left_out.append(LeftOut(player, error.message))
    return Attempt(made, tuple(left_out))


def performer_of(performance: Performance, player: Player) -> Performer:
    """Collect all inputs of a player's motion; computing the grip may take seconds.

    Raises
    ------
    AppError
        The instrument or the character is missing or damaged.
    """
    for message in performance.lacking(player):
        raise AppError(message.id, **message.arguments)
    instrument = performance.held(player)
    return Performer(
        player=player,
        character=character_of(player),
        body=body_of(player),
        instrument=instrument,
        model=model_of(instrument),
        grip=hold_of(player, instrument),
    )


def performers_of(
    performance: Performance, players: Iterable[Player], stop_requested: StopRequested = lambda: False
) -> Attempt[Performer]:
    """Prepare the performer (character, instrument, plan) of each player; the result also lists failures."""
    return attempt(players, lambda player: performer_of(performance, player), stop_requested)


def dancings_of(
    performance: Performance, dancers: Iterable[Dancer], stop_requested: StopRequested = lambda: False
) -> Attempt[Dancing]:
    """Prepare the dance of each dancer; the result also lists failures."""
    return attempt(dancers, lambda dancer: dancing_of(performance, dancer), stop_requested)


def require_players(left_out: Sequence[LeftOut], file: str, wording: Wording) -> None:
    """Raise FileError if every player was left out, with the reasons; ``file`` is named in the error."""
    reasons = "; ".join(f"{one.player.name}: {wording(one.reason)}" for one in left_out)
    raise FileError("player.all_left_out", file=file, reasons=reasons)
