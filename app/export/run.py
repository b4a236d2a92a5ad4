"""Exports a performance as files: characters, instruments, report. Players that cannot be exported are excluded and
reported.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import NamedTuple

import msgspec
import numpy as np

from app.errors import Message, StopRequested, raise_if_stopped
from app.export.earlier_exports import files_that_stay
from app.export.file_names import REPORT, sound_name, stage_names
from app.export.folder import files_into
from app.export.measure import greatest_correlations
from app.export.player import ExportedPlayer
from app.export.processes import export_players, process_count
from app.export.report import (
    SWAY_LEAST_S,
    DancerReport,
    LeftOutReport,
    PlayerReport,
    Report,
    StageReport,
    UnplayedPartReport,
    encode_report,
)
from app.export.request import ExportCast, ExportRequest, cast_of
from app.export.stage import write_stage
from app.formats.atomic import atomic_write
from app.formats.texture_files import texture_files
from app.performance.performance_problems import reported_lines
from app.score.chunks import INCOMPLETE
from app.score.model import UnplayedPart
from app.score.part_messages import begins_after

Progress = Callable[[float, str], None]
"""Function called with the completed share 0..1 and the name of the performer being exported."""

_SOUND_WORK = 0.3
"""Work of the sound, relative to a player's."""
_STAGE_WORK = 0.4
"""Work of the stage for each player and format, relative to a player's."""


class WordedReports(NamedTuple):
    """The report in the language of its file and in that of the user."""

    filed: Report
    shown: Report


def export(
    request: ExportRequest,
    wording: Callable[[Message], str],
    stop_requested: StopRequested = lambda: False,
    progress: Progress = lambda share, label: None,
    shown_in: Callable[[Message], str] | None = None,
) -> Report:
    """Write the files of all requested players that can be exported, and ``report.json``, atomically.

    Parameters
    ----------
    request : ExportRequest
        The export.
    wording : callable
        Returns a message as text for the report file.
    stop_requested, progress : callable
        Stop the work once the first returns True; the second is called with the share done and a text.
    shown_in : callable, optional
        Returns a message as text for the returned report and for errors, if the user's language differs from the
        file's.

    Raises
    ------
    FileError
        See `cast_of`; or a file cannot be written.
    UsageError
        usd-core is not installed.
    Cancelled
        ``stop_requested`` returned True.
    """
    cast = cast_of(request, shown_in or wording, stop_requested)
    return write_cast(request, cast, wording, stop_requested, progress, shown_in).shown


def write_cast(
    request: ExportRequest,
    cast: ExportCast,
    wording: Callable[[Message], str],
    stop_requested: StopRequested = lambda: False,
    progress: Progress = lambda share, label: None,
    shown_in: Callable[[Message], str] | None = None,
) -> WordedReports:
    """Write the files of all performers in a cast, of the stage and of the sound, and return the reports; parameters as
    in `export`.
    """
    dancers: list[DancerReport] = []
    everyone = len(cast.ids)
    stage_files = stage_names(request.performance, request.formats, request.source) if request.stage else {}
    begun = everyone + (_SOUND_WORK if request.sound else 0.0)
    whole = begun + _STAGE_WORK * everyone * len(stage_files)
    labels = {player.id: player.name for player in request.performance.project.players}
    labels |= {dancer.id: dancer.name for dancer in request.dancers}
    shares: dict[str, float] = {}

    def reported(one: str, share: float) -> None:
        raise_if_stopped(stop_requested)
        if shares.get(one) != share:
            shares[one] = share
            progress(sum(shares.values()) / whole, labels[one])

    with files_into(request.folder) as folder:
        count = process_count(request, cast)
        exported = export_players(request, cast, folder, count, reported)
        for dancer in cast.dancers:
            # The modules of dances are loaded only for pieces with dancers.
            from app.export.dancers import export_dancer

            dancers.append(export_dancer(request, dancer, folder, partial(reported, dancer.dancer.id)))
        if request.sound:
            # So are those of sound.
            from app.export.sound import write_sound

            sound = sound_name(request.source)

            def mixed(share: float) -> None:
                progress((everyone + _SOUND_WORK * share) / whole, sound)

            write_sound(folder / sound, request.performance.project, request.span, mixed, stop_requested)
        players = {one.player.id: exported[one.player.id] for one in cast.musicians}
        stage = None
        if stage_files:
            label = next(iter(stage_files.values()))

            def placed(share: float) -> None:
                raise_if_stopped(stop_requested)
                progress((begun + (whole - begun) * share) / whole, label)

            stage = write_stage(request, cast, folder, placed)
        textures = texture_files(folder)
        filed = _report(request, cast, players, tuple(dancers), stage, wording, textures)
        with atomic_write(folder / REPORT) as stream:
            stream.write(encode_report(filed))
    if shown_in is None:
        return WordedReports(filed, filed)
    return WordedReports(filed, _report(request, cast, players, tuple(dancers), stage, shown_in, textures))


