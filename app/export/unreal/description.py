"""Content of ``performance.json``: everything that a script needs in Unreal to build a scene from an export.

Times are seconds of the animation, which begins at 0, or frames. A performer's ``stage`` is in metres as in
``report.json``, ``place`` in Unreal's centimetres and degrees.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Final

import msgspec

from app.errors import Message
from app.export.equipped_skeleton import socket_names
from app.export.report import PlaceReport, stage_place
from app.export.request import CastDancing, CastMusician, ExportCast, ExportRequest
from app.export.target import TargetSkeleton
from app.export.unreal.layout import FigurePlace, Layout
from app.export.unreal.manifest import OwnFile
from app.export.unreal.surfaces import FileContents, Surfaces, UnrealMaterial, UnrealTexture
from app.performance.ensemble import Performance
from app.performance.span import FrameSpan
from app.project.casting import StagePosition
from app.project.model import Project
from app.project.performers import Dancer, Player
from app.score.model import Score
from app.score.tempo import TempoMap

SCHEMA: Final = 6
"""Version of the description, increased when a script for the previous version would misread it. Version 2 added
dancers; 3 added instruments that a player changes to; 4 added meshes shared by players, and instruments at sockets; 5
added image files; 6 moved textures to a folder that all pieces share.
"""


class Rate(msgspec.Struct, frozen=True):
    """Frames per second as a fraction."""

    numerator: int
    denominator: int


class UnrealPlace(msgspec.Struct, frozen=True):
    """Place of an actor in Unreal (left-handed, Z up): (x, y, z) in metres becomes (100 x, 100 z, 100 y) in
    centimetres, so that a rotation from +Z towards +X is a negative yaw.
    """

    x_cm: float
    y_cm: float
    z_cm: float
    yaw_deg: float


class UnrealFigure(msgspec.Struct, frozen=True):
    """A skeletal mesh in Unreal with its animation: relative path of its file, and its assets.

    ``bones`` are all bones, the root first; ``socket`` is the bone of the player's character that holds the instrument,
    or empty; ``materials`` are the textured ones by slot name.
    """

    file: str
    mesh: str
    skeleton: str
    animation: str
    bones: tuple[str, ...]
    socket: str = ""
    materials: dict[str, str] = {}


class Double(msgspec.Struct, frozen=True):
    """A further instrument of a musician in the description for Unreal; while it is not played it lies beside the
    player.
    """

    name: str
    part: str
    instrument_id: str
    instrument: UnrealFigure


class Cast(msgspec.Struct, frozen=True):
    """A musician in the description for Unreal, with all instruments."""

    name: str
    part: str
    instrument_id: str
    character_id: str
    stage: PlaceReport
    place: UnrealPlace
    character: UnrealFigure
    instrument: UnrealFigure
    doubles: tuple[Double, ...]
    props: UnrealFigure | None = None
    """Meshes of straps and chair; None without props."""


class CastDancer(msgspec.Struct, frozen=True):
    """A dancer in the description for Unreal. The place is that at the start of the dance; the animation moves on from
    there."""

    name: str
    choreography: str
    character_id: str
    stage: PlaceReport
    place: UnrealPlace
    character: UnrealFigure


class UnrealSound(msgspec.Struct, frozen=True):
    """Sound of the piece in the description for Unreal. ``offset_s`` is the animation time at which the file begins."""

    file: str
    asset: str
    source: str
    """Origin of the sound: ``"recording"`` or ``"synthesiser"``."""
    offset_s: float
    duration_s: float
    rate_hz: int
    channels: int


class Tempo(msgspec.Struct, frozen=True):
    """A tempo in the description for Unreal: tick and seconds at which it begins, and quarter notes per minute."""

    tick: int
    s: float
    quarters_per_minute: float


class UnrealMetre(msgspec.Struct, frozen=True):
    """A time signature in the description for Unreal: tick and seconds at which it begins."""

    tick: int
    s: float
    numerator: int
    denominator: int


class UnrealBar(msgspec.Struct, frozen=True):
    """The start of a bar within the animation; a pickup is bar 0. ``frame`` is the nearest frame."""

    number: int
    tick: int
    s: float
    frame: int


class UnrealMarker(msgspec.Struct, frozen=True):
    """A rehearsal mark in the description for Unreal, with its bar. ``frame`` is the nearest frame of the animation."""

    text: str
    bar: int
    tick: int
    s: float
    frame: int


class Cue(msgspec.Struct, frozen=True):
    """A cue given by a player: the preparatory nod begins at ``start_s``, the cued players enter at ``entry_s``."""

    player: str
    start_s: float
    entry_s: float
    frame: int


class LeftOutFigures(msgspec.Struct, frozen=True):
    """A requested player or dancer that could not be exported, in the description for Unreal, with the reason.
    ``assets`` are those of earlier exports, which are kept."""

    name: str
    reason: str
    assets: tuple[str, ...]


class Description(msgspec.Struct, frozen=True):
    """Content of the whole file. ``first_frame_s`` is the performance time of frame 0, counted from tick 0;
    ``first_frame`` is the number of that frame in an export of the whole piece; ``files`` are the sources of the
    assets, by relative path.
    """

    schema: int
    made_by: str
    piece: str
    title: str
    content: str
    sequence: str
    rate: Rate
    frames: int
    first_frame_s: float
    first_frame: int
    bars_exported: tuple[int, int] | None
    sound: UnrealSound
    players: tuple[Cast, ...]
    dancers: tuple[CastDancer, ...]
    ticks_per_quarter: int
    pickup_ticks: int
    tempo: tuple[Tempo, ...]
    metres: tuple[UnrealMetre, ...]
    bars: tuple[UnrealBar, ...]
    markers: tuple[UnrealMarker, ...]
    cues: tuple[Cue, ...]
    files: dict[str, OwnFile]
    left_out: tuple[LeftOutFigures, ...]
    textures: tuple[UnrealTexture, ...] = ()
    materials: tuple[UnrealMaterial, ...] = ()


def describe(
    request: ExportRequest,
    cast: ExportCast,
    layout: Layout,
    wording: Callable[[Message], str],
    sound: UnrealSound,
    contents: Mapping[str, FileContents],
    *,
    files: Mapping[str, OwnFile],
    surfaces: Surfaces,
) -> Description:
    """Return the description of an export for Unreal.

    Parameters
    ----------
    request, cast : ExportRequest and ExportCast
        The export and its performers.
    layout : Layout
        Paths of the piece.
    wording : callable
        Returns a reason for an exclusion as text.
    sound : UnrealSound
        The exported sound.
    contents : mapping of str to FileContents
        Bones and materials by path of the file.
    files : mapping of str to OwnFile
        Sources of the assets, by relative path.
    surfaces : Surfaces
        Textured materials of all files.
    """
    project, span, bars = request.performance.project, request.span, request.bars
    score, rate = project.score, span.fps
    time = _Time(request.performance.piece.clock, span)
    left_out = {one.player.id: wording(one.reason) for one in cast.left_out}
    return Description(
        schema=SCHEMA,
        made_by=request.creator,
        piece=layout.piece,
        title=score.title,
        content=layout.content,
        sequence=layout.sequence,
        rate=Rate(rate.numerator, rate.denominator),
        frames=span.count,
        first_frame_s=span.first_frame_s,
        first_frame=span.first,
        bars_exported=bars,
        sound=sound,
        players=tuple(_cast(project, musician, layout, contents) for musician in cast.musicians),
        dancers=tuple(_cast_dancer(dancer, layout, contents) for dancer in cast.dancers),
        ticks_per_quarter=score.ticks_per_quarter,
        pickup_ticks=score.pickup_ticks,
        tempo=_tempo(score, time),
        metres=_metres(score, time),
        bars=_bars(score, bars, time),
        markers=_markers(score, bars, time),
        cues=_cues(request.performance, [one.player for one in cast.musicians], time),
        files=dict(files),
        left_out=tuple(
            LeftOutFigures(one.name, left_out[one.id], _assets(layout.figures(one.id)))
            for one in project.performers
            if one.id in left_out
        ),
        textures=surfaces.textures,
        materials=surfaces.materials,
    )


def _cast(project: Project, musician: CastMusician, layout: Layout, contents: Mapping[str, FileContents]) -> Cast:
    player = musician.player
    first, *others = (
        Double(
            one.player.name,
            project.part(one.player).name,
            one.player.instrument_id,
            _figure(layout.instruments[one.player.id], contents, musician.sockets.get(one.player.id, "")),
        )
        for one in musician.performers
    )
    props = layout.props[player.id]
    return Cast(
        name=first.name,
        part=first.part,
        instrument_id=first.instrument_id,
        character_id=player.character_id,
        stage=stage_place(player.stage),
        place=_actor_place(player, musician.target),
        character=_character(player, musician.target, layout, contents, musician.left_off),
        instrument=first.instrument,
        doubles=tuple(others),
        props=_figure(props, contents) if props.file.as_posix() in contents else None,
    )


def _cast_dancer(cast: CastDancing, layout: Layout, contents: Mapping[str, FileContents]) -> CastDancer:
    dancer = cast.dancer
    return CastDancer(
        name=dancer.name,
        choreography=cast.dancing.choreography_name,
        character_id=dancer.character_id,
        stage=stage_place(dancer.stage),
        place=_actor_place(dancer, cast.target),
        character=_character(dancer, cast.target, layout, contents),
    )


def _character(
    one: Player | Dancer,
    target: TargetSkeleton,
    layout: Layout,
    contents: Mapping[str, FileContents],
    left_off: tuple[str, ...] = (),
) -> UnrealFigure:
    mesh, skeleton = layout.body(one, socket_names(target), left_off)
    return _figure(replace(layout.characters[one.id], mesh=mesh, skeleton=skeleton), contents)


def _figure(place: FigurePlace, contents: Mapping[str, FileContents], socket: str = "") -> UnrealFigure:
    file = place.file.as_posix()
    held = contents[file]
    return UnrealFigure(file, place.mesh, place.skeleton, place.animation, held.bones, socket, held.materials)


def _actor_place(one: Player | Dancer, target: TargetSkeleton) -> UnrealPlace:
    """Return the place of a performer's actor in Unreal; the origin if the place is part of the root bone's
    animation.
    """
    return place_of(one.stage) if target.place is None else UnrealPlace(0.0, 0.0, 0.0, 0.0)


def _assets(places: Iterable[FigurePlace]) -> tuple[str, ...]:
    return tuple(path for place in places for path in (place.mesh, place.skeleton, place.animation) if path)


@dataclass(frozen=True)
class _Time:
    """Conversion of performance times to times and frames of the animation."""

    clock: TempoMap
    span: FrameSpan

    def after_s(self, tick: float) -> float:
        """Return the animation time in seconds of a tick."""
        return self.since_s(self.clock.seconds(float(tick)))

    def since_s(self, s: float) -> float:
        """Convert a performance time to animation time, in seconds."""
        return round(s - self.span.first_frame_s, 6)

    def frame(self, s: float) -> int:
        """Return the frame of the animation nearest to a second of the performance."""
        return math.floor(s * self.span.fps.numerator / self.span.fps.denominator + 0.5)

    def shows(self, frame: int) -> bool:
        """Return whether the animation has a frame with this number."""
        return 0 <= frame < self.span.count


def _tempo(score: Score, time: _Time) -> tuple[Tempo, ...]:
    return tuple(
        Tempo(change.tick, time.after_s(change.tick), round(60e6 / change.microseconds_per_quarter, 6))
        for change in score.tempo_map.changes
    )


def _metres(score: Score, time: _Time) -> tuple[UnrealMetre, ...]:
    return tuple(
        UnrealMetre(metre.tick, time.after_s(metre.tick), metre.numerator, metre.denominator) for metre in score.metres
    )


def _bars(score: Score, bars: tuple[int, int] | None, time: _Time) -> tuple[UnrealBar, ...]:
    first, last = bars or (0 if score.pickup_ticks else 1, score.last_bar)
    starts = [(number, score.metre_map.tick_of_bar(number)) for number in range(first, last + 1)]
    reported = (UnrealBar(number, tick, time.after_s(tick), time.frame(time.after_s(tick))) for number, tick in starts)
    return tuple(bar for bar in reported if time.shows(bar.frame))


def _markers(score: Score, bars: tuple[int, int] | None, time: _Time) -> tuple[UnrealMarker, ...]:
    reported = []
    for marker in score.markers:
        bar, s = score.metre_map.bar_of_tick(marker.tick), time.after_s(marker.tick)
        if bars is None or bars[0] <= bar <= bars[1]:
            reported.append(UnrealMarker(marker.text, bar, marker.tick, s, time.frame(s)))
    return tuple(marker for marker in reported if time.shows(marker.frame))


def _cues(performance: Performance, musicians: Iterable[Player], time: _Time) -> tuple[Cue, ...]:
    reported = []
    for player in (one for musician in musicians for one in performance.project.played_by(musician)):
        for cue in performance.plan(player).cues:
            entry = time.frame(cue.end_s - time.span.first_frame_s)
            reported.append(Cue(player.name, time.since_s(cue.start_s), time.since_s(cue.end_s), entry))
    return tuple(sorted((cue for cue in reported if time.shows(cue.frame)), key=lambda cue: cue.entry_s))


def place_of(stage: StagePosition) -> UnrealPlace:
    """Convert a performer's place on stage to Unreal's coordinates (centimetres and degrees)."""
    turn_deg = math.degrees(math.remainder(stage.turn_rad, math.tau))
    return UnrealPlace(
        x_cm=round(100.0 * stage.x_m, 3) + 0.0,
        y_cm=round(100.0 * stage.z_m, 3) + 0.0,
        z_cm=0.0,
        yaw_deg=-round(turn_deg, 4) + 0.0,
    )


def encode_description(description: Description) -> bytes:
    """Return the description of an Unreal import as indented JSON in UTF-8."""
    return msgspec.json.format(msgspec.json.encode(description), indent=1) + b"\n"
