"""An independent check of ``suisou inspect --json``: verifies everything promised about the printed object from the
object and from mido's reading of the file, without code of the program. `faults` returns sentences, so that a test
shows all of them.

`faults` returns sentences, so that a test shows all of them at once.
"""

from __future__ import annotations

import io
import math
import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import mido

Inspection = Mapping[str, Any]
Sounding = tuple[int, int, int, int]
"""Onset tick, duration in ticks, pitch and velocity."""

# Table 3.1 of the thesis, concert pitches.
TABLE = {
    "trumpet": {57: "2", 59: "123", 60: "13", 62: "12", 64: "2", 65: "0", 67: "12", 69: "2"},
    "trombone": {57: "2", 59: "4", 60: "3", 62: "1", 64: "2", 65: "1", 67: "2", 69: "2"},
}


def _upwards(labels: str, lowest: int) -> dict[int, str]:
    return dict(enumerate(labels.split(), lowest))


# First choices of github.com/bsz90/fingering-chart and, below E 2, of the harmonic series; concert pitches.
FIRST = {
    "trumpet": _upwards("123 13 23 12 1 2 0 123 13 23 12 1 2 0 23 12 1 2 0 12 1 2 0 1 2 0 23 12 1 2 0", 52),
    "trombone": {
        **_upwards("T6 T5 T4 T3 T2 6 5 4 3 2 1", 36),
        **_upwards("T2 6 5 4 3 2 1 5 4 3 2 1 4 3 2 1 3 2 1 3 2 3 2 1", 47),
    },
}
HELD_S = 0.35
RELEASED = 0.22
OFF_S = 0.045
"""Seconds by which a played note may begin before or after its written position."""
SLOW_S = 0.4
"""Seconds between adjacent onsets above which no alternate fingering is needed."""
TUBE_M = 2.76
TRAVEL_M = 0.62


FAMILY = {
    "trumpet_Bb": "trumpet",
    "cornet_Bb": "trumpet",
    "flugelhorn_Bb": "trumpet",
    "trombone_tenor_F_attachment": "trombone",
}
"""Instruments whose published fingerings are in this module: three valves in B flat, or the tenor's slide."""


def opened(path: Path) -> mido.MidiFile:
    """Read a file with mido; key signatures that mido refuses are blanked."""
    data = re.sub(rb"\xff\x59\x02..", b"\xff\x59\x02\x00\x00", path.read_bytes(), flags=re.DOTALL)
    return mido.MidiFile(file=io.BytesIO(data), clip=True)


def sounding_notes(path: Path) -> list[tuple[int, int, Sounding]]:
    """Notes (track, channel, note) of a file of format 0 or 1 in mido's reading; the first note-on is ended first, and
    velocity 0 is a note-off.
    """
    found = []
    for number, track in enumerate(opened(path).tracks):
        tick = 0
        open_: dict[tuple[int, int], list[tuple[int, int]]] = {}
        for message in track:
            tick += message.time
            if message.type == "note_on" and message.velocity:
                open_.setdefault((message.channel, message.note), []).append((tick, message.velocity))
            elif message.type in ("note_on", "note_off"):
                waiting = open_.get((message.channel, message.note))
                if waiting:
                    onset, velocity = waiting.pop(0)
                    note = (onset, max(tick - onset, 1), message.note, velocity)
                    found.append((number, message.channel, note))
        for (channel, pitch), waiting in open_.items():
            for onset, velocity in waiting:
                found.append((number, channel, (onset, max(tick - onset, 1), pitch, velocity)))
    return found


def tempos(path: Path) -> list[tuple[int, int]]:
    """Pairs (tick, microseconds per quarter) of all tracks by tick; of several at one tick the last track's counts."""
    changes = {0: 500000}
    ordered = []
    for track in opened(path).tracks:
        tick = 0
        for message in track:
            tick += message.time
            if message.type == "set_tempo" and message.tempo > 0:
                ordered.append((tick, message.tempo))
    changes.update(ordered)
    return sorted(changes.items())


