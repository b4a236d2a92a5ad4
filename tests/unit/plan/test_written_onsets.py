"""Where in its bar a note stands that somebody played: where it would be written."""

from __future__ import annotations

import numpy as np

from app.plan.generate import Line, Piece, make_plans, time_frame
from app.plan.line import line_times
from app.plan.lungs import notated, written_onsets
from tests.support.plan import PlainClock, line_of, valves

QUARTER = 480


def test_played_onsets_stand_where_they_would_be_written() -> None:
    # Eighths, triplets and sixteenths, up to 15 ms early or late at 120 quarters a minute.
    written = np.array([0, 240, 480, 640, 800, 960, 1080, 1200, 1320, 1440])
    late = np.array([9, -14, 3, 14, -7, -11, 5, 14, -3, -9])
    assert written_onsets(np.maximum(written + late, 0), QUARTER).tolist() == written.tolist()


def test_written_onsets_are_kept_to_the_tick() -> None:
    thirty_seconds = np.arange(0, 1920, 60)
    assert written_onsets(thirty_seconds, QUARTER) is thirty_seconds
    assert written_onsets(np.append(thirty_seconds, 1931), QUARTER)[-1] == 1931


def test_a_silence_is_no_longer_than_the_written_step() -> None:
    """Two notes 40 ms apart that share a place in the score, among notes off the grid."""
    onsets = [11, 490, 530, 1013, 1451, 1931]
    clock = PlainClock()
    line = Line("p", line_of(*((onset, 10, 65) for onset in onsets)), valves())
    score = notated(line_times(line, clock), Piece(clock))
    assert (score.silence_tick[1:] <= np.diff(score.onset_tick)).all()
    assert (score.played_end_tick >= score.onset_tick).all()
    assert make_plans(Piece(clock), (line,), time_frame((line,), clock))["p"].breaths
