"""Scores in MusicXML: good ones with everything that the reader knows, and small ones that ask for much work."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable
from typing import Final

from tests.unit.score.musicxml.documents import (
    articulation,
    direction,
    document,
    dynamic,
    listed,
    note,
    part,
    score,
    slur,
    words,
)

_ORNAMENT: Final = "<ornaments><{}/></ornaments>"
_REPEAT: Final = '<barline location="right"><repeat direction="backward"{}/></barline>'
_ENDING: Final = '<barline location="{}"><ending number="{}" type="{}"/>{}</barline>'


def packed(text: str) -> bytes:
    """Compressed file without the present time, so that a seed always gives the same mutants."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        files = {
            "META-INF/container.xml": '<container><rootfiles><rootfile full-path="a.xml"/></rootfiles></container>',
            "a.xml": text,
        }
        for name, content in files.items():
            archive.writestr(zipfile.ZipInfo(name), content, zipfile.ZIP_DEFLATED, 9)
    return stream.getvalue()


def seeds() -> list[bytes]:
    """Small scores, one of them by measures and one compressed."""
    shift = "<attributes><transpose><chromatic>-2</chromatic></transpose></attributes>"
    marked = (
        dynamic("mf")
        + words("con sord.")
        + note("C5", 4, notations=slur("start") + articulation("accent"))
        + note("D5", 4, '<tie type="start"/>', notations=slur("stop"))
        + note("D5", 4, '<tie type="stop"/>', notations=articulation("breath-mark") + "<fermata/>")
        + note("E5", before="<grace/>")
        + note("E5", 4, notations=_ORNAMENT.format("trill-mark"))
    )
    sounding = (
        direction("<rehearsal>A</rehearsal>", '<sound tempo="96"/>')
        + direction('<wedge type="crescendo"/>')
        + note("F5", 8, notations=_ORNAMENT.format("turn") + articulation("staccato"))
        + note("A5", 4, before="<chord/>")
        + direction('<wedge type="stop"/>')
        + "<backup><duration>8</duration></backup><forward><duration>4</duration></forward>"
        + note("C4", 12, voice=2, notations="<technical><fingering>1</fingering><stopped/></technical>")
    )
    ended = (
        _ENDING.format("left", 1, "start", "")
        + note("G4", 16)
        + _ENDING.format("right", 1, "stop", "")
        + _REPEAT.format("")
    )
    again = _ENDING.format("left", 2, "start", "") + note("A4", 16) + words("D.C. al Fine")
    first = document(shift + marked, sounding + words("Fine"), words("rit.") + ended, again)
    inside = '<score-instrument id="I"><instrument-sound>brass.tuba</instrument-sound></score-instrument>'
    two = score(listed("P1", "Flute"), listed("P2", "x", inside), part("P1", note("C5", 16)), part("P2", note("x", 16)))
    timewise = two.replace("score-partwise", "score-timewise")
    return [first.encode(), two.encode("utf-16"), timewise.encode(), packed(first)]


def _bars(bar: str, size: int, after: str = "") -> str:
    """A score of as many equal bars as have room."""
    return document(*[bar] * max(size // (len(bar) + 40), 1), after or bar)


def repeats(size: int) -> bytes:
    """Return repeats of everything, as often as is taken."""
    return _bars(note("C5", 1) + _REPEAT.format(' times="64"'), size).encode()


def squeezed(size: int) -> bytes:
    """Return as many notes as compress into the size, each bar many times."""
    return packed(_bars(note("C5", 1) + _REPEAT.format(' times="64"'), 100 * size))


def spaces(size: int) -> bytes:
    """Return a packed score that unpacks to about a thousand times its size."""
    return packed(document(note("C5", 16)) + " " * (1000 * size))


def elements(size: int) -> bytes:
    """Return as many elements as there is room for."""
    return document("<a/>" * (size // 4)).encode()


def measures(size: int) -> bytes:
    """Return empty measures, compressed."""
    return packed(document(*[""] * (4 * size)))


def late_parts(size: int) -> bytes:
    """Return a score by measures whose parts all begin in the last one, compressed."""
    measures, late = "<measure/>" * (2 * size), "".join(f'<part id="{number}"/>' for number in range(size))
    text = f"<score-timewise><part-list/>{measures}<measure>{late}</measure></score-timewise>"
    return packed(text)


def parts(size: int) -> bytes:
    """Return parts without notes, compressed."""
    return packed(score(*(listed(f"P{number}", "") for number in range(size))))


def trills(size: int) -> bytes:
    """Return long notes with trills, in a slow tempo."""
    bar = direction("<words/>", '<sound tempo="5"/>') + note("C5", 4000, notations=_ORNAMENT.format("trill-mark"))
    return _bars(bar, size).encode()


def chords(size: int) -> bytes:
    """Return one chord of as many notes as there is room for, tied to itself."""
    tied = '<tie type="start"/><tie type="stop"/>'
    tone = note("C5", 4, tied, before="<chord/>", notations=slur("start") + slur("stop", 2))
    return document(note("C5", 4, tied) + tone * max(size // len(tone), 1)).encode()


def slurs(size: int) -> bytes:
    """Return slurs that never end on one note."""
    begun = slur("start") * max(size // 40, 1)
    return document(note("C5", 4, notations=begun) + note("C5", 4, notations=begun.replace("start", "stop"))).encode()


def tempi(size: int) -> bytes:
    """Return rit. and tempo in turns, at one place and one after another."""
    bar = words("rit.") + words("accel.") + '<sound tempo="7.1"/>' + note("C5", 1, notations="<fermata/>")
    return _bars(bar, size).encode()


def jumps(size: int) -> bytes:
    """Return measures that all jump to the beginning."""
    return _bars('<sound dacapo="yes"/>' + note("C5", 1), size).encode()


def nested(size: int) -> bytes:
    """Return repetitions within repetitions."""
    bar = note("C5", 1)
    count = max(size // (2 * len(bar) + 200), 1)
    forward = '<barline location="left"><repeat direction="forward"/></barline>'
    return document(*[forward + bar] * count, *[bar + _REPEAT.format(' times="64" after-jump="yes"')] * count).encode()


def divisions(size: int) -> bytes:
    """Return a measure of notes, each in divisions of its own."""
    one = "<attributes><divisions>{}</divisions></attributes>" + note("C5", 1)
    return document("".join(one.format(2 * place + 1) for place in range(max(size // (len(one) + 3), 1)))).encode()


COSTLY_SCORES: Final[tuple[Callable[[int], bytes], ...]] = (
    *(repeats, squeezed, spaces, elements, measures, parts, late_parts),
    *(trills, chords, slurs, tempi, jumps, nested, divisions),
)
