"""Small projects with as much work as their size allows: with large numbers, lengths and distances."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache, partial
from pathlib import Path
from typing import Any, Final

import msgspec

from app.plan.by_hand.additive_curve import AdditiveCurve, CurveKey, Tangent
from app.plan.by_hand.corrections import (
    AddExpression,
    AddGesture,
    ChangeExpression,
    ChangeGesture,
    Correction,
    PinFingering,
    PlayStyle,
    PoseCorrection,
    RemoveEvent,
    SetBreath,
    SetCue,
    SetEmbouchure,
    Vary,
)
from app.plan.kinds import GESTURES
from app.project import storage
from app.project.dance_corrections import DanceCorrection, ForbidState, PinState, UseSegment
from app.project.model import CompSpan, PlayerTakes, Project, project_from_score
from app.project.model import map_choices as choices_of
from app.project.performers import Dancer
from app.project.piece_metadata import metadata_of, save_metadata
from app.project.recording import AudioTrack, BeatPin, Doubt
from app.score.limits import LAST_TICK
from app.score.metre_map import Metre
from app.score.model import ControllerCurve, Marker, Note, PercussionHit
from app.score.read import read_midi
from app.score.take import Cleaning, ControllerMapping, Take
from app.score.tempo import TempoChange, TempoMap
from instrument_maps.load import bundled_maps
from metadata.model import Expression
from tests.fuzz.harness.costly_midi import END, midi, note

QUARTER: Final = 480
NOTES: Final = 8
HOURS_QUARTERS: Final = 43_000
"""Length in quarters: nearly twelve hours at 60 per minute."""

Way = Callable[[int], Project]
"""Function from a number of items to a project with as many."""


@cache
def base(players: int = 1) -> Project:
    """Trumpets with eight quarters each."""
    tracks = [b"\0\xc0\x38" + b"".join(note(60 + at % 5, delta=0) for at in range(NOTES)) + END for _ in range(players)]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.mid"
        path.write_bytes(midi(*tracks))
        maps = bundled_maps()
        return replace(project_from_score(read_midi(path, maps=choices_of(maps.values())), maps), source="")


def encoded(project: Project) -> bytes:
    """The project's file without its layout."""
    return storage.encode_autosave(project, Path("/tmp/a.suisou"), storage.Autosaved("work", 1))


def of_size(way: Way, size: int) -> bytes:
    """File of a project with as many items as fit into a size, at least one."""
    few, some = (len(encoded(way(count))) for count in (2, 34))
    count = 2 + (size - few) * 32 // max(some - few, 1)
    return encoded(way(max(count, 1)))


# Corrections of a player


def _corrected(items: Sequence[Correction], notes: int = 0) -> Project:
    """A piece of so many quarters, with these corrections."""
    project = base()
    if notes:
        line = tuple(Note(f"1:{at + 1}", at * QUARTER, QUARTER, 60 + at % 5, 80) for at in range(max(notes, NOTES)))
        part = msgspec.structs.replace(project.score.parts[0], notes=line)
        project = replace(project, score=msgspec.structs.replace(project.score, parts=(part,)), read_notes={})
    return replace(project, corrections={project.players[0].id: tuple(items)})


def _each(make: Callable[..., Correction]) -> Way:
    """One correction for each note, which reveals code that searches all notes for every correction. The function that
    makes a correction takes its number and, if it takes two arguments, the end of the piece.
    """

    def way(count: int) -> Project:
        more = (QUARTER * max(count, NOTES),) if make.__code__.co_argcount > 1 else ()
        return _corrected([make(number, *more) for number in range(count)], count)

    return way


def _spread(number: int, of: int) -> int:
    """Ticks within a piece, apart for each number."""
    return number * 7919 % (of - 60)


