"""Check that everyone who comes with the program plays every instrument within the bounds of contacts.

    python -m resources.build.check_cast [--write] [PERSON | INSTRUMENT ...]

Each person plays the instrument's compass from its lowest to its highest note, a semitone at a time. Contacts are
judged as an export's are, and joints by the human ranges. What is worse than the finished bodies do it is printed and
makes the command fail, unless the person's file says that it is not cast for the instrument; `--write` makes the file
say so, and removes what does not help: carriages (`fit_carriages`) and holds of their own (`build_holds --people`). It
also writes how far the arms of everyone who is cast are strained, by which people of the user are judged. Someone who
is not cast although the compass is within the bounds is printed too, and stays so: pieces have faster changes.
"""

from __future__ import annotations

import json
import os
import re
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from importlib.resources import files
from pathlib import Path

# One thread: with many small sums several threads only wait for each other.
os.environ.setdefault("OMP_NUM_THREADS", "1")

import mido
import msgspec
import numpy as np

from app.arrays import FloatArray
from app.contacts.bounds import contact_name
from app.contacts.breaks import contact_problems
from app.contacts.judge import ContactJudge
from app.contacts.missed_contacts import missed_contacts
from app.export.joints import anatomical_angles
from app.formats.toml import toml
from app.performance.bodies import character_of, hold_of, model_of
from app.performance.cast import performer_of
from app.performance.ensemble import Performance
from app.performance.motion import performance_curves
from app.performance.span import whole_span
from app.project.edit.players import assign
from app.project.model import Project, map_choices, project_from_score
from app.rig.characters.character_library import bundled_characters, character_named
from app.rig.grip.carriage import carried_by
from app.rig.grip.fitting.fit_terms import GRIP_M, TOUCH_M
from app.rig.grip.fitting.grip_files import bundled_path, hold_for
from app.rig.grip.fitting.same_hands import CHECKED_NAME, arms_cost
from app.rig.model import Character
from app.rig.people.bundled_people import bundled_people, bundled_person, not_cast_for
from app.score.read import read_midi
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap
from metadata.load import load_body, load_skeleton
from resources.build.fit_carriages import write_carriages

FPS = Fraction(30)
NOTE_TICKS = 240
LEAST_DEG, SAME = 2.0, 0.05
"""Degrees beyond a range that count: fewer are what the tests of wrists allow the finished bodies in motion. Degrees or
millimetres by which a person may be worse than a finished body."""
WRITE = "--write"
LINE = re.compile(r"^not_cast_for = .*$", re.MULTILINE)


def compass(instrument: InstrumentMap, path: Path, step: int = 1) -> Path:
    """Write a MIDI file of the instrument's notes from lowest to highest at an interval in semitones."""
    track = mido.MidiTrack([mido.MetaMessage("set_tempo", tempo=500_000), mido.Message("program_change", program=56)])
    wait = 1920
    for pitch in range(instrument.range.low, instrument.range.high + 1, step):
        track.append(mido.Message("note_on", note=pitch, velocity=80, time=wait))
        track.append(mido.Message("note_off", note=pitch, velocity=0, time=NOTE_TICKS))
        wait = 0
    mido.MidiFile(ticks_per_beat=480, tracks=[track]).save(path)
    return path


def compass_project(instrument: InstrumentMap, path: Path, step: int = 1) -> Project:
    """Piece of one player who plays the whole compass of an instrument; its file is written to ``path``."""
    maps = bundled_maps()
    project = project_from_score(read_midi(compass(instrument, path, step), maps=map_choices(maps.values())), maps)
    return assign(project, [project.players[0].id], instrument_id=instrument.id)


def faults(project: Project, character_id: str) -> dict[str, float]:
    """Let a character play a piece of one player and return unreachable touches, broken contacts and exceeded human
    ranges, in millimetres or degrees, by names that are equal for all characters. Touches that the hold itself misses
    count by the distance beyond their bound.
    """
    player = msgspec.structs.replace(project.players[0], character_id=character_id)
    performance = Performance(replace(project, players=(player,)))
    curves = performance_curves(performance, performer_of(performance, player))
    motion = curves.motion(FPS, 0, whole_span(performance.time_frame, FPS).count)
    judge = ContactJudge(curves, character_of(player), model_of(performance.instrument(player)))
    known = tuple(one for one in performance.problems(player.id) if one.message.id.startswith("contact."))
    found = beyond_deg(character_of(player), motion.rotations.astype(np.float64))
    for touch in missed_contacts(hold_of(player, performance.instrument(player))):
        bound_m = GRIP_M if touch.control is None else TOUCH_M
        found[f"hold {contact_name(touch)}"] = 1000.0 * (touch.distance_m - bound_m)
    for problem in known + contact_problems(judge.breaks(motion), performance.plan(player).grips, known):
        given = problem.message.arguments
        named = [str(given[name]) for name in ("label", "side", "touch", "control") if name in given]
        name = " ".join([problem.message.id, *named])
        found[name] = max(found.get(name, 0.0), float(given.get("gap_mm", 0.0)))
    return found


