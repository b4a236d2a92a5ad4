"""Reads MusicXML by music21 or by partitura, in a Python of their own, for comparison with our reader.

    python notation_readers.py music21|partitura FILE...

For each file one line of JSON: the file, and its notes and slurs as they are written, repeats not taken, and the order
in which the reader plays the measures. Times are in quarters from the beginning; grace notes, cue notes, chord symbols
and percussion without pitch are left out.
"""

from __future__ import annotations

import json
import sys
import warnings
from pathlib import Path
from typing import Any


def by_music21(path: Path) -> dict[str, Any]:
    """Read a score by music21."""
    from music21 import converter, note, percussion, repeat, sites, spanner

    score = converter.parse(str(path), forceSource=True, format="musicxml")
    order: list[int] | str
    try:
        order = _order_of_music21(score, repeat)
    except repeat.ExpanderException as error:
        order = repr(error)[:200]
    score = score.toSoundingPitch()
    notes: list[list[float]] = []
    slurs: set[tuple[float, float]] = set()
    for part in score.parts:
        spanners = [*part.recurse().getElementsByClass(spanner.Slur), *score.spannerBundle.getByClass(spanner.Slur)]
        for slur in spanners:
            first, last = slur.getFirst(), slur.getLast()
            if first is None or last is None or first.duration.isGrace or last.duration.isGrace:
                continue
            try:
                slurs.add(
                    (
                        round(float(first.getOffsetInHierarchy(part)), 3),
                        round(float(last.getOffsetInHierarchy(part)), 3),
                    )
                )
            except sites.SitesException:
                # A slur of another part.
                continue
        tied = part.stripTies()
        for one in tied.recurse().notes:
            if isinstance(one, (note.Unpitched, percussion.PercussionChord)) or "ChordSymbol" in one.classes:
                continue
            if one.duration.isGrace or getattr(one.style, "noteSize", None) == "cue":
                continue
            onset = float(one.getOffsetInHierarchy(tied))
            end = onset + float(one.duration.quarterLength)
            notes += [[round(onset, 3), round(end, 3), round(float(pitch.ps), 2)] for pitch in one.pitches]
    return {"notes": sorted(notes), "slurs": sorted(slurs), "order": order}


def _order_of_music21(score: Any, repeat: Any) -> list[int]:
    """Indices of the measures in the order in which music21 plays its first part."""
    part = score.parts[0]
    for place, measure in enumerate(part.getElementsByClass("Measure")):
        measure.editorial["place"] = place
    played = repeat.Expander(part).process()
    return [measure.editorial["place"] for measure in played.getElementsByClass("Measure")]


def by_partitura(path: Path) -> dict[str, Any]:
    """Read a score by partitura."""
    import partitura
    from partitura import score as kinds

    score = partitura.load_musicxml(str(path))
    notes: list[list[float]] = []
    slurs: list[list[float]] = []
    for part in score.parts:
        rows = list(zip(part._quarter_times, part._quarter_durations, strict=False))

        def quarters(tick: float, rows: list[tuple[int, int]] = rows) -> float:
            total, place, divisions = 0.0, 0.0, float(rows[0][1])
            for at, following in rows:
                if at >= tick:
                    break
                total += (at - place) / divisions
                place, divisions = at, float(following)
            return round(total + (tick - place) / divisions, 3)

        shifts = sorted(part.iter_all(kinds.Transposition), key=lambda one: one.start.t)
        for one in part.notes_tied:
            if isinstance(one, kinds.GraceNote) or not hasattr(one, "midi_pitch"):
                continue
            shift = next((row.chromatic or 0 for row in reversed(shifts) if row.start.t <= one.start.t), 0)
            notes.append([quarters(one.start.t), quarters(one.end_tied.t), one.midi_pitch + shift])
        for slur in part.iter_all(kinds.Slur):
            first, last = slur.start_note, slur.end_note
            if first is None or last is None or isinstance(first, kinds.GraceNote) or isinstance(last, kinds.GraceNote):
                continue
            slurs.append([quarters(first.start.t), quarters(last.start.t)])
    order: list[int] | str
    try:
        order = _order_of_partitura(score.parts[0], kinds)
    except Exception as error:  # noqa: BLE001 - partitura has none of its own: unfolding fails with whatever it met
        order = repr(error)[:200]
    return {"notes": sorted(notes), "slurs": sorted(slurs), "order": order}


def _order_of_partitura(part: Any, kinds: Any) -> list[int]:
    """Indices of the measures in the order in which partitura plays a part."""
    starts = sorted(measure.start.t for measure in part.iter_all(kinds.Measure))
    found: list[int] = []
    path = kinds.get_paths(part, no_repeats=False, all_repeats=True, ignore_leap_info=False)[0]
    segments = path.segments
    for name in path.path:
        segment = segments[name]
        found += [place for place, start in enumerate(starts) if segment.start.t <= start < segment.end.t]
    return found


READERS = {"music21": by_music21, "partitura": by_partitura}


def main() -> None:
    """Print a reader's results for some files."""
    warnings.simplefilter("ignore")
    read = READERS[sys.argv[1]]
    for name in sys.argv[2:]:
        try:
            found = read(Path(name))
        except Exception as error:  # noqa: BLE001 - a reader that trips over one file is told, and reads the next one
            found = {"error": f"{type(error).__name__}: {error}"[:200]}
        print(json.dumps({"file": name, **found}), flush=True)


if __name__ == "__main__":
    main()
