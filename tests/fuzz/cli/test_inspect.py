"""Whatever bytes and words a user gives, the command line ends with a status and a sentence."""

from __future__ import annotations

import contextlib
import io
import json
import tempfile
from collections.abc import Sequence
from pathlib import Path

from hypothesis import example, given, settings
from hypothesis import strategies as st

from app.cli import main

ROOT = Path(__file__).parents[3]
_DUET = (ROOT / "tests" / "data" / "midi" / "ensemble" / "trumpet_duet_bach_minuet.mid").read_bytes()
SEED_FILE = _DUET.replace(b"staffA:", b"Trumpet").replace(b"staffB:", b"Trumpet")
"""A piece whose track names determine the instruments."""
QUARTET = ROOT / "resources" / "examples" / "quartet.mid"


def run(arguments: Sequence[str]) -> tuple[int, str, str]:
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = main(arguments)
    return status, out.getvalue(), err.getvalue()


def check(data: bytes) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "piece.mid"
        path.write_bytes(data)
        status, out, err = run(["inspect", str(path), "--json"])
    if status == 0:
        # Where the damage is in a name, nothing says which instrument plays the part.
        assert err == "" or err.startswith(f"suisou: {path}: nothing says which instruments play ")
        json.loads(out, parse_constant=lambda name: refuse(name))
    else:
        assert status == 1
        assert out == ""
        assert "piece.mid" in err


def refuse(name: str) -> None:
    raise AssertionError(f"{name} is no JSON number")


# Planning each takes half a second; the campaign reads thousands of damaged files.
@settings(max_examples=20, deadline=None)
@given(st.lists(st.tuples(st.integers(0, len(SEED_FILE) - 1), st.integers(0, 255)), max_size=6), st.integers(0, 400))
# One player plays trumpet and piccolo.
@example([(466, 192)], 0)
def test_damaged_files(changes: list[tuple[int, int]], cut: int) -> None:
    data = bytearray(SEED_FILE)
    for place, value in changes:
        data[place] = value
    check(bytes(data[: len(data) - cut]))


@settings(max_examples=40, deadline=None)
@given(st.binary(max_size=300), st.booleans())
def test_any_bytes(data: bytes, with_header: bool) -> None:
    check(SEED_FILE[:14] + data if with_header else data)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.text(max_size=30), max_size=3))
def test_any_settings(texts: list[str]) -> None:
    status, _, err = run(["inspect", str(QUARTET), "--no-contacts", *(f"--set={text}" for text in texts)])
    assert status in (0, 2)
    assert (status == 0) == (err == "")


@settings(max_examples=60, deadline=None)
@given(
    st.sampled_from(["*.amplitude", "Trumpet 1.seed", "*.posture", "*.cue_leader", "*.lung_s", "*.breath_min_beats"]),
    st.one_of(st.text(max_size=12), st.floats().map(str), st.integers().map(str)),
)
def test_any_values(name: str, value: str) -> None:
    status, _, err = run(["inspect", str(QUARTET), "--no-contacts", f"--set={name}={value}"])
    assert status in (0, 2)
    assert (status == 0) == (err == "")
