"""Choice of the characters of a new piece: people with the build for what they play, unlike their neighbours."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence

import msgspec
import numpy as np

from app.arrays import BoolArray, FloatArray, IndexArray
from app.project.band_in_title import ANY_AGE, Years
from app.project.casting import StagePosition
from app.project.footprint import solid_m3
from app.rig.characters.character_library import character_named, our_arm_m, our_characters
from app.rig.people.body_shapes import Phenotype, years_of
from app.rig.people.bundled_people import bundled_people, bundled_person, not_cast_for, our_years
from app.rig.people.make_person import NEUTRAL_MEANS
from app.rig.people.person import originals
from instrument_maps.model import Control, InstrumentMap

FAR_REACH_M = 0.4
"""Travel in metres of a hand that works at the end of an arm."""
LONG_ARMS = 0.9
"""Length of arms that count as long, relative to the longest."""

BULK_M = (0.15, 0.30)
"""Cube roots of the volumes of instruments that anyone carries (a tenor saxophone), and that ask for the whole build
(a tuba)."""
WHOLE_TRAVEL_M = 1.5
"""Travel in metres of a hand that would ask for the whole build; a trombone has 0.62."""
HEIGHTS_M, ELDER_YEARS, ELDER_LOSS = (1.55, 1.85), (60.0, 90.0), 0.6
"""Heights between which build grows, and ages between which `ELDER_LOSS` of it goes."""
BUILD = 4.0
"""Cost of each share of build missing for an instrument, where that of twins side by side is about 1/2."""
NEAR_M, TOGETHER = 1.5, 0.04
"""Distance in metres at which likeness counts by 1/e, and the least share that counts anywhere on the stage."""
LATER_COST, AGAIN_COST, UNSUITED_COST = 1e3, 1e5, 1e8
"""Costs of a character for every range of ages before its own, for every time that it is on the stage already, and of
one that is too small.
"""
MOST_EXCHANGES, LEAST_GAIN = 4, 1e-5
"""Greatest number of exchanges for each seat after the first choice, and the least gain of one."""
LIKENESS = {
    "height_m": (0.10, 0.28),
    "hair": (1.0, 0.12),
    "skin": (0.7, 0.18),
    "sex": (1.0, 0.15),
    "years": (25.0, 0.17),
}
"""Differences that count as whole, and shares of all: hair and skin are logarithms of luminance."""
STYLE = 0.1
"""Share of hairstyles in all differences."""
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
"""Luminance of linear red, green and blue (Rec. 709)."""


class Candidate(msgspec.Struct, frozen=True):
    """A character as the casting sees it.

    Attributes
    ----------
    build : float
        Strength and size for large instruments, 0..1.
    hair, skin : float
        Logarithm of the luminance of their colours.
    style : str
        Hairstyle.
    arm_m : float
        Length of an arm in metres; 0 where no instrument of the piece needs it.
    too_small_for : frozenset of str
        Instruments that are too large for the body.
    later : int
        Number of ranges of ages from which people are cast before this one.
    """

    id: str
    height_m: float
    years: float
    sex: float
    build: float
    hair: float
    skin: float
    style: str
    arm_m: float = 0.0
    too_small_for: frozenset[str] = frozenset()
    later: int = 0


class Seat(msgspec.Struct, frozen=True):
    """A place that someone is cast for.

    Attributes
    ----------
    instruments : tuple of str
        Ids of the instruments that are played there.
    asks : float
        Share of the whole build that the largest one asks for, 0..1.
    travel_m : float
        Longest distance in metres that a hand travels on one.
    stage : StagePosition
        Place on the stage.
    """

    instruments: tuple[str, ...]
    asks: float
    travel_m: float
    stage: StagePosition


def choose_characters(
    seats: Sequence[Seat], candidates: Sequence[Candidate], cast: Mapping[int, str] | None = None
) -> tuple[str, ...]:
    """Choose a character for every seat: large instruments first, for people with the build for them; everyone unlike
    those nearby, and different while people last, in the order of their ages' ranges.

    Parameters
    ----------
    candidates : sequence of Candidate
        At least one; of equals the first is chosen.
    cast : mapping of int to str, optional
        Ids of characters that seats have already, by the seat's index.

    Returns
    -------
    tuple of str
        Ids, in the order of the seats.
    """
    places = {one.id: place for place, one in enumerate(candidates)}
    alike, near = _alike(candidates), _near([seat.stage for seat in seats])
    own = np.array([_own_costs(seat, candidates) for seat in seats]).reshape(len(seats), len(candidates))
    given = dict(cast or {})
    taken, free = [places[id] for id in given.values() if id in places], set(range(len(seats))) - set(given)
    for seat, id in given.items():
        if id in places:
            own += near[:, seat, None] * alike[places[id]]
    chosen: dict[int, int] = {}
    beside = np.zeros_like(own)
    again = AGAIN_COST * np.bincount(taken, minlength=len(candidates)).astype(np.float64)
    for seat in sorted(free, key=lambda seat: (-seats[seat].asks, seat)):
        chosen[seat] = _least(own[seat] + beside[seat] + again)
        again[chosen[seat]] += AGAIN_COST
        beside += near[:, seat, None] * alike[chosen[seat]]
    rows = sorted(free)
    found = _exchanged(
        np.array([chosen[row] for row in rows], dtype=np.intp), own[rows], near[np.ix_(rows, rows)], alike, again
    )
    new = {row: candidates[place].id for row, place in zip(rows, found, strict=True)}
    return tuple(given.get(seat) or new[seat] for seat in range(len(seats)))


def _least(costs: FloatArray) -> int:
    """Return the first place of the least cost, rounded: the same where the last bits of a processor are others."""
    return int(np.argmin(np.round(costs, 6)))


def _exchanged(
    chosen: IndexArray, own: FloatArray, near: FloatArray, alike: FloatArray, again: FloatArray
) -> IndexArray:
    """Return a choice (S,) for S seats in which neither an exchange of two characters nor one that is not on the stage
    yet would lower the costs.

    Parameters
    ----------
    chosen : (S,) int
        Candidate of each seat.
    own : (S, N)
        Cost of each candidate in each seat, whoever else is chosen.
    near : (S, S)
        Share by which likeness counts between seats.
    alike : (N, N)
        Likeness of the candidates.
    again : (N,)
        Cost of choosing each candidate once more.
    """
    chosen, again, seats = chosen.copy(), again.copy(), np.arange(len(chosen))
    apart = near * (1.0 - np.eye(len(chosen)))
    for _ in range(MOST_EXCHANGES * len(chosen)):
        costs = own + apart @ alike[chosen]
        now = costs[seats, chosen]
        # Two who change places are as alike as before.
        both = costs[:, chosen] + apart * (alike[np.ix_(chosen, chosen)] - 1.0)
        swaps = both + both.T - now[:, None] - now
        comes = costs + again - (again[chosen] - AGAIN_COST + now)[:, None]
        steps = np.concatenate([swaps, comes], axis=1)
        best = _least(steps.ravel())
        seat, other = divmod(best, steps.shape[1])
        if steps[seat, other] > -LEAST_GAIN:
            break
        if other < len(chosen):
            chosen[[seat, other]] = chosen[[other, seat]]
        else:
            again[chosen[seat]] -= AGAIN_COST
            chosen[seat] = other - len(chosen)
            again[chosen[seat]] += AGAIN_COST
    return chosen


def _own_costs(seat: Seat, candidates: Sequence[Candidate]) -> FloatArray:
    """Return the cost (N,) of each candidate for a seat, whoever sits beside it."""
    lacking = np.array([max(seat.asks - one.build, 0.0) for one in candidates])
    later = np.array([one.later for one in candidates])
    return np.asarray(BUILD * lacking + LATER_COST * later + UNSUITED_COST * ~_suited(seat, candidates))


def _suited(seat: Seat, candidates: Sequence[Candidate]) -> BoolArray:
    """Return whether each candidate is long-armed and large enough for a seat; if no one is, only long-armed."""
    longest_m = max(one.arm_m for one in candidates)
    far = seat.travel_m > FAR_REACH_M
    long = np.array([not far or one.arm_m >= LONG_ARMS * longest_m for one in candidates])
    suited = long & np.array([one.too_small_for.isdisjoint(seat.instruments) for one in candidates])
    return suited if suited.any() else long


def _alike(candidates: Sequence[Candidate]) -> FloatArray:
    """Return the likeness (N, N) of N candidates, 0..1."""
    unlike = np.zeros((len(candidates), len(candidates)))
    for name, (whole, share) in LIKENESS.items():
        values = np.array([getattr(one, name) for one in candidates], dtype=np.float64)
        unlike += share * np.minimum(np.abs(values[:, None] - values) / whole, 1.0)
    styles = np.array([one.style for one in candidates])
    unlike += STYLE * (styles[:, None] != styles)
    return 1.0 - unlike


def _near(stages: Sequence[StagePosition]) -> FloatArray:
    """Return the share by which likeness counts between each two of N places, (N, N)."""
    places_m = np.array([(stage.x_m, stage.z_m) for stage in stages]).reshape(-1, 2)
    apart_m = np.linalg.norm(places_m[:, None] - places_m, axis=2)
    return np.asarray(np.maximum(np.exp(-((apart_m / NEAR_M) ** 2)), TOGETHER))


def characters_for(
    played: Sequence[Sequence[InstrumentMap]], stages: Sequence[StagePosition], years: Years = ANY_AGE
) -> tuple[str, ...]:
    """Choose a bundled character for each player of a new piece, by instruments, place and ranges of age
    (`years_in_title`).
    """
    seats = [_seat(own, stage) for own, stage in zip(played, stages, strict=True)]
    return choose_characters(seats, _candidates(seats, years))


def newcomers_character(
    instrument: InstrumentMap, there: Sequence[tuple[str, StagePosition]], years: Years = ANY_AGE
) -> str:
    """Choose a bundled character for a player who comes to others, who are given by character and place, beside the
    last of them.
    """
    last = there[-1][1] if there else StagePosition(0.0, 0.0, 0.0)
    seats = [*(Seat((), 0.0, 0.0, stage) for _, stage in there), _seat([instrument], last)]
    cast = {place: id for place, (id, _) in enumerate(there)}
    return choose_characters(seats, _candidates(seats, years), cast)[-1]


def _candidates(seats: Sequence[Seat], years: Years) -> list[Candidate]:
    # Measuring arms takes a moment, and few instruments need it.
    arms = any(seat.travel_m > FAR_REACH_M for seat in seats)
    found = []
    for id in our_characters():
        own = our_years(id)
        later = next((place for place, (youngest, older) in enumerate(years) if youngest <= own < older), None)
        if later is not None:
            found.append(_candidate(id, arms, later))
    return found


def _seat(played: Sequence[InstrumentMap], stage: StagePosition) -> Seat:
    travel_m = max(map(_hand_travel_m, played))
    low_m, high_m = BULK_M
    bulk_m = max(map(solid_m3, played)) ** (1.0 / 3.0)
    asks = max((bulk_m - low_m) / (high_m - low_m), travel_m / WHOLE_TRAVEL_M)
    return Seat(tuple(one.id for one in played), min(max(asks, 0.0), 1.0), travel_m, stage)


def _candidate(id: str, arms: bool, later: int) -> Candidate:
    person = bundled_person(id) if id in bundled_people() else None
    phenotype = originals()[id] if person is None else person.phenotype
    colors = _colors_of(id) if person is None else person.colors
    return Candidate(
        id=id,
        height_m=phenotype.height_m,
        years=years_of(phenotype.age),
        sex=phenotype.sex,
        build=build_of(phenotype),
        hair=_luminance(colors["hair"]),
        skin=_luminance(colors["skin"]),
        style=id if person is None else person.hair or person.original,
        arm_m=our_arm_m(id) if arms else 0.0,
        too_small_for=not_cast_for(id),
        later=later,
    )


def build_of(phenotype: Phenotype) -> float:
    """Return strength and size for large instruments, 0..1: height for the most part, muscles and weight, less of all
    in old age.
    """
    low_m, high_m = HEIGHTS_M
    tall = min(max((phenotype.height_m - low_m) / (high_m - low_m), 0.0), 1.0)
    old = float(np.interp(years_of(phenotype.age), ELDER_YEARS, (0.0, ELDER_LOSS)))
    return (0.6 * tall + 0.2 * phenotype.muscle + 0.2 * phenotype.weight) * (1.0 - old)


def _colors_of(id: str) -> dict[str, tuple[float, float, float]]:
    """Return the colours of hair and skin of a bundled body, as those of people."""
    found = {}
    for material in (material for mesh in character_named(id).meshes for material in mesh.materials):
        mean = NEUTRAL_MEANS.get(material.name, 1.0)
        red, green, blue, _ = material.base_color
        found[material.name] = (mean * red, mean * green, mean * blue)
    return found


def _luminance(color: Collection[float]) -> float:
    return math.log(float(LUMINANCE @ np.array(color)))


def _hand_travel_m(instrument: InstrumentMap) -> float:
    """Return the longest distance in metres that a hand travels on an instrument."""
    return max((control.travel_m for control in instrument.controls if _by_hand(control)), default=0.0)


def _by_hand(control: Control) -> bool:
    """Return whether the whole hand moves along with a control, as with a slide."""
    return control.finger.endswith(".hand")
