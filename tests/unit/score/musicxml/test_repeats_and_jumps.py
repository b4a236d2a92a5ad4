"""Order in which measures with repeats and jumps are played."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.errors import FileError
from app.score.musicxml.repeats_and_jumps import playing_order
from app.score.musicxml.written import Bar
from tests.unit.score.musicxml.documents import direction, document, note, read, words
from tests.unit.score.musicxml.test_notes import rows


def bars(text: str) -> list[Bar]:
    """Bars of a line like ``"|: a | 1[ b :] | 2[ c ]"``: measures between bars, ``1[`` begins an ending, ``]`` ends it,
    ``:`` before a bar repeats; words in capitals are signs."""
    found: list[Bar] = []
    for number, measure in enumerate(text.split("|"), 1):
        bar = Bar(str(number))
        for place, token in enumerate(measure.split()):
            if token == ":" and place == 0:
                bar.forward = True
            elif token.startswith(":"):
                bar.backward = int(token.strip(":]x") or 2)
                bar.ending_stop = token.endswith("]")
            elif token.endswith("["):
                bar.ending_start = frozenset(map(int, token[:-1].split(",")))
            elif token == "]":
                bar.ending_stop = True
            elif token == "TRIO":
                bar.said.add("trio")
            elif token in ("DC", "DS", "FINE", "TOCODA", "CODA", "SEGNO"):
                values = {"DC": ("da_capo", True), "DS": ("dal_segno", "s"), "FINE": ("fine", True)}
                values |= {"TOCODA": ("to_coda", "c"), "CODA": ("coda", "c"), "SEGNO": ("segno", "s")}
                setattr(bar, *values[token])
        found.append(bar)
    return found


@pytest.mark.parametrize(
    ("line", "played"),
    [
        ("a|b|c", "123"),
        ("a|b :|c", "12123"),
        ("a|: b|c :|d", "123234"),
        ("a|: b :3x|c", "12223"),
        ("a|1[ b :]|2[ c ]|d", "12134"),
        (": a|1,2[ b :]|3[ c ]|d", "1212134"),
        (": a|1[ b :]|2[ c :]|3[ d ]|e", "1213145"),
        (": a|1[ b :]|c", "1213"),
        ("a|b FINE|c DC", "12312"),
        ("a|SEGNO b|c FINE|d DS", "123423"),
        ("a|SEGNO b TOCODA|c DS|CODA d", "12324"),
        ("a TOCODA|b DC|CODA c", "1213"),
        # Repeats are not taken again after a jump, and the last ending is.
        (": a :|b FINE|c DC", "112312"),
        (": a|1[ b :]|2[ c ]|d FINE|e DC", "121345134"),
        # A minuet is played again without its trio, unless more is written.
        (": a :|TRIO b|c DC", "11231"),
        ("a FINE|b|TRIO c DC", "1231"),
        # Four repeated strains are a minuet and its trio, though no word says so; three or five are something else.
        (": a :|: b :|: c :|: d DC :", "1122334412"),
        ("a :|: b :|: c :|: d DC|e :", "112233454512"),
        (": a :|: b|1[ c :]|2[ d ]|: e :|: f|1[ g :]|2[ h DC ]", "1123245567681" + "24"),
        (": a :|: b :|: c DC :", "112233123"),
        (": a :|: b :|: c :|: d :|e DC", "11223344512345"),
        ("a|TRIO b|c", "123"),
        # Words before the last repeat of a trio; a bracket whose beginning a program omitted.
        ("a FINE|: b|c DC|d :|", "12342341"),
        ("a|b :]|2[ c ]|d", "12134"),
        # After endings, a repeat without a beginning applies to the measures after them.
        ("a|1[ b :]|2[ c ]|d :|e", "1213445"),
        ("a|1[ b :]|2[ c ]|d|1[ e :]|2[ f ]|g", "121345467"),
        (": a|1[ b :]|c|d :|e", "12134345"),
        # A section in a section: the outer sign leads to where the inner one ended.
        (": a|: b :|c :|d", "122334"),
    ],
)
def test_order(line: str, played: str) -> None:
    assert "".join(str(place + 1) for place in playing_order(bars(line), "x").measures) == played


def test_repeats_of_repeats_are_bounded() -> None:
    many = [bar for _ in range(4000) for bar in bars(": a :64x")]
    with pytest.raises(FileError, match="too_many_repeats"):
        playing_order(many, "x")


def test_a_jump_to_a_sign_that_is_not_there_is_reported(tmp_path: Path) -> None:
    contents = read(tmp_path, document(note("C4", 16) + words("D.S.", '<sound dalsegno="s"/>'), note("D4", 16)))
    assert [message.id for message in contents.warnings] == ["musicxml.lost_jump"]
    assert len(rows(contents)) == 2


def test_words_alone_say_where_to_go(tmp_path: Path) -> None:
    measures = (
        note("C4", 16),
        direction("<segno/>") + note("D4", 16) + words("To Coda"),
        note("E4", 16) + words("D.S. al Coda"),
        direction("<coda/>") + note("F4", 16),
    )
    assert [pitch for _, _, pitch in rows(read(tmp_path, document(*measures)))] == [60, 62, 64, 62, 65]
    measures = (note("C4", 16), note("D4", 16) + words("Fine"), note("E4", 16) + words("D.C. al Fine"))
    assert [pitch for _, _, pitch in rows(read(tmp_path, document(*measures)))] == [60, 62, 64, 60, 62]
    measures = (note("C4", 16), note("D4", 16) + words("Voice tacet on D.S."), note("E4", 16))
    contents = read(tmp_path, document(*measures))
    assert ([pitch for _, _, pitch in rows(contents)], contents.warnings) == ([60, 62, 64], ())


def test_a_tie_into_the_second_ending_is_one_note(tmp_path: Path) -> None:
    left = '<barline location="left"><ending number="{0}" type="start"/></barline>'
    right = '<barline location="right"><ending number="{0}" type="stop"/>{1}</barline>'
    back = '<repeat direction="backward"/>'
    measures = (
        note("C4", 16, '<tie type="start"/>'),
        left.format(1) + note("C4", 16, '<tie type="stop"/>') + right.format(1, back),
        left.format(2) + note("C4", 16, '<tie type="stop"/>') + right.format(2, ""),
    )
    assert rows(read(tmp_path, document(*measures))) == [(0, 8, 60), (8, 16, 60)]
