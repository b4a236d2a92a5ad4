"""Names and refusals of edits of notes."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "edit.add_note": "Add note",
    "edit.erase_notes": "Erase notes",
    "edit.move_notes": "Move notes",
    "edit.transpose_notes": "Transpose notes",
    "edit.nudge_notes": "Nudge notes",
    "edit.resize_notes": "Change length of notes",
    "edit.split_notes": "Split notes",
    "edit.join_notes": "Join notes",
    "edit.duplicate_notes": "Duplicate notes",
    "edit.change_velocity": "Change velocity",
    "edit.quantise_notes": "Quantise notes",
    "edit.cut_notes": "Cut notes",
    "edit.paste_notes": "Paste notes",
    "notes.before_start": "A note would begin before the piece.",
    "notes.pitch_outside": "There is no pitch {pitch}; pitches go from {low} to {high}.",
    "notes.velocity_outside": "There is no velocity {velocity}; velocities go from {low} to {high}.",
    "notes.too_short": "A note needs a length of at least one tick.",
    "notes.nothing_to_split": "No chosen note sounds across this place: there is nothing to split.",
    "notes.nothing_to_join": "To join notes, choose two or more of one pitch that follow one another.",
    "notes.nothing_to_paste": "There are no notes on the clipboard: copy some first.",
    "notes.nowhere_to_paste": "There is no player to paste the notes to: add one first.",
}
