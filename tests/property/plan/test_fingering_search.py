"""The search for fingerings compared with brute force and with first choices, on synthetic instruments."""

from __future__ import annotations

import itertools

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import IntArray
from app.plan.fingering.costs import FingeringProblem, fingering_problem
from app.plan.fingering.fingerings import plan_fingerings
from app.plan.fingering.search import best_path
from app.plan.generate import MonophonicPart
from app.plan.music.piece import line_times
from instrument_maps.load import bundled_maps
from instrument_maps.model import Fingering, InstrumentMap
from tests.support.plan import PlainClock, PlainNote, slide, valves
from tests.support.woodwinds import clarinet, double_horn, oboe, saxophone

INSTRUMENTS = {
    "valves": (valves(), 52, 80),
    "slide": (slide(), 40, 68),
    "clarinet": (clarinet(), 52, 82),
    "oboe": (oboe(), 60, 70),
    "saxophone": (saxophone(), 62, 88),
    "double horn": (double_horn(), 60, 77),
    "trumpet": (bundled_maps()["trumpet_Bb"], 52, 87),
    "trombone": (bundled_maps()["trombone_tenor_F_attachment"], 28, 77),
}


def phrases(low: int, high: int, most: int) -> st.SearchStrategy[tuple[PlainNote, ...]]:
    """Lines of fast notes in small steps, with rests now and then."""

    def build(first: int, steps: list[tuple[int, int, int]]) -> tuple[PlainNote, ...]:
        notes, tick, pitch = [], 0, first
        for index, (interval, length, rest) in enumerate(steps):
            pitch = min(max(pitch + interval, low), high)
            notes.append(PlainNote(f"1:{index + 1}", tick, length, pitch))
            tick += length + rest
        return tuple(notes)

    interval = st.one_of(st.integers(-2, 2), st.integers(-12, 12))
    step = st.tuples(interval, st.sampled_from([40, 60, 80, 120, 240, 480]), st.sampled_from([0, 0, 0, 0, 60, 480]))
    return st.builds(build, st.integers(low, high), st.lists(step, min_size=1, max_size=most))


def trill_of(notes: tuple[PlainNote, ...], onset: list[float]) -> list[bool]:
    trill = [False] * max(len(notes) - 1, 0)
    for start in range(len(notes) - 3):
        pitches = [note.pitch for note in notes[start : start + 4]]
        quick = all(onset[start + k + 1] - onset[start + k] <= 0.15 + 1e-9 for k in range(3))
        width = abs(pitches[0] - pitches[1])
        if width > 2:
            quick = all(onset[start + k + 1] - onset[start + k] <= 0.09 + 1e-9 for k in range(3))
        if quick and pitches[0] == pitches[2] and pitches[1] == pitches[3] and 1 <= width <= 12:
            trill[start : start + 3] = [True] * 3
    return trill


def glide_of(notes: tuple[PlainNote, ...], onset: list[float], end: list[float]) -> list[bool]:
    """Steps of three or more quick slurred semitones in one direction."""
    glide = [False] * max(len(notes) - 1, 0)
    for start in range(len(notes) - 3):
        steps = [notes[start + k + 1].pitch - notes[start + k].pitch for k in range(3)]
        quick = all(onset[start + k + 1] - onset[start + k] <= 0.15 + 1e-9 for k in range(3))
        slurred = all(onset[start + k + 1] - end[start + k] < 0.01 for k in range(3))
        if quick and slurred and steps in ([1, 1, 1], [-1, -1, -1]):
            glide[start : start + 3] = [True] * 3
    return glide


def is_chromatic(notes: tuple[PlainNote, ...], onset: list[float], index: int) -> bool:
    sides = [(at, at + 1) for at in (index - 1, index) if 0 <= at < len(notes) - 1]
    near = [abs(notes[b].pitch - notes[a].pitch) for a, b in sides if onset[b] - onset[a] <= 0.3 + 1e-9]
    return bool(near) and all(width == 1 for width in near)


def turned(fingering: Fingering, instrument: InstrumentMap) -> set[str]:
    """Levers turned by a fingering."""
    levers = {one.name for one in instrument.controls if one.kind == "lever" and one.role == "pitch"}
    return {name for name, value in fingering.controls.items() if value > 0.0 and name in levers}


