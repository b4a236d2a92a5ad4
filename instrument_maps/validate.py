"""What a map must fulfil beyond its types: names that exist, numbers in range, fingerings that are complete."""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterator
from typing import TypeAlias

from instrument_maps.fingering_label import NONE, WORDS, says_words, words_of
from instrument_maps.model import (
    MOVERS,
    PARTS,
    ROOT,
    SCHEMA_VERSION,
    Box,
    Capsule,
    Carriage,
    Cone,
    Contact,
    Control,
    ControlMotion,
    Cylinder,
    Fingering,
    InstrumentMap,
    Proxy,
    Ring,
    Vector,
)
from instrument_maps.vocabulary import vocabulary

Problem: TypeAlias = tuple[str, str]
"""Key path and what is wrong there, e.g. ``("controls[2].finger", "'right.indx' is not a finger")``."""

_UNIT_TOLERANCE = 1e-3
_REACH_M = 3.0
_MOST_NAME = 200
_CENTS = 200.0
_SMALLEST, _LARGEST = 0.2, 4.0
_HARMONICS = 20
_FLAT_CENTS, _SHARP_CENTS = 40, 60
"""How far a harmonic may be below and above its note: valves together are too short, the eleventh is in between."""


LIPS_MEET = frozenset({"cup", "air_jet"})
"""Kinds of embouchure with nothing between the lips."""


def problems(instrument: InstrumentMap) -> Iterator[Problem]:
    """Yield every problem of a map whose types are right, in the order of its tables."""
    yield from _head(instrument)
    yield from _mouthpiece(instrument)
    yield from _controls(instrument)
    yield from _links(instrument)
    yield from _endpin(instrument)
    yield from _contacts(instrument)
    yield from _proxies(instrument)
    yield from _hold(instrument)
    yield from _acoustics(instrument)
    yield from _air(instrument)
    yield from _water(instrument)
    yield from _stopped(instrument)
    yield from _fingerings(instrument)


def _head(instrument: InstrumentMap) -> Iterator[Problem]:
    if instrument.schema_version != SCHEMA_VERSION:
        yield "schema_version", f"{instrument.schema_version} is not {SCHEMA_VERSION}, the version this program reads"
    if not instrument.id.isidentifier():
        yield "id", f"'{instrument.id}' is not a plain name (letters, digits, underscores)"
    for key, text in (("name.en", instrument.name.en), ("name.ja", instrument.name.ja)):
        if not text.strip():
            yield key, "is empty"
        if len(text) > _MOST_NAME:
            yield key, f"is longer than {_MOST_NAME} characters"
    if instrument.size != 1.0:
        yield "size", "is chosen for each player (hold.size_range); a file is as large as its model"
    if not instrument.plays:
        yield "plays", "is empty: no part would ever be given to this instrument"
    known = vocabulary().instruments
    for key, ids in (("plays", instrument.plays), ("substitutes_for", instrument.substitutes_for)):
        for index, id in enumerate(ids):
            if id not in known:
                yield f"{key}[{index}]", f"'{id}' is not in the vocabulary of instruments"
    limits = instrument.range
    if not 0 <= limits.low <= limits.easy_low <= limits.easy_high <= limits.high <= 127:
        yield "range", "must be 0 <= low <= easy_low <= easy_high <= high <= 127"
    low, high = limits.usual
    if not limits.low <= low <= limits.easy_low <= limits.easy_high <= high <= limits.high:
        yield "range", "must be low <= usual_low <= easy_low <= easy_high <= usual_high <= high"
    if abs(instrument.transposition_semitones) > 36:
        yield "transposition_semitones", f"{instrument.transposition_semitones} is more than three octaves"
    if not instrument.model.endswith(".glb") or "/" in instrument.model or "\\" in instrument.model:
        yield "model", f"'{instrument.model}' is not the name of a .glb file"


def _mouthpiece(instrument: InstrumentMap) -> Iterator[Problem]:
    mouthpiece = instrument.mouthpiece
    yield from _point("mouthpiece.position_m", mouthpiece.position_m)
    yield from _unit("mouthpiece.air_axis", mouthpiece.air_axis)
    yield from _unit("mouthpiece.up_axis", mouthpiece.up_axis)
    if abs(_dot(mouthpiece.air_axis, mouthpiece.up_axis)) > _UNIT_TOLERANCE:
        yield "mouthpiece.up_axis", "is not at a right angle to air_axis"
    if not 0.0 <= instrument.embouchure.puff <= 1.0:
        yield "embouchure.puff", "must be from 0 to 1"
    if not 0.0 <= instrument.embouchure.vibrato <= 1.0:
        yield "embouchure.vibrato", "must be from 0 to 1"
    apart_m = instrument.embouchure.lips_apart_m
    if instrument.embouchure.kind in LIPS_MEET:
        if apart_m:
            yield "embouchure.lips_apart_m", f"has no meaning for the kind '{instrument.embouchure.kind}'"
    elif not 0 < apart_m < 0.05:
        yield "embouchure.lips_apart_m", "must be more than 0 and less than 0.05: something is between the lips"
    if not 0 < mouthpiece.rim_radius_m <= mouthpiece.rim_outer_radius_m < 0.1:
        yield "mouthpiece.rim_radius_m", "must be 0 < rim_radius_m <= rim_outer_radius_m < 0.1"


