"""Hypothesis strategy for valid projects."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import msgspec
from hypothesis import strategies as st

from app.errors import Message
from app.plan.by_hand.additive_curve import CHANNELS, INTERPOLATIONS, AdditiveCurve, CurveKey, Tangent
from app.plan.by_hand.corrections import Correction
from app.plan.by_hand.mark_corrections import OfMark
from app.plan.music.written_dynamics import DYNAMIC_TEXTS
from app.plan.parameters import PARAMETERS, Bounds, PlayerParameters
from app.project import limits
from app.project.casting import StagePosition
from app.project.dance_corrections import ForbidState, PinState, UseSegment
from app.project.import_decisions import ImportDecisions, ReadTiming, RowDecision, TrackMark
from app.project.model import DANCER_PARAMETERS, Project
from app.project.performers import Dancer, Player
from app.project.recording import AudioTrack
from app.project.video import VideoTrack
from app.rig.people.wardrobe import OutfitChoice
from app.score.limits import too_long
from app.score.marks import MARK_KINDS
from app.score.metre_map import Metre
from app.score.model import ControllerCurve, Note, Part, PercussionHit, Score, UnplayedPart
from app.score.tempo import TempoChange, TempoMap
from metadata.model import ARKIT_MORPHS, Expression
from tests.support.parameters import values

texts = st.text(st.characters(exclude_categories=["Cs"]), max_size=12)
ids = st.text(st.characters(exclude_categories=["Cs"]), min_size=1, max_size=6)
fractions01 = st.floats(0.0, 1.0)
ticks = st.integers(-100_000, 100_000)


def within(bounds: Bounds) -> st.SearchStrategy[float]:
    return st.floats(*bounds)


@st.composite
def scores(draw: st.DrawFn) -> Score:
    quarter = draw(st.integers(1, 960))
    note_ids = iter(draw(st.lists(ids, min_size=12, max_size=12, unique=True)))
    parts = tuple(
        Part(
            id=part_id,
            name=draw(texts),
            track=draw(st.integers(0, 40)),
            voice=draw(st.integers(0, 3)),
            channel=draw(st.integers(0, 15)),
            program=draw(st.none() | st.integers(0, 127)),
            instrument=draw(st.none() | texts),
            map_id=draw(ids),
            notes=draw(notes(note_ids)),
            curves=tuple(draw(st.lists(curves(), max_size=2))),
        )
        for part_id in draw(st.lists(ids, max_size=3, unique=True))
    )
    tempo_ticks = sorted({0, *draw(st.lists(st.integers(1, 10_000), max_size=3))})
    tempi = tuple(TempoChange(tick, draw(within(limits.MICROSECONDS_PER_QUARTER))) for tick in tempo_ticks)
    metre_ticks = sorted({0, *draw(st.lists(st.integers(1, 10_000), max_size=3))})
    metres = tuple(Metre(tick, draw(st.integers(1, 20)), draw(st.sampled_from([2, 4, 8, 16]))) for tick in metre_ticks)
    return Score(
        title=draw(texts),
        ticks_per_quarter=quarter,
        tempo_map=TempoMap(quarter, tempi),
        metres=metres,
        pickup_ticks=draw(st.sampled_from([0, *metre_ticks[1:2]])),
        parts=parts,
        unplayed=tuple(
            draw(
                st.lists(
                    st.builds(
                        UnplayedPart, texts, st.just(Message("score.not_wind", {"instrument": "x"})), st.integers(0, 9)
                    ),
                    max_size=2,
                )
            )
        ),
        warnings=tuple(draw(st.lists(st.just(Message("midi.patterns", {"patterns": 3})), max_size=2))),
        percussion=tuple(
            PercussionHit(*hit)
            for hit in sorted(
                draw(st.lists(st.tuples(st.integers(0, 9_000), st.integers(0, 127), st.integers(1, 127)), max_size=4))
            )
        ),
    )


@st.composite
def notes(draw: st.DrawFn, note_ids: Any) -> tuple[Note, ...]:
    drawn = draw(
        st.lists(
            st.tuples(st.integers(0, 9_000), st.integers(0, 127), st.integers(1, 900), st.integers(1, 127)), max_size=4
        )
    )
    return tuple(
        Note(next(note_ids), onset, length, pitch, velocity) for onset, pitch, length, velocity in sorted(drawn)
    )


@st.composite
def curves(draw: st.DrawFn) -> ControllerCurve:
    kind = draw(st.sampled_from(["breath", "volume", "expression", "aftertouch", "pitch_bend"]))
    at = tuple(sorted(draw(st.sets(st.integers(0, 9_000), max_size=5))))
    low = -1.0 if kind == "pitch_bend" else 0.0
    return ControllerCurve(kind, at, tuple(draw(st.floats(low, 1.0)) for _ in at))


colours = st.sampled_from(["", "#0A1b2C"])
outfits = st.builds(OutfitChoice, st.sampled_from(["", "concert_black", "elsewhere"]), colours, colours, colours)
stages = st.builds(StagePosition, within(limits.STAGE_M), within(limits.STAGE_M), st.floats(-7.0, 7.0))


@st.composite
def dancers(draw: st.DrawFn, id: str, name: str, folder: str) -> Dancer:
    return Dancer(
        id=id,
        name=name,
        choreography=draw(
            st.sampled_from(["salsa", f"{folder}/salsa.choreography", f"{folder}/踊り/a b.CHOREOGRAPHY"])
            | st.sampled_from(["/elsewhere/x.choreography", "D:\\dances\\x.choreography"])
        ),
        character_id=draw(ids),
        stage=draw(stages),
        mirrored=draw(st.booleans()),
        **{name: draw(values(parameter)) for name, parameter in DANCER_PARAMETERS.items()},
        colour=draw(colours),
        outfit=draw(outfits),
    )


indices = st.integers(*limits.CHOREOGRAPHY_INDEX)
dance_corrections = (
    st.builds(PinState, ticks, indices)
    | st.builds(UseSegment, ticks, indices)
    | st.tuples(ticks, st.integers(1, 9_000), indices).map(
        lambda values: ForbidState(values[0], values[0] + values[1], values[2])
    )
)


@st.composite
def players(draw: st.DrawFn, id: str, name: str, part_ids: list[str]) -> Player:
    return Player(
        id=id,
        name=name,
        part_id=draw(st.sampled_from(part_ids)),
        instrument_id=draw(ids),
        character_id=draw(ids),
        parameters=PlayerParameters(**{name: draw(values(parameter)) for name, parameter in PARAMETERS.items()}),
        stage=draw(stages),
        colour=draw(colours),
        outfit=draw(outfits),
        muted=draw(st.booleans()),
        soloed=draw(st.booleans()),
    )


@st.composite
def additive_curves(draw: st.DrawFn) -> AdditiveCurve:
    """Draw a curve on any channel with any handles."""
    channel = draw(st.sampled_from([*CHANNELS]))
    most = CHANNELS[channel].most
    forward = st.integers(0, 100_000)
    handles = st.none() | st.builds(Tangent, forward, st.floats(-10.0 * most, 10.0 * most))
    keys = [
        CurveKey(
            tick,
            draw(st.floats(-most, most)),
            draw(st.sampled_from(INTERPOLATIONS)),
            draw(handles),
            draw(handles),
        )
        for tick in sorted(draw(st.sets(ticks, min_size=1, max_size=3)))
    ]
    return AdditiveCurve(
        draw(texts),
        channel,
        tuple(keys),
        draw(forward),
        draw(forward),
        draw(fractions01),
        draw(st.booleans()),
        draw(st.text("curve \u66f2", max_size=6)),
    )


@st.composite
def corrections(draw: st.DrawFn) -> Correction:
    """Draw a correction of any kind, from the types of its fields, so that new kinds are included."""
    struct = draw(st.sampled_from(Correction.__args__))
    if struct is AdditiveCurve:
        return draw(additive_curves())
    values = {}
    for field in msgspec.structs.fields(struct):
        if field.type in (int, int | None, "int", "int | None"):
            values[field.name] = draw(ticks if field.name.endswith(("tick", "ticks")) else st.integers(*limits.SEED))
        elif field.type in (float, float | None):
            values[field.name] = draw(st.floats(-1e6, 1e6))
        elif field.type in (str, str | None):
            values[field.name] = draw(texts)
        elif field.type is bool:
            values[field.name] = draw(st.booleans())
        elif field.required:
            values[field.name] = draw(st.from_type(field.type))
    if issubclass(struct, OfMark):
        values |= draw(_mark_anchors(values["kind"]))
        values = {name: value for name, value in values.items() if name in struct.__struct_fields__}
    made: Correction = struct(**values)
    return made


@st.composite
def _mark_anchors(draw: st.DrawFn, kind: str) -> dict[str, object]:
    """Draw anchors and text of a mark of a given kind."""
    anchor = MARK_KINDS[kind].anchor
    at_tick = anchor in ("place", "span")
    note = st.none() if at_tick else st.text("0123456789:", min_size=1, max_size=8)
    tick = ticks if at_tick else st.none()
    return {
        "note_id": draw(note),
        "last_note_id": draw(note) if anchor == "notes" else None,
        "start_tick": draw(tick.map(lambda at: None if at is None else abs(at))),
        "end_tick": draw(tick.map(lambda at: None if at is None else abs(at))),
        "text": draw(st.sampled_from(DYNAMIC_TEXTS)) if kind == "dynamic" else draw(texts),
    }


marks = st.builds(
    TrackMark,
    track=st.integers(0, 40),
    channel=st.integers(0, 15),
    change=st.integers(0, 3),
    name=texts,
    instrument_name=texts,
    program=st.none() | st.integers(0, 127),
    reported=st.lists(ids, max_size=2).map(tuple),
    called=texts,
    melody=st.lists(st.integers(0, 2**32 - 1), max_size=3).map(tuple),
)
rows = st.builds(
    RowDecision,
    tracks=st.lists(marks, min_size=1, max_size=2).map(tuple),
    requested=st.booleans(),
    map_id=st.none() | ids,
    name=texts,
    split=st.sampled_from(["sustained", "every", "never"]),
    written=st.booleans(),
    character_id=st.none() | ids,
    voice_maps=st.lists(st.none() | ids, max_size=3).map(tuple),
)
decisions = st.builds(
    ImportDecisions,
    encoding=st.sampled_from([None, "utf-8", "cp932", "big5"]),
    rows=st.lists(rows, max_size=2).map(tuple),
)


@st.composite
def curves_read(draw: st.DrawFn, score: Score, read: Iterable[str]) -> dict[str, tuple[ControllerCurve, ...]]:
    """Draw the controller curves of each part that was read from a file."""
    here = {part.id: part.curves for part in score.parts}
    return {
        part_id: here[part_id] if draw(st.booleans()) else tuple(draw(st.lists(curves(), max_size=1)))
        for part_id in read
    }


expressions = st.builds(
    Expression,
    name=ids,
    description=texts,
    # A file is in order, so that the same project is the same bytes.
    weights=st.dictionaries(st.sampled_from(ARKIT_MORPHS), fractions01, max_size=4).map(
        lambda weights: dict(sorted(weights.items()))
    ),
    while_playing=st.booleans(),
    fade_in_s=st.floats(0.001, 60.0),
    fade_out_s=st.floats(0.001, 60.0),
)


@st.composite
def projects(draw: st.DrawFn, folder: str = "/music") -> Project:
    # Longer scores cannot be saved.
    score = draw(scores().filter(lambda score: too_long(score) is None))
    part_ids = [part.id for part in score.parts]
    performer_ids = draw(st.lists(ids, max_size=5, unique=True))
    split = draw(st.integers(0, min(len(performer_ids), 3))) if part_ids else 0
    player_ids, dancer_ids = performer_ids[:split], performer_ids[split:][:2]
    count = split + len(dancer_ids)
    names = draw(st.lists(texts, min_size=count, max_size=count, unique_by=lambda name: name.casefold()))
    danced = {id: tuple(draw(st.lists(dance_corrections, max_size=3))) for id in dancer_ids}
    path = st.sampled_from([f"{folder}/a.wav", f"{folder}/sub/録音.flac", "/elsewhere/x.mp3"])
    corrected = {id: tuple(draw(st.lists(corrections(), max_size=3))) for id in player_ids}
    read = {
        part.id: {
            note.id: note if draw(st.booleans()) else msgspec.structs.replace(note, pitch=127 - note.pitch)
            for note in part.notes
            if not note.id.startswith("n:")
        }
        for part in sorted(score.parts, key=lambda part: part.id.encode())
        if draw(st.booleans())
    }
    return Project(
        score=score,
        players=tuple(draw(players(id, name, part_ids)) for id, name in zip(player_ids, names, strict=False)),
        corrections={id: corrected[id] for id in sorted(corrected, key=str.encode) if corrected[id]},
        seed=draw(st.integers(*limits.SEED)),
        preroll_beats=draw(within(limits.PREROLL_BEATS)),
        felt_beat_quarters=draw(within(limits.FELT_BEAT_QUARTERS)),
        fps=draw(st.fractions(1, 240, max_denominator=1001)),
        audio=draw(st.none() | st.builds(AudioTrack, path, st.floats(-1e4, 1e4), st.none() | fractions01)),
        video=draw(st.none() | st.builds(VideoTrack, path, st.floats(-1e4, 1e4), st.none() | fractions01)),
        expressions=tuple(draw(st.lists(expressions, max_size=2, unique_by=lambda item: item.name))),
        source=draw(st.just("") | path),
        read_notes=read,
        read_curves=draw(curves_read(score, read)),
        read_timing=draw(st.none() | st.just(ReadTiming(score.tempo_map, score.metres, score.pickup_ticks))),
        imported=draw(st.none() | decisions),
        dancers=tuple(draw(dancers(id, name, folder)) for id, name in zip(dancer_ids, names[split:], strict=True)),
        dance_corrections={id: danced[id] for id in sorted(danced, key=str.encode) if danced[id]},
    )