def _curve(number: int, ticks: Sequence[int], channel: str = "bell.up", **more: Any) -> AdditiveCurve:
    keys = tuple(CurveKey(tick, float(at % 3), **more) for at, tick in enumerate(ticks))
    return AdditiveCurve(f"a{number}", channel, keys)


def _long_piece(project: Project, quarters: int = HOURS_QUARTERS, us_per_quarter: float = 1_000_000.0) -> Project:
    """The piece with a note at its end, hours away."""
    score, part = project.score, project.score.parts[0]
    last = Note("9:9", quarters * QUARTER, QUARTER, 64, 80)
    part = msgspec.structs.replace(part, notes=(*part.notes, last))
    tempo = TempoMap(QUARTER, (TempoChange(0, us_per_quarter),))
    return replace(project, score=msgspec.structs.replace(score, parts=(part, *score.parts[1:]), tempo_map=tempo))


def _through_hours(make: Callable[[int], Correction]) -> Way:
    return lambda count: _long_piece(_corrected([make(number) for number in range(count)]))


FAR: Final = LAST_TICK - 1
CORRECTIONS: Final[dict[str, Way]] = {
    "curves far": _each(lambda at: _curve(at, (0, FAR))),
    "curves far before": _each(lambda at: _curve(at, (-FAR, 0))),
    "constant curves far": _each(lambda at: _curve(at, (0, FAR - 9, FAR), interpolation="constant")),
    "curves of many keys": lambda count: _corrected([_curve(0, range(0, 40 * min(count, 5000), 40))]),
    "curves of keys every ten seconds": lambda count: _long_piece(
        _corrected([_curve(0, range(0, 4800 * min(count, 4000), 4800))])
    ),
    "curves of steep handles": lambda count: _long_piece(
        _corrected(
            [
                _curve(
                    0,
                    range(0, 4800 * min(count, 4000), 4800),
                    arrive=Tangent(4800, 5.0),
                    leave=Tangent(4800, -5.0),
                )
            ]
        )
    ),
    "curves of one channel": _each(lambda at, end: _curve(at, (0, 900, end))),
    "curves through hours": _through_hours(lambda at: _curve(at, (0, 900, HOURS_QUARTERS * QUARTER))),
    "curves with hours to come in": _each(
        lambda at: msgspec.structs.replace(_curve(at, (0, 9)), blend_in_ticks=FAR, blend_out_ticks=FAR)
    ),
    "poses at once": _each(lambda at, end: PoseCorrection(f"p{at}", "bell", 0, end, up_deg=1.0)),
    "poses in turn": _each(
        lambda at, end: PoseCorrection(f"p{at}", "head", _spread(at, end), _spread(at, end) + 9, up_deg=1.0)
    ),
    "poses far": _each(
        lambda at: PoseCorrection(f"p{at}", "torso", -FAR, FAR, up_deg=1.0, fade_in_ticks=FAR, fade_out_ticks=FAR)
    ),
    "variations at once": _each(lambda at, end: Vary(f"v{at}", 0, end + at, at)),
    "variations in turn": _each(lambda at, end: Vary(f"v{at}", _spread(at, end), _spread(at, end) + 9, at)),
    "variations far": _each(lambda at: Vary(f"v{at}", -FAR, FAR, at)),
    "variations through hours": _through_hours(lambda at: Vary(f"v{at}", at, HOURS_QUARTERS * QUARTER - at, at)),
    "styles at once": _each(lambda at, end: PlayStyle(f"s{at}", ("jazz", "soloist")[at % 2], at, end + at)),
    "styles in turn": _each(
        lambda at, end: PlayStyle(f"s{at}", "jazz", _spread(at, end), _spread(at, end) + 40, 10, 10)
    ),
    "styles far": _each(lambda at: PlayStyle(f"s{at}", "jazz", -FAR, FAR, FAR, FAR)),
    "styles of many names": _each(lambda at: PlayStyle(f"s{at}", f"n{at}", at, at + 40)),
    "breaths of one note": _each(lambda at: SetBreath("1:3", -at - 100, -at)),
    "breaths within a note": _each(lambda at: SetBreath("1:3", 1 + at % 300, 2 + at % 300 + at % 9, kind="within")),
    "breaths of no notes": _each(lambda at: SetBreath(f"x{at}", -100, 0, moved_from=f"y{at}")),
    "breaths far": _each(lambda at: SetBreath(f"1:{1 + at % NOTES}", -FAR, FAR - 9)),
    "cues at once": _each(lambda at: SetCue(f"@{at}", takers=("1.1.1",))),
    "cues far": _each(lambda at: SetCue(f"@{FAR - at}")),
    "cues far before": _each(lambda at: SetCue(f"@{at - FAR}", beats=1e6)),
    "cues of hours": _each(lambda at: SetCue(f"1:{1 + at % NOTES}", beats=1e9)),
    "embouchures": _each(lambda at: SetEmbouchure(f"1:{at}", tension=0.5)),
    "pins": _each(lambda at: PinFingering(f"1:{at}", "0")),
    "removals": _each(lambda at: RemoveEvent(f"breath:1:{at}", f"1:{at}")),
    "gestures at once": _each(lambda at, end: AddGesture(f"g{at}", GESTURES[at % len(GESTURES)].id, 0, end, 1.0)),
    "gestures in turn": _each(
        lambda at, end: AddGesture(
            f"g{at}", GESTURES[at % len(GESTURES)].id, _spread(at, end), _spread(at, end) + 30, 1.0
        )
    ),
    "gestures far": _each(lambda at: AddGesture(f"g{at}", GESTURES[at % len(GESTURES)].id, -FAR, FAR, 1.0)),
    "gestures in hours": _each(
        lambda at: AddGesture(f"g{at}", GESTURES[at % len(GESTURES)].id, FAR - 9 - at, FAR - at, 1.0)
    ),
    "named gestures at once": _each(lambda at, end: AddGesture(f"g{at}", "named", 0, end, 1.0, "shrug")),
    "named gestures in turn": _each(
        lambda at, end: AddGesture(f"g{at}", "named", _spread(at, end), _spread(at, end) + 30, 1.0, "page_turn")
    ),
    "named gestures far": _each(lambda at: AddGesture(f"g{at}", "named", -FAR, FAR, 1.0, "lean_in")),
    "changed gestures": _each(lambda at: ChangeGesture(f"sway:{at}", 0, 9, 1.0)),
    "expressions at once": _each(lambda at, end: AddExpression(f"e{at}", "smile", 0, end)),
    "expressions in turn": _each(
        lambda at, end: AddExpression(f"e{at}", "proud", _spread(at, end), _spread(at, end) + 30)
    ),
    "expressions far": _each(lambda at: AddExpression(f"e{at}", "smile", -FAR, FAR, 1.0, 1e9, 1e9)),
    "changed expressions": _each(lambda at: ChangeExpression(f"expression:{at}", "smile", 0, 9)),
}


