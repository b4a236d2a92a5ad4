"""Motion computed by several copies of a process is equal to the bit, even if copies are killed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from dataclasses import astuple
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.motion.model import Motion
from app.performance import motion_copies
from app.performance.cast import performers_of
from app.performance.ensemble import Performance
from app.performance.motion import player_motion
from app.performance.motion_copies import shares
from app.performance.span import bars_span
from app.project.model import map_choices, project_from_score
from app.score.read import read_midi
from instrument_maps.load import bundled_maps

ROOT = Path(__file__).parents[3]


def test_without_free_cores_or_for_few_frames_nothing_is_copied() -> None:
    assert shares(100_000, 1) == [range(100_000)]
    assert shares(5000, 8) == [range(5000)]


def compare_copies() -> None:
    """Compare a motion with that of copies, with working ones and with killed ones."""
    maps = bundled_maps()
    score = read_midi(ROOT / "resources" / "examples" / "quartet.mid", maps=map_choices(maps.values()))
    performance = Performance(project_from_score(score, maps))
    player = performance.project.players[0]
    performer = performers_of(performance, (player,)).made[player.id]
    span = bars_span(performance, Fraction(24), (2, 4), 0.0)
    alone = player_motion(performance, performer, span)

    def killed(*_: Any) -> None:
        os.kill(os.getpid(), signal.SIGKILL)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(motion_copies, "_WORTH_FRAMES", span.count // 4)
        assert list(map(len, shares(span.count, 3))) != [span.count]
        assert same(player_motion(performance, performer, span, cores=3), alone)
        patch.setattr(motion_copies, "_make", killed)
        assert same(player_motion(performance, performer, span, cores=3), alone)


def same(one: Motion, other: Motion) -> bool:
    np.testing.assert_equal(astuple(one), astuple(other))
    return True


@pytest.mark.skipif(sys.platform != "linux", reason="processes are copied on Linux only")
def test_copies_make_the_same_bits() -> None:
    code = f"from {__name__} import *; compare_copies()"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
