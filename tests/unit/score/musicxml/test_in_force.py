"""After a jump, directions apply by their position on the page: later ones do not apply to earlier measures."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.score.track_channel import TrackChannel
from tests.unit.score.musicxml.documents import document, dynamic, note, read, words

Q = 480
BACK = words("D.C. al Fine", '<sound dacapo="yes"/>')
FINE = words("Fine", '<sound fine="yes"/>')
REPEAT = '<barline location="right"><repeat direction="backward"/></barline>'


def played(folder: Path, *bars: str, name: str = "Flute", ending: str = BACK) -> tuple[TrackChannel, ...]:
    """Streams of bars with a Fine in the first and a jump to it after the last."""
    *others, last = (note("C5", 16) if one == "" else one for one in bars)
    first, *rest = others
    fine = FINE if ending == BACK else ""
    return tuple(read(folder, document(first + fine, *rest, last + ending, name=name)).channels)


@pytest.mark.parametrize("ending", [BACK, REPEAT])
def test_the_instrument_is_that_of_the_page(tmp_path: Path, ending: str) -> None:
    streams = played(tmp_path, note("C5", 16), words("to Picc.") + note("C6", 16), ending=ending)
    numbers = {stream.played_on: list(stream.numbers) for stream in streams}
    assert numbers == {"": [1, 3], "piccolo": [2] if ending == BACK else [2, 4]}


@pytest.mark.parametrize("word", ["con sord.", "gestopft", "<mute>"])
def test_a_mute_is_that_of_the_page(tmp_path: Path, word: str) -> None:
    said = words(word) if word != "<mute>" else "<sound><play><mute>straight</mute></play></sound>"
    (stream,) = played(tmp_path, note("C4", 16), said + note("C4", 16), name="Horn in F")
    assert [end - start for start, end in stream.muted] == [4 * Q]
    (stream,) = played(tmp_path, said + note("C4", 16), words("open") + note("C4", 16), name="Horn in F")
    assert len(stream.muted) == 2


def test_a_dynamic_is_that_of_the_page(tmp_path: Path) -> None:
    (stream,) = played(tmp_path, dynamic("p") + note("C5", 8) + note("C5", 8), dynamic("ff") + note("C5", 16))
    assert [*stream.velocities] == [49, 49, 112, 49, 49]
    (stream,) = played(tmp_path, note("C5", 16), dynamic("ff") + note("C5", 16))
    assert [*stream.velocities] == [80, 112, 80]
    (stream,) = played(tmp_path, dynamic("fp") + note("C5", 16), "", dynamic("ff") + note("C5", 16), ending=REPEAT)
    assert [*stream.velocities] == [96, 49, 112, 96, 49, 112]


def test_a_dal_segno_takes_what_was_said_before_its_sign(tmp_path: Path) -> None:
    segno = '<direction><direction-type><segno/></direction-type><sound segno="s"/></direction>'
    back = words("D.S. al Fine", '<sound dalsegno="s"/>')
    bars = (
        dynamic("p") + words("1.") + note("C5", 16),
        segno + note("C5", 16) + FINE,
        dynamic("f") + words("a2") + note("C5", 16) + back,
    )
    (stream,) = read(tmp_path, document(*bars, name="Horn in F 1.2")).channels
    assert [*stream.velocities] == [49, 49, 96, 49]
    assert stream.solos == ((0, 1), (8 * Q, 0), (12 * Q, 1))
    assert [(mark.tick, mark.text) for mark in stream.marks if mark.kind == "dynamic"] == [
        (0, "p"),
        (8 * Q, "f"),
        (12 * Q, "p"),
    ]


def test_a_transposition_is_that_of_the_page(tmp_path: Path) -> None:
    shift = "<attributes><transpose><chromatic>{}</chromatic></transpose></attributes>"
    (stream,) = played(
        tmp_path, shift.format(-2) + note("C5", 16), shift.format(-3) + note("C5", 16), name="Clarinet in Bb"
    )
    assert [*stream.pitches] == [70, 69, 70]