def slow_seconds(tick: float, changes: Sequence[tuple[int, int]], quarter: int) -> float:
    """Time of a tick in seconds, calculated tempo by tempo; the first tempo also applies before its tick."""
    time_s = 0.0
    if tick < 0:
        return tick * changes[0][1] / quarter / 1e6
    for (start, tempo), end in zip(changes, [change[0] for change in changes[1:]] + [None], strict=True):
        if tick <= start:
            break
        until = tick if end is None else min(tick, end)
        time_s += (until - start) * tempo / quarter / 1e6
    return time_s


def faults(
    path: Path, found: Inspection, *, thresholds: Sequence[float] = (0.5, 1.0, 2.0), felt_beat: float = 1.0,
    preroll: float | None = None,
) -> list[str]:  # fmt: skip
    """All errors in the output about a file of format 0 or 1."""
    changes, quarter = tempos(path), found["ticks_per_beat"]
    wrong = _notes(path, found, changes, quarter)
    names = [player["name"] for player in found["players"]]
    if len({name.casefold() for name in names}) < len(names) or not all(name.strip() for name in names):
        wrong.append(f"names: {names}")
    for part in found["unplayed"]:
        if set(part) != {"name", "reason", "note_count"} or " " not in part["reason"] or not part["name"]:
            wrong.append(f"unplayed: {part}")
    onsets = [note["onset_tick"] for player in found["players"] for note in player["notes"]]
    if onsets:
        first = min(onsets)
        first_s = slow_seconds(first, changes, quarter)
        if preroll is None:
            preroll = found["preroll_beats"]
            if preroll < 4.0 or preroll % 1.0:
                wrong.append(f"a pre-roll of {preroll} beats")
        start_s = min(slow_seconds(first - preroll * felt_beat * quarter, changes, quarter), first_s - 2.0)
        # The start is given in the tempo that begins: for it there are two beats of that, or all where there are fewer.
        beat_s = slow_seconds(first + felt_beat * quarter, changes, quarter) - first_s
        start_s = min(start_s, first_s - min(preroll, 2.0) * beat_s)
        if abs(found["first_frame_s"] - start_s) > 1e-6:
            wrong.append(f"first_frame_s {found['first_frame_s']} instead of {start_s}")
        wrong += _cues(found, first, changes, quarter, felt_beat)
    for player in found["players"]:
        wrong += [f"{player['name']}: {fault}" for fault in _fingerings(player)]
        wrong += [
            f"{player['name']}: {fault}"
            for fault in _breaths(player, found, changes, quarter, tuple(thresholds), felt_beat)
        ]
    return wrong


def _notes(path: Path, found: Inspection, changes: Sequence[tuple[int, int]], quarter: int) -> list[str]:
    wrong = []
    truth = Counter(note for _, _, note in sounding_notes(path))
    reported: Counter[Sounding] = Counter()
    for player in found["players"]:
        ids = [note["id"] for note in player["notes"]]
        if len(set(ids)) < len(ids):
            wrong.append(f"{player['name']}: ids repeat")
        reported.update((n["onset_tick"], n["duration_tick"], n["pitch"], n["velocity"]) for n in player["notes"])
        for note in player["notes"]:
            onset_s = slow_seconds(note["onset_tick"], changes, quarter)
            end_s = slow_seconds(note["onset_tick"] + note["duration_tick"], changes, quarter)
            if abs(note["onset_s"] - onset_s) > 1e-6 or abs(note["duration_s"] - (end_s - onset_s)) > 1e-6:
                wrong.append(f"{player['name']}: note {note['id']} at {note['onset_s']} instead of {onset_s}")
    extra = reported - truth
    if extra:
        wrong.append(f"{sum(extra.values())} notes that mido does not read, such as {next(iter(extra))}")
    missing = truth.total() - reported.total() - sum(part["note_count"] for part in found["unplayed"])
    if missing:
        wrong.append(f"{missing} notes neither played nor listed")
    ids = [note["id"] for player in found["players"] for note in player["notes"]]
    if len(set(ids)) < len(ids):
        wrong.append("note ids are not unique in the piece")
    last = max((note[0] + note[1] for note in truth.elements()), default=0)
    if truth and abs(found["duration_s"] - slow_seconds(last, changes, quarter)) > 1e-6:
        wrong.append(f"duration_s {found['duration_s']} instead of {slow_seconds(last, changes, quarter)}")
    return wrong


