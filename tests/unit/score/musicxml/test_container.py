"""MusicXML files in any encoding, compressed or not; refused files, within seconds."""

from __future__ import annotations

import io
import sys
import time
import zipfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest

from app.errors import FileError
from app.messages import LANGUAGES, text
from app.score.musicxml import container, parts
from tests.unit.score.musicxml.documents import HEAD, document, dynamic, listed, note, part, read, score, slur, words
from tests.unit.score.musicxml.test_notes import rows

PIECE = document(note("C4", 16), name="Trompete in B – ソロ")
INDEX = '<container><rootfiles><rootfile full-path="{}"/></rootfiles></container>'
ONE = [(0, 4, 60)]


def packed(**members: str | bytes) -> bytes:
    """Compressed file; two underscores in a name represent a slash."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name.replace("__", "/").replace("_xml", ".xml"), content)
    return stream.getvalue()


def refused(folder: Path, content: str | bytes, name: str = "piece.musicxml") -> str:
    start = time.process_time()
    with pytest.raises(FileError) as raised:
        read(folder, content, name)
    assert time.process_time() - start < 5
    for language in LANGUAGES:
        assert name in text(raised.value.message, language)
    return raised.value.message.id


@pytest.mark.parametrize(
    "content",
    [
        PIECE.encode("utf-8-sig"),
        PIECE.encode("utf-16"),
        PIECE.replace("UTF-8", "UTF-16").encode("utf-16-le"),
        # Declared as another encoding than it is in, as programs do that write through a string.
        PIECE.replace("UTF-8", "UTF-16").encode(),
        PIECE.replace("UTF-8", "Shift_JIS").replace("–", "-").encode("shift_jis"),
        b"\r\n \n" + PIECE.encode(),
        PIECE.replace("ソロ", "\x0b\x00").encode(),
    ],
)
def test_encodings_of_real_programs(tmp_path: Path, content: bytes) -> None:
    contents = read(tmp_path, content)
    assert rows(contents) == ONE
    assert contents.channels[0].name.startswith("Trompete in B")


@pytest.mark.parametrize(
    "doctype",
    [
        '<!DOCTYPE score-partwise PUBLIC "-//Recordare//DTD MusicXML 4.0 Partwise//EN" "http://www.musicxml.org/x.dtd">',
        '<!DOCTYPE score-partwise SYSTEM "file:///etc/passwd">',
        "<!DOCTYPE score-partwise>\n<!-- a comment -->",
        "<!DOCTYPE score-partwise []>",
    ],
)
def test_document_types_are_read_without_what_they_name(tmp_path: Path, doctype: str) -> None:
    assert rows(read(tmp_path, PIECE.replace(HEAD, HEAD + doctype))) == ONE


def test_compressed_files_hold_what_their_index_names(tmp_path: Path) -> None:
    other = document(note("D4", 16))
    both = packed(a_xml=other, scores__piece_xml=PIECE, **{"META-INF__container_xml": INDEX.format("scores/piece.xml")})
    assert rows(read(tmp_path, both, "piece.mxl")) == ONE
    assert rows(read(tmp_path, packed(piece_xml=PIECE), "piece.mxl")) == ONE
    # The format is recognised from the content.
    assert rows(read(tmp_path, both, "piece.mid")) == ONE


def test_a_score_by_measures(tmp_path: Path) -> None:
    attributes = "<attributes><divisions>4</divisions></attributes>"
    listing = listed("P1", "Flute") + listed("P2", "Tuba")
    first = f'<measure number="1"><part id="P1">{attributes}{note("C5", 16)}</part></measure>'
    second = (
        f'<measure number="2"><part id="P1">{note("D5", 16)}</part>'
        f'<part id="P2">{attributes}{note("C2", 16)}</part></measure>'
    )
    timewise = f"{HEAD}<score-timewise><part-list>{listing}</part-list>{first}{second}</score-timewise>"
    contents = read(tmp_path, timewise)
    assert rows(contents) == [(0, 4, 72), (4, 8, 74)]
    assert rows(contents, 1) == [(4, 8, 36)]


def test_damage_and_other_documents(tmp_path: Path) -> None:
    assert refused(tmp_path, PIECE[:-40]) == "musicxml.damaged"
    assert refused(tmp_path, "<html><body/></html>") == "musicxml.not_a_score"
    assert refused(tmp_path, "<opus><score/></opus>") == "musicxml.list_of_scores"
    assert refused(tmp_path, b"", "a.musicxml") == "musicxml.damaged"
    assert refused(tmp_path, b"PK\x03\x04 and no more", "a.mxl") == "musicxml.damaged_archive"
    assert refused(tmp_path, packed(readme="hello"), "a.mxl") == "musicxml.no_score_in_archive"
    assert refused(tmp_path, packed(piece_xml=PIECE)[:-200], "a.mxl") == "musicxml.damaged_archive"


def test_entities_are_refused(tmp_path: Path) -> None:
    laughs = "".join(f'<!ENTITY a{n} "{f"&a{n - 1};" * 10 if n else "ha" * 10}">' for n in range(12))
    bomb = PIECE.replace(HEAD, f"{HEAD}<!DOCTYPE score-partwise [{laughs}]>").replace("Trompete", "&a11;")
    assert refused(tmp_path, bomb) == "musicxml.entities"
    outside = PIECE.replace(HEAD, f'{HEAD}<!DOCTYPE score-partwise [<!ENTITY x SYSTEM "file:///etc/passwd">]>')
    assert refused(tmp_path, outside) == "musicxml.entities"


def test_bombs_are_refused(tmp_path: Path) -> None:
    spaces = packed(piece_xml=PIECE.encode() + b" " * 2**26)
    assert refused(tmp_path, spaces, "a.mxl") == "musicxml.archive_too_large"
    assert refused(tmp_path, "<a>" * 100_000) == "musicxml.too_deep"
    assert refused(tmp_path, score(*(listed(f"P{n}", "x") for n in range(50_000)))) == "musicxml.too_many_parts"
    late = "".join(f'<part id="P{number}"/>' for number in range(1000))
    timewise = f"{HEAD}<score-timewise><part-list/>{'<measure/>' * 3000}<measure>{late}</measure></score-timewise>"
    assert refused(tmp_path, timewise) == "musicxml.too_many_measures"
    long = document(note("C4", 16).replace("<duration>16<", "<duration>999999999<"))
    assert refused(tmp_path, long) == "musicxml.bad_value"
    assert refused(tmp_path, document(*[note("C4", 99_999)] * 50)) == "musicxml.too_long"
    jumps = [words("D.C.", '<sound dacapo="yes"/>') + note("C4", 1)] * 1000
    assert refused(tmp_path, document(*jumps)) == "musicxml.too_many_repeats"
    # Fewer, but each is played three hundred times.
    assert refused(tmp_path, document(*jumps[:300])) == "musicxml.too_many_notes"


@pytest.mark.parametrize("method", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_archives_are_packed_as_the_format_says(tmp_path: Path, method: int) -> None:
    """Other compression methods produce gigabytes from a kilobyte before they can be stopped."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", method) as archive:
        archive.writestr("a.xml", PIECE)
    assert refused(tmp_path, stream.getvalue(), "a.mxl") == "musicxml.damaged_archive"