def _controls(instrument: InstrumentMap) -> Iterator[Problem]:
    labels = {fingering.label for fingering in instrument.fingerings}
    for key in ("name", "node", "label"):
        seen: dict[str, int] = defaultdict(int)
        for index, control in enumerate(instrument.controls):
            value = getattr(control, key)
            if not value:
                continue
            seen[value] += 1
            if seen[value] > 1:
                yield f"controls[{index}].{key}", f"'{value}' is used twice"
    for index, control in enumerate(instrument.controls):
        path = f"controls[{index}]"
        if not control.name.isidentifier():
            yield f"{path}.name", f"'{control.name}' is not a plain name (letters, digits, underscores)"
        if control.node == ROOT:
            yield f"{path}.node", f"'{ROOT}' is the instrument itself and does not move"
        if control.finger not in MOVERS:
            yield f"{path}.finger", f"'{control.finger}' is not a finger"
        if (control.node is None) != (control.motion is None):
            yield f"{path}.motion", "belongs to a control with a node, and every node needs one"
        elif control.motion is None and control.kind != "hole":
            yield f"{path}.node", "is missing: only a hole may be without a moving part"
        if control.motion is not None:
            yield from _motion(f"{path}.motion", control.motion)
        if control.half_value is not None:
            yield from _within(f"{path}.half_value", control.half_value, 0.05, 0.95)
            if control.kind != "hole":
                yield f"{path}.half_value", "belongs to controls of the kind 'hole'"
        if control.kind in WORDS and control.role == "pitch" and (not control.label or " " in control.label):
            yield f"{path}.label", "must be one word: the label of a fingering is made of it"
        yield from _within(f"{path}.hover_m", control.hover_m, 0, 0.02)
        yield from _timing(path, control)
        yield from _role(path, control, labels)


def _motion(path: str, motion: ControlMotion) -> Iterator[Problem]:
    yield from _unit(f"{path}.axis", motion.axis)
    if (motion.travel_m is None) == (motion.angle_rad is None):
        yield path, "needs either travel_m or angle_rad"
    if motion.travel_m is not None and not 0 < motion.travel_m < _REACH_M:
        yield f"{path}.travel_m", f"{motion.travel_m} m is not a travel"
    if motion.angle_rad is not None:
        if not 0 < abs(motion.angle_rad) < math.pi:
            yield f"{path}.angle_rad", f"{motion.angle_rad} rad is not the turn of a lever"
        if motion.pivot_m is None:
            yield f"{path}.pivot_m", "is missing: a turn needs a pivot"
        else:
            yield from _point(f"{path}.pivot_m", motion.pivot_m)
    elif motion.pivot_m is not None:
        yield f"{path}.pivot_m", "has no meaning without angle_rad"


def _links(instrument: InstrumentMap) -> Iterator[Problem]:
    taken = {control.node for control in instrument.controls} | {ROOT}
    names = {control.name for control in instrument.controls}
    for index, link in enumerate(instrument.links):
        path = f"links[{index}]"
        if link.node in taken:
            yield f"{path}.node", f"'{link.node}' is moved by something else already"
        taken.add(link.node)
        yield from _motion(f"{path}.motion", link.motion)
        if not link.controls:
            yield f"{path}.controls", "is empty: this part would never move"
        for place, name in enumerate(link.controls):
            if name not in names:
                yield f"{path}.controls[{place}]", f"there is no control named '{name}'"


def _endpin(instrument: InstrumentMap) -> Iterator[Problem]:
    pin = instrument.endpin
    if pin is None:
        return
    # Its node is also the name of its bone, and of how far it is drawn out.
    taken = {ROOT, *(control.node for control in instrument.controls), *(link.node for link in instrument.links)}
    if pin.node in taken or pin.node in {control.name for control in instrument.controls}:
        yield "endpin.node", f"'{pin.node}' is moved by something else already"
    yield from _unit("endpin.axis", pin.axis)
    yield from _point("endpin.tip_m", pin.tip_m)
    yield from _within("endpin.most_m", pin.most_m, 0.001, 1)


