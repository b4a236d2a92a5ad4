"""What is wrong with how a player is to act: styles and habits that are not there.

Messages: ``project.style_missing``, ``project.habit_missing`` (player, name, known).
"""

from __future__ import annotations

from app.errors import Message
from app.project.performers import Player
from metadata.acting import names_in
from metadata.library import MetadataLibrary


def unknown_acting(player: Player, library: MetadataLibrary) -> tuple[Message, ...]:
    """What to report about a style or habits that are not there: they change nothing."""
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
