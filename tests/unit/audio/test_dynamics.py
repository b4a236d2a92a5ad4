"""Dynamics of recordings with known expression: they are recovered, and players breathe and swell accordingly."""

from __future__ import annotations

import tracemalloc
from dataclasses import replace
from functools import cache

import msgspec
import numpy as np
import pytest
from scipy.stats import spearmanr

from app.audio.dynamics import RecordingLoudness, dynamics, loudness
from app.audio.mix import mixdown
from app.audio.score_sound import analysis_sound
from app.audio.track import RATE_HZ
from app.errors import AppError
from app.performance.ensemble import Performance
from app.project.edit.dynamics import set_dynamics
from app.project.model import Project
from app.score.model import ControllerCurve
from tests.unit.audio.pieces import quartet
from tests.unit.audio.test_offset import as_samples, end_s

EVERY = 120
"""Ticks between two values of the true expression."""


def expressive(seeds: dict[str, int]) -> Project:
    """The quartet with equal velocities, and smooth curves of expression by part."""
    project = quartet()
    ticks = np.arange(0, project.score.end_tick, EVERY)
    parts = []
    for part in project.score.parts:
        rng = np.random.default_rng(seeds[part.id])
        waves = sum(
            np.sin(2 * np.pi * (ticks / length + rng.random()))
            for length in (15360 * rng.uniform(0.7, 1.3), 5000, 2500)
        )
        values = tuple(np.round(0.65 + 0.1 * waves, 3).tolist())
        notes = tuple(msgspec.structs.replace(note, velocity=80) for note in part.notes)
        curve = ControllerCurve("expression", tuple(ticks.tolist()), values)
        parts.append(msgspec.structs.replace(part, notes=notes, curves=(curve,)))
    return replace(project, score=msgspec.structs.replace(project.score, parts=tuple(parts)))


def plain(project: Project) -> Project:
    """Return the project without controller curves: dynamics of the score alone."""
    parts = tuple(msgspec.structs.replace(part, curves=()) for part in project.score.parts)
    return replace(project, score=msgspec.structs.replace(project.score, parts=parts))


@cache
def together() -> Project:
    return expressive({part.id: 1 for part in quartet().score.parts})


def heard(project: Project) -> RecordingLoudness:
    return loudness(as_samples(mixdown(project, -1.0, end_s(project) + 1.0)), RATE_HZ)


@cache
def mix_of_all() -> RecordingLoudness:
    return heard(together())


def found(
    project: Project, mix: RecordingLoudness | None, stems: dict[str, RecordingLoudness] | None = None
) -> dict[str, ControllerCurve]:
    score = project.score
    return dynamics(score, -1.0, mix, stems or {}, {part.id for part in score.parts})


def values_at(curve: ControllerCurve, ticks: np.ndarray) -> np.ndarray:
    place = np.searchsorted(curve.ticks, ticks, side="right") - 1
    return np.array(curve.values)[np.maximum(place, 0)]


def correlation(project: Project, curves: dict[str, ControllerCurve], part_id: str) -> float:
    """Correlation of ranks while the part sounds."""
    part = next(part for part in project.score.parts if part.id == part_id)
    ticks = np.concatenate([np.arange(note.onset_tick, note.end_tick, 60) for note in part.notes])
    return float(spearmanr(values_at(curves[part_id], ticks), values_at(part.curves[0], ticks)).statistic)


def test_dynamics_of_everybody_are_found_in_one_recording() -> None:
    project = together()
    curves = found(plain(project), mix_of_all())
    for part in project.score.parts:
        value = correlation(project, curves, part.id)
        print(f"mix, {part.name}: {value:.3f}")
        assert value >= 0.8


def test_each_player_has_the_dynamics_of_their_stem() -> None:
    project = expressive({part.id: number for number, part in enumerate(quartet().score.parts)})
    stems = {}
    for player in project.players:
        stems[player.part_id] = heard(replace(project, players=(player,)))
    curves = found(plain(project), None, stems)
    for part in project.score.parts:
        value = correlation(project, curves, part.id)
        print(f"stem, {part.name}: {value:.3f}")
        assert value >= 0.8


def test_quiet_and_loud_stay_plausible() -> None:
    project = together()
    even = heard(plain(project))
    for mix in (mix_of_all(), even, RecordingLoudness(even.level_db * 3.0)):
        for curve in found(plain(project), mix).values():
            low, middle, high = np.quantile(
                values_at(curve, np.arange(0, project.score.end_tick, 60)), [0.05, 0.5, 0.95]
            )
            assert 0.15 <= low <= middle <= high <= 1.0
            assert 0.5 < middle < 0.75
    swing = np.ptp(np.quantile(next(iter(found(plain(project), even).values())).values, [0.1, 0.9]))
    assert swing < 0.25, "what hardly swells is not blown up"


def test_breath_follows() -> None:
    project = plain(together())
    after = set_dynamics(project, found(project, mix_of_all()))
    assert all(curve.kind == "breath" for part in after.score.parts for curve in part.curves)
    player, part = after.players[0], after.score.parts[0]
    events = Performance(after).plan(player).embouchures
    flat = {event.note_id: event.air for event in Performance(project).plan(player).embouchures}
    middles = {note.id: (note.onset_tick + note.end_tick) // 2 for note in part.notes}
    true = values_at(together().score.parts[0].curves[0], np.array([middles[event.note_id] for event in events]))
    more = np.array([event.air - flat[event.note_id] for event in events])
    assert spearmanr(more, true).statistic > 0.7


def test_silence_says_nothing() -> None:
    with pytest.raises(AppError, match="nothing_to_compare"):
        found(quartet(), loudness(np.zeros((10 * RATE_HZ, 2), np.int16), RATE_HZ))


def test_listening_takes_little_more_memory_than_the_recording() -> None:
    """An hour in double precision would take gigabytes."""
    samples = np.random.default_rng(1).integers(-9000, 9000, (60 * RATE_HZ, 2)).astype(np.int16)
    loudness(samples[:RATE_HZ], RATE_HZ)  # Libraries are loaded.
    for listen in (loudness, analysis_sound):
        tracemalloc.start()
        try:
            listen(samples, RATE_HZ)
            peak = tracemalloc.get_traced_memory()[1]
        finally:
            tracemalloc.stop()
        assert peak < 3 * samples.nbytes, listen