@pytest.mark.parametrize("encoding", ["punycode", "idna", "utf-7", "zlib_codec", "unicode_escape", "undefined", "x"])
def test_what_is_no_encoding_of_documents_is_read_as_utf8(tmp_path: Path, encoding: str) -> None:
    assert rows(read(tmp_path, PIECE.replace('encoding="UTF-8"', f'encoding="{encoding}"'))) == rows(
        read(tmp_path, PIECE)
    )


def test_many_divisions_without_a_common_multiple_take_no_longer(tmp_path: Path) -> None:
    """Exact sums of fractions would become ever larger."""
    odd = [f"<attributes><divisions>{2 * number + 1}</divisions></attributes>" for number in range(1500)]
    text = document(*(one + note("C4", 2 * number + 1) for number, one in enumerate(odd)))
    (stream,) = read(tmp_path, text).channels
    assert stream.onset_ticks == [number * 10_080 for number in range(1500)]
    # The same within a measure, where rests and notes sum up.
    within = document("".join(one + note("C4", 1) for one in odd))
    started = time.process_time()
    assert len(rows(read(tmp_path, within))) == 1500
    assert time.process_time() - started < 1.0


def test_too_many_elements_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(container, "MOST_ELEMENTS", 10)
    assert refused(tmp_path, PIECE) == "musicxml.too_many_elements"


def test_too_many_measures_of_a_part_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parts, "MOST_BARS", 10)
    assert refused(tmp_path, document(*[""] * 11)) == "musicxml.too_many_measures"


def test_a_score_without_notes_opens_with_a_warning(tmp_path: Path) -> None:
    contents = read(tmp_path, score(listed("P1", "Flute"), part("P1", note("r", 16))))
    assert [message.id for message in contents.warnings] == ["musicxml.no_notes"]


def calls_made(work: Callable[[], object]) -> int:
    """Number of function calls including those of C, independent of the machine's load."""
    count = 0

    def seen(_frame: object, event: str, _argument: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(seen)
    try:
        work()
    finally:
        sys.setprofile(None)
    return count


def test_four_times_as_many_notes_take_about_four_times_as_many_calls(tmp_path: Path) -> None:
    bar = dynamic("mf") + "".join(
        note(name, 2, "<type>eighth</type><stem>up</stem>", notations=slur("start" if place % 2 == 0 else "stop"))
        for place, name in enumerate(("C5", "D5", "E5", "F5", "G5", "A5", "B5", "C6"))
    )
    calls = dict[int, int]()
    for bars in (100, 400):
        text = document(*[bar] * bars)
        # Values cached for all scores are computed here.
        assert len(read(tmp_path, text).channels[0].pitches) == 8 * bars
        calls[bars] = calls_made(partial(read, tmp_path, text))
    assert calls[400] < 4.2 * calls[100]
