"""Edits of a map's fingering table as pure functions, and the user's map file with changed fingerings.

Every edit returns a new tuple of fingerings, sorted, with ranks that count from 1; `problems_of` returns why a map with
them would be refused.
"""

from __future__ import annotations

import json
import os
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import msgspec

from app.errors import MapError, UsageError
from app.formats.atomic import atomic_write
from app.formats.files import cannot_write
from app.formats.toml import toml_text
from instrument_maps.extend import BASE
from instrument_maps.fingering_label import HALF, NONE, OPEN, controls_of, says_words, words_of
from instrument_maps.load import bundled_maps, parse_map, parse_table
from instrument_maps.model import Fingering, InstrumentMap
from instrument_maps.validate import problems
from instrument_maps.value_checks import Problem

Table: TypeAlias = tuple[Fingering, ...]

_OURS = frozenset({BASE, "id", "fingerings"})
_ROW_KEYS = ("written_pitch", "rank", "label", "controls", "cents", "correction", "fingers", "tags")


def read_label(instrument: InstrumentMap, text: str) -> tuple[str, dict[str, float]]:
    """Parse a fingering that the user typed: its label, and the values of its controls by name.

    Signs may be in any order and case if that is unambiguous; a slide's position is that of other fingerings with the
    label.

    Raises
    ------
    UsageError
        A sign or a position of the slide is unknown.
    """
    pitch = [control for control in instrument.controls if control.role == "pitch"]
    text = " ".join(text.split())
    if any(control.kind == "slide" for control in pitch):
        known = [one for one in instrument.fingerings if one.label.casefold() == text.casefold()]
        if not known:
            places = dict.fromkeys(one.label for one in instrument.fingerings)
            raise UsageError("fingering.unknown_place", text=text, places=", ".join(sorted(places)))
        middle = sorted(known, key=lambda one: sorted(one.controls.values()))[len(known) // 2]
        return middle.label, dict(middle.controls)
    signs = {control.label: control.label for control in pitch if control.label}
    signs |= {f"{control.label}{HALF}": f"{control.label}{HALF}" for control in pitch if control.half_value is not None}
    folded: dict[str, list[str]] = {}
    for sign in signs:
        folded.setdefault(sign.casefold(), []).append(sign)

    def meant(word: str) -> str:
        near = folded.get(word.casefold(), [])
        return word if word in signs or len(near) != 1 else near[0]

    words = says_words(pitch)
    none = OPEN if words else NONE
    if text.casefold() in ("", none, OPEN, "open", NONE):
        return none, {}
    reported = (
        " ".join(map(meant, text.replace(",", " ").split())) if words else "".join(map(meant, text.replace(" ", "")))
    )
    values = controls_of(reported, pitch)
    if values is None:
        raise UsageError("fingering.unknown_sign", text=text, signs=", ".join([none, *signs]))
    return (words_of(values, pitch) if words else reported), values


def with_label(instrument: InstrumentMap, table: Table, written: int, rank: int, text: str) -> Table:
    """Return the table with a new label for the fingering with this written pitch and rank; its control values follow
    from the label. Raises as `read_label`, and UsageError if the note has this label already.
    """
    label, controls = read_label(instrument, text)
    if any(one.label == label and one.rank != rank for one in of_pitch(table, written)):
        raise UsageError("fingering.twice", text=label)
    old = next(one for one in of_pitch(table, written) if one.rank == rank)
    if old.label == label:
        return table
    return _changed(table, written, rank, label=label, controls=controls, correction={}, fingers={})


def pressed_label(instrument: InstrumentMap, one: Fingering, name: str) -> str:
    """Return the label of a fingering after a click on one of its controls, which cycles from up to down, half down (if
    possible) and up again.
    """
    control = instrument.control(name)
    value = one.controls.get(name, control.rest_value)
    steps = [0.0, 1.0] if control.half_value is None else [0.0, 1.0, control.half_value]
    # A value between both ends is set to the other end than the nearer one.
    after = steps[(steps.index(value) + 1) % len(steps)] if value in steps else float(value < 0.5)
    values = {**one.controls, name: after}
    pitch = [control for control in instrument.controls if control.role == "pitch"]
    if says_words(pitch):
        return words_of(values, pitch)
    down = "".join(
        control.label for control in pitch if control.kind != "slide" and values.get(control.name, 0.0) > 0.0
    )
    if any(control.kind == "slide" for control in pitch):
        return down + one.label.lstrip("".join(control.label for control in pitch))
    return down or NONE


def read_cents(text: str) -> float:
    """Read typed cents; an empty text is 0. Raises UsageError for an invalid number."""
    try:
        return float(text.replace("−", "-").replace(",", ".").removesuffix("¢") or 0.0)
    except ValueError:
        raise UsageError("fingering.no_number", text=text) from None


def free_label(instrument: InstrumentMap, table: Table, written: int) -> str | None:
    """Return a valid label that no fingering of a note has yet, the most common one; None if there is none."""
    own = {one.label for one in of_pitch(table, written)}
    counts = Counter(one.label for one in instrument.fingerings)
    for label, _ in counts.most_common():
        if label not in own:
            more = added(instrument, table, written, label)
            if not problems_of(instrument, more):
                return label
    return None


def with_cents(table: Table, written: int, rank: int, cents: float) -> Table:
    """Return the table with a new deviation in cents for the fingering with this written pitch and rank."""
    return _changed(table, written, rank, cents=float(cents))


def with_tags(table: Table, written: int, rank: int, tags: Iterable[str]) -> Table:
    """Return the table with new tags for the fingering with this written pitch and rank."""
    return _changed(table, written, rank, tags=tuple(dict.fromkeys(tag.strip() for tag in tags if tag.strip())))


def moved(table: Table, written: int, rank: int, by: int) -> Table:
    """Return the table with one fingering moved earlier (``by`` -1) or later among those of its note."""
    own = list(of_pitch(table, written))
    target = rank - 1 + by
    if not 0 <= target < len(own):
        return table
    own.insert(target, own.pop(rank - 1))
    return _with_pitch(table, written, own)


def added(instrument: InstrumentMap, table: Table, written: int, text: str) -> Table:
    """Return the table with one more alternate fingering of a note, in last place. Raises as `with_label`."""
    label, controls = read_label(instrument, text)
    own = of_pitch(table, written)
    if any(one.label == label for one in own):
        raise UsageError("fingering.twice", text=label)
    new = Fingering(written, len(own) + 1, label, controls, tags=("alternate",))
    return _with_pitch(table, written, [*own, new])


def removed(table: Table, written: int, rank: int) -> Table:
    """Return the table without one fingering. Raises UsageError for the last one of a note."""
    own = of_pitch(table, written)
    if len(own) < 2:
        raise UsageError("fingering.last")
    return _with_pitch(table, written, [one for one in own if one.rank != rank])


def reverted(table: Table, base: Table, written: int) -> Table:
    """Return the table with the fingerings of one note replaced by those of ``base``."""
    return _with_pitch(table, written, list(of_pitch(base, written)))


def of_pitch(table: Table, written: int) -> Table:
    """Return the rows of a fingering table with a written pitch."""
    return tuple(one for one in table if one.written_pitch == written)


def problems_of(instrument: InstrumentMap, table: Table) -> tuple[Problem, ...]:
    """Return the reasons why a map with this table would be refused."""
    return tuple(problems(msgspec.structs.replace(instrument, fingerings=table)))


def _changed(table: Table, written: int, rank: int, **fields: Any) -> Table:
    return tuple(
        msgspec.structs.replace(one, **fields) if (one.written_pitch, one.rank) == (written, rank) else one
        for one in table
    )


def _with_pitch(table: Table, written: int, own: Sequence[Fingering]) -> Table:
    ranked = [msgspec.structs.replace(one, rank=place) for place, one in enumerate(own, 1)]
    others = [one for one in table if one.written_pitch != written]
    return tuple(sorted([*others, *ranked], key=lambda one: (one.written_pitch, one.rank)))


# User's file


def base_table(instrument: InstrumentMap, path: Path | None) -> Table:
    """Fingerings of the map that a user's map extends; for a bundled map its own fingerings; empty if the user's map
    extends none.
    """
    if path is None:
        return instrument.fingerings
    text = toml_text(path)
    base = parse_table(text, str(path)).get(BASE)
    if not isinstance(base, str):
        return ()
    bare = f'{BASE} = "{base}"\nid = "{instrument.id}"\n'
    return parse_map(bare, str(path)).fingerings


def own_text(instrument: InstrumentMap, table: Table, text: str | None, file: str) -> str | None:
    """Return the text of the user's map file with a changed fingering table; None if the table equals that of the
    extended map, so that no file is needed.

    Parameters
    ----------
    instrument : InstrumentMap
        Map before the change.
    table : tuple of Fingering
        The changed fingerings.
    text : str or None
        Present text of the user's file, whose other lines are kept; None if there is none, so that the bundled map is
        extended.
    file : str
        Path of the file, beside which the extended map is looked for.

    Raises
    ------
    MapError
        The user's file has a syntax error or cannot be rewritten, or the result is invalid.
    """
    known: dict[str, Any] = {} if text is None else parse_table(text, file)
    fresh = text is None
    if text is None:
        text = (
            f"# {instrument.name.en}: your own version. What is not said here is as in the map it extends.\n\n"
            f'{BASE} = "{instrument.id}"\nid = "{instrument.id}"\n'
        )
    base = parse_table(text, file).get(BASE)
    below = bundled_maps()[instrument.id].fingerings if fresh else ()
    if not fresh and isinstance(base, str):
        below = parse_map(f'{BASE} = "{base}"\nid = "{instrument.id}"\n', file).fingerings
    pitches = sorted({one.written_pitch for one in table})
    reported = [
        one for pitch in pitches if of_pitch(table, pitch) != of_pitch(below, pitch) for one in of_pitch(table, pitch)
    ]
    if not reported and (fresh or set(known) <= _OURS):
        return None
    result = _without_block(text)
    if reported:
        result = _with_block(result, _block(reported, instrument))
    try:
        read = parse_map(result, file)
        rest = {key: value for key, value in parse_table(result, file).items() if key != "fingerings"}
    except MapError as error:
        if error.message.id == "table.syntax":
            raise MapError("map.not_rewritten", file=file) from error
        raise
    if read.fingerings != table or (not fresh and rest != {key: v for key, v in known.items() if key != "fingerings"}):
        raise MapError("map.not_rewritten", file=file)
    return result


def save_own(instrument: InstrumentMap, table: Table, folder: Path) -> Path | None:
    """Write the user's map file with a changed fingering table, and return its path; None if the table has no
    differences from the extended map, so that the file was deleted.

    Raises
    ------
    MapError
        As in `own_text`.
    FileError
        The user's file cannot be read, or the folder or file cannot be written.
    """
    path = folder / f"{instrument.id}.toml"
    before = toml_text(path) if os.path.exists(path) else None
    text = own_text(instrument, table, before, str(path))
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if text is None:
            path.unlink(missing_ok=True)
            return None
    except OSError as error:
        raise cannot_write(path, error) from error
    with atomic_write(path) as stream:
        stream.write(text.encode())
    return path


def _block(reported: Sequence[Fingering], instrument: InstrumentMap) -> str:
    rows = "\n".join(f"  {_row(one, instrument)}," for one in reported)
    return f"fingerings = [\n{rows}\n]\n"


def _row(one: Fingering, instrument: InstrumentMap) -> str:
    values = msgspec.structs.asdict(one)
    if controls_of(one.label, instrument.controls) == one.controls:
        values["controls"] = {}
    if not one.cents:
        del values["cents"]
    return _inline({key: values[key] for key in _ROW_KEYS if values.get(key) not in (None, {}, ())})


def _inline(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {_inline(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(_inline, value)) + "]"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return repr(value)


_KEY = re.compile(r"^fingerings\s*=\s*\[", re.MULTILINE)
_TABLE = re.compile(r"^\s*\[", re.MULTILINE)


def _without_block(text: str) -> str:
    """Remove the list of fingerings from the text of a map file."""
    found = _KEY.search(text)
    if found is None:
        return text
    end = _closing(text, found.end())
    return text[: found.start()] + text[end:].lstrip("\n")


def _with_block(text: str, block: str) -> str:
    """Insert a list of fingerings into the text of a map file, before the first table, since lines after a table's
    header would belong to that table.
    """
    first = _TABLE.search(text)
    at = len(text) if first is None else first.start()
    head = text[:at].rstrip("\n")
    return f"{head}\n\n{block}" + (f"\n{text[at:].lstrip(chr(10))}" if text[at:].strip() else "")


def _closing(text: str, at: int) -> int:
    """Return the index of the bracket that closes the list opened before ``at``, ignoring strings and comments."""
    depth, quote = 1, ""
    while at < len(text) and depth:
        sign = text[at]
        if quote:
            at += 1 if sign == "\\" and quote == '"' else 0
            quote = "" if sign == quote else quote
        elif sign == "#":
            at = text.find("\n", at) if "\n" in text[at:] else len(text)
        elif sign in "\"'":
            quote = sign
        else:
            depth += (sign == "[") - (sign == "]")
        at += 1
    return at
