"""Ten minutes of players fit into 600 MB, since one player's motion and files are in memory at a time."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
TEN_MINUTES = ROOT / "tests" / "data" / "midi" / "awkward" / "long_14662notes_rossini_overture.mid"
MOST_BYTES = 600 * 2**20

MEASURING = """
import resource, sys
from app.cli import main
status = main(sys.argv[1:])
print(status, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024))
"""


@pytest.mark.bench
@pytest.mark.skipif(sys.platform == "win32", reason="no resource module")
def test_ten_minutes_of_two_players(tmp_path: Path) -> None:
    """Two players suffice to show whether the first is freed before the second is computed."""
    running = []
    for number, players in enumerate((["trumpet 1"], ["trumpet 1", "trombone 1"])):
        named = [argument for player in players for argument in ("--player", player)]
        arguments = ["export", str(TEN_MINUTES), "--to", str(tmp_path / f"out {number}"), *named]
        command = [sys.executable, "-c", MEASURING, *arguments]
        running.append(subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True))
    peaks = []
    for process in running:
        printed, errors = process.communicate()
        status, peak = printed.splitlines()[-1].split()
        assert status == "0", printed + errors
        peaks.append(int(peak))
    print(f"10 minutes at 60 frames/s: one player {peaks[0] / 1e6:.0f} MB, two players {peaks[1] / 1e6:.0f} MB")
    assert max(peaks) < MOST_BYTES
    assert peaks[1] - peaks[0] < 0.2 * MOST_BYTES
