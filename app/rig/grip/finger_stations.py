"""Stations of fingers: the places at which a finger works its controls, from the contacts of an instrument's map.

A finger with several keys moves from one *station* to the next; the first in the map is its home. A contact without a
control is kept at every station, unless the same part of the finger works controls at other places. Then it is a
separate station at which the finger rests.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from app.arrays import FloatArray, IndexArray
from instrument_maps.hold import Contact
from instrument_maps.model import FINGERS, Control, InstrumentMap

HOVER_POWER = 2.0
"""Exponent of a finger's remaining height over its key's travel, so that it drops ahead of the key."""
HALF_ASIDE_M = 0.0025
"""Sideways distance in metres of a finger on a half-covered hole."""
MOST_HOVER_M = 0.020
"""Greatest height in metres of a waiting finger."""


@dataclass(frozen=True)
class Station:
    """A place of a finger, with the controls that it works there.

    Attributes
    ----------
    finger : str
        Side and finger, such as ``"right.little"``.
    controls : tuple of str
        Names of the controls, sorted; empty if the finger only rests.
    contacts : tuple of int
        Indices of the map's contacts that the finger keeps there.
    """

    finger: str
    controls: tuple[str, ...]
    contacts: tuple[int, ...]


def stations(instrument: InstrumentMap) -> Mapping[str, tuple[Station, ...]]:
    """Return the stations (groups of keys that a finger reaches from one position) of every finger that touches the
    instrument, home first."""
    return _stations(instrument.contacts, instrument.controls)


@lru_cache(maxsize=64)
def _stations(contacts: tuple[Contact, ...], controls: tuple[Control, ...]) -> Mapping[str, tuple[Station, ...]]:
    found: dict[str, tuple[Station, ...]] = {}
    of_hands = frozenset(control.name for control in controls if control.finger.endswith(".hand"))
    for finger in (f"{hand}.{name}" for hand in ("left", "right") for name in FINGERS):
        touches = {
            index: _worked(contact, of_hands)
            for index, contact in enumerate(contacts)
            if contact.part.startswith(f"{finger}.")
        }
        working = {contacts[index].part for index, works in touches.items() if works}
        kept = [index for index, works in touches.items() if not works and contacts[index].part not in working]
        places = dict.fromkeys(works for index, works in touches.items() if index not in kept)
        if touches:
            found[finger] = tuple(
                Station(finger, place, tuple(i for i, works in touches.items() if i in kept or works == place))
                for place in places or [()]
            )
    return found


def worked_by(contact: Contact, instrument: InstrumentMap) -> tuple[str, ...]:
    """Return the names of the controls that a finger works by this contact, sorted; empty if the whole hand
    works them.
    """
    return _worked(contact, frozenset(one.name for one in instrument.controls if one.finger.endswith(".hand")))


def _worked(contact: Contact, of_hands: frozenset[str]) -> tuple[str, ...]:
    if contact.control is None or contact.control in of_hands:
        return ()
    return tuple(sorted({contact.control, *contact.together}))


def station_for(places: Sequence[Station], worked: frozenset[str]) -> int:
    """Return the index of the station for a set of controls: the equal set, or the one with most in common."""
    return max(
        range(len(places)),
        key=lambda index: (
            worked == frozenset(places[index].controls),
            len(worked.intersection(places[index].controls)),
            -len(places[index].controls),
            -index,
        ),
    )


def fingers_at_work(
    instrument: InstrumentMap, controls: Mapping[str, float], fingers: Mapping[str, str]
) -> dict[str, frozenset[str]]:
    """Return the controls that each finger works at given control values; ``fingers`` names the finger of controls that
    are not worked by the usual one.
    """
    found: dict[str, set[str]] = {}
    for control in instrument.controls:
        if controls.get(control.name, control.rest_value) != control.rest_value:
            found.setdefault(fingers.get(control.name, control.finger), set()).add(control.name)
    return {finger: frozenset(names) for finger, names in found.items()}


def stations_of_notes(
    instrument: InstrumentMap, notes: Iterable[tuple[Mapping[str, float], Mapping[str, str]]]
) -> dict[str, IndexArray]:
    """Return the station of each finger in each note (N,), by finger; -1 if it works nothing.

    Parameters
    ----------
    notes : iterable of (controls, fingers)
        Control values and exceptional fingers of each note, as in `fingers_at_work`.
    """
    kinds, at_work = kinds_of_notes(instrument, notes)
    return {
        finger: np.array([station_for(found, work[finger]) if finger in work else -1 for work in at_work], np.intp)[
            kinds
        ]
        for finger, found in stations(instrument).items()
    }


def kinds_of_notes(
    instrument: InstrumentMap, notes: Iterable[tuple[Mapping[str, float], Mapping[str, str]]]
) -> tuple[IndexArray, list[dict[str, frozenset[str]]]]:
    """Return for each note (N,) the index of its fingering among the distinct ones, and for each distinct one the
    controls that each finger works.
    """
    known: dict[tuple[int, int], int] = {}
    at_work: list[dict[str, frozenset[str]]] = []
    kinds = []
    held = list(notes)
    for controls, fingers in held:
        # Compared by identity: notes with the same fingering share its tables.
        kind = known.setdefault((id(controls), id(fingers)), len(at_work))
        if kind == len(at_work):
            at_work.append(fingers_at_work(instrument, controls, fingers))
        kinds.append(kind)
    return np.array(kinds, np.intp), at_work


def asked_together(instrument: InstrumentMap) -> tuple[tuple[tuple[str, int], tuple[str, int]], ...]:
    """Return all pairs of (finger, station) of one hand that some fingering requires at the same time; both stations
    are not the home station. Sorted.
    """
    working = stations_of_notes(instrument, ((one.controls, one.fingers) for one in instrument.fingerings))
    away = [
        (finger, number) for finger, numbers in working.items() for number in range(1, int(numbers.max(initial=0)) + 1)
    ]
    return tuple(
        (first, second)
        for first, second in itertools.combinations(sorted(away), 2)
        if first[0] != second[0] and first[0].split(".")[0] == second[0].split(".")[0]
        if np.any((working[first[0]] == first[1]) & (working[second[0]] == second[1]))
    )


def only_at(instrument: InstrumentMap) -> tuple[tuple[str, int] | None, ...]:
    """Return for each contact the only (finger, station) at which it is touched; None for a contact that is always
    touched.

    A contact is touched only while its station is in use if the finger has several stations or hovers above this one.
    """
    return _only_at(instrument.contacts, instrument.controls)


@lru_cache(maxsize=64)
def _only_at(contacts: tuple[Contact, ...], controls: tuple[Control, ...]) -> tuple[tuple[str, int] | None, ...]:
    found: list[tuple[str, int] | None] = [None] * len(contacts)
    heights = {control.name: control.hover_m for control in controls}
    for finger, places in _stations(contacts, controls).items():
        for number, station in enumerate(places):
            waits = any(heights[name] for name in station.controls)
            for index in station.contacts:
                at_all = all(index in place.contacts for place in places)
                if not at_all or (contacts[index].control in station.controls and waits):
                    found[index] = (finger, number)
    return tuple(found)


def hover_m(station: Station, instrument: InstrumentMap) -> float:
    """Return the height in metres at which a finger waits over its station; 0 if it stays on its control."""
    return max((instrument.control(name).hover_m for name in station.controls), default=0.0)


def height_share(control: Control, values: npt.ArrayLike) -> FloatArray:
    """Return the remaining share (F,) of the height of a waiting finger for values (F,) of its control: 1 at rest, 0 if
    worked.
    """
    full = 1.0 if control.half_value is None else control.half_value
    left: FloatArray = np.maximum(1.0 - np.asarray(values, dtype=np.float64) / full, 0.0) ** HOVER_POWER
    return left


def aside_m(contact: Contact, instrument: InstrumentMap, values: npt.ArrayLike) -> FloatArray:
    """Return the offset (F, 3) in metres of a finger from its touch point in the instrument's frame, on a half-covered
    hole.

    The offset is towards wrist or palm along the surface.
    """
    values = np.asarray(values, dtype=np.float64)
    control = None if contact.control is None else instrument.control(contact.control)
    if control is None or control.half_value is None:
        return np.zeros((*values.shape, 3))
    half = control.half_value
    share = np.where(values < half, values / half, (1.0 - values) / (1.0 - half))
    return np.multiply.outer(
        np.clip(share, 0.0, 1.0) * HALF_ASIDE_M * instrument.size, _aside(contact, control, instrument)
    )


def _aside(contact: Contact, control: Control, instrument: InstrumentMap) -> FloatArray:
    hand = contact.part.split(".")[0]
    seed = next(seed for seed in instrument.hands if seed.hand == hand)
    # A half hole, or one of two holes side by side, is opened towards the palm; a plate is opened along the finger.
    back = np.asarray(seed.palm_normal if control.node is None else seed.finger_direction) * -1.0
    normal = np.asarray(contact.normal)
    along = back - normal * float(back @ normal)
    length = float(np.linalg.norm(along))
    return along / length if length > 0.1 else np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