def _timing(path: str, control: Control) -> Iterator[Problem]:
    yield from _within(f"{path}.rest_value", control.rest_value, 0, 1)
    yield from _within(f"{path}.move_window_s", control.move_window_s, 0.005, 2)
    yield from _within(f"{path}.move_note_share", control.move_note_share, 0.01, 1)
    if control.attack_s is not None:
        yield from _within(f"{path}.attack_s", control.attack_s, 0.05, 2)
    if control.max_speed_m_s is not None:
        yield from _within(f"{path}.max_speed_m_s", control.max_speed_m_s, 0.05, 20)
        if not control.travel_m:
            yield f"{path}.max_speed_m_s", "has no meaning for a turn"


def _role(path: str, control: Control, labels: set[str]) -> Iterator[Problem]:
    if control.role == "intonation":
        if not control.used_with:
            yield f"{path}.used_with", "is empty: this control would never move"
        if control.held_min_s is None:
            yield f"{path}.held_min_s", "is missing"
        else:
            yield from _within(f"{path}.held_min_s", control.held_min_s, 0, 10)
        for index, label in enumerate(control.used_with):
            if label not in labels:
                yield f"{path}.used_with[{index}]", f"no fingering is labelled '{label}'"
        return
    if control.used_with:
        yield f"{path}.used_with", "belongs to controls of the role 'intonation'"
    if control.held_min_s is not None:
        yield f"{path}.held_min_s", "belongs to controls of the role 'intonation'"


def _contacts(instrument: InstrumentMap) -> Iterator[Problem]:
    nodes = {ROOT, *instrument.nodes}
    controls = {control.name: control for control in instrument.controls}
    seen: set[tuple[str, str, frozenset[str]]] = set()
    for index, contact in enumerate(instrument.contacts):
        path = f"contacts[{index}]"
        if contact.part not in PARTS:
            yield f"{path}.part", f"'{contact.part}' is not a part of a hand"
        if contact.node not in nodes:
            yield f"{path}.node", f"'{contact.node}' is neither '{ROOT}' nor the node of a control"
        yield from _point(f"{path}.position_m", contact.position_m)
        yield from _unit(f"{path}.normal", contact.normal)
        if contact.grip == "guide":
            yield f"{path}.grip", "'guide' is for fingers that a character lacks; a file says 'firm' or 'resting'"
        if contact.control is not None and contact.control not in controls:
            yield f"{path}.control", f"there is no control named '{contact.control}'"
        elif contact.control is None and contact.when != "always":
            yield f"{path}.when", f"'{contact.when}' needs a control"
        for place, name in enumerate(contact.together):
            if name not in controls or name == contact.control or contact.control is None:
                yield f"{path}.together[{place}]", f"'{name}' is no other control beside '{contact.control}'"
        station = frozenset((*([contact.control] if contact.control else []), *contact.together))
        if (contact.part, contact.when, station) in seen:
            yield f"{path}.part", f"'{contact.part}' touches twice"
        seen.add((contact.part, contact.when, station))
    for index, control in enumerate(instrument.controls):
        if control.finger in MOVERS and not any(_works(contact, control) for contact in instrument.contacts):
            yield f"controls[{index}].finger", f"no contact says where '{control.finger}' touches '{control.name}'"
    yield from _hands(instrument, nodes)


def _works(contact: Contact, control: Control) -> bool:
    """Return whether a contact is the mover of a control; a whole hand touches with any of its parts."""
    hand, _, mover = control.finger.partition(".")
    of_mover = contact.part.startswith(f"{hand}." if mover == "hand" else f"{hand}.{mover}.")
    return contact.control == control.name and of_mover


def _hands(instrument: InstrumentMap, nodes: set[str]) -> Iterator[Problem]:
    hands = [seed.hand for seed in instrument.hands]
    for index, seed in enumerate(instrument.hands):
        path = f"hands[{index}]"
        if seed.hand in hands[:index]:
            yield f"{path}.hand", f"the {seed.hand} hand starts twice"
        if seed.node not in nodes:
            yield f"{path}.node", f"'{seed.node}' is neither '{ROOT}' nor the node of a control"
        yield from _point(f"{path}.palm_position_m", seed.palm_position_m)
        yield from _unit(f"{path}.palm_normal", seed.palm_normal)
        yield from _unit(f"{path}.finger_direction", seed.finger_direction)
        if seed.elbow_off_ribs_deg is not None:
            yield from _within(f"{path}.elbow_off_ribs_deg", seed.elbow_off_ribs_deg, 0, 120)
        for finger, curl in enumerate(seed.curl):
            yield from _within(f"{path}.curl[{finger}]", curl, 0, 1)
    for index, contact in enumerate(instrument.contacts):
        hand = contact.part.partition(".")[0]
        if contact.part in PARTS and hand not in hands:
            yield f"contacts[{index}].part", f"'hands' does not say where the {hand} hand starts"