def stays(
    index: int,
    notes: tuple[PlainNote, ...],
    ways: Fingering,
    instrument: InstrumentMap,
    onset: list[float],
    end: list[float],
) -> bool:
    """Return whether a fingering that keeps a lever turned is next to one that needs it."""
    near = []
    for at in (index - 1, index + 1):
        if 0 <= at < len(notes) and notes[at].pitch != notes[index].pitch:
            early, late = min(at, index), max(at, index)
            if onset[late] - end[early] < 0.5:
                near.append(turned(instrument.fingerings_for(notes[at].pitch)[0], instrument))
    own = turned(ways, instrument)
    return bool(own) and ways.rank > 1 and "beside" in ways.tags and own in near


def choice_cost(fingering: Fingering, first: Fingering, length: float, places: set[str], beside: bool) -> float:
    """All notes of these tests are of a middling loudness; ``places`` are the tags that are right here."""
    cost = float(min(fingering.rank - 1, 3))
    if fingering.rank > 1:
        cost += 0.5 if "forked" in fingering.tags else 0.0
        cost += 10.0 if "rare" in fingering.tags else 0.0
        cost = 0.1 if "held" in fingering.tags else cost
        meant = set(fingering.tags) & {"trill", "fast", "forte", "piano", "chromatic", "attack"}
        if meant & places:
            cost = min({"chromatic": -0.5, "attack": -4.0}.get(tag, 0.5) for tag in meant & places)
        elif meant:
            cost += 6.0
    cost = -0.5 if beside else cost
    return cost + max(abs(fingering.cents) - abs(first.cents), 0.0) / 20.0 * min(length / 0.25, 1.0)


def held(fingering: Fingering, instrument: InstrumentMap) -> dict[str, frozenset[tuple[str, bool]]]:
    """Controls held by each finger: their names, and whether completely."""
    result: dict[str, set[tuple[str, bool]]] = {}
    for control in instrument.controls:
        value = fingering.controls.get(control.name, control.rest_value)
        if control.role == "pitch" and control.kind != "slide" and value > 0.0:
            finger = fingering.fingers.get(control.name, control.finger)
            result.setdefault(finger, set()).add((control.name, value > 0.5))
    return {finger: frozenset(keys) for finger, keys in result.items()}


def fingers_cost(
    a: Fingering, b: Fingering, instrument: InstrumentMap, step: float, gap: float, hurry: float, trill: bool
) -> float:
    """Cost of the fingers' motion between two fingerings."""
    levers = {one.name for one in instrument.controls if one.kind == "lever" and one.finger.endswith("thumb")}
    before, after = held(a, instrument), held(b, instrument)
    nothing: frozenset[tuple[str, bool]] = frozenset()
    moved, weighted, jumps, rolls, turned = 0, 0.0, 0.0, 0, 0
    rise, fall = False, False
    for finger in before.keys() | after.keys():
        here, there = before.get(finger, nothing), after.get(finger, nothing)
        if here == there:
            continue
        moved += 1
        if {name for name, whole in here ^ there if whole} & levers:
            weighted += 0.5
            turned += 1
        else:
            weighted += {"thumb": 1.25, "little": 1.25, "ring": 1.1}.get(finger.split(".")[1], 1.0)
            rise |= bool({name for name, _ in here} - {name for name, _ in there})
            fall |= bool({name for name, _ in there} - {name for name, _ in here})
        if here and there:
            if {name for name, _ in here} & {name for name, _ in there}:
                rolls += 1
            else:
                jumps += {"little": 4.0, "ring": 3.0}.get(finger.split(".")[1], 1.5)
    weighted += 0.5 if rise and fall else 0.0
    flips = 1.0 if turned and rise | fall else 0.0
    crosses = any((a.written_pitch >= edge) != (b.written_pitch >= edge) for edge in instrument.breaks)
    pace = share_of_pace(step)
    if trill:
        weighted += 0.75 * turned
        weighted += 1.1 if moved == 0 and a.written_pitch != b.written_pitch else 0.0
    leaves_down = any("held" in one.tags for one in instrument.fingerings)
    awkward = 0.15 * moved * leaves_down + 0.8 * rolls + 0.9 * flips + (0.25 * max(moved - 3, 0) if crosses else 0.0)
    return weighted * hurry + awkward * pace + jumps * max(1.0 - gap / 0.12, 0.0)