def _cues(
    found: Inspection, first: int, changes: Sequence[tuple[int, int]], quarter: int, felt_beat: float
) -> list[str]:
    wrong = []
    first_s = slow_seconds(first, changes, quarter)
    leaders = [
        (player["name"], cue)
        for player in found["players"]
        for cue in player["cues"]
        if abs(cue["end_s"] - first_s) < 1e-6
    ]
    if found["unplayed"]:
        # Parts without players may have begun earlier, and lead the entry.
        return [] if len(leaders) <= 1 else [f"{len(leaders)} players give the start"]
    if len(leaders) != 1:
        return [f"{len(leaders)} players give the start"]
    cue = leaders[0][1]
    beat_s = slow_seconds(first + felt_beat * quarter, changes, quarter) - first_s
    # Before a pickup that lies within a beat it is a beat before that one.
    peak_s = (first_s - 2.0 * beat_s, first_s - beat_s)
    if abs(cue["beat_s"] - beat_s) > 1e-6 or not peak_s[0] < cue["peak_s"] < peak_s[1] + 1e-6:
        wrong.append(f"the cue's beat is {cue['beat_s']} at {cue['peak_s']}, not {beat_s} before {first_s}")
    if cue["start_s"] < found["first_frame_s"] - 1e-9:
        wrong.append("the cue begins before the performance")
    spans = sorted(
        (note["onset_tick"], note["onset_tick"] + note["duration_tick"])
        for player in found["players"]
        for note in player["notes"]
    )
    reach = spans[0][1]
    cues = [cue for player in found["players"] for cue in player["cues"]]
    ends = [cue["end_s"] for cue in cues]
    common = [cue["end_s"] for cue in cues if cue["reason"].startswith("cue for all players after")]
    for onset, end in spans[1:]:
        if onset > reach:
            rest_s = slow_seconds(onset, changes, quarter) - slow_seconds(reach, changes, quarter)
            entry_s = slow_seconds(onset, changes, quarter)
            given = any(abs(end_s - entry_s) < 1e-5 for end_s in ends)
            # Cues of a player do not overlap: one takes a beat and a half, and before a pickup up to a beat more.
            lead_s = 2.5 * (slow_seconds(onset + felt_beat * quarter, changes, quarter) - entry_s)
            busy = any(entry_s - lead_s < end_s < entry_s for end_s in ends)
            if rest_s >= 1.5 + 1e-6 and not given and not busy:
                wrong.append(f"no cue for the entry at {entry_s} after {rest_s} s of rest")
            given = any(abs(end_s - entry_s) < 1e-5 for end_s in common)
            if rest_s < 1.5 - 1e-6 and (onset - reach < 2 * felt_beat * quarter or rest_s < 0.75 - 1e-6) and given:
                wrong.append(f"a cue at {entry_s} after {rest_s} s of rest")
        reach = max(reach, end)
    return wrong


def _expected_controls(kind: str, label: str, controls: Mapping[str, float]) -> bool:
    if kind == "trumpet":
        return all(controls[f"valve_{digit}"] == float(digit in label) for digit in "123")
    place = int(label.lstrip("T"))
    if controls["trigger"] != float(label.startswith("T")):
        return False
    out_m = controls["slide"] * TRAVEL_M
    tube_m = TUBE_M * (2 ** (5 / 12) if label.startswith("T") else 1.0)
    return abs(out_m - tube_m * (2 ** ((place - 1) / 12) - 1) / 2) < 0.036


