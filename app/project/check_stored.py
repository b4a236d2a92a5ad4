"""Checks that every value survives a file: each is encoded as in the file and decoded again.

`app.project.check` bounds the values; this module ensures that none is lost: non-finite numbers become ``null`` in
JSON, integers that arithmetic turned into floats have the wrong type, and lone surrogates are invalid text.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import Any, Final, NamedTuple, get_type_hints

import msgspec
import numpy as np

from app.encoding import is_text, stored
from app.errors import shortened
from app.plan.by_hand.corrections import Correction
from app.project.dance_corrections import DanceCorrection
from app.project.model import PlayerTakes, Project
from app.project.performers import Dancer, Player
from app.project.recording import AudioTrack
from app.project.value_checks import Fault
from app.project.video import VideoTrack
from app.score.model import ControllerCurve, Note, Part, Score
from metadata.model import Expression

_PARTS: Final = "parts"
_SETTINGS: Final = (
    *("seed", "preroll_beats", "section_intensity", "felt_beat_quarters"),
    *("conductor", "audio", "video", "read_timing", "imported", "ignored_problems", "cameras"),
)
"""Fields of a project whose values are stored unchanged."""


class _Group(NamedTuple):
    """Stored values of one type that are encoded together to be checked: a list whose index is part of the key path, or
    a single value.
    """

    place: str
    values: Sequence[Any]
    kind: Any
    is_list: bool = True


def stored_faults(project: Project, before: Project | None = None) -> Iterator[Fault]:
    """Yield key path and description of every value that would not be restored from a file.

    Parameters
    ----------
    before : Project, optional
        A project known to be valid: objects shared with it are not checked again.
    """
    known = {} if before is None else {group.place: group.values for group in _groups(before)}
    for place, values, kind, is_list in _groups(project):
        old = known.get(place, ())
        if values is old:
            continue
        sound = set(map(id, old))
        for index, value in enumerate(values):
            if id(value) not in sound:
                yield from unit_faults(value, kind, f"{place}[{index}]" if is_list else place)


def unit_faults(value: Any, kind: Any, place: str) -> Iterator[Fault]:
    """Yield the faults of a value that must be restored unchanged from a file as the type ``kind``; ``place`` is its
    key path.
    """
    value = _as_stored(value)
    try:
        decoder = _decoder(kind)
        back = decoder.decode(msgspec.json.encode(value, enc_hook=plain_number))
        if back != value:
            yield place, "would come back from the file as another value"
    except msgspec.ValidationError as error:
        detail, _, inside = str(error).partition(" - at `$")
        yield f"{place}{inside.removesuffix('`')}", shortened(detail)
    except UnicodeEncodeError:
        yield next(_not_text(value, place), place), "must be Unicode text"
    except (TypeError, ValueError, OverflowError, RecursionError) as error:
        yield place, shortened(error)


def plain_number(value: Any) -> Any:
    """Convert numpy numbers, left by calculations, for the encoder of a project."""
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{type(value).__name__} cannot be kept in a file")


def _groups(project: Project) -> Iterator[_Group]:
    score = project.score
    for name, kind in _hints(Score).items():
        if name != _PARTS:
            yield _Group(f"score.{name}", (getattr(score, name),), kind, is_list=False)
    yield _Group(f"score.{_PARTS}", score.parts, Part)
    yield _Group("players", project.players, Player)
    for player, corrections in project.corrections.items():
        yield _Group(f"corrections[{player!r}]", corrections, Correction)
    yield _Group("dancers", project.dancers, Dancer)
    for dancer, items in project.dance_corrections.items():
        yield _Group(f"dance_corrections[{dancer!r}]", items, DanceCorrection)
    yield _Group("expressions", project.expressions, Expression)
    for part, notes in project.read_notes.items():
        yield _Group(f"edited_notes[{part!r}]", (notes,), dict[str, Note], is_list=False)
    for part, curves in project.read_curves.items():
        yield _Group(f"edited_curves[{part!r}]", curves, ControllerCurve)
    hints = _hints(Project)
    for name in _SETTINGS:
        yield _Group(name, (getattr(project, name),), hints[name], is_list=False)
    for player, recorded in project.takes.items():
        yield _Group(f"takes[{player!r}]", (recorded,), PlayerTakes, is_list=False)


def _as_stored(value: Any) -> Any:
    """Return a value with its paths in stored form, since file names may be bytes that are not valid text."""
    if isinstance(value, AudioTrack | VideoTrack):
        return msgspec.structs.replace(value, path=stored(value.path))
    if isinstance(value, Dancer):
        return msgspec.structs.replace(value, choreography=stored(value.choreography))
    if isinstance(value, Player):
        choreography = stored(value.parameters.choreography)
        parameters = msgspec.structs.replace(value.parameters, choreography=choreography)
        return msgspec.structs.replace(value, parameters=parameters)
    return value


def _not_text(value: Any, place: str) -> Iterator[str]:
    """Yield the key paths of texts in a stored value that are not valid Unicode."""
    if isinstance(value, str):
        if not is_text(value):
            yield place
    elif isinstance(value, msgspec.Struct):
        for field in value.__struct_fields__:
            yield from _not_text(getattr(value, field), f"{place}.{field}")
    elif isinstance(value, Mapping):
        for key, item in value.items():
            yield from _not_text(key, place)
            yield from _not_text(item, f"{place}[{key!r}]")
    elif isinstance(value, tuple | list):
        for index, item in enumerate(value):
            yield from _not_text(item, f"{place}[{index}]")


@cache
def _decoder(kind: Any) -> msgspec.json.Decoder[Any]:
    return msgspec.json.Decoder(kind)


@cache
def _hints(kind: type) -> dict[str, Any]:
    return get_type_hints(kind)


# Created while the import lock is held: msgspec crashes if two threads use a type for the first time at once.
for _type in (
    Part,
    Player,
    Correction,
    Dancer,
    DanceCorrection,
    Expression,
    dict[str, Note],
    PlayerTakes,
    ControllerCurve,
):
    _decoder(_type)
for _struct, _names in ((Score, Score.__struct_fields__), (Project, _SETTINGS)):
    for _name in _names:
        _decoder(_hints(_struct)[_name])
