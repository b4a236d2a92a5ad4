"""Checks of a map beyond its types: existing names, numbers in range, complete fingerings."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator

from instrument_maps.fingering_label import WORDS
from instrument_maps.instrument_names import vocabulary
from instrument_maps.model import MOVERS, ROOT, SCHEMA_VERSION, Control, ControlMotion, InstrumentMap
from instrument_maps.validate_fingerings import fingerings_problems
from instrument_maps.validate_hold import contacts_problems, hold_problems, proxies_problems
from instrument_maps.value_checks import REACH_M, UNIT_TOLERANCE, Problem, dot, near_point, unit_vector, within

_MOST_NAME = 200
_MOST_SIGN = 4
_FURTHEST = 12.0
"""Greatest distance of a key from the first hole in a drawn fingering, in units of the distance of holes."""

LIPS_MEET = frozenset({"cup", "air_jet"})
"""Kinds of embouchure without a reed or beak between the lips."""


def problems(instrument: InstrumentMap) -> Iterator[Problem]:
    """Yield the problems of a map whose values have correct types, in the order of its tables."""
    yield from _head(instrument)
    yield from _mouthpiece(instrument)
    yield from _controls(instrument)
    yield from _chart(instrument)
    yield from _links(instrument)
    yield from _endpin(instrument)
    yield from contacts_problems(instrument)
    yield from proxies_problems(instrument)
    yield from hold_problems(instrument)
    yield from _acoustics(instrument)
    yield from _air(instrument)
    yield from _water(instrument)
    yield from _stopped(instrument)
    yield from fingerings_problems(instrument)


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
    yield from near_point("mouthpiece.position_m", mouthpiece.position_m)
    yield from unit_vector("mouthpiece.air_axis", mouthpiece.air_axis)
    yield from unit_vector("mouthpiece.up_axis", mouthpiece.up_axis)
    if abs(dot(mouthpiece.air_axis, mouthpiece.up_axis)) > UNIT_TOLERANCE:
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
            yield from within(f"{path}.half_value", control.half_value, 0.05, 0.95)
            if control.kind != "hole":
                yield f"{path}.half_value", "belongs to controls of the kind 'hole'"
        if control.kind in WORDS and control.role == "pitch" and (not control.label or " " in control.label):
            yield f"{path}.label", "must be one word: the label of a fingering is made of it"
        yield from within(f"{path}.hover_m", control.hover_m, 0, 0.02)
        yield from _timing(path, control)
        yield from _role(path, control, labels)


def _motion(path: str, motion: ControlMotion) -> Iterator[Problem]:
    yield from unit_vector(f"{path}.axis", motion.axis)
    if (motion.travel_m is None) == (motion.angle_rad is None):
        yield path, "needs either travel_m or angle_rad"
    if motion.travel_m is not None and not 0 < motion.travel_m < REACH_M:
        yield f"{path}.travel_m", f"{motion.travel_m} m is not a travel"
    if motion.angle_rad is not None:
        if not 0 < abs(motion.angle_rad) < math.pi:
            yield f"{path}.angle_rad", f"{motion.angle_rad} rad is not the turn of a lever"
        if motion.pivot_m is None:
            yield f"{path}.pivot_m", "is missing: a turn needs a pivot"
        else:
            yield from near_point(f"{path}.pivot_m", motion.pivot_m)
    elif motion.pivot_m is not None:
        yield f"{path}.pivot_m", "has no meaning without angle_rad"


def _chart(instrument: InstrumentMap) -> Iterator[Problem]:
    known = {control.name for control in instrument.controls}
    for key in ("name", "en", "ja"):
        seen: set[str] = set()
        for index, row in enumerate(instrument.chart):
            value = getattr(row, key)
            if value in seen:
                yield f"chart[{index}].{key}", f"'{value}' is used twice"
            seen.add(value)
    for index, row in enumerate(instrument.chart):
        path = f"chart[{index}]"
        if row.name not in known:
            yield f"{path}.name", f"there is no control named '{row.name}'"
        for key, most in (("en", _MOST_NAME), ("ja", _MOST_NAME), ("sign", _MOST_SIGN)):
            value = getattr(row, key)
            if not value.strip() and key != "sign":
                yield f"{path}.{key}", "is empty"
            if len(value) > most:
                yield f"{path}.{key}", f"is longer than {most} characters"
        for number in row.at or ():
            yield from within(f"{path}.at", number, -_FURTHEST, _FURTHEST)


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
    # Its node also names its bone and the control for its length.
    taken = {ROOT, *(control.node for control in instrument.controls), *(link.node for link in instrument.links)}
    if pin.node in taken or pin.node in {control.name for control in instrument.controls}:
        yield "endpin.node", f"'{pin.node}' is moved by something else already"
    yield from unit_vector("endpin.axis", pin.axis)
    yield from near_point("endpin.tip_m", pin.tip_m)
    yield from within("endpin.most_m", pin.most_m, 0.001, 1)


def _timing(path: str, control: Control) -> Iterator[Problem]:
    yield from within(f"{path}.rest_value", control.rest_value, 0, 1)
    yield from within(f"{path}.move_window_s", control.move_window_s, 0.005, 2)
    yield from within(f"{path}.move_note_share", control.move_note_share, 0.01, 1)
    if control.attack_s is not None:
        yield from within(f"{path}.attack_s", control.attack_s, 0.05, 2)
    for name in ("max_speed_m_s", "unhurried_speed_m_s"):
        speed_m_s = getattr(control, name)
        if speed_m_s is not None:
            yield from within(f"{path}.{name}", speed_m_s, 0.05, 20)
            if not control.travel_m:
                yield f"{path}.{name}", "has no meaning for a turn"
    if control.unhurried_speed_m_s is not None and control.unhurried_speed_m_s > (control.max_speed_m_s or 0.0):
        yield f"{path}.unhurried_speed_m_s", "is more than max_speed_m_s"


def _role(path: str, control: Control, labels: set[str]) -> Iterator[Problem]:
    if control.role == "intonation":
        if not control.used_with:
            yield f"{path}.used_with", "is empty: this control would never move"
        if control.held_min_s is None:
            yield f"{path}.held_min_s", "is missing"
        else:
            yield from within(f"{path}.held_min_s", control.held_min_s, 0, 10)
        for index, label in enumerate(control.used_with):
            if label not in labels:
                yield f"{path}.used_with[{index}]", f"no fingering is labelled '{label}'"
        return
    if control.used_with:
        yield f"{path}.used_with", "belongs to controls of the role 'intonation'"
    if control.held_min_s is not None:
        yield f"{path}.held_min_s", "belongs to controls of the role 'intonation'"


def _acoustics(instrument: InstrumentMap) -> Iterator[Problem]:
    acoustics = instrument.acoustics
    if acoustics is None:
        return
    controls = {control.name for control in instrument.controls if control.role == "pitch"}
    yield from within("acoustics.tube_m", acoustics.tube_m, 0.1, 20)
    for name, semitones in acoustics.semitones.items():
        if name not in controls:
            yield f"acoustics.semitones.{name}", f"there is no control named '{name}' that changes the pitch"
        if semitones == 0:
            yield f"acoustics.semitones.{name}", "is 0: such a control does not change the pitch"
        yield from within(f"acoustics.semitones.{name}", semitones, -12, 24)
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
    yield from within("stopped.fingered_semitones", stopped.fingered_semitones, -12, 12)
    for axis in range(3):
        yield from within(f"stopped.turned_deg[{axis}]", stopped.turned_deg[axis], -90, 90)
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
    if water.position_m is not None and math.hypot(*water.position_m) > REACH_M:
        yield "water.position_m", f"is more than {REACH_M:g} m from the mouthpiece"
    if water.normal is not None and abs(math.hypot(*water.normal) - 1.0) > UNIT_TOLERANCE:
        yield "water.normal", "is not a unit vector"