def beyond_deg(character: Character, rotations: FloatArray) -> dict[str, float]:
    """Degrees beyond the human range by joint and axis, where there are any, of rotations (F, J, 4)."""
    body, profile = load_body(), load_skeleton()
    found = {}
    for joint in profile.joints:
        if joint.kind not in body.limits or joint.name not in character.skeleton.names:
            continue
        axes = np.array(msgspec.structs.astuple(profile.joint_axes(joint.name)))[None]
        turns = rotations[:, character.skeleton.index(joint.name)].T[:, None]
        angles = np.degrees(anatomical_angles(turns, axes)).reshape(3, -1)
        limits = body.limits[joint.kind]
        ranges = (limits.flexion_deg, limits.sideways_deg, limits.twist_deg)
        for name, values, (low, high) in zip(("flexion", "sideways", "twist"), angles, ranges, strict=True):
            excess = max(low - float(values.min()), float(values.max()) - high)
            if excess > LEAST_DEG:
                found[f"{joint.name} {name}"] = excess
    return found


def worse(found: Mapping[str, float], allowed: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """Faults of a character that exceed those of all bundled bodies."""
    most = {name: max(one.get(name, 0.0) for one in allowed) for name in found}
    return {
        name: amount
        for name, amount in found.items()
        if amount > most[name] + SAME and not (most[name] and name.startswith("contact."))
    }


def checked(requested: Sequence[str]) -> dict[str, dict[str, dict[str, float]]]:
    """Faults by person and instrument that exceed those of the bundled bodies, for the named ones or all."""
    maps, people = bundled_maps(), bundled_people()
    result: dict[str, dict[str, dict[str, float]]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for instrument in [maps[name] for name in maps if name in requested] or maps.values():
            project = compass_project(instrument, Path(folder) / "compass.mid")
            allowed = [faults(project, id) for id in bundled_characters()]
            for id in [name for name in people if name in requested] or people:
                result.setdefault(id, {})[instrument.id] = worse(faults(project, id), allowed)
    return result


def main(requested: Sequence[str]) -> None:
    """Check all persons with all instruments, or the named ones."""
    write, names = WRITE in requested, [name for name in requested if name != WRITE]
    unknown = set(names) - set(bundled_people()) - set(bundled_maps())
    if unknown:
        sys.exit(f"no person and no instrument has this name: {', '.join(sorted(unknown))}")
    failed = False
    for id, instruments in checked(names).items():
        before = not_cast_for(id)
        for instrument_id, found in instruments.items():
            if found and instrument_id not in before:
                failed = True
                amounts = ", ".join(f"{name} {amount:.2f}" for name, amount in found.items())
                print(f"{id} {instrument_id}: {amounts}", flush=True)
            elif not found and instrument_id in before:
                print(f"{id} {instrument_id}: not cast, but within the bounds here", flush=True)
        if write:
            small = {name for name, found in instruments.items() if found}
            for name in small:
                bundled_path(id, name).unlink(missing_ok=True)
            now = small | before
            path = bundled_people()[id]
            line = f"not_cast_for = [{', '.join(json.dumps(name) for name in sorted(now))}]"
            path.write_text(LINE.sub(line, path.read_text(encoding="utf-8")), encoding="utf-8")
            carriages = bundled_person(id).carriages
            write_carriages(path, {name: shares for name, shares in carriages.items() if name not in small})
    if write:
        path = Path(str(files("resources"))) / "characters" / CHECKED_NAME
        path.write_text(toml(greatest_costs()), encoding="utf-8")
    sys.exit(1 if failed and not write else 0)


def greatest_costs() -> dict[str, dict[str, float]]:
    """Greatest cost of the arms among everyone who is cast for an instrument, by the body that the hands are from."""
    result: dict[str, dict[str, float]] = {}
    for id in (*bundled_characters(), *bundled_people()):
        character = character_named(id)
        hands = character.hands_of or character
        own = result.setdefault(hands.id, {})
        for instrument in (one for name, one in bundled_maps().items() if name not in not_cast_for(id)):
            hold = hold_for(hands, model_of(instrument), instrument, load_body())
            shares = bundled_person(id).carriages.get(instrument.id) if id in bundled_people() else None
            carried = instrument if shares is None else carried_by(instrument, shares)
            cost = arms_cost(hold, character, carried, load_body())
            own[instrument.id] = max(own.get(instrument.id, 0.0), round(cost, 1))
    return result


if __name__ == "__main__":
    main(sys.argv[1:])
