"""``suisou characters``: lists the characters, checks whether a file's figure can play, adds a character, makes a
person.
"""

from __future__ import annotations

import argparse
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from app.cli.commands import add_actions
from app.cli.options import bounded_number
from app.cli.speech import ENGLISH, Speech, said, spoken
from app.cli.terminal import say, say_json, warn
from app.cli.widths import on_left
from app.encoding import restored, shown, stored
from app.errors import AppError, Message, UsageError
from app.rig.characters.character_library import LEAST_M, MOST_M, CharacterEntry
from app.rig.people.body_shapes import age_of
from app.rig.people.bundled_people import bundled_people, bundled_person, like, our_name
from app.rig.people.person import ranges
from app.rig.people.wardrobe import wardrobe

if TYPE_CHECKING:
    from app.rig.characters.load_character import CharacterFigure

MOST_YEARS = 120.0
"""Greatest age in years that is read at all; people made from one body have a range of their own."""

_weight = bounded_number(-10.0, 10.0, "quantity.weight", float)
_height = bounded_number(LEAST_M, MOST_M, "quantity.height", float)
_years = bounded_number(0.0, MOST_YEARS, "quantity.years", float)
_percent = bounded_number(0.0, 100.0, "quantity.percent", float)


class CannotPlayError(AppError):
    """A checked figure cannot play; the reasons have been printed."""


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Declare the options of ``suisou characters``."""
    command.add_argument("--json", action="store_true")
    command.set_defaults(run=list_characters)
    actions = add_actions(command)
    check = actions.add_parser("check", help="")
    _add_file(check)
    check.add_argument("--json", action="store_true")
    check.set_defaults(run=check_character)
    add = actions.add_parser("add", help="")
    _add_file(add)
    add.add_argument("--name", default="", metavar="NAME")
    add.set_defaults(run=add_character)
    make = actions.add_parser("make", help="")
    make.add_argument("name", metavar="NAME")
    make.add_argument("--like", required=True, metavar="ID")
    make.add_argument("--height", type=_height, metavar="METRES")
    make.add_argument("--age", type=_years, metavar="YEARS")
    make.add_argument("--keep-looks", action="store_true")
    make.add_argument("--muscle", type=_percent, metavar="PERCENT")
    make.add_argument("--weight", type=_percent, metavar="PERCENT")
    make.set_defaults(run=make_person)


def _add_file(command: argparse.ArgumentParser) -> None:
    command.add_argument("file", type=Path, metavar="FILE")
    command.add_argument("--joint", action="append", default=[], metavar="JOINT=BONE")
    command.add_argument("--morph", action="append", default=[], metavar="SHAPE=MORPH[:WEIGHT][+...]")
    command.add_argument("--height", type=_height, default=0.0, metavar="METRES")
    command.add_argument("--hide", action="append", default=[], metavar="MESH")
    command.add_argument("--keep-props", action="store_true")


def list_characters(arguments: argparse.Namespace) -> None:
    """Print every character: id, title, names and file; the outfits; then the own folder and what is wrong in it."""
    from app.rig.characters.character_library import character_library, character_problems

    known = character_library()
    speech = ENGLISH if arguments.json else spoken()
    rows = [
        {
            "id": id,
            "title": _title(id, source.entry, speech),
            "names": _names(id),
            "file": stored(source.path),
            "own": source.entry is not None,
        }
        for id, source in known.sources.items()
    ]
    outfits = [
        {
            "id": id,
            "title": speech.name(outfit.title),
            "colours": {str(tint): colour for tint, colour in outfit.colours.items()},
        }
        for id, outfit in wardrobe().items()
    ]
    problems = {shown(id): speech(problem) for id, problem in character_problems().items()}
    if arguments.json:
        found = {"characters": rows, "outfits": outfits, "folder": stored(known.folder), "problems": problems}
        say_json(found)
        return
    for row in rows:
        mark, title = "*" if row["own"] else "", str(row["title"])
        called = " / ".join([title, *sorted({*_names(str(row["id"])).values()} - {title})])
        say(on_left(f"{row['id']}{mark}", 28) + f" {called}" if called else f"{row['id']}{mark}")
    if outfits:
        say("", said("characters.outfits"))
    for id, outfit in wardrobe().items():
        parts = ", ".join(f"{tint} {colour}" for tint, colour in outfit.colours.items())
        say("  " + on_left(id, 26) + f" {speech.name(outfit.title)}" + (f" ({parts})" if parts else ""))
    say("", said("cli.own_folder", folder=str(known.folder)))
    for problem in problems.values():
        say(f"  {problem}")


def _title(id: str, entry: CharacterEntry | None, speech: Speech) -> str:
    """Return the title of a character; empty if it has only an id."""
    name = our_name(id)
    return speech.name(name) if name is not None else entry.title if entry is not None else ""


def _names(id: str) -> dict[str, str]:
    """Return the names of a bundled character by language; empty for a user's own character, which has a
    title instead.
    """
    name = our_name(id)
    return {} if name is None else {"en": name.en, "ja": name.ja}


def check_character(arguments: argparse.Namespace) -> None:
    """Print the joints and shapes that were recognised in a figure.

    Raises
    ------
    CannotPlayError
        The figure cannot play.
    """
    joints, morphs = joints_of(arguments.joint), morphs_of(arguments.morph)
    speech = ENGLISH if arguments.json else spoken()
    found = checked(
        arguments.file, joints, morphs, arguments.height, arguments.hide, speech, keep_props=arguments.keep_props
    )
    if arguments.json:
        say_json(found)
    else:
        say(*as_text(found))
    if not found["plays"]:
        raise CannotPlayError("character.cannot_play", file=arguments.file.name)


def add_character(arguments: argparse.Namespace) -> None:
    """Add the character in a file to the user's characters, and print its id.

    Raises
    ------
    FileError, UsageError
        If the file cannot be used, or an option does not fit it.
    """
    from app.rig.characters.character_library import add_character as add
    from app.rig.characters.figure_build import at_height
    from app.rig.characters.load_character import read_character

    joints, morphs = joints_of(arguments.joint), morphs_of(arguments.morph)
    hidden: Collection[str] = arguments.hide
    reading = read_character(arguments.file, joints, morphs)
    notes = list(at_height(reading.figure, arguments.height).notes)
    if not arguments.keep_props:
        hidden, note = _left_out(reading, hidden)
        notes += [] if note is None else [note]
    for note in notes:
        warn(spoken()(note))
    if reading.joints.doubtful:
        bones = {joint: reading.figure.bone_names[reading.joints.bones[joint]] for joint in reading.joints.doubtful}
        warn(said("characters.doubtful", joints=", ".join(f"{joint} ({bone})" for joint, bone in bones.items())))
    say(add(arguments.file, arguments.name, joints, morphs, arguments.height, hidden))


def _left_out(reading: CharacterFigure, hidden: Collection[str]) -> tuple[Collection[str], Message | None]:
    """Return the names of the meshes to hide, with props held in the hands added, and a message about the added props.

    The message is None if the hands hold none.
    """
    from app.rig.characters.props import props_in_hands

    props = [name for name in props_in_hands(reading.figure, reading.joints.bones) if name not in hidden]
    if not props:
        return hidden, None
    return (*hidden, *props), Message("character.props", {"names": ", ".join(props), "count": len(props)})


def make_person(arguments: argparse.Namespace) -> None:
    """Make a person from a bundled one by the options, and print its id and a warning that names the instruments that
    the body is too small for.

    Raises
    ------
    FileError, UsageError
        If the person cannot be written, or an option does not fit it.
    """
    from app.performance.bodies import strained_on
    from app.rig.characters.character_library import add_person, character_named
    from instrument_maps.load import bundled_maps

    if arguments.like not in bundled_people():
        raise UsageError("character.missing", id=arguments.like, known=", ".join(bundled_people()))
    heights_m, years = ranges([bundled_person(arguments.like).original])
    _require_within("--height", arguments.height, heights_m, arguments.like)
    _require_within("--age", arguments.age, years, arguments.like)
    measures = {"height_m": arguments.height, "age": None if arguments.age is None else age_of(arguments.age)}
    for name in ("muscle", "weight"):
        given = getattr(arguments, name)
        measures[name] = None if given is None else given / 100.0
    said_so = {name: value for name, value in measures.items() if value is not None}
    person = like(arguments.like, said_so)
    if arguments.keep_looks:
        person = msgspec.structs.replace(person, looks_years=0.0)
    id = add_person(person, arguments.name)
    say(id)
    strained = strained_on(character_named(id), person)
    if strained:
        names = ", ".join(spoken().name(bundled_maps()[one].name) for one in strained)
        warn(said("characters.strained", names=names))


def _require_within(option: str, value: float | None, bounds: tuple[float, float], id: str) -> None:
    """Raise UsageError if an option's value is outside its bounds for people like a bundled one."""
    least, most = bounds
    if value is not None and not least <= value <= most:
        quantity = said("quantity.years" if option == "--age" else "quantity.height")
        given = {"quantity": quantity, "least": f"{least:g}", "most": f"{most:g}", "id": id}
        raise UsageError("characters.measure", option=option, **given)