def naive_cost(notes: tuple[PlainNote, ...], choice: list[Fingering], instrument: InstrumentMap) -> float:
    """The documented costs, note by note, with plain floats: the slow and obvious second implementation."""
    seconds = PlainClock().seconds
    onset = [seconds(note.onset_tick) for note in notes]
    end = [seconds(note.onset_tick + note.duration_tick) for note in notes]
    slides = [control for control in instrument.controls if control.role == "pitch" and control.kind == "slide"]
    trill, glide = trill_of(notes, onset), glide_of(notes, onset, end)
    registers = [sum(edge <= one.written_pitch for edge in instrument.breaks) for one in choice]
    steps = [onset[index + 1] - onset[index] for index in range(len(notes) - 1)]
    cost = 0.0
    for index, fingering in enumerate(choice):
        first = instrument.fingerings_for(notes[index].pitch)[0]
        sides = [side for side in (index - 1, index) if 0 <= side < len(steps)]
        places = {"chromatic"} if is_chromatic(notes, onset, index) else set()
        places |= {"trill"} if any(trill[side] for side in sides) else set()
        places |= {"fast"} if any(steps[side] <= 0.15 + 1e-9 and not trill[side] for side in sides) else set()
        tongued = index == 0 or onset[index] - end[index - 1] >= 0.01
        lifted = index > 0 and registers[index] > registers[index - 1]
        places |= {"attack"} if index == 0 or ((tongued or lifted) and not trill[index - 1]) else set()
        beside = stays(index, notes, fingering, instrument, onset, end)
        cost += choice_cost(fingering, first, end[index] - onset[index], places, beside)
    hurried, moved_by = [], []
    for index, step in enumerate(steps):
        a, b = choice[index], choice[index + 1]
        gap = max(onset[index + 1] - end[index], 0.0)
        if notes[index].pitch == notes[index + 1].pitch and a != b:
            ways = instrument.fingerings_for(notes[index].pitch)
            easy = min(max((step - 0.3) / 0.1, 0.0), 1.0) if slides or ways.index(b) < ways.index(a) else 0.0
            cost += (8.0 - 7.2 * easy) * max(1.0 - gap / 0.5, 0.0)
        hurry = max(0.085 / step - 1.0, 0.0)
        if trill[index]:
            hurry = max(hurry, 3.0 * max(0.15 / step - 1.0, 0.0))
        share, change, slide_cost = 0.0, 0.0, 0.0
        for control in slides:
            delta = b.controls.get(control.name, 0.0) - a.controls.get(control.name, 0.0)
            distance = abs(delta) * (control.motion.travel_m or 0.0)
            share = distance / 2.5 / (gap + 0.5 * (end[index] - onset[index]))
            smear = 1.0 if gap > 0.0 else 1.25
            slide_cost += smear * 3.0 * min(max(share - 0.7, 0.0), 0.3)
            slide_cost += 1.8 + 3.0 * (share - 1.0) if share > 1.0 else 0.0
            change = delta
        if slides and glide[index]:
            along = change * (notes[index + 1].pitch - notes[index].pitch) < 0.0
            still = held(a, instrument) == held(b, instrument)
            slide_cost = 0.0 if along and still else 6.0
        cost += slide_cost * (3.0 if trill[index] else 1.0)
        cost += (
            1.0
            * share_of_pace(step)
            * sum(
                abs(b.controls.get(control.name, 0.0) - a.controls.get(control.name, 0.0))
                * (control.motion.travel_m or 0.0)
                for control in slides
            )
        )
        jumps = fingers_cost(a, b, instrument, 9.0, gap, 0.0, False)
        cost += fingers_cost(a, b, instrument, step, gap, hurry, trill[index]) + jumps * (2.0 if trill[index] else 0.0)
        hurried.append(max(share - 0.7, 0.0))
        moved_by.append(change)
    for index in range(len(notes) - 2):
        if moved_by[index] * moved_by[index + 1] < -1e-6:
            cost += 0.5 * min(hurried[index], hurried[index + 1], 1.0)
        if slides and notes[index].pitch == notes[index + 2].pitch and abs(moved_by[index] + moved_by[index + 1]) > 0.1:
            cost += 4.0 * min(share_of_pace(steps[index]), share_of_pace(steps[index + 1]))
    return cost


