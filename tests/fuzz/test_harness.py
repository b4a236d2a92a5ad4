"""The harness notices every way in which a reader can fail."""

from __future__ import annotations

import random
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.fuzz.harness import mutators, scores, seeds
from tests.fuzz.harness.campaign import Child, Result, Tally, keep, minimised
from tests.fuzz.harness.readers import KINDS

FAILING = "tests.fuzz.harness.failing"


@pytest.fixture(scope="module")
def child() -> Iterator[Child]:
    with Child(["failing"], FAILING) as result:
        yield result


@pytest.mark.parametrize(
    ("data", "outcome", "failure"),
    [
        (b"good", "accepted", ""),
        (b"refuse", "refused", ""),
        (b"unworded", "unworded", "unworded: KeyError in "),
        (b"late", "broken", "broken: save: file.cannot_write"),
        (b"abort", "killed", "killed: status -6"),
        (b"hang", "killed", "killed: status -24"),
        (b"large", "accepted", "costs more than 1 GB"),
        (b"larger", "escaped", "escaped: "),
        (b"x", "escaped", "escaped: KeyError"),
        (b"good again", "accepted", ""),
    ],
)
def test_each_failure_is_noticed(child: Child, data: bytes, outcome: str, failure: str) -> None:
    result = child.run("failing", data)
    assert result.outcome == outcome, result.detail
    assert result.failure.startswith(failure), result
    assert bool(result.failure) == bool(failure)


def test_what_fails_is_made_small_and_kept(tmp_path: Path) -> None:
    small = minimised("failing", b"a long text with an x in it" * 20, "escaped: KeyError in -", module=FAILING)
    assert small == b"x"
    kept = keep("midi", small, tmp_path)
    assert kept.parent == tmp_path / "midi"
    assert kept.suffix == ".mid"
    assert kept.read_bytes() == b"x"


def test_a_tally_knows_the_smallest_failure_and_the_worst_of_each_size() -> None:
    tally = Tally()
    assert tally.add(b"a" * 10, Result("accepted", "", "", 1.0, 100.0))
    assert not tally.add(b"b" * 10, Result("refused", "", "", 1.1, 90.0))
    for data in (b"cc", b"c", b"ccc"):
        tally.add(data, Result("escaped", "here", "", 0.1, 10.0))
    assert (tally.tries, tally.accepted, tally.refused) == (5, 1, 1)
    assert tally.failures["escaped: here"][:2] == (3, b"c")
    assert tally.worst[1000] == {"cpu_s": (1.1, b"b" * 10), "peak_mb": (100.0, b"a" * 10)}


@pytest.mark.parametrize("name", KINDS)
def test_a_seed_makes_the_same_mutants_again(name: str) -> None:
    kind = KINDS[name]
    first, second = (
        [mutators.mutated(kind.seeds(), chance, kind.structured) for _ in range(30)]
        for chance in (random.Random(5), random.Random(5))
    )
    assert first == second
    assert len(set(first)) > 20


def test_a_packed_score_does_not_depend_on_the_time(monkeypatch: pytest.MonkeyPatch) -> None:
    first = scores.packed("<score/>")
    monkeypatch.setattr(time, "localtime", lambda *_: time.struct_time((2000, 1, 2, 3, 4, 5, 6, 2, 0)))
    assert scores.packed("<score/>") == first


def test_mutants_of_midi_are_read_on() -> None:
    """The file is whole after its structure was changed: its lengths are right."""
    chance = random.Random(1)
    data = (seeds.ROOT / "resources/examples/quartet.mid").read_bytes()
    for _ in range(50):
        mutant = mutators.midi_events(data, chance)
        at = 14
        while at < len(mutant):
            assert mutant[at : at + 4] == b"MTrk"
            at += 8 + int.from_bytes(mutant[at + 4 : at + 8], "big")
        assert at == len(mutant)