VALVE_KEPT = {41: "T1", 48: "T1"}
"""Labels of F 2 and C 3 on a trombone with an F valve."""


def _fingerings(player: Mapping[str, Any]) -> list[str]:
    wrong = []
    kind = FAMILY.get(player["instrument"])
    notes = player["notes"]
    for index, note in enumerate(notes):
        label, pitch, controls = note["fingering"], note["pitch"], note["controls"]
        if not label or any(not 0.0 <= value <= 1.0 for value in controls.values()):
            wrong.append(f"note {note['id']}: '{label}' with controls {controls}")
        if kind is None:
            continue
        if not _expected_controls(kind, label, controls):
            wrong.append(f"note {note['id']}: {label} with {controls}")
        around = [
            abs(other["onset_s"] - note["onset_s"])
            for other in [*notes[max(index - 1, 0) : index], *notes[index + 1 : index + 2]]
        ]
        # Next to a note that needs the thumb's valve, a trombonist leaves it turned.
        beside = {
            FIRST[kind].get(other["pitch"], "")
            for other in [*notes[max(index - 1, 0) : index], *notes[index + 1 : index + 2]]
        }
        if label == VALVE_KEPT.get(pitch) and any(one.startswith("T") for one in beside):
            continue
        if pitch in FIRST[kind] and min(around, default=9.0) > SLOW_S and label != FIRST[kind][pitch]:
            wrong.append(f"note {note['id']}: {pitch} with {label} though there is time for {FIRST[kind][pitch]}")
        if pitch in TABLE[kind] and min(around, default=9.0) > SLOW_S and label != TABLE[kind][pitch]:
            wrong.append(f"note {note['id']}: {pitch} with {label} against table 3.1")
        following = notes[index + 1]["onset_s"] if index + 1 < len(notes) else note["onset_s"] + 99.0
        length_s = min(note["duration_s"], following - note["onset_s"])
        if kind == "trumpet" and abs(length_s - HELD_S) > 0.2:
            held = length_s > HELD_S
            ring, saddle = controls["third_slide"] > 0.0, controls["first_slide"] > 0.0
            if ring != (held and label in ("13", "123")) or saddle != (held and label == "12"):
                wrong.append(f"note {note['id']}: {label} for {length_s} s with {controls}")
    return wrong


def _detached(notes: Sequence[Mapping[str, Any]]) -> list[bool]:
    """Return whether the silence before each note is due to the articulation of the previous note: as for two
    neighbours with the same step, or for at least half of all notes.
    """
    steps = [math.nan, *(other["onset_tick"] - one["onset_tick"] for one, other in pairwise(notes))]
    shares = [
        math.nan,
        *(1.0 - one["duration_tick"] / max(step, 1) for one, step in zip(notes, steps[1:], strict=False)),
    ]
    result = []
    for index, share in enumerate(shares):
        alike = [abs(other - share) < 0.13 for other in shares]
        steady = [
            same and abs(step - steps[index]) < 0.13 * steps[index] for same, step in zip(alike, steps, strict=True)
        ]
        runs = any(all(steady[max(first, 0) : first + 3]) for first in range(max(index - 2, 1), index + 1)
                   if first + 3 <= len(steady))  # fmt: skip
        result.append(runs or 2 * sum(alike) >= len(notes) - 1)
    return result


