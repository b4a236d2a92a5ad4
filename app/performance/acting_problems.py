"""Problems with a player's style, habits and choreography: missing ones."""

from __future__ import annotations

from typing import Protocol, cast

from app.errors import Message
from app.optional_features import modules
from app.plan.model import TimeFrame
from app.project.performers import Player
from metadata.acting import names_in
from metadata.library import MetadataLibrary


def unknown_acting(player: Player, library: MetadataLibrary) -> tuple[Message, ...]:
    """Return warnings about a style or habits of a player that do not exist any more and so have no effect."""
    styles, habits = library.styles.items, library.habits.items
    style, found = player.parameters.style, list[Message]()
    if style not in styles:
        known = ", ".join(sorted(styles))
        found.append(Message("project.style_missing", {"player": player.name, "name": style, "known": known}))
    for name in names_in(player.parameters.habits):
        if name not in habits:
            known = ", ".join(sorted(habits))
            found.append(Message("project.habit_missing", {"player": player.name, "name": name, "known": known}))
    return tuple(found)


class JudgeOfChoreographies(Protocol):
    """Protocol of the function that checks whether a player can dance a choreography; its implementation is optional,
    so the core does not import it.
    """

    def unfit_choreography(self, player: Player, frame: TimeFrame) -> Message | None:
        """Reason why a player cannot dance the selected choreography; None if it is possible or none is selected."""


def unfit_choreography(player: Player, frame: TimeFrame) -> tuple[Message, ...]:
    """Return warnings if a player cannot dance the selected choreography; loads the module that makes dances."""
    if not player.parameters.choreography:
        return ()
    for _, module in modules("dances"):
        unfit = cast(JudgeOfChoreographies, module).unfit_choreography(player, frame)
        return () if unfit is None else (unfit,)
    return (Message("project.no_dances", {"dancer": player.name}),)
