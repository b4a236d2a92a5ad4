"""Output of ``suisou inspect --json`` for engraved music, checked by an independent reading."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli import main
from tests.support.judge import faults

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[3]
FILES = [
    *sorted((ROOT / "tests" / "data" / "midi" / "ensemble").glob("*.mid")),
    ROOT / "resources" / "examples" / "quartet.mid",
]


ASSIGNED = {
    "brass_quintet_pezel_sonata21.mid": ("Sopran=trumpet_Bb", "Tenor=trombone_tenor_F_attachment", "Bass=tuba_F"),
    "solo_trumpet_bach_bist_du_bei_mir.mid": ("*=trumpet_Bb",),
    "trumpet_duet_bach_minuet.mid": ("*=trumpet_Bb",),
}
"""Instruments of the files that do not name them."""


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_everything_printed_about_real_music_is_true(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assigned = [f"--assign={one}" for one in ASSIGNED.get(path.name, ())]
    # The judge uses sounding pitches, as in the file.
    options = ["--json", "--no-contacts", "--sounding", "*", "--set", "*.breath_need=0", "--felt-beat", "1", *assigned]
    assert main(["inspect", str(path), *options]) == 0
    assert faults(path, json.loads(capsys.readouterr().out)) == []


def test_a_rest_that_no_one_breathes_in_is_a_fault(capsys: pytest.CaptureFixture[str]) -> None:
    path = next(path for path in FILES if "lutkin" in path.name)
    assert main(["inspect", str(path), "--json", "--no-contacts", "--set", "*.breath_need=0", "--felt-beat", "1"]) == 0
    found = json.loads(capsys.readouterr().out)
    for player in found["players"]:
        # All but the first one, which needs no rest.
        player["breaths"] = [event for event in player["breaths"] if event["end_s"] < 1.0]
    wrong = faults(path, found)
    assert {fault.split(":")[0] for fault in wrong} == {player["name"] for player in found["players"]}
    assert all("no breath in" in fault or "no preparation" in fault for fault in wrong)
