"""Work in the background: what is being done."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "work.open": "opening",
    "work.save": "saving",
    "work.autosave": "writing unsaved work down",
    "work.recoverable": "looking for unsaved work",
    "work.clean_up": "removing temporary files of earlier runs",
    "work.plan": "planning what {players} players do",
    "work.hold": "finding out how {players} players hold their instruments",
    "work.instruments": "reading your instruments",
    "work.load_figures": "loading the players' figures",
    "work.compare": "what the generator would do for {player}",
    "work.learn": "learning {file}",
    "work.reimport": "reading the MIDI file again",
    "work.portraits": "drawing the characters' portraits",
    "work.choreography": "reading the choreography",
    "work.dances": "finding out what the dancers dance",
    "work.stream": "looking for {host}",
    "work.character": "reading {file}",
    "work.character_add": "adding {name}",
    "work.character_picture": "drawing the character",
    "work.characters": "reading your characters",
    "work.export": "writing the files",
    "work.compare_skeleton": "comparing the skeletons with {file}",
    "work.export_midi": "writing the MIDI file",
    "work.playblast": "making the film",
    "work.synthesise": "making the sound",
    "work.read_motion": "reading {file}",
    "work.read_recording": "reading {file}",
    "work.estimate_offset": "finding the recording's offset",
}