def _proxies(instrument: InstrumentMap) -> Iterator[Problem]:
    nodes = {ROOT, *instrument.nodes}
    for index, proxy in enumerate(instrument.proxy):
        path = f"proxy[{index}]"
        if proxy.node not in nodes:
            yield f"{path}.node", f"'{proxy.node}' is neither '{ROOT}' nor the node of a control"
        for key, detail in _proxy(proxy):
            yield f"{path}.{key}", detail


def _proxy(proxy: Proxy) -> Iterator[Problem]:
    if isinstance(proxy, Capsule | Cylinder | Cone):
        yield from _point("a_m", proxy.a_m)
        yield from _point("b_m", proxy.b_m)
        if not isinstance(proxy, Capsule) and math.dist(proxy.a_m, proxy.b_m) < 1e-6:
            yield "b_m", "is the same point as a_m"
        radii = (
            {"radius_a_m": proxy.radius_a_m, "radius_b_m": proxy.radius_b_m}
            if isinstance(proxy, Cone)
            else {"radius_m": proxy.radius_m}
        )
        for key, radius in radii.items():
            yield from _within(key, radius, 1e-5, _REACH_M)
    elif isinstance(proxy, Ring):
        yield from _point("centre_m", proxy.centre_m)
        yield from _unit("axis", proxy.axis)
        yield from _within("radius_m", proxy.radius_m, 1e-4, _REACH_M)
        yield from _within("tube_radius_m", proxy.tube_radius_m, 1e-5, proxy.radius_m)
    elif isinstance(proxy, Box):
        yield from _point("centre_m", proxy.centre_m)
        yield from _unit("x_axis", proxy.x_axis)
        yield from _unit("y_axis", proxy.y_axis)
        if abs(_dot(proxy.x_axis, proxy.y_axis)) > _UNIT_TOLERANCE:
            yield "y_axis", "is not at a right angle to x_axis"
        for axis, half in enumerate(proxy.half_m):
            yield from _within(f"half_m[{axis}]", half, 1e-5, _REACH_M)


def _hold(instrument: InstrumentMap) -> Iterator[Problem]:
    hold = instrument.hold
    if not hold.postures:
        yield "hold", "says neither how it is played standing nor how seated"
    smallest, largest = hold.size_range
    if not _SMALLEST <= smallest <= 1.0 <= largest <= _LARGEST:
        yield (
            "hold.size_range",
            f"must be [smallest, largest] with {_SMALLEST} <= smallest <= 1 <= largest <= {_LARGEST}",
        )
    for name in ("standing", "seated"):
        carriage, lowered = getattr(hold, name), getattr(hold, f"lowered_{name}")
        if (carriage is None) != (lowered is None):
            yield f"hold.lowered_{name}", f"must be there exactly where hold.{name} is"
        if carriage is not None:
            yield from _carriage(f"hold.{name}", carriage)
        if lowered is not None:
            yield from _point(f"hold.lowered_{name}.offset_m", lowered.offset_m)
            for key in ("pitch_down_deg", "yaw_left_deg", "roll_left_deg"):
                yield from _within(f"hold.lowered_{name}.{key}", getattr(lowered, key), -180, 180)


def _carriage(path: str, carriage: Carriage) -> Iterator[Problem]:
    for key in ("pitch_down_deg", "yaw_left_deg", "roll_left_deg"):
        low, usual, high = getattr(carriage, key)
        if not -180 <= low <= usual <= high <= 180:
            yield f"{path}.{key}", "must be [lowest, usual, highest] in degrees"
    for key, most in (("head_left_deg", 60), ("head_lean_left_deg", 25), ("trunk_left_deg", 45)):
        yield from _within(f"{path}.{key}", getattr(carriage, key), -most, most)


def _acoustics(instrument: InstrumentMap) -> Iterator[Problem]:
    acoustics = instrument.acoustics
    if acoustics is None:
        return
    controls = {control.name for control in instrument.controls if control.role == "pitch"}
    yield from _within("acoustics.tube_m", acoustics.tube_m, 0.1, 20)
    for name, semitones in acoustics.semitones.items():
        if name not in controls:
            yield f"acoustics.semitones.{name}", f"there is no control named '{name}' that changes the pitch"
        if semitones == 0:
            yield f"acoustics.semitones.{name}", "is 0: such a control does not change the pitch"
        yield from _within(f"acoustics.semitones.{name}", semitones, -12, 24)
    if acoustics.compensator is not None and acoustics.compensator not in acoustics.semitones:
        yield "acoustics.compensator", f"'{acoustics.compensator}' is not among acoustics.semitones"
    if acoustics.slide_control is not None and acoustics.slide_control not in controls:
        yield "acoustics.slide_control", f"there is no control named '{acoustics.slide_control}'"