def _unserved(
    rest: float,
    late: float,
    thresholds: tuple[float, float, float],
    onset: int,
    beat: float,
    breath: Mapping[str, Any] | None,
    preparations: Sequence[Mapping[str, Any]],
    seconds: Callable[[float], float],
    note_id: str,
) -> list[str]:
    """Problems of the breath in a rest of ``rest`` beats, which is longer in the score by ``late`` beats."""
    least, last, prepare = thresholds
    if rest + late >= prepare:
        requested: tuple[float, ...] = (onset - min(2 * beat, rest * beat), onset - beat, onset)
    elif rest + late >= last:
        requested = (onset - min(beat, rest * beat), onset)
    elif rest + late >= least:
        requested = (onset - rest * beat, onset)
    else:
        return []
    if breath is None:
        return [f"no breath in {rest} beats of rest before note {note_id}"]
    wrong = []
    start_s, end_s = seconds(requested[-2]), seconds(requested[-1])
    if abs(breath["start_s"] - start_s) > 1e-6 or not -1e-9 <= end_s - breath["end_s"] <= 0.05:
        wrong.append(f"breath {breath['start_s']}..{breath['end_s']} instead of {start_s}..{end_s}")
    if len(requested) == 3:
        start_s, end_s = seconds(requested[0]), seconds(requested[1])
        if not any(
            abs(event["start_s"] - start_s) < 1e-6 and abs(event["end_s"] - end_s) < 1e-6 for event in preparations
        ):
            wrong.append(f"no preparation in {rest} beats of rest before note {note_id}")
    return wrong


CATCH_BREATH_S, SHORTEST_NOTE_S = 0.2, 1.0 / 24.0
"""Least seconds of a breath, and of the sound of a note that is shortened for it."""


def leaves_out(breath: Mapping[str, Any], note: Mapping[str, Any], following: Mapping[str, Any]) -> bool:
    """Return whether a breath replaces a note, of which hardly anything would remain otherwise."""
    named = re.search(r"(?:instead|in place) of notes? (\S+) \(\S+\)(?: and (\S+) \(\S+\))?,", breath["reason"])
    step_s = following["onset_s"] - note["onset_s"]
    pitches = [_named_pitch(name) for name in named.groups() if name] if named else []
    return note["pitch"] in pitches and step_s < CATCH_BREATH_S + SHORTEST_NOTE_S


def _named_pitch(name: str) -> int:
    """MIDI number of a pitch's name with middle C as C4."""
    letter, accidental, octave = re.fullmatch(r"([A-G])([♯♭]?)(-?\d+)", name).groups()
    return (
        12 * (int(octave) + 1)
        + {"C": 0, "D": 2, "E": 4, "F": 5, "G": 7, "A": 9, "B": 11}[letter]
        + "♭ ♯".find(accidental or " ")
        - 1
    )


def _given_up_s(length_s: float) -> float:
    """Seconds that a note may lose to a breath: half of it, or for the shortest breath all but its beginning."""
    return max(0.5 * length_s, min(length_s - SHORTEST_NOTE_S, CATCH_BREATH_S))


