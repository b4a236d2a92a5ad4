"""Recording in the editor."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "edit.record": "record {count} {count:take|takes}",
    "record.no_player": "There is no player to record: add one first.",
    "record.no_device": "No MIDI device is listened to: choose one in Record > Devices.",
    "record.no_place": "There is nowhere to write a take to: save the project first.",
    "record.nothing_played": "No note was played: nothing was recorded.",
    "record.player_gone": "The player who was recorded is no longer there; what was played is kept in {file}.",
    "record.device_lost": "{device} was unplugged; it is listened to again when it comes back.",
    "record.device_lost_running": (
        "{device} was unplugged; what was played is kept, and recording goes on when it comes back."
    ),
    "record.device_back": "{device} is back.",
    "record.recovered": "{count} {count:take|takes} of a recording that was cut short {count:was|were} recovered.",
}