# The piece


def _scored(players: int = 1, **fields: Any) -> Project:
    project = base(players)
    return replace(project, score=msgspec.structs.replace(project.score, **fields))


def _part_of(**fields: Any) -> Project:
    project = base()
    part = msgspec.structs.replace(project.score.parts[0], **fields)
    return replace(project, score=msgspec.structs.replace(project.score, parts=(part,)))


def _notes(count: int, onset: Callable[[int], int], length: Callable[[int], int], pitches: int = 12) -> Project:
    notes = [Note(f"1:{at}", onset(at), length(at), 60 + at * 5 % pitches, 80) for at in range(count)]
    return _part_of(notes=tuple(sorted(notes, key=lambda one: (one.onset_tick, one.pitch))))


def _metres(count: int) -> Project:
    """A metre for every bar, and a note after them."""
    metres = tuple(Metre(QUARTER * at, 1, 4) if at % 2 else Metre(QUARTER * at, 2, 8) for at in range(count))
    return _long_piece(_scored(metres=metres), max(count + 9, 20), 500_000.0)


def _tempos(count: int, ticks: int = 10) -> Project:
    changes = tuple(TempoChange(at * ticks, 500_000.0 + 1000.0 * (at % 7)) for at in range(count))
    return _scored(tempo_map=TempoMap(QUARTER, changes))


