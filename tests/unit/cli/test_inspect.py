"""What `suisou inspect` prints for people."""

from __future__ import annotations

from typing import Any

from app.cli.inspect import tables


def found(*labels: str) -> dict[str, Any]:
    notes = [{"pitch": 60 + index, "fingering": label} for index, label in enumerate(labels)]
    player = {"name": "One", "instrument": "thing", "notes": notes, "breaths": [], "cues": []}
    return {
        "duration_s": 1.0, "players": [player], "unplayed": [], "dancers": [], "left_out": [], "warnings": [],
        "ticks_per_beat": 480, "tempo": [{"bpm": 120.0}],
    }  # fmt: skip


def test_valves_stand_side_by_side() -> None:
    assert tables("x.mid", found("0", "13", "T2"))[-1].endswith("0 13 T2")


def test_fingerings_of_several_keys_are_distinguished() -> None:
    text = "\n".join(tables("x.mid", found("(open)", "L1 T", "L1 L2 T", "L1 L2 L3 T")))
    assert text.endswith("(open), L1 T, L1 L2 T")