def _air(instrument: InstrumentMap) -> Iterator[Problem]:
    air = instrument.air
    if air is not None and not 60 >= air.piano_s >= air.mezzoforte_s >= air.forte_s >= 1:
        yield "air", "must be 60 >= piano_s >= mezzoforte_s >= forte_s >= 1"
    shift = instrument.transposition_semitones
    for index, written in enumerate(instrument.breaks):
        if not instrument.range.low + shift < written <= instrument.range.high + shift:
            yield f"breaks[{index}]", f"written pitch {written} is not within the range"


def _stopped(instrument: InstrumentMap) -> Iterator[Problem]:
    stopped = instrument.stopped
    if stopped is None:
        return
    yield from _within("stopped.fingered_semitones", stopped.fingered_semitones, -12, 12)
    for axis in range(3):
        yield from _within(f"stopped.turned_deg[{axis}]", stopped.turned_deg[axis], -90, 90)
    known = {control.name for control in instrument.controls if control.role == "pitch"}
    for index, name in enumerate(stopped.without):
        if name not in known:
            yield f"stopped.without[{index}]", f"there is no control named '{name}' with the role 'pitch'"


def _water(instrument: InstrumentMap) -> Iterator[Problem]:
    water = instrument.water
    if water is None:
        return
    if not water.gesture.isidentifier():
        yield "water.gesture", f"'{water.gesture}' is not the name of a gesture"
    if (water.position_m is None) != (water.normal is None):
        yield "water.normal", "a water key has a position and a normal"
    if water.position_m is not None and math.hypot(*water.position_m) > _REACH_M:
        yield "water.position_m", f"is more than {_REACH_M:g} m from the mouthpiece"
    if water.normal is not None and abs(math.hypot(*water.normal) - 1.0) > _UNIT_TOLERANCE:
        yield "water.normal", "is not a unit vector"


def _fingerings(instrument: InstrumentMap) -> Iterator[Problem]:
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
    yield from _within(f"{path}.cents", fingering.cents, -_CENTS, _CENTS)
    roles = {control.name: control.role for control in instrument.controls}
    used_with = {control.name: control.used_with for control in instrument.controls}
    for key, role, values in (
        ("controls", "pitch", fingering.controls),
        ("correction", "intonation", fingering.correction),
    ):
        for name, value in values.items():
            if roles.get(name) != role:
                yield f"{path}.{key}.{name}", f"there is no control named '{name}' with the role '{role}'"
            yield from _within(f"{path}.{key}.{name}", value, 0, 1)
    known = all(roles.get(name) == "pitch" and 0 <= value <= 1 for name, value in fingering.controls.items())
    if fingering.label and known:
        yield from _label(f"{path}.label", fingering, instrument)
        yield from _fingers(path, fingering, instrument)
        yield from _harmonic(f"{path}.controls", fingering, instrument)
    for name in fingering.correction:
        if name in used_with and roles[name] == "intonation" and fingering.label not in used_with[name]:
            yield f"{path}.correction.{name}", f"'{name}' is not used with '{fingering.label}' (controls, used_with)"


def _fingers(path: str, fingering: Fingering, instrument: InstrumentMap) -> Iterator[Problem]:
    """No finger is asked for two things at once, unless a contact says where it does both."""
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
    """The short form names what moves: the signs of the controls in any order, the place of a slide, or 0 for none."""
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
    """What sounds is near a harmonic of the tube with these controls; slides have places between, so are not asked."""
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


def _within(path: str, value: float, low: float, high: float) -> Iterator[Problem]:
    if not low <= value <= high:  # also catches nan
        yield path, f"{value:g} is not between {low:g} and {high:g}"


def _point(path: str, point: Vector) -> Iterator[Problem]:
    if not all(abs(value) <= _REACH_M for value in point):  # also catches nan
        yield path, f"{list(point)} is not a point in metres near the instrument"


def _unit(path: str, vector: Vector) -> Iterator[Problem]:
    length = math.hypot(*vector)
    if not abs(length - 1) <= _UNIT_TOLERANCE:
        yield path, f"{list(vector)} has the length {length:g}, not 1"


def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
