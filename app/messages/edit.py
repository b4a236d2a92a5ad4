"""Names of edits, as the undo list shows them."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    # Events of the plan
    "edit.move_events": "move {count} events",
    "edit.resize_events": "resize {count} events",
    "edit.set_event_amount": "change how much of {count} events",
    "edit.set_fades": "change fades",
    "edit.set_expression": "change the expression",
    "edit.set_embouchure": "change the embouchure of {count} notes",
    "edit.pin_fingerings": "fingering of {count} notes",
    "edit.add_breath": "add a breath",
    "edit.add_preparation": "add a preparation",
    "edit.add_cue": "add a cue",
    "edit.add_gesture": "add a gesture",
    "edit.add_expression": "add an expression",
    "edit.toggle_preparation": "preparation on or off",
    "edit.remove_events": "delete {count} events",
    "edit.give_back": "back to the generator's",
    "edit.give_back_player": "revert all corrections of {player}",
    "edit.set_audio_offset": "offset of the recording",
    "edit.no_note_to_breathe_for": "there is no note after this place to breathe for",
    "edit.no_note_to_cue": "there is no note after this place to give a cue to",
}
