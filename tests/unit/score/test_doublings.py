"""Players who change to another instrument within a track, and sounds that are no such change."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.messages import text
from app.project.importing import ImportRow, import_project, usual_rows
from app.project.model import map_choices
from app.score.assignments import PartAssignment
from app.score.contents import assigned_score
from app.score.model import MOST_VOICES, Score
from app.score.read import read_contents, read_midi
from instrument_maps.load import bundled_maps
from tests.unit.score.midi_bytes import END, chunk, header, meta, note

MAPS = map_choices(bundled_maps().values())


def program(number: int) -> bytes:
    return bytes([0, 0xC0, number])


def words(text: str) -> bytes:
    return meta(1, text.encode())


def music(*pitches: int) -> bytes:
    return b"".join(note(pitch) for pitch in pitches)


def write(tmp_path: Path, name: str, *events: bytes) -> Path:
    path = tmp_path / "piece.mid"
    track = (meta(3, name.encode()) if name else b"") + b"".join(events) + END
    path.write_bytes(header(1, 2) + chunk(b"MTrk", END) + chunk(b"MTrk", track))
    return path


def score_of(tmp_path: Path, name: str, *events: bytes) -> Score:
    return read_midi(write(tmp_path, name, *events), maps=MAPS)


def parts(score: Score) -> list[tuple[str, str, list[int]]]:
    return [(part.name, part.map_id, [one.pitch for one in part.notes]) for part in score.parts]


LOW, HIGH, BACK = music(72, 74), music(86, 88, 90), music(76, 77)


@pytest.mark.parametrize("name", ["Flute", "Flute / Piccolo", "Fl. 2"])
@pytest.mark.parametrize(
    ("there", "back"),
    [
        (program(72), program(73)),
        (words("to Picc."), words("to Fl.")),
        (words("muta in Ottavino"), words("muta in Flauto")),
        (words("nimmt Piccolo"), words("nimmt Flöte")),
        (words("(ピッコロに持ち替え)"), words("フルートに持替え")),
    ],
)
def test_a_flutist_changes_to_the_piccolo_and_back(tmp_path: Path, name: str, there: bytes, back: bytes) -> None:
    score = score_of(tmp_path, name, program(73), LOW, there, HIGH, back, BACK)
    assert parts(score) == [(name, "flute", [72, 74, 76, 77]), (f"Piccolo ({name})", "piccolo", [86, 88, 90])]
    assert [(part.id, part.voice) for part in score.parts] == [("2.1.1", 0), ("2.1.17", MOST_VOICES)]
    assert len({one.id for part in score.parts for one in part.notes}) == 7
    (warning,) = score.warnings
    assert (warning.id, warning.arguments["count"], warning.arguments["pitch"]) == ("score.doubling", 3, 86)
    assert text(warning).startswith(
        f"Piccolo ({name}): the player changes to Piccolo for 3 notes, the first at 1.2.000 (D6)"
    )


def test_a_part_for_two_instruments_may_begin_with_the_second(tmp_path: Path) -> None:
    score = score_of(tmp_path, "Flute / Piccolo", program(72), HIGH, program(73), LOW)
    assert {part.map_id: [one.pitch for one in part.notes] for part in score.parts} == {
        "flute": [72, 74],
        "piccolo": [86, 88, 90],
    }


@pytest.mark.parametrize(
    ("name", "events"),
    [
        # Muted trumpets, brass sections and strings are sounds; a cornet has no program; a name beats the program.
        ("Trumpet", (program(56), LOW, program(59), LOW, program(56), LOW)),
        ("", (program(56), LOW, program(59), LOW)),
        ("Trumpet", (program(56), LOW, program(61), LOW, program(48), LOW)),
        ("Cornet", (program(56), LOW, program(59), LOW, program(56), LOW)),
        ("Flute", (program(72), LOW)),
        ("Flute", (program(73), LOW, words("to Coda"), LOW, words("solo"), LOW, words("Piccolo solo follows"), LOW)),
        ("Flute", (program(72), program(73), LOW)),
    ],
)
def test_what_is_no_other_instrument_is_one_player(tmp_path: Path, name: str, events: tuple[bytes, ...]) -> None:
    score = score_of(tmp_path, name, *events)
    assert len(score.parts) == 1
    assert score.warnings == ()


def test_the_muted_program_alone_is_a_trumpet(tmp_path: Path) -> None:
    (part,) = score_of(tmp_path, "", program(59), LOW).parts
    assert (part.instrument, part.map_id, part.program) == ("trumpet", "trumpet_Bb", 59)


def test_who_merges_the_stretches_has_one_player_again(tmp_path: Path) -> None:
    contents = read_contents(write(tmp_path, "Flute", program(73), LOW, program(72), HIGH, program(73), BACK))
    (part,) = assigned_score(contents, [PartAssignment((0, 1))], MAPS).parts
    assert [one.pitch for one in part.notes] == [72, 74, 86, 88, 90, 76, 77]


def test_a_row_of_the_import_is_one_instruments(tmp_path: Path) -> None:
    contents = read_contents(write(tmp_path, "Flute", program(73), LOW, program(72), HIGH))
    rows = usual_rows(contents, bundled_maps())
    other = ImportRow(rows[1].assignment, character_id="another")
    project = import_project(contents, [rows[0], other], bundled_maps())
    # One musician plays both, with the character chosen for either.
    assert [player.character_id == "another" for player in project.players] == [True, True]
    assert len(project.bodies) == 1
