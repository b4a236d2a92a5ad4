"""The saxophones' fingerings compared with three public charts, and their sizes with real ones."""

from __future__ import annotations

import csv
from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest

from app.formats.gltf.read import read_glb
from instrument_maps.load import bundled_maps, model_path

MAPS = {name: found for name, found in bundled_maps().items() if name.startswith("sax_")}
ALTO = MAPS["sax_alto_Eb"]
CHARTS = Path(__file__).parents[2] / "data" / "fingerings" / "saxophone.csv"
"""First choices (rank 1) and alternates (2 and more) of three charts."""

BY_MAKERS = {90: "makers print high F sharp; no chart goes so high", 57: "the chart's B and B flat key both: its error"}
"""Reason by written pitch why no chart has the map's first choice."""
ALTISSIMO = range(91, 95)
"""Written pitches above the charts' range, with Rascher's fingerings."""
FRONT = {"2L 3L ff oct", "2L ff oct sbb"}
"""Alternates published by makers of instruments with front F."""

FINGER = {
    "oct": "left thumb", "la": "left thumb", "1L": "left index", "bbb": "left index", "ff": "left index",
    "pd": "left index", "peb": "left index", "pf": "left index", "2L": "left middle", "3L": "left ring",
    "gs": "left little", "cs": "left little", "lb": "left little", "lbb": "left little", "1R": "right index",
    "se": "right index", "sc": "right index", "sbb": "right index", "2R": "right middle", "3R": "right ring",
    "afs": "right ring", "hfs": "right ring", "leb": "right little", "lc": "right little",
}  # fmt: skip
TOGETHER = ({"1L", "bbb"}, {"pd", "peb"}, {"pd", "peb", "pf"})
HEIGHT_M = {"sax_alto_Eb": (0.60, 0.70), "sax_tenor_Bb": (0.75, 0.86), "sax_baritone_Eb": (1.0, 1.15)}


def charts() -> dict[int, dict[str, list[int]]]:
    """Ranks by written pitch and fingering, one from each chart that contains it."""
    found: dict[int, dict[str, list[int]]] = defaultdict(lambda: defaultdict(list))
    with CHARTS.open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            found[int(row["written_pitch"])][row["fingering"]].append(int(row["rank"]))
    return found


def possible(label: str) -> bool:
    """Return whether ten fingers can play a fingering."""
    asked: dict[str, set[str]] = defaultdict(set)
    for sign in label.split() if label != "(open)" else ():
        asked[FINGER[sign]].add(sign)
    return all(len(signs) == 1 or signs in TOGETHER for signs in asked.values())


@pytest.mark.parametrize("written", range(58, 90))
def test_first_choices_are_the_charts_majority(written: int) -> None:
    label = ALTO.fingerings_for(written - ALTO.transposition_semitones)[0].label
    votes = {keys: ranks.count(1) for keys, ranks in charts()[written].items()}
    assert possible(label)
    assert votes[label] == max(votes.values())
    assert votes[label] >= 2


def test_alternates_are_in_a_chart_and_have_a_reason() -> None:
    for fingering in ALTO.fingerings:
        assert possible(fingering.label), fingering
        # The charts contain neither trills with palm keys nor keys kept pressed between notes.
        known = fingering.label in charts()[fingering.written_pitch] or {"trill", "held"} & set(fingering.tags)
        assert known or fingering.written_pitch in (*BY_MAKERS, *ALTISSIMO) or fingering.label in FRONT, fingering
        assert bool(fingering.tags) == (fingering.rank > 1), fingering


def test_all_saxophones_are_fingered_alike_and_sound_elsewhere() -> None:
    shifts = {"sax_soprano_Bb": 2, "sax_alto_Eb": 9, "sax_tenor_Bb": 14, "sax_baritone_Eb": 21}
    for name, instrument in MAPS.items():
        assert instrument.transposition_semitones == shifts[name]
        assert instrument.range.low == (57 if name == "sax_baritone_Eb" else 58) - shifts[name]
        assert instrument.range.high == ALTISSIMO[-1] - shifts[name]
        shared = [one for one in ALTO.fingerings if one.written_pitch >= instrument.range.low + shifts[name]]
        assert [one for one in instrument.fingerings if one.written_pitch >= 58] == shared


def test_b_flat_has_its_three_ways_and_one_for_trills_and_front_f_its_alternates() -> None:
    labels = [fingering.label for fingering in ALTO.fingerings_for(70 - 9)]
    assert labels == ["1L 2L sbb", "1L 1R", "1L bbb", "1L 2L gs sbb"]
    assert "2L ff oct" in [fingering.label for fingering in ALTO.fingerings_for(89 - 9)]


@pytest.mark.parametrize("name", sorted(MAPS))
def test_sizes_are_those_of_real_ones_and_pearls_fit_hands(name: str) -> None:
    instrument = MAPS[name]
    model = read_glb(model_path(instrument))
    points = np.vstack([
        primitive.positions + node.translation
        for node in model.nodes if node.mesh is not None
        for primitive in model.meshes[node.mesh].primitives
    ])  # fmt: skip
    extent = np.ptp(points, axis=0)
    if name == "sax_soprano_Bb":
        assert 0.63 < extent[2] < 0.70
    else:
        low, high = HEIGHT_M[name]
        assert low < extent[1] < high
    places = {
        contact.control: np.array(contact.position_m) + model.nodes[index].translation
        for contact in instrument.contacts
        for index, node in enumerate(model.nodes)
        if contact.control and not contact.together and node.name == contact.node
    }
    for hand in "LR":
        first, second, third = (places[f"key_{number}{hand}"] for number in (1, 2, 3))
        for a, b in ((first, second), (second, third)):
            assert 0.028 < np.linalg.norm(a - b) < 0.042
