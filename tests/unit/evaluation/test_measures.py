"""Measures of the bundled quartet's first players, and of motions with known measures."""

from __future__ import annotations

from dataclasses import replace
from importlib.resources import as_file, files

import numpy as np
import pytest

from app.evaluation.measures import (
    VariantMeasures,
    VariantPlayerMeasures,
    measure,
    measure_variants,
    motions_of,
    quantity_of_motion_mm_s,
)
from app.evaluation.variants import LATE_S
from app.performance.ensemble import Performance
from app.project.edit.players import set_parameters
from app.project.model import Project, map_choices, project_from_score
from app.score.read import read_midi
from instrument_maps.load import bundled_maps


@pytest.fixture(scope="module")
def duet() -> Project:
    """A trumpet and a trombone of the bundled quartet."""
    maps = bundled_maps()
    with as_file(files("resources") / "examples" / "quartet.mid") as path:
        project = project_from_score(read_midi(path, maps=map_choices(maps.values())), maps)
    return replace(project, players=project.players[::3])


@pytest.fixture(scope="module")
def variants(duet: Project) -> dict[str, VariantMeasures]:
    found = measure_variants(duet, ("film", "generated", "still", "shifted"))
    return {one.variant: one for one in found}


def both(
    variants: dict[str, VariantMeasures], one: str, other: str
) -> list[tuple[VariantPlayerMeasures, VariantPlayerMeasures]]:
    """The same players of two variants."""
    return list(zip(variants[one].players, variants[other].players, strict=True))


def test_only_ours_are_measured(variants: dict[str, VariantMeasures]) -> None:
    assert list(variants) == ["generated", "still", "shifted"]
    assert [player.player for player in variants["still"].players] == ["Trumpet 1", "Trombone 2"]


def test_ours_is_in_time_and_keeps_contact(variants: dict[str, VariantMeasures]) -> None:
    for player in variants["generated"].players:
        assert player.lag.notes > 40
        assert player.lag.missed == 0
        assert (player.lag.detectable, player.lag.unacceptable) == (0.0, 0.0)
        assert player.contact == 1.0
        assert player.notes > 100


def test_late_fingers_are_found_as_late_as_they_are(variants: dict[str, VariantMeasures]) -> None:
    for late, ours in both(variants, "shifted", "generated"):
        assert late.lag.median_ms is not None
        assert ours.lag.median_ms is not None
        assert late.lag.median_ms - ours.lag.median_ms == pytest.approx(1000.0 * LATE_S, abs=2.0)
        assert (late.lag.notes, late.lag.missed) == (ours.lag.notes, 0)
        assert (late.lag.detectable, late.lag.unacceptable) == (1.0, 1.0)
        # Fingers go with their valves.
        assert late.contact == 1.0


def test_amplitude_is_seen_in_the_head_and_not_in_the_lag(duet: Project, variants: dict[str, VariantMeasures]) -> None:
    large = measure(Performance(set_parameters(duet, [player.id for player in duet.players], amplitude=1.0)))
    for one, half in both({**variants, "large": large}, "large", "generated"):
        assert one.head_mm_s is not None
        assert half.head_mm_s is not None
        assert one.head_mm_s > 1.3 * half.head_mm_s
        assert one.lag == half.lag
    for still, half in both(variants, "still", "generated"):
        assert still.head_mm_s is not None
        assert half.head_mm_s is not None
        assert still.head_mm_s < 0.8 * half.head_mm_s


def test_breaths_show(variants: dict[str, VariantMeasures]) -> None:
    for player in variants["generated"].players:
        breath = player.breath
        assert breath.breaths > 10
        for visible in (breath.chest_mm, breath.shoulders_mm, breath.ribs, breath.mouth):
            assert visible.at_breaths is not None
            assert visible.between is not None
            assert visible.at_breaths > 1.8 * visible.between


def test_motion_that_is_held_still_breaks_contact_and_is_missed(duet: Project) -> None:
    """Motionless fingers are off the moving keys."""
    performance = Performance(duet)
    whole = measure(performance)
    frozen = {
        player_id: replace(motion, rotations=np.repeat(motion.rotations[:1], motion.frames, axis=0))
        for player_id, motion in motions_of(performance).items()
    }
    for still, moving in zip(measure(performance, motions=frozen).players, whole.players, strict=True):
        assert still.contact is not None
        assert still.contact < 0.5
        assert moving.contact == 1.0


@pytest.mark.parametrize("hz", [0.5, 1.0, 4.0])
@pytest.mark.parametrize("fps", [24.0, 60.0])
def test_quantity_of_motion_of_a_sine(hz: float, fps: float) -> None:
    """The root mean square speed of a sine of 10 mm is its greatest speed over the square root of two."""
    times_s = np.arange(0.0, 40.0, 1.0 / fps)
    place_m = np.zeros((len(times_s), 3))
    place_m[:, 0] = 0.010 * np.sin(2.0 * np.pi * hz * times_s)
    inner = (times_s > 5.0) & (times_s < 35.0)
    found = quantity_of_motion_mm_s(place_m, fps, inner)
    # Differences over two frames make fast motion a little slower; the filter's edges take a little too.
    step = 2.0 * np.pi * hz / fps
    assert found == pytest.approx(10.0 * 2.0 * np.pi * hz / np.sqrt(2.0) * np.sin(step) / step, rel=0.12)


def test_what_is_no_motion_counts_nothing() -> None:
    times_s = np.arange(0.0, 40.0, 1.0 / 60.0)
    drift = np.stack([0.001 * times_s, np.zeros_like(times_s), np.zeros_like(times_s)], axis=1)
    everything = np.ones(len(times_s), np.bool_)
    found = quantity_of_motion_mm_s(drift, 60.0, (times_s > 10.0) & (times_s < 30.0))
    assert found == pytest.approx(0.0, abs=0.05)
    assert quantity_of_motion_mm_s(drift, 60.0, ~everything) is None
    assert quantity_of_motion_mm_s(drift[:30], 60.0, everything[:30]) is None
