"""Small MusicXML documents from short descriptions."""

from __future__ import annotations

from pathlib import Path

from app.score.contents import PieceContents
from app.score.read import read_contents

HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'


def note(
    name: str, length: int = 4, *inside: str, notations: str = "", before: str = "", voice: int = 1, more: str = ""
) -> str:
    """Make a note ("C4", "F#5", "Bb3") or a rest ("r") with a length in sixteenths.

    Parameters
    ----------
    before : str
        Elements before the pitch: ``<grace/>``, ``<chord/>``.
    more : str
        Attributes.
    """
    if name == "r":
        pitch = "<rest/>"
    elif name.startswith("x"):
        pitch = "<unpitched><display-step>E</display-step><display-octave>4</display-octave></unpitched>"
    else:
        alter = {"#": "<alter>1</alter>", "b": "<alter>-1</alter>"}.get(name[1:-1], "")
        pitch = f"<pitch><step>{name[0]}</step>{alter}<octave>{name[-1]}</octave></pitch>"
    duration = "" if "<grace" in before else f"<duration>{length}</duration>"
    said = f"<notations>{notations}</notations>" if notations else ""
    return f"<note{more}>{before}{pitch}{duration}{''.join(inside)}<voice>{voice}</voice>{said}</note>"


def slur(kind: str, number: int = 1) -> str:
    """Make the beginning or end of a slur."""
    return f'<slur type="{kind}" number="{number}"/>'


def articulation(name: str) -> str:
    """Make an articulation."""
    return f"<articulations><{name}/></articulations>"


def direction(kind: str, sound: str = "") -> str:
    """Make a direction above the staff."""
    return f"<direction><direction-type>{kind}</direction-type>{sound}</direction>"


def words(text: str, sound: str = "") -> str:
    """Make words above the staff."""
    return direction(f"<words>{text}</words>", sound)


def dynamic(name: str) -> str:
    """Make a dynamic below the staff."""
    return direction(f"<dynamics><{name}/></dynamics>")


ATTRIBUTES = (
    "<attributes><divisions>4</divisions><key><fifths>0</fifths></key>"
    "<time><beats>4</beats><beat-type>4</beat-type></time></attributes>"
)


def part(id: str, *measures: str, attributes: str = ATTRIBUTES) -> str:
    """Make a part of some measures; the first contains the attributes."""
    rows = [
        f'<measure number="{number}">{attributes if number == 1 else ""}{content}</measure>'
        for number, content in enumerate(measures, 1)
    ]
    return f'<part id="{id}">{"".join(rows)}</part>'


def listed(id: str, name: str, inside: str = "") -> str:
    """Make the entry of a part in the list."""
    return f'<score-part id="{id}"><part-name>{name}</part-name>{inside}</score-part>'


def document(*measures: str, name: str = "Trumpet in Bb", inside: str = "", attributes: str = ATTRIBUTES) -> str:
    """Make a score of one part."""
    return score(listed("P1", name, inside), part("P1", *measures, attributes=attributes))


def score(*inside: str) -> str:
    """Make a score from its list of parts and its parts."""
    rows = "".join(one for one in inside if one.startswith("<score-part"))
    parts = "".join(one for one in inside if not one.startswith("<score-part"))
    return f'{HEAD}<score-partwise version="4.0"><part-list>{rows}</part-list>{parts}</score-partwise>'


def read(folder: Path, text: str | bytes, name: str = "piece.musicxml") -> PieceContents:
    """Read a document like a file."""
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_contents(path)
