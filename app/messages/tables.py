"""Instrument maps, metadata, models."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "table.syntax": "{file}, line {line}, column {column}: {detail}; correct it in a text editor",
    "table.invalid": "{file}: {place}: {detail}",
    "table.not_utf8": "{file} is not UTF-8 text (byte {byte}); save it as UTF-8 in a text editor",
    "vocabulary.invalid": "{file}: {detail}",
    "gltf.not_gltf": "{file} is not a glTF 2.0 file",
    "gltf.damaged": "{file} is damaged: {what} is wrong",
    "gltf.external": "{file} needs the file {uri} beside it; only files that hold everything themselves are read",
    "gltf.unsupported": "{file} uses {what}, which is not supported",
    "gltf.too_deep": "{file} nests its nodes more than {most} deep; export the character alone",
    "gltf.too_large": "{file} describes far more data than a file of its size holds; export the character alone",
    "figure.unknown_format": "{file} is neither VRM, glTF nor FBX",
    "figure.too_large": "{file} describes more data than any character has; export the character alone",
    "figure.no_bones": "{file} has no bones: a character needs a skeleton to play with",
    "figure.scaled": "{file} makes its figure {height_m} m tall, so its unit is wrong: sizes are taken times {factor}",
    "figure.odd_height": "{file} makes its figure {height_m} m tall; if that is not meant, export it in the right unit",
    "character.incomplete": "{file} cannot play: no bone was found for {joints}; name those bones by hand",
    "character.file_missing": "{file} names {name}, which is not beside it",
    "character.odd_name": "the name of {file} has characters that cannot be shown; rename it",
    "character.taken": "{file} describes {id!r}, which is one of our own characters; give it another name",
    "character.cannot_play": "{file} cannot play; what it lacks is said above",
    "characters.joint": "{text!r} names no joint and its bone; write e.g. leftHand=Wrist_L",
    "characters.morph": "{text!r} names no shape and what makes it; write e.g. jawOpen=Mouth_A:0.8+Teeth_A:0.8",
    "instruments.invalid": "{file} is not valid; problems: {count}",
    "instruments.read_again": "read again: {maps}",
    "map.unreadable": "{file}: cannot be read: {detail}",
    "map.not_rewritten": (
        "{file}: its table of fingerings is written in a way that cannot be changed here; change it in a text editor"
    ),
    "fingering.unknown_sign": "{text!r} says nothing on this instrument; its signs are: {signs}",
    "fingering.unknown_place": "{text!r} is no place of the slide; there are: {places}",
    "fingering.twice": "{text!r} is there already for this note",
    "fingering.no_number": "{text!r} is no number of cents",
    "fingering.last": "the only fingering of a note cannot be removed",
    "map.unknown": "there is no instrument map named {id!r}",
    "figure.no_joint": "{file}: there is no joint named {joint!r}; there are: {joints}",
    "figure.no_bone": "{file} has no bone named {bone!r}, which is said to be {joint}",
    "figure.no_shape": "{file}: there is no shape of the face named {shape!r} among ARKit's",
    "figure.no_morph": "{file} has no morph named {morph!r}, which is said to make {shape}",
    "metadata.missing": "there is no {kind} named {name!r}; there are: {known}",
    "character.missing": "there is no character named {id!r}; there are: {known}",
    "character.added": "{name} is there now: choose it for a player, under Character",
    "character.landmarks_missing": "the character {id!r} lacks what playing needs: {missing}",
    "model.invalid": "{file}: {detail}",
}