def joints_of(texts: list[str]) -> dict[str, str]:
    """Parse the user's corrections ``JOINT=NAME`` into bone names by joint. Raises UsageError."""
    found = {}
    for given in texts:
        joint, equals, bone = given.partition("=")
        if not equals or not joint:
            raise UsageError("characters.joint", text=given)
        found[joint] = bone
    return found


def morphs_of(texts: list[str]) -> dict[str, dict[str, float]]:
    """Parse the user's corrections of face shapes into weights of morphs by shape. Raises UsageError."""
    found: dict[str, dict[str, float]] = {}
    for given in texts:
        shape, equals, parts = given.partition("=")
        if not equals or not shape:
            raise UsageError("characters.morph", text=given)
        found[shape] = {}
        for part in filter(None, parts.split("+")):
            name, colon, weight = part.rpartition(":")
            try:
                found[shape][name if colon else part] = _weight(weight) if colon else 1.0
            except argparse.ArgumentTypeError as error:
                raise UsageError("characters.morph", text=given) from error
    return found


def checked(
    path: Path,
    joints: Mapping[str, str],
    morphs: Mapping[str, Mapping[str, float]],
    height_m: float = 0.0,
    hidden: Collection[str] = (),
    speech: Speech = ENGLISH,
    *,
    keep_props: bool = False,
) -> dict[str, Any]:
    """Read a figure's file, and return as data for JSON how its bones and morphs map to joints and expressions, with
    notes.

    Parameters
    ----------
    joints, morphs : mapping
        The user's corrections: bone names by joint, and weights of morphs by face shape.
    height_m : float
        Height of the figure in metres.
    hidden : collection of str
        Names of meshes to leave out.
    speech : Speech
        Language of the notes.
    keep_props : bool
        Whether to keep objects that the figure holds in its hands.

    Raises
    ------
    FileError
        If the file contains no figure.
    """
    from app.rig.characters.figure_build import at_height, figure_height
    from app.rig.characters.figure_to_character import figure_character
    from app.rig.characters.joint_mapping import JointMapping
    from app.rig.characters.load_character import read_character
    from app.rig.characters.split_hands import bones_beside_hands
    from app.rig.grip.fitting.fitted_instrument import notes_on_body
    from metadata.model import REQUIRED_JOINTS

    reading = read_character(path, joints, morphs)
    names = reading.figure.bone_names
    hidden, note = (hidden, None) if keep_props else _left_out(reading, hidden)
    figure = at_height(reading.figure.without(hidden), height_m)
    lacking = [joint for joint in REQUIRED_JOINTS if joint not in reading.joints.bones]
    # A joint found only by shape counts only if the figure has a complete body.
    mapped = reading.joints if reading.joints.profile or not lacking else JointMapping("", {}, (), ())
    beside: dict[str, list[str]] = {}
    for bone, joint in bones_beside_hands(reading.figure, mapped.bones).items():
        beside.setdefault(joint, []).append(names[bone])
    reported = [*figure.notes, *([] if note is None else [note])]
    if not lacking:
        character = figure_character(figure, shown(path.stem), reading.joints.bones, reading.face.morphs)
        reported += notes_on_body(character)
    return {
        "file": stored(path),
        "kind": reading.figure.origin,
        "plays": not lacking,
        "bones": len(names),
        "skinned": reading.figure.is_skinned,
        "height_m": round(figure_height(figure) or 0.0, 4),
        "meshes": [mesh.name for mesh in reading.figure.meshes],
        "hidden_meshes": list(hidden),
        "names": mapped.profile,
        "joints": {joint: names[bone] for joint, bone in mapped.bones.items()},
        "further_bones": beside,
        "missing_joints": list(mapped.missing),
        "required_joints": lacking,
        "doubtful_joints": list(mapped.doubtful),
        "face": reading.face.profile,
        "morphs": {shape: dict(own) for shape, own in reading.face.morphs.items()},
        "missing_morphs": list(reading.face.missing),
        "notes": [speech(note) for note in reported],
    }


