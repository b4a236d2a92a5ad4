"""All scores that music21 brings, and ours, as three readers read them; prints a table."""

from __future__ import annotations

import time

import pytest

from app.score.read import read_contents
from tests.support.notation import DATA, EXAMPLES, READERS, corpus, differences, others, ours, python_of_readers
from tests.support.notation_differences import known

SLOWEST = 0.5 / 3000
"""Greatest seconds per note."""


@pytest.mark.bench
def test_all_scores(capsys: pytest.CaptureFixture[str]) -> None:
    if not python_of_readers():
        pytest.skip("music21 and partitura are set up by ./test")
    names = (DATA / "music21_corpus.txt").read_text(encoding="utf-8").split()
    paths = [
        *sorted(path for path in DATA.iterdir() if path.suffix in (".xml", ".musicxml")),
        *sorted(EXAMPLES.glob("*.musicxml")),
        *sorted(
            path for path in (corpus() / "musicxml/lilypondTestSuite").iterdir() if path.suffix in (".xml", ".mxl")
        ),
        *(corpus() / "corpus" / name for name in names),
    ]
    read = [ours(path) for path in paths]
    unexpected = []
    for reader in READERS:
        equal = 0
        for path, own, other in zip(paths, read, others(reader, paths), strict=True):
            found, (expected, reason) = differences(own, other), known(str(path), reader)
            equal += not found
            if found != expected:
                unexpected.append((reader, path.name, sorted(found), sorted(expected)))
            elif found:
                with capsys.disabled():
                    print(f"\n{reader} {path.name}: {', '.join(sorted(found))}: {reason}", end="")
        with capsys.disabled():
            print(f"\n{reader}: {equal} of {len(paths)} files equal")
    assert not unexpected


@pytest.mark.bench
def test_a_long_score_is_read_quickly(capsys: pytest.CaptureFixture[str]) -> None:
    """Read a score as long as a symphony's movement: the time for each note, the fastest of three."""
    path = EXAMPLES / "quartet.musicxml"
    notes = sum(len(stream.pitches) for stream in read_contents(path).channels)
    taken = []
    for _ in range(3):
        started = time.process_time()
        read_contents(path)
        taken.append(time.process_time() - started)
    with capsys.disabled():
        print(f"\n3,000 notes of a score in {3000 * min(taken) / notes:.2f} s")
    assert min(taken) / notes < SLOWEST