def _takes(takes: Sequence[Take], comp: Sequence[CompSpan] = ()) -> Project:
    project = base()
    recorded = PlayerTakes(tuple(takes), tuple(comp), project.score.parts[0].notes)
    return replace(project, takes={project.players[0].id: recorded})


def _take(number: int, times_us: Sequence[int] = (), messages: Sequence[str] = (), end_us: int = 10**6) -> Take:
    return Take(
        f"take:{number + 1}",
        "T",
        "",
        "",
        "",
        ControllerMapping(),
        Cleaning(quantise=1.0, align=1.0),
        TempoMap(QUARTER, (TempoChange(0, 500_000.0),)),
        0,
        end_us,
        tuple(times_us),
        tuple(messages),
    )


def _struck(count: int, step_us: int, lasting: int) -> Project:
    """A take of notes of which some sound at once."""
    rows = []
    for at in range(count):
        rows.append((at * step_us, f"90{48 + at % 24:02x}50"))
        rows.append(((at + lasting) * step_us, f"80{48 + at % 24:02x}00"))
    rows.sort()
    end_us = rows[-1][0] + 1 if rows else 1
    return _takes([_take(0, [time for time, _ in rows], [raw for _, raw in rows], end_us)])


def _players(count: int) -> Project:
    """Players of one part."""
    project = base()
    one = project.players[0]
    others = tuple(msgspec.structs.replace(one, id=f"p{at}", name=f"n{at}") for at in range(min(count, 999)))
    return replace(project, players=(one, *others))


def _doublings(count: int) -> Project:
    """A musician who plays one instrument after the other, a part each."""
    project = base()
    one, part = project.players[0], project.score.parts[0]
    parts, players = [part], [one]
    for at in range(min(count, 999)):
        first = (NOTES + at) * QUARTER
        parts.append(msgspec.structs.replace(part, id=f"q{at}", notes=(Note(f"{at + 2}:1", first, 240, 60, 80),)))
        players.append(
            msgspec.structs.replace(
                one, id=f"p{at}", name=f"n{at}", part_id=f"q{at}", doubles=one.id,
                instrument_id=("flugelhorn_Bb", "trumpet_Bb")[at % 2],
            )
        )  # fmt: skip
    return replace(project, players=tuple(players), score=msgspec.structs.replace(project.score, parts=tuple(parts)))


