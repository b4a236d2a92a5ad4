"""Names and refusals of edits of notes."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "edit.add_note": "add a note",
    "edit.erase_notes": "erase {count} {count:note|notes}",
    "edit.move_notes": "move {count} {count:note|notes}",
    "edit.transpose_notes": "transpose {count} {count:note|notes}",
    "edit.nudge_notes": "nudge {count} {count:note|notes}",
    "edit.resize_notes": "length of {count} {count:note|notes}",
    "edit.split_notes": "split {count} {count:note|notes}",
    "edit.join_notes": "join {count} {count:note|notes}",
    "edit.duplicate_notes": "duplicate {count} {count:note|notes}",
    "edit.change_velocity": "velocity of {count} {count:note|notes}",
    "edit.quantise_notes": "quantise {count} {count:note|notes}",
    "edit.cut_notes": "cut {count} {count:note|notes}",
    "edit.paste_notes": "paste {count} {count:note|notes}",
    "edit.set_tempo": "set the tempo",
    "edit.move_tempo": "move a tempo",
    "edit.move_metre": "move a metre change",
    "edit.remove_tempo": "remove a tempo",
    "edit.set_felt_beat": "set the felt beat",
    "edit.set_metre": "set the metre",
    "edit.remove_metre": "remove a metre",
    "note.before_start": "A note would begin before the piece.",
    "note.after_all_pieces": "A note would end later than any piece can last.",
    "note.pitch_outside": "There is no pitch {pitch}; pitches go from {low} to {high}.",
    "note.velocity_outside": "There is no velocity {velocity}; velocities go from {low} to {high}.",
    "note.too_short": "A note needs a length of at least one tick.",
    "note.nothing_to_split": "No chosen note sounds across this place: there is nothing to split.",
    "note.nothing_to_join": "To join notes, choose two or more of one pitch that follow one another.",
    "note.nothing_to_paste": "There are no notes on the clipboard: copy some first.",
    "note.nowhere_to_paste": "There is no player to paste the notes to: add one first.",
}