def _breaths(
    player: Mapping[str, Any],
    found: Inspection,
    changes: Sequence[tuple[int, int]],
    quarter: int,
    thresholds: tuple[float, ...],
    felt_beat: float,
) -> list[str]:
    least, last, prepare = thresholds
    wrong: list[str] = []

    def seconds(tick: float) -> float:
        return slow_seconds(tick, changes, quarter)

    beat = felt_beat * quarter
    notes = player["notes"]
    # A player who holds a note together with others may breathe within it, with that reason.
    held = [event for event in player["breaths"] if event["reason"].startswith("staggered breath within a note")]
    for event in held:
        if not any(n["onset_s"] < event["start_s"] < event["end_s"] < n["onset_s"] + n["duration_s"] for n in notes):
            wrong.append(f"the breath at {event['end_s']} is within no note")
    player = {**player, "breaths": [event for event in player["breaths"] if event not in held]}
    breaths = [event for event in player["breaths"] if event["kind"] == "breath"]
    preparations = [event for event in player["breaths"] if event["kind"] == "preparation"]
    onset_ticks = [note["onset_tick"] for note in notes]
    served: dict[int, Mapping[str, Any]] = {}
    for breath in breaths:
        at = [index for index, note in enumerate(notes) if -1e-9 <= note["onset_s"] - breath["end_s"] <= 0.05 + 1e-9]
        if not at:
            wrong.append(f"the breath at {breath['end_s']} ends at no onset")
        for index in at[:1]:
            served[index] = breath
        if breath["start_s"] < found["first_frame_s"] - 1e-9:
            wrong.append(f"the breath at {breath['end_s']} begins before the performance")
    for event in player["breaths"]:
        if not event["reason"] or event["end_s"] - event["start_s"] <= 0:
            wrong.append(f"breath {event}")
        for end in ("start", "end"):
            if abs(seconds(event[f"{end}_beat"] * quarter) - event[f"{end}_s"]) > 1e-5:
                wrong.append(f"the {end} of the breath at {event['end_s']} in beats: {event[f'{end}_beat']}")
    reach = 0
    detached = _detached(notes)
    ends = [tick + note["duration_tick"] for tick, note in zip(onset_ticks, notes, strict=True)]
    is_played = any(tick * 24 % quarter for tick in [*onset_ticks, *ends])
    for index, note in enumerate(notes):
        onset = note["onset_tick"]
        if index == 0:
            rest = seconds(onset) - found["first_frame_s"]
            if 0 not in served:
                wrong.append("no first breath")
            reach = onset + note["duration_tick"]
            continue
        rest = max(onset - reach, 0) / beat
        if onset == onset_ticks[index - 1]:
            reach = max(reach, onset + note["duration_tick"])
            continue
        breath = served.get(index)
        # Detached notes have no rests between them: of those nothing is expected.
        if rest < 1.0 and detached[index]:
            reach = max(reach, onset + note["duration_tick"])
            continue
        # Players release a note early, more so if it began early: a fifth of the time to the next note is not a rest,
        # and neither is the delay of a late note, if a breath does not fit.
        step_s, silence_s = seconds(onset) - seconds(onset_ticks[index - 1]), seconds(onset) - seconds(reach)
        early = silence_s <= RELEASED * step_s + (2.0 if silence_s < CATCH_BREATH_S else 1.0) * OFF_S
        if is_played and breath is None and rest < 1.0 and early:
            reach = max(reach, onset + note["duration_tick"])
            continue
        # In a line that was played a rest may be the one a score would write, after a note held a little too long.
        readings = [
            _unserved(rest, late, (least, last, prepare), onset, beat, breath, preparations, seconds, str(note["id"]))
            for late in ((0.0, 0.05 / felt_beat) if is_played else (0.0,))
        ]
        wrong += min(readings, key=len)
        if breath is not None and rest < least:
            before = notes[index - 1]
            length_s = min(before["duration_s"], note["onset_s"] - before["onset_s"])
            least_s = before["onset_s"] + length_s - _given_up_s(length_s)
            if breath["start_s"] < least_s - 1e-6 and not leaves_out(breath, before, note):
                wrong.append(f"the catch breath at {breath['end_s']} takes most of the note before")
        reach = max(reach, onset + note["duration_tick"])
    for event in player["breaths"]:
        for note, following in pairwise([*notes, None]):
            end_s = note["onset_s"] + note["duration_s"]
            if following is not None:
                end_s = min(end_s, following["onset_s"])
            inside_s = min(end_s, event["end_s"]) - max(note["onset_s"], event["start_s"])
            most_s = 0.0
            if following is not None and event["kind"] == "breath":
                out = leaves_out(event, note, following)
                before_out = (
                    re.search("(?:instead|in place) of note", event["reason"])
                    and event["start_s"] < following["onset_s"]
                )
                if out or before_out or abs(following["onset_s"] - event["end_s"]) <= 0.05:
                    most_s = end_s - note["onset_s"] if out else _given_up_s(end_s - note["onset_s"])
            if inside_s > most_s + 1e-6:
                wrong.append(f"{event['kind']} {event['start_s']}..{event['end_s']} inside note {note['id']}")
    return wrong
