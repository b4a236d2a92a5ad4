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
    # Players
    "edit.rename_player": "rename {player}",
    "edit.add_player": "add {player}",
    "edit.duplicate_players": "duplicate {count} players",
    "edit.remove_players": "remove {count} players",
    "edit.move_players": "order of the players",
    "edit.mute": "mute {count} players",
    "edit.unmute": "unmute {count} players",
    "edit.solo": "solo {count} players",
    "edit.unsolo": "end the solo of {count} players",
    "edit.player_part": "another part for {count} players",
    "edit.player_instrument": "another instrument for {count} players",
    "edit.player_character": "another character for {count} players",
    "edit.player_colour": "colour of {count} players",
    "edit.player_posture": "standing or seated: {count} players",
    "edit.player_parameter": "set {parameter} of {count} players",
    "edit.reset_parameters": "reset {count} players",
    "edit.randomise_players": "make {count} players differ",
    "edit.place_players": "place {count} players",
    "edit.arrange_players": "automatic arc",
    "edit.apply_preset": "preset {preset} for {count} players",
    "player.no_name": "a name must have at least one sign that can be seen",
}
