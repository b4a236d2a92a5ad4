"""Names of edits, as the undo list shows them."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    # The piece
    "edit.piece_settings": "settings of the piece",
    # The recording
    "edit.estimate_offset": "estimated offset of the recording",
    "edit.fit_tempo": "offset and tempo fitted to the recording",
    "edit.remove_audio": "remove the recording",
    "edit.set_audio": "another recording",
    # Events of the plan
    "edit.move_events": "move {count} {count:event|events}",
    "edit.resize_events": "resize {count} {count:event|events}",
    "edit.set_event_amount": "change how much of {count} {count:event|events}",
    "edit.set_fades": "change fades",
    "edit.set_expression": "change the expression",
    "edit.set_embouchure": "change the embouchure of {count} {count:note|notes}",
    "edit.pin_fingerings": "fingering of {count} {count:note|notes}",
    "edit.add_breath": "add a breath",
    "edit.add_cue": "add a cue",
    "edit.add_gesture": "add a gesture",
    "edit.add_expression": "add an expression",
    "edit.toggle_preparation": "preparation on or off",
    "edit.remove_events": "delete {count} {count:event|events}",
    "edit.give_back": "back to the generator's",
    "edit.change_expression": "face of {expression}",
    "edit.own_expression": "an expression made from {expression}",
    "edit.rename_expression": "rename an expression",
    "edit.remove_expression": "remove {expression}",
    "expression.kept": "{name} is kept for other projects",
    "edit.reattach": "re-attach a correction",
    "edit.give_back_player": "revert all corrections of {player}",
    "edit.set_offset": "offset of the recording",
    "edit.no_note_to_breathe_for": "there is no note after this place to breathe for",
    "edit.no_such_fingering": "{label} is no fingering of this note; there are: {known}",
    "problems.none": "there are no problems",
    "edit.no_note_to_cue": "there is no note after this place to give a cue to",
    # Generating
    "edit.vary_everyone": "another performance by everyone",
    "edit.vary_players": "another performance by players: {count}",
    "edit.vary_span": "another performance of some bars",
    "edit.unvary_span": "some bars as at first",
    "generate.kept": "performed anew; corrections kept: {kept}",
    "generate.kept_and_lost": (
        "performed anew; corrections kept: {kept}; without a place now, kept all the same: {lost}"
    ),
    # Poses
    "edit.hold_bell": "hold the bell differently",
    "edit.hold_head": "hold the head differently",
    "edit.hold_left_elbow": "hold the left elbow differently",
    "edit.hold_right_elbow": "hold the right elbow differently",
    "edit.hold_torso": "hold the torso differently",
    "edit.release_pose": "pose back to the generator's",
    # Dances
    "edit.pin_dance": "{dancer} dances basic motion {number}",
    "edit.use_dance_segment": "{dancer} dances another segment",
    "edit.move_dance_motion": "move a motion of {dancer}",
    "edit.forbid_dance": "{dancer} does not dance basic motion {number}",
    "edit.release_dance": "dance of {dancer} back to the generator's",
    # Players
    "edit.add_dancer": "add a dancer",
    "edit.duplicate_dancer": "duplicate {dancer}",
    "edit.remove_dancer": "remove {dancer}",
    "edit.rename_dancer": "rename {dancer}",
    "edit.move_dancers": "order of the dancers",
    "edit.dancer_choreography": "choreography of {dancer}",
    "edit.dancer_character": "character of {dancer}",
    "edit.dancer_parameter": "{parameter} of {dancer}",
    "edit.dancer_mirrored": "mirror {dancer}",
    "edit.dancer_place": "place {dancer} on the stage",
    "edit.rename_player": "rename {player}",
    "edit.add_player": "add {player}",
    "edit.duplicate_players": "duplicate players: {count}",
    "edit.remove_players": "remove players: {count}",
    "edit.move_players": "order of the players",
    "edit.mute": "mute players: {count}",
    "edit.unmute": "unmute players: {count}",
    "edit.solo": "solo players: {count}",
    "edit.unsolo": "end of solo for players: {count}",
    "edit.player_part": "another part for players: {count}",
    "edit.player_instrument": "another instrument for players: {count}",
    "edit.player_character": "another character for players: {count}",
    "edit.player_colour": "colour of players: {count}",
    "edit.parameter": "{parameter}, players: {count}",
    "edit.reset_parameters": "reset players: {count}",
    "edit.randomise_players": "randomise players: {count}",
    "edit.place_players": "place players: {count}",
    "edit.arrange_players": "automatic arc",
    "edit.apply_preset": "preset {preset} for players: {count}",
    "preset.saved": "the preset {name} is saved",
    "player.too_many": "a project can have {most} players",
    "player.no_name": "a name must have at least one sign that can be seen",
    "dancer.too_many": "a project can have {most} dancers",
    "dancer.no_choreography": (
        "{file} is neither a choreography file (.choreography) nor a choreography that comes with the program; choose "
        "one of these"
    ),
    "edit.reimport": "re-import the MIDI file",
}