def _compared(players: Mapping[str, ExportedPlayer], duration_s: float) -> tuple[PlayerReport, ...]:
    """Return the players' reports, with the correlations of the motion of their trunks with other players' added unless
    the export is shorter than `SWAY_LEAST_S`.
    """
    torsos = {id: np.array(one.torso_rad) for id, one in players.items() if one.torso_rad is not None}
    reports = {id: one.report for id, one in players.items()}
    if len(torsos) >= 2 and duration_s >= SWAY_LEAST_S:
        sway = greatest_correlations({id: torso[:, 0] for id, torso in torsos.items()})
        lean = greatest_correlations({id: torso[:, 1] for id, torso in torsos.items()})
        for id in torsos:
            alike = {"sway_correlation": round(sway[id], 4), "lean_correlation": round(lean[id], 4)}
            reports[id] = msgspec.structs.replace(reports[id], **alike)
    return tuple(reports.values())


def _report(
    request: ExportRequest,
    cast: ExportCast,
    players: Mapping[str, ExportedPlayer],
    dancers: tuple[DancerReport, ...],
    stage: StageReport | None,
    wording: Callable[[Message], str],
    textures: tuple[str, ...],
) -> Report:
    project, span = request.performance.project, request.span
    warnings, ignored = list[str](), 0
    for musician in cast.musicians:
        for player in (performer.player for performer in musician.performers):
            own = map(wording, musician.checked.messages) if player is musician.player else ()
            found = players[musician.player.id].problems[player.id]
            lines, left = reported_lines(
                request.performance, player, found, wording, request.with_ignored, request.bars
            )
            warnings += [f"{player.name}: {line}" for line in (*own, *lines)]
            ignored += left
    rate = span.fps

    def later(remark: Message) -> bool:
        return request.bars is not None and begins_after(remark, request.bars[1])

    def earlier(part: UnplayedPart) -> bool:
        return request.bars is not None and part.end_tick <= project.score.metre_map.tick_of_bar(request.bars[0])

    report = Report(
        version=request.creator,
        source=request.source,
        first_frame_s=span.first_frame_s,
        fps=rate.numerator / rate.denominator,
        fps_exact=str(rate),
        frames=span.count,
        end_s=span.end_s,
        bars=request.bars,
        seed=project.seed,
        players=_compared(players, span.count / float(rate)),
        warnings=(*(wording(message) for message in project.score.warnings if not later(message)), *warnings),
        incomplete=tuple(wording(message) for message in project.score.warnings if message.id in INCOMPLETE),
        unplayed=tuple(
            UnplayedPartReport(part.name, wording(part.reason), part.note_count)
            for part in project.score.unplayed
            if not later(part.reason) and not earlier(part)
        ),
        left_out=tuple(LeftOutReport(one.player.name, wording(one.reason)) for one in cast.left_out),
        sound=sound_name(request.source) if request.sound else None,
        dancers=dancers,
        stage=stage,
        keys=request.keys,
        textures=textures,
        ignored_problems=ignored,
    )
    return msgspec.structs.replace(report, earlier=files_that_stay(request.folder, report.names))
