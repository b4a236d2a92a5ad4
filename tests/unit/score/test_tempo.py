"""The tempo map compared with slow sums."""

import numpy as np
import pytest

from app.score.tempo import TempoChange, TempoMap


def slow_seconds(tempo_map: TempoMap, tick: int) -> float:
    """Seconds calculated tick by tick according to the definition."""
    tempo = tempo_map.changes[0].microseconds_per_quarter
    if tick < 0:
        return tick * tempo / 1e6 / tempo_map.ticks_per_quarter
    changes = {change.tick: change.microseconds_per_quarter for change in tempo_map.changes}
    total = 0.0
    for now in range(tick):
        tempo = changes.get(now, tempo)
        total += tempo / 1e6 / tempo_map.ticks_per_quarter
    return total


RITARDANDO = TempoMap.of_changes(96, [TempoChange(0, 400_000), TempoChange(96, 450_000), TempoChange(150, 900_000)])


@pytest.mark.parametrize("tick", [-200, -1, 0, 1, 95, 96, 97, 149, 150, 151, 400])
def test_seconds_are_the_sum_of_the_ticks(tick: int) -> None:
    assert RITARDANDO.seconds(tick) == pytest.approx(slow_seconds(RITARDANDO, tick), abs=1e-12)


def test_arrays_keep_their_shape_and_agree_with_scalars() -> None:
    ticks = np.arange(-100, 300).reshape(20, 20)
    seconds = RITARDANDO.seconds(ticks)
    assert seconds.shape == ticks.shape
    assert seconds.dtype == np.float64
    assert [RITARDANDO.seconds(int(tick)) for tick in ticks.flat] == seconds.ravel().tolist()


def test_the_thesis_example_lasts_a_quarter_and_half_a_second() -> None:
    # 240 and 480 ticks at time base 480 and 120 beats per minute (reference T3).
    tempo_map = TempoMap(480)
    assert tempo_map.seconds(240) == 0.25
    assert tempo_map.seconds(720) - tempo_map.seconds(240) == 0.5


def test_a_file_without_tempo_goes_at_120_and_a_late_first_tempo_does_not_change_the_start() -> None:
    tempo_map = TempoMap.of_changes(480, [TempoChange(960, 1_000_000)])
    assert tempo_map.bpm == ((0, 120.0), (960, 60.0))
    assert tempo_map.seconds(1440) == 2.0


def test_the_last_of_several_tempi_at_one_tick_counts_and_repetitions_fall_away() -> None:
    changes = [TempoChange(0, 700_000), TempoChange(0, 600_000), TempoChange(50, 600_000), TempoChange(90, 500_000)]
    assert TempoMap.of_changes(100, changes).changes == (TempoChange(0, 600_000), TempoChange(90, 500_000))


@pytest.mark.parametrize(
    ("ticks_per_second", "ticks_per_quarter"),
    [(25 * 40, 500), (24 * 4, 48), (30 * 80, 1200), (30000 / 1001 * 80, 1199)],
)
def test_smpte_ticks_keep_their_duration(ticks_per_second: float, ticks_per_quarter: int) -> None:
    tempo_map = TempoMap.of_smpte(ticks_per_second)
    assert tempo_map.ticks_per_quarter == ticks_per_quarter
    assert tempo_map.seconds(123_456) == pytest.approx(123_456 / ticks_per_second, rel=1e-13)
    assert tempo_map.bpm[0][1] == pytest.approx(120, rel=1e-3)
