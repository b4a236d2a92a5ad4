"""Checks of a map's fingerings: completeness, and agreement with the harmonics of the tube."""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterator

from instrument_maps.fingering_label import NONE, says_words, words_of
from instrument_maps.model import MOVERS, Fingering, InstrumentMap
from instrument_maps.value_checks import Problem, within

_CENTS = 200.0
_HARMONICS = 20
_FLAT_CENTS, _SHARP_CENTS = 40, 60
"""Largest distances in cents of a harmonic below and above its note, since combined valves are too short and the
eleventh harmonic is between notes.
"""


def fingerings_problems(instrument: InstrumentMap) -> Iterator[Problem]:
    ranks: dict[int, list[int]] = defaultdict(list)
    labels: dict[int, list[str]] = defaultdict(list)
    shift = instrument.transposition_semitones
    low, high = instrument.range.low + shift, instrument.range.high + shift
    previous = (-1, 0)
    for index, fingering in enumerate(instrument.fingerings):
        path = f"fingerings[{index}]"
        yield from _fingering(path, fingering, instrument)
        if not low <= fingering.written_pitch <= high:
            yield f"{path}.written_pitch", f"{fingering.written_pitch} is not in the range, written {low}..{high}"
        place = (fingering.written_pitch, fingering.rank)
        if place <= previous:
            yield path, "is out of order: fingerings are sorted by written pitch, then rank"
        previous = place
        if any(fingering.label == other for other in labels[fingering.written_pitch]):
            yield f"{path}.label", f"'{fingering.label}' is there twice for this note"
        labels[fingering.written_pitch].append(fingering.label)
        ranks[fingering.written_pitch].append(fingering.rank)
    for written, found in ranks.items():
        if sorted(found) != list(range(1, len(found) + 1)):
            yield "fingerings", f"written pitch {written}: the ranks {found} do not count from 1 without gaps"
    for written in range(low, high + 1):
        if written not in ranks:
            yield "fingerings", f"written pitch {written} (concert {written - shift}) has none"


def _fingering(path: str, fingering: Fingering, instrument: InstrumentMap) -> Iterator[Problem]:
    if not fingering.label:
        yield f"{path}.label", "is empty"
    yield from within(f"{path}.cents", fingering.cents, -_CENTS, _CENTS)
    roles = {control.name: control.role for control in instrument.controls}
    used_with = {control.name: control.used_with for control in instrument.controls}
    for key, role, values in (
        ("controls", "pitch", fingering.controls),
        ("correction", "intonation", fingering.correction),
    ):
        for name, value in values.items():
            if roles.get(name) != role:
                yield f"{path}.{key}.{name}", f"there is no control named '{name}' with the role '{role}'"
            yield from within(f"{path}.{key}.{name}", value, 0, 1)
    known = all(roles.get(name) == "pitch" and 0 <= value <= 1 for name, value in fingering.controls.items())
    if fingering.label and known:
        yield from _label(f"{path}.label", fingering, instrument)
        yield from _fingers(path, fingering, instrument)
        yield from _harmonic(f"{path}.controls", fingering, instrument)
    for name in fingering.correction:
        if name in used_with and roles[name] == "intonation" and fingering.label not in used_with[name]:
            yield f"{path}.correction.{name}", f"'{name}' is not used with '{fingering.label}' (controls, used_with)"


def _fingers(path: str, fingering: Fingering, instrument: InstrumentMap) -> Iterator[Problem]:
    """Yield a problem for each finger that no contact lets work all the controls it needs, such as two keys at once,
    and for unknown fingers.
    """
    asked: dict[str, set[str]] = defaultdict(set)
    for control in instrument.controls:
        finger = fingering.fingers.get(control.name, control.finger)
        if fingering.controls.get(control.name, control.rest_value) > 0 and not finger.endswith(".hand"):
            asked[finger].add(control.name)
    for name, finger in fingering.fingers.items():
        if fingering.controls.get(name, 0.0) <= 0:
            yield f"{path}.fingers.{name}", "is not among the controls of this fingering"
        if finger not in MOVERS:
            yield f"{path}.fingers.{name}", f"'{finger}' is not a finger"
    for finger, names in asked.items():
        of_finger = [contact for contact in instrument.contacts if contact.part.startswith(f"{finger}.")]
        if not any(names == {contact.control or "", *contact.together} for contact in of_finger):
            requested = " and ".join(f"'{name}'" for name in sorted(names))
            yield (
                f"{path}.controls",
                f"no contact lets '{finger}' work {requested}{' together' if len(names) > 1 else ''}",
            )


def _label(path: str, fingering: Fingering, instrument: InstrumentMap) -> Iterator[Problem]:
    """Yield a problem unless the label matches the moved controls: their signs in any order, the position of a slide,
    or 0 for none.
    """
    pitch = [control for control in instrument.controls if control.role == "pitch"]
    if says_words(pitch):
        named = words_of(fingering.controls, pitch)
        if fingering.label != named:
            yield path, f"'{fingering.label}' does not name what the controls say, '{named}'"
        return
    moved = [control for control in pitch if fingering.controls.get(control.name, control.rest_value) > 0]
    signed = [control for control in moved if control.kind != "slide"]
    if not all(control.label for control in signed):
        return
    reported, none = "".join(sign for sign in fingering.label if not sign.isspace()), NONE
    if any(control.kind == "slide" for control in pitch):
        reported, none = reported.rstrip("0123456789"), "a place of the slide"
    named = "".join(control.label for control in signed)
    plain = reported.replace(NONE, "") if reported.count(NONE) <= 1 else reported
    if Counter(plain) != Counter(named) or (NONE in reported and any(sign.isdigit() for sign in plain)):
        yield path, f"'{fingering.label}' does not name what the controls say, '{named or none}'"


def _harmonic(path: str, fingering: Fingering, instrument: InstrumentMap) -> Iterator[Problem]:
    """Yield a problem unless the note is near a harmonic of the tube with these controls; not checked for slides, which
    have positions in between.
    """
    acoustics = instrument.acoustics
    if acoustics is None or acoustics.slide_control is not None:
        return
    plain = again = 1.0
    for name, value in fingering.controls.items():
        longer = (2 ** (acoustics.semitones.get(name, 0) / 12) - 1) * value
        if name == acoustics.compensator:
            again += longer
        else:
            plain += longer
    tube = 12 * math.log2(plain * again)
    above = fingering.written_pitch - instrument.transposition_semitones + tube - acoustics.fundamental_pitch
    off = (100 * (12 * math.log2(number) - above) for number in range(1, _HARMONICS + 1))
    if not any(-_FLAT_CENTS <= cents <= _SHARP_CENTS for cents in off):
        yield path, f"written pitch {fingering.written_pitch} is no harmonic of the tube that '{fingering.label}' makes"
