"""The places of a finger: where the contacts of a map say it is for every set of controls it works.

A finger with several keys goes from one place (*station*) to the next; the first in the map is where it is at home. A
contact without a control is kept at every station, unless its part of the finger works controls at other places: then
it is a place of its own, where the finger rests.
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
"""A finger drops to its key ahead of the key's way down: what is left of its height goes with this power."""
HALF_ASIDE_M = 0.0025
"""A finger on half a hole lies this much aside."""
MOST_HOVER_M = 0.020
"""A finger that is up waits no higher."""


@dataclass(frozen=True)
class Station:
    """A place of a finger, with the controls it works there.

    Attributes
    ----------
    finger : str
        ``"right.little"``.
    controls : tuple of str
        What it works there, sorted; empty where it only rests.
    contacts : tuple of int
        Which of the map's contacts it keeps there.
    """

    finger: str
    controls: tuple[str, ...]
    contacts: tuple[int, ...]


def stations(instrument: InstrumentMap) -> Mapping[str, tuple[Station, ...]]:
    """The stations of every finger that touches anything, home first."""
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
    """The controls that a finger works by this contact, sorted; none where a whole hand works them."""
    return _worked(contact, frozenset(one.name for one in instrument.controls if one.finger.endswith(".hand")))


def _worked(contact: Contact, of_hands: frozenset[str]) -> tuple[str, ...]:
    if contact.control is None or contact.control in of_hands:
        return ()
    return tuple(sorted({contact.control, *contact.together}))


def station_for(places: Sequence[Station], worked: frozenset[str]) -> int:
    """Return which of a finger's stations lets it work these controls: the same set, or what has most in common with
    it."""
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
    """Return which controls each finger works where ``controls`` are away from rest and ``fingers`` work some of them
    instead of the usual ones."""
    found: dict[str, set[str]] = {}
    for control in instrument.controls:
        if controls.get(control.name, control.rest_value) != control.rest_value:
            found.setdefault(fingers.get(control.name, control.finger), set()).add(control.name)
    return {finger: frozenset(names) for finger, names in found.items()}


def stations_of_notes(
    instrument: InstrumentMap, notes: Iterable[tuple[Mapping[str, float], Mapping[str, str]]]
) -> dict[str, IndexArray]:
    """Return which of its stations each finger works in each note (N,), by finger; -1 where it works nothing.

    Parameters
    ----------
    notes : iterable of (controls, fingers)
        Of the fingerings, as `fingers_at_work` takes them.
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
    """Sort notes (N,) into kinds by their fingering, with the fingers at work in each kind; a line has only a few
    kinds."""
    known: dict[tuple[int, int], int] = {}
    at_work: list[dict[str, frozenset[str]]] = []
    kinds = []
    held = list(notes)
    for controls, fingers in held:
        # By identity: notes of one fingering share its tables.
        kind = known.setdefault((id(controls), id(fingers)), len(at_work))
        if kind == len(at_work):
            at_work.append(fingers_at_work(instrument, controls, fingers))
        kinds.append(kind)
    return np.array(kinds, np.intp), at_work


def asked_together(instrument: InstrumentMap) -> tuple[tuple[tuple[str, int], tuple[str, int]], ...]:
    """Pairs of stations of one hand's fingers, neither of them at home, that some fingering of the map asks for at
    once; sorted."""
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
    """For every contact, the finger and the only station at which it counts; None for one that is kept all the time.

    What a finger works at one of several stations, or waits over, it touches only while it works it.
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
    """Return how high a finger waits over its station; 0 where it stays on what it works."""
    return max((instrument.control(name).hover_m for name in station.controls), default=0.0)


def height_share(control: Control, values: npt.ArrayLike) -> FloatArray:
    """Share (F,) of the height at which a finger waits that is left while its control is at these values."""
    full = 1.0 if control.half_value is None else control.half_value
    left: FloatArray = np.maximum(1.0 - np.asarray(values, dtype=np.float64) / full, 0.0) ** HOVER_POWER
    return left


def aside_m(contact: Contact, instrument: InstrumentMap, values: npt.ArrayLike) -> FloatArray:
    """Return how far (F, 3) a finger lies off its touch point in the instrument's frame: aside on a hole that is half
    closed.

    Aside is towards wrist or palm, along the surface.
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
    # Half of a hole, or one of two that lie side by side, is opened towards the palm; that of a plate along the finger.
    back = np.asarray(seed.palm_normal if control.node is None else seed.finger_direction) * -1.0
    normal = np.asarray(contact.normal)
    along = back - normal * float(back @ normal)
    length = float(np.linalg.norm(along))
    return along / length if length > 0.1 else np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
