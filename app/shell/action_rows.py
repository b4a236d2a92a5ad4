"""All rows of the action table, in the order of the menus."""

from __future__ import annotations

from typing import Any, Final

from app.optional_features import extended
from app.shell.action import ActionRow
from app.shell.commands import (
    application,
    camera_bookmarks,
    characters,
    edit,
    events,
    exchange,
    file,
    fingerings,
    generate,
    help,
    marks,
    notes,
    piece_metadata,
    playback,
    players,
    problems,
    record,
    takes,
    timeline,
    video,
    viewport,
)

FILE_ORDER: Final = (
    "file.new",
    "file.open",
    "file.open_example",
    "file.open_danced_example",
    "file.save",
    "file.save_as",
    "file.import_midi",
    "file.reimport",
    "file.reimport_other",
    "file.add_audio",
    "file.add_video",
    "file.add_character",
    "file.export_midi",
    "file.save_metadata",
    "file.load_metadata",
    "file.compare_metadata",
    "file.rules",
    "file.metadata_folder",
    "file.piece_settings",
    "file.close",
    "file.quit",
)
"""Order of the rows of the first menu, whichever module they are from."""


def rows() -> tuple[ActionRow[Any], ...]:
    """Return all rows of the table of actions, in the order in which the preferences list them."""
    place = {action_id: number for number, action_id in enumerate(FILE_ORDER)}
    own: tuple[ActionRow[Any], ...] = (
        *(*file.ACTIONS, *exchange.ACTIONS, *edit.ACTIONS, *notes.ACTIONS, *marks.ACTIONS, *fingerings.ACTIONS),
        *(*events.ACTIONS, *edit.FELT_BEATS, *players.ACTIONS, *timeline.ACTIONS, *viewport.ACTIONS),
        *camera_bookmarks.ACTIONS,
        *(*video.ACTIONS, *playback.ACTIONS, *record.ACTIONS, *takes.ACTIONS, *generate.ACTIONS, *problems.ACTIONS),
        *(*characters.ACTIONS, *piece_metadata.ACTIONS, *help.ACTIONS, *application.ACTIONS),
    )
    found = extended(own, "actions", lambda row: row.id)
    # Rows of optional features come before the last two, which close the piece and the program.
    others = {"file": place["file.close"] - 0.5}
    return tuple(sorted(found, key=lambda row: place.get(row.id, others.get(row.menu, len(place)))))
