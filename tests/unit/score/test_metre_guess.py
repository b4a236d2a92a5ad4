"""Metres of files without time signatures: correct for real music, and none in unclear cases."""

from __future__ import annotations

import random
from pathlib import Path

import mido
import pytest

from app.errors import Message
from app.messages import text
from app.score.metre_guess import Line, guessed_metres
from app.score.metre_map import Metre
from app.score.read import read_contents
from app.score.stated_timing import UNSTATED, Assumed

MIDI = Path(__file__).parents[2] / "data" / "midi"
Q = 480


def without_metres(name: str, to: Path, jitter_s: float = 0.0) -> Path:
    """Write a piece without time signatures, with each note shifted randomly."""
    file, chance = mido.MidiFile(MIDI / name, clip=True), random.Random(name)
    reach = round(jitter_s * 2 * file.ticks_per_beat)
    for track in file.tracks:
        at, events = 0, []
        for message in track:
            at += message.time
            moved = at + chance.randint(0, reach) if message.type in ("note_on", "note_off") else at
            if message.type != "time_signature":
                events.append((moved, message))
        last = 0
        track.clear()
        for tick, message in sorted(events, key=lambda event: event[0]):
            track.append(message.copy(time=tick - last))
            last = tick
    file.save(to / "piece.mid")
    return to / "piece.mid"


@pytest.mark.parametrize(
    ("name", "metre"),
    [
        ("ensemble/trumpet_duet_bach_minuet.mid", (3, 4)),
        ("ensemble/concert_band_hall_tenth_regiment_march.mid", (6, 8)),
        ("ensemble/brass_quintet_pezel_sonata21.mid", (3, 2)),
    ],
)
@pytest.mark.parametrize("jitter_s", [0.0, 0.02])
def test_music_in_three_has_its_metre(name: str, metre: tuple[int, int], jitter_s: float, tmp_path: Path) -> None:
    contents = read_contents(without_metres(name, tmp_path, jitter_s))
    assert contents.metres == (Metre(0, *metre),)
    assert contents.pickup_ticks == 0
    note = Message("midi.metre_assumed", {"numerator": metre[0], "denominator": metre[1]})
    assert note in contents.warnings
    number = f"{metre[0]}/{metre[1]}"
    assert text(note, "en") == f"no time signature in the file: {number} assumed from the notes"
    assert number in text(note, "ja")


@pytest.mark.parametrize(
    "name",
    [
        "ensemble/brass_quartet_lutkin_2tpt_tbn_tuba.mid",
        "ensemble/cornets_sackbuts_speer_sonata.mid",
        "ensemble/oboe_bassoon_devienne_sonata2.mid",
        "ensemble/orch_brandenburg2_mv1_trumpet_recorder_oboe.mid",
        "ensemble/reed_trio_mozart_k229_mv1.mid",
        "ensemble/solo_altosax_bach_partita_allemande.mid",
        "ensemble/solo_cornet_arban_first_study10.mid",
        "ensemble/trombone_quartet_bach_air.mid",
        "awkward/keysig_9sharps_beethoven_coriolan.mid",
    ],
)
def test_music_in_two_or_four_stays_in_four(name: str) -> None:
    assert guessed_metres(*_notes(MIDI / name)) is None


def _notes(path: Path) -> tuple[list[Line], int]:
    """Lines of a file, and its ticks per quarter."""
    contents = read_contents(path)
    lines = [Line(stream.onset_ticks, stream.end_ticks, stream.pitches) for stream in contents.channels]
    return lines, contents.tempo_map.ticks_per_quarter


def test_the_bar_line_after_a_pickup_is_found() -> None:
    """A minuet that begins with the last quarter of a bar."""
    lines, quarter = _notes(MIDI / "ensemble/trumpet_duet_bach_minuet.mid")
    moved = [
        Line(
            [0, *(tick + quarter for tick in line.onset_ticks)],
            [quarter, *(tick + quarter for tick in line.end_ticks)],
            [line.pitches[0] - 5, *line.pitches],
        )
        for line in lines
    ]
    assert guessed_metres(moved, quarter) == ((Metre(0, 3, 4), Metre(quarter, 3, 4)), quarter)


@pytest.mark.parametrize("seed", range(4))
def test_notes_on_no_grid_and_few_notes_say_nothing(seed: int) -> None:
    chance = random.Random(seed)
    onsets = sorted(chance.sample(range(Q * 120), 300))
    ends = [tick + 200 for tick in onsets]
    assert guessed_metres([Line(onsets, ends, [60 + chance.randrange(12) for _ in onsets])], Q) is None
    assert guessed_metres([Line([0, 3 * Q, 6 * Q], [Q, 4 * Q, 7 * Q], [60, 62, 64])], Q) is None
    assert guessed_metres([], Q) is None


def test_chance_on_the_grid_seldom_looks_like_a_metre() -> None:
    found = []
    for seed in range(12):
        chance = random.Random(seed)
        onsets = sorted(chance.sample(range(0, Q * 120, Q // 2), 150))
        line = Line(onsets, [tick + Q // 2 for tick in onsets], [60 + chance.randrange(12) for _ in onsets])
        found.append(guessed_metres([line], Q))
    assert sum(metres is not None for metres in found) <= 2


def test_metres_of_an_earlier_version_are_kept(tmp_path: Path) -> None:
    """Kept in the new version's ticks, whatever its notes suggest; the standard's metre needs no guess."""
    path = without_metres("ensemble/trumpet_duet_bach_minuet.mid", tmp_path)
    quarter = mido.MidiFile(path).ticks_per_beat
    before = Assumed((Metre(0, 5, 8), Metre(2 * quarter, 5, 8)), 2 * quarter, 2 * quarter)
    kept = read_contents(path, assumed=before)
    assert (kept.metres, kept.pickup_ticks) == ((Metre(0, 5, 8), Metre(quarter, 5, 8)), quarter)
    standard = read_contents(path, assumed=Assumed(UNSTATED, 0, quarter))
    assert standard.metres == UNSTATED
    assert not [warning for warning in standard.warnings if warning.id == "midi.metre_assumed"]