def _turns(count: int) -> Project:
    """A musician who changes between six instruments with every note."""
    project = base()
    one, part = project.players[0], project.score.parts[0]
    parts, players = [], []
    for which in range(6):
        notes = tuple(
            Note(f"{which + 1}:{at}", (6 * at + which) * QUARTER, 240, 60, 80) for at in range(max(count // 6, 1))
        )
        parts.append(msgspec.structs.replace(part, id=f"q{which}", notes=notes))
        players.append(
            msgspec.structs.replace(
                one, id=one.id if not which else f"p{which}", name=f"n{which}", part_id=f"q{which}",
                doubles=one.id if which else "", instrument_id=("flugelhorn_Bb", "trumpet_Bb")[which % 2],
            )
        )  # fmt: skip
    return replace(project, players=tuple(players), score=msgspec.structs.replace(project.score, parts=tuple(parts)))


PIECES: Final[dict[str, Way]] = {
    "short notes": lambda count: _notes(count, lambda at: 60 * at, lambda at: 50),
    "notes at once": lambda count: _notes(count, lambda at: 0, lambda at: 480, 60),
    "notes at once of all lengths": lambda count: _notes(count, lambda at: at, lambda at: 4800 + 10 * at, 60),
    "notes through hours": lambda count: _notes(count, lambda at: at, lambda at: HOURS_QUARTERS * QUARTER // 2, 60),
    "notes minutes apart": lambda count: _notes(count, lambda at: at * (40_000_000 // max(count, 1)), lambda at: 400),
    "hours": lambda count: _long_piece(base()),
    "hours of twelve": lambda count: _long_piece(base(min(count, 60))),
    "hours at 240 frames": lambda count: replace(_long_piece(base(min(count, 60))), fps=Fraction(240)),
    "hours of short felt beats": lambda count: replace(_long_piece(base(min(count, 60))), felt_beat_quarters=1 / 16),
    "a preroll of hours": lambda count: replace(
        _scored(min(count, 60), tempo_map=TempoMap(QUARTER, (TempoChange(0, 120_000_000.0),))), preroll_beats=64.0
    ),
    "tempos": _tempos,
    "tempos through hours": lambda count: replace(
        _long_piece(base()),
        score=msgspec.structs.replace(
            _long_piece(base()).score,
            tempo_map=TempoMap(
                QUARTER, tuple(TempoChange(at * 4800, 500_000.0 + at % 9) for at in range(min(count, 4000)))
            ),
        ),
    ),
    "metres": _metres,
    "metres of short bars through hours": lambda count: replace(
        _long_piece(base(), 12_000),
        score=msgspec.structs.replace(_long_piece(base(), 12_000).score, metres=(Metre(0, 1, 64),)),
    ),
    "markers": lambda count: _scored(markers=tuple(Marker(at, "A") for at in range(count))),
    "markers at one tick": lambda count: _scored(markers=tuple(Marker(9, f"A{at}") for at in range(count))),
    "markers far": lambda count: _scored(markers=tuple(Marker(FAR - count + at, "A") for at in range(count))),
    "percussion": lambda count: _scored(percussion=tuple(PercussionHit(at, 36, 80) for at in range(count))),
    "breath": lambda count: _part_of(
        curves=(ControllerCurve("breath", tuple(range(count)), tuple(at % 3 / 3.0 for at in range(count))),)
    ),
    "breath far": lambda count: _part_of(
        curves=(
            ControllerCurve(
                "breath", tuple(FAR - count + at for at in range(count)), tuple(at % 3 / 3.0 for at in range(count))
            ),
        )
    ),
    "bends": lambda count: _part_of(
        curves=(ControllerCurve("pitch_bend", tuple(range(count)), tuple(at % 3 / 3.0 for at in range(count))),)
    ),
    "curves": lambda count: _part_of(curves=tuple(ControllerCurve("expression", (at,), (0.5,)) for at in range(count))),
    "mutes at once": lambda count: _part_of(muted=tuple((at, 3000 + at) for at in range(count))),
    "mutes in turn": lambda count: _part_of(muted=tuple((at, at) for at in range(count))),
    "players of one part": _players,
    "instruments of one musician": _doublings,
    "instruments by turns": _turns,
    "takes": lambda count: _takes([_take(at) for at in range(min(count, 2000))]),
    "a take of notes": lambda count: _struck(count, 20_000, 1),
    "a take of notes at once": lambda count: _struck(count, 1000, 20),
    "a take of breath": lambda count: _takes(
        [_take(0, range(0, 1000 * count, 1000), [f"b002{at % 128:02x}" for at in range(count)], 1000 * count)]
    ),
    "a take of months": lambda count: _takes(
        [_take(at, (0, 10**13), ("903c50", "803c00"), 10**13) for at in range(min(count, 2000))]
    ),
    "a comp": lambda count: _takes([_take(0)], [CompSpan(at, at + 1, "take:1") for at in range(count)]),
    "a comp of months": lambda count: _takes(
        [_take(0, (0, 10**13), ("903c50", "803c00"), 10**13)], [CompSpan(at, at + 1, "take:1") for at in range(count)]
    ),
    "expressions of its own": lambda count: replace(
        base(),
        expressions=tuple(
            Expression(
                name=f"x{at}",
                description="d",
                weights={"jawOpen": 0.5},
                while_playing=True,
                fade_in_s=0.2,
                fade_out_s=0.3,
            )
            for at in range(count)
        ),
    ),
    "pins of a recording": lambda count: replace(
        base(), audio=AudioTrack("/nowhere.wav", pins=tuple(BeatPin(at, float(at) / 9.0) for at in range(count)))
    ),
    "doubts of a recording": lambda count: replace(
        base(), audio=AudioTrack("/nowhere.wav", doubts=tuple(Doubt(at, at + 1, 0.5) for at in range(count)))
    ),
}


# Dances


def _danced(count: int, quarters: int = 0, corrections: Sequence[DanceCorrection] = (), **fields: Any) -> Project:
    project = base()
    if quarters:
        project = _long_piece(project, quarters)
    stage, character = project.players[0].stage, project.players[0].character_id
    dancers = tuple(
        Dancer(f"dancer:{at + 1}", f"d{at}", "salsa", character, stage, seed=at, **fields)
        for at in range(min(count, 200))
    )
    return replace(project, dancers=dancers, dance_corrections={"dancer:1": tuple(corrections)} if corrections else {})


DANCES: Final[dict[str, Way]] = {
    "dancers": _danced,
    "dancers of hours": partial(_danced, quarters=HOURS_QUARTERS),
    "dancers of a quarter of an hour": partial(_danced, quarters=880),
    "dancers who begin in hours": partial(_danced, delay_beats=10_000.0),
    "pinned motions": lambda count: _danced(1, corrections=[PinState(at, at % 9) for at in range(count)]),
    "pinned motions far": lambda count: _danced(1, corrections=[PinState(FAR - at, at % 9) for at in range(count)]),
    "forbidden motions": lambda count: _danced(1, corrections=[ForbidState(-FAR, FAR, at % 9) for at in range(count)]),
    "forbidden motions in turn": lambda count: _danced(
        1, corrections=[ForbidState(at, at + 9, at % 9) for at in range(count)]
    ),
    "forbidden motions of minutes": lambda count: _danced(
        1, 880, corrections=[ForbidState(-FAR, FAR, at) for at in range(count)]
    ),
    "pinned motions of minutes": lambda count: _danced(
        1, 880, corrections=[PinState(at * 900 % 560_000, at % 9) for at in range(count)]
    ),
    "segments": lambda count: _danced(1, corrections=[UseSegment(at, at % 9) for at in range(count)]),
}

COSTLY_PROJECTS: Final[dict[str, Callable[[int], bytes]]] = {
    name: partial(of_size, way) for name, way in {**CORRECTIONS, **PIECES}.items()
}


def costly_metadata(size: int, way: str = "poses in turn") -> bytes:
    """The acting of a piece as a file of its own."""
    few, some = (len(_metadata(way, count)) for count in (2, 34))
    return _metadata(way, max(2 + (size - few) * 32 // max(some - few, 1), 1))


def _metadata(way: str, count: int) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.toml"
        save_metadata(metadata_of(CORRECTIONS[way](count)), path)
        return path.read_bytes()


COSTLY_METADATA: Final[dict[str, Callable[[int], bytes]]] = {
    way: partial(costly_metadata, way=way)
    for way in ("curves far", "curves of many keys", "poses at once", "variations at once", "styles in turn")
}
COSTLY_DANCES: Final[dict[str, Callable[[int], bytes]]] = {name: partial(of_size, way) for name, way in DANCES.items()}
"""Functions from a size in bytes to a file, by cause of the cost; files of fixed size ignore the size."""
