"""Projects: files, recovery, re-import."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    # Files
    "project.damaged": (
        "{file} is no project file or is damaged: {detail}; the version before it was last saved may be beside it, "
        "with .bak at the end of its name"
    ),
    "project.invalid": (
        "{file} cannot be opened: {place}: {detail}; put it right there in a text editor, or open the version before "
        "it was last saved, which has .bak at the end of its name"
    ),
    "project.newer": (
        "{file} was saved by a newer version of the program (its file version is {version}, this program knows up to "
        "{known}); open it with the newer version"
    ),
    "project.cannot_save": (
        "{file} was not saved, it could not be opened again: {place}: {detail}; undo the last edit, then save"
    ),
    "project.read_only": "{file} is write-protected; save it under another name or allow writing",
    "project.open_elsewhere": (
        "{file} is open in another window too; what is saved here and there replaces each other"
    ),
    "project.written": (
        "--written says how the pitches of a MIDI file are read; {file} is a project, whose notes are "
        "transposed in the editor"
    ),
    "project.assign": (
        "--assign gives instruments to the parts of a MIDI file; {file} is a project; there use --set "
        "'PLAYER.instrument=ID'"
    ),
    "assign.malformed": "--assign: {assignment!r} is not PART=INSTRUMENT, for instance 'Lead=trumpet_Bb'",
    "assign.instrument_unknown": "there is no instrument {instrument!r}; there are: {possible}",
    "assign.needed": "{reason} with --assign '{part}=INSTRUMENT'",
    "project.encoding": "--encoding says how the texts of a MIDI file are read; {file} is a project and needs none",
    "autosave.elsewhere": (
        "{file} cannot be autosaved in its own folder ({reason}); for now it is autosaved in {folder} and offered from "
        "there after a crash. Free some space or allow writing, or save the project in another folder"
    ),
    "autosave.refused": (
        "unsaved work is at risk: {file} can be autosaved neither in its own folder ({reason}) nor in {folder} "
        "({folder_reason}); save the project in another folder now"
    ),
    "autosave.nowhere": (
        "unsaved work is at risk: it cannot be autosaved in {folder} ({reason}); save the project in another folder now"
    ),
    "presence.refused": (
        "{file} cannot be written ({reason}): new pieces are not autosaved until they are saved to a file, and unsaved "
        "work is offered only when its file is opened; allow writing there or free some space"
    ),
    "project.instrument_missing": (
        "{player} plays the instrument {id!r}, which is not installed; choose another one or install it"
    ),
    "project.character_missing": (
        "{player} is the character {id!r}, which is not installed; choose another one or install it"
    ),
    "project.choreography_missing": (
        "{dancer} dances the choreography {name!r}, which does not come with this version of the program; choose a "
        "choreography file or one of: {known}"
    ),
    "project.choreography_file_missing": (
        "{dancer} dances the choreography {file}, which is not there; put the file back or choose another choreography"
    ),
    "project.unknown_remark": "a remark of another version of the program ({remark})",
    # Edits of the piece
    "tempo.outside": "a tempo must be from {low:g} to {high:g} quarters per minute",
    "tempo.first_stays": "what holds from the beginning can be changed, but neither moved nor removed",
    "tempo.none_here": "no tempo begins at tick {tick}",
    "tempo.place_outside": "tick {tick} lies outside every piece",
    "metre.none_here": "no metre begins at tick {tick}",
    "metre.impossible": "{numerator}/{denominator} is no metre; the lower number must be 1, 2, 4, 8, 16, 32 or 64",
    "metre.pickup_too_long": "a pickup is shorter than a whole bar: at most {most} ticks",
    "metre.inside_pickup": "no metre can begin within the pickup; change the pickup first",
    "piece.value_outside": "{what} must be from {low:g} to {high:g}",
    "piece.no_recording": "there is no recording that an offset could belong to; choose one first",
    "piece.path_unusable": "the path {path} cannot be kept in a project; rename the file or move it",
    "expression.invalid": "the expression {name!r} cannot be kept: {place}: {detail}",
    "expression.no_name": "an expression needs a name that can be seen",
    "expression.name_taken": "there is an expression {name!r} already; choose another name",
    "expression.none_of_name": "there is no expression {name!r} of your own in this project",
    # Presets
    # Re-import
    "reimport.done": "the MIDI file is taken in; notes found again: {kept}, corrections without a note: {lost}",
    "reimport.no_note": "a correction of this kind ({kind}) belongs to no note",
    "reimport.not_played": "the player does not play the note {note}; choose one of theirs",
    "preset.no_name": "a preset needs a name that can be seen",
    "preset.none_of_name": "there is no preset {name!r}",
}