def as_text(found: Mapping[str, Any]) -> list[str]:
    """Return the findings about a figure as lines of text."""
    doubtful = set(found["doubtful_joints"])
    ways = {"": "characters.by_shape", "vrm0": "characters.by_vrm0", "vrm1": "characters.by_vrm1"}
    counts = {key: found[key] for key in ("kind", "bones", "height_m")}
    names: str = found["names"]
    lines = [
        said("characters.figure", file=restored(found["file"]), meshes=len(found["meshes"]), **counts),
    ]
    if found["joints"]:
        lines += ["", said("characters.joints", found_by=said(ways[names]) if names in ways else names)]
        lines += (
            f"  {on_left(joint, 26)}{'?' if joint in doubtful else ' '} "
            + " + ".join([bone, *found["further_bones"].get(joint, ())])
            for joint, bone in found["joints"].items()
        )
    hidden = set(found["hidden_meshes"])
    listed = [said("characters.hidden", name=name) if name in hidden else name for name in found["meshes"]]
    lines += ["", said("characters.meshes", names=", ".join(listed))]
    if found["missing_joints"]:
        lines += ["", said("characters.without_bone", names=", ".join(found["missing_joints"]))]
    lines += ["", *_face(found)]
    if found["notes"] or found["required_joints"]:
        lines += ["", *found["notes"]]
    if found["required_joints"]:
        names = ", ".join(found["required_joints"])
        lines.append(said("characters.required", names=names) if found["skinned"] else said("characters.no_skeleton"))
    return lines


def _face(found: Mapping[str, Any]) -> list[str]:
    """Return lines of text about the morphs found for a figure's face."""
    if not found["morphs"]:
        return [said("characters.no_face", count=len(found["missing_morphs"]))]
    lines = [said("characters.face", profile=found["face"] or said("characters.unknown_face"))]
    for shape, own in found["morphs"].items():
        lines.append(f"  {on_left(shape, 26)}  {' + '.join(_share(name, weight) for name, weight in own.items())}")
    if found["missing_morphs"]:
        lines.append(said("characters.without_morph", names=", ".join(found["missing_morphs"])))
    return lines


def _share(name: str, weight: float) -> str:
    return name if weight == 1.0 else f"{name} x {weight:g}"