def path_cost(problem: FingeringProblem, path: IntArray) -> float:
    """Cost of a path over the whole line as calculated by the search."""
    count = len(path)
    notes, steps = np.arange(count), np.arange(count - 1)
    cost = float(problem.local_cost[notes, path].sum() + problem.motions.cost[steps, path[:-1], path[1:]].sum())
    if problem.reversal_cost is not None:
        cost += float(problem.reversal_cost[steps[:-1], path[:-2], path[1:-1], path[2:]].sum())
    return cost


def share_of_pace(step: float) -> float:
    """Share of the cost of haste for a step of a length in seconds: 0 from half a second on, 1 up to 0.12 s."""
    return min(max((0.5 - step) / 0.38, 0.0), 1.0)


@given(st.sampled_from(sorted(INSTRUMENTS)), st.data())
@settings(max_examples=80, deadline=None)
def test_the_search_finds_the_cheapest_of_all_paths(name: str, data: st.DataObject) -> None:
    instrument, low, high = INSTRUMENTS[name]
    notes = data.draw(phrases(low, high, 6))
    problem = fingering_problem(notes, line_times(MonophonicPart("p", notes, instrument), PlainClock()), instrument, {})
    path = best_path(problem)
    ranked = [instrument.fingerings_for(note.pitch) for note in notes]
    chosen = naive_cost(notes, [ways[column] for ways, column in zip(ranked, path.tolist(), strict=True)], instrument)
    assert np.isclose(chosen, path_cost(problem, path), rtol=0.0, atol=1e-9)
    cheapest = min(naive_cost(notes, list(choice), instrument) for choice in itertools.product(*ranked))
    assert chosen <= cheapest + 1e-9


@given(st.sampled_from(sorted(INSTRUMENTS)), st.data())
@settings(max_examples=150, deadline=None)
def test_no_phrase_travels_further_or_faster_than_the_first_choices(name: str, data: st.DataObject) -> None:
    instrument, low, high = INSTRUMENTS[name]
    notes = data.draw(phrases(low, high, 60))
    times = line_times(MonophonicPart("p", notes, instrument), PlainClock())
    events, _ = plan_fingerings(notes, times, instrument, {})
    slides = [control for control in instrument.controls if control.role == "pitch" and control.kind == "slide"]
    kinds = {control.kind for control in instrument.controls if control.role == "pitch"}
    planned = [event.controls for event in events]
    onset, end = times.onset_s.tolist(), times.played_end_s.tolist()
    first = []
    for index, note in enumerate(notes):
        ways = instrument.fingerings_for(note.pitch)
        kept = [way for way in ways if stays(index, notes, way, instrument, onset, end)]
        first.append((kept or ways)[0].controls)

    def travel(controls: list[dict[str, float]], start: int, end: int) -> tuple[float, int, float]:
        metres, moves, fastest = 0.0, 0, 0.0
        for index in range(start, end - 1):
            for control in slides:
                place = [controls[at].get(control.name, 0.0) for at in (index, index + 1)]
                distance = abs(place[1] - place[0]) * (control.motion.travel_m or 0.0)
                free_s = times.onset_s[index + 1] - times.onset_s[index] - 0.5 * times.duration_s[index]
                metres += distance
                fastest = max(fastest, distance / free_s)
            for control in instrument.controls if kinds == {"press"} else ():
                if control.role == "pitch":
                    moves += controls[index].get(control.name, 0.0) != controls[index + 1].get(control.name, 0.0)
        return metres, moves, fastest

    silences = [float(times.onset_s[index + 1] - times.played_end_s[index]) for index in range(len(notes) - 1)]
    cuts = [0, *(index + 1 for index, silence in enumerate(silences) if silence >= 0.25), len(notes)]
    for begin, until in itertools.pairwise(cuts):
        for ours, table in zip(travel(planned, begin, until), travel(first, begin, until), strict=True):
            assert ours <= table + 1e-6


@given(st.data())
@settings(max_examples=40, deadline=None)
def test_a_pin_is_kept_wherever_it_is(data: st.DataObject) -> None:
    instrument, low, high = INSTRUMENTS["trombone"]
    notes = data.draw(phrases(low, high, 20))
    index = data.draw(st.integers(0, len(notes) - 1))
    label = data.draw(st.sampled_from([way.label for way in instrument.fingerings_for(notes[index].pitch)]))
    times = line_times(MonophonicPart("p", notes, instrument), PlainClock())
    events, _ = plan_fingerings(notes, times, instrument, {notes[index].id: label})
    assert events[index].label == label
    assert [event.corrected for event in events] == [at == index for at in range(len(notes))]
