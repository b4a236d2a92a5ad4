"""An evaluation from a project and a video of real players: clips, the page, its key and the measures.

Messages
--------
evaluate.there_already(file), evaluate.no_excerpt; progress: evaluate.step_video and others.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Final, TypeAlias

from app.audio.mix import mixdown
from app.audio.track import RATE_HZ, Block
from app.encoding import restored
from app.errors import AppError, FileError, Message, raise_if_stopped
from app.evaluation.clips import CRF, ClipScene, Framing, Stages, cut_video, draw_ours
from app.evaluation.design import codes, new_id, orders, pairs_of
from app.evaluation.excerpts import Excerpt, choose_excerpts, practice_of
from app.evaluation.imported_videos import ImportedVideo, import_video
from app.evaluation.key import KEY_FILE, VERSION, EvaluationClip, EvaluationKey, Variant, write_key
from app.evaluation.keyframes import Keyframes, holds_motion, read_keyframes
from app.evaluation.loudness import equally_loud
from app.evaluation.measures import MEASURES_FILE, measure_variants, write_measures
from app.evaluation.page import PAGE_FILE, page
from app.evaluation.request import EvaluationRequest, aspects_of, variants_of
from app.export.folder import files_into
from app.export.video import side_by_side
from app.performance.cast import LeftOut, require_players
from app.performance.ensemble import Performance
from app.performance.span import FrameSpan, bars_span, cut_span
from app.project.model import Project

Report: TypeAlias = Callable[[float, Message], None]
StopRequested: TypeAlias = Callable[[], bool]
Imported: TypeAlias = ImportedVideo | Keyframes
"""What is compared with ours, at its place in the piece."""
CLIPS: Final = "clips"
_PRACTICE: Final = "practice"


@dataclass(frozen=True)
class Made:
    """What was written.

    Attributes
    ----------
    left_out : tuple of LeftOut
        Performers who could not be drawn.
    video : ImportedVideo or None
        The film of real players at its place.
    """

    folder: Path
    key: EvaluationKey
    pairs: int
    viewers: int
    left_out: tuple[LeftOut, ...]
    video: ImportedVideo | None


def make_evaluation(
    project: Project,
    request: EvaluationRequest,
    stages: Stages,
    wording: Callable[[Message], str],
    report: Report,
    stop_requested: StopRequested,
) -> Made:
    """Write an evaluation: all of it or nothing.

    Parameters
    ----------
    stages : Stages
        What draws performances.
    wording : callable
        Words the reasons why performers cannot be drawn.
    report : callable
        Called with the share 0..1 that is done and what is being done.

    Raises
    ------
    AppError
        Those of this module, of `variants_of`, `import_video` and of writing.
    Cancelled
    """
    variants = variants_of(request)
    folder = Path(restored(request.folder))
    if os.path.lexists(folder / KEY_FILE):
        raise FileError("evaluate.there_already", file=str(folder))
    project, videos = _videos(project, request, variants, report, stop_requested)
    performance = Performance(project)
    performance.hold(stop_requested, lambda share: report(0.2 + 0.05 * share, Message("evaluate.step_holds")))
    if "keyframes" in variants and holds_motion(restored(request.keyframes)):
        path = Path(restored(request.keyframes))
        videos["keyframes"] = read_keyframes(performance, path, request.player_ids, request.keyframes_offset_s)
    scenes = _scenes(performance, request, videos, report, stop_requested)
    drawn = _clips(project, request, variants, scenes[:-1])
    singles = tuple(clip.code for clip in drawn) if request.presentation != "pair" else ()
    pairs = pairs_of([(clip.code, clip.variant, clip.excerpt) for clip in drawn])
    pairs = pairs if request.presentation != "single" else ()
    table = orders(singles, pairs)
    key = EvaluationKey(
        "suisou-evaluation",
        VERSION,
        new_id(),
        request.title,
        request.seed,
        tuple(sorted(drawn, key=lambda clip: clip.code)),
        aspects_of(request.view, len(project.seen)),
    )
    with files_into(folder) as new:
        clips = new / CLIPS
        clips.mkdir()
        left_out = _draw(
            project, request, variants, videos, scenes, drawn, clips, stages, wording, report, stop_requested
        )
        for number, (left, right) in enumerate(pairs):
            report(0.9 + 0.05 * number / len(pairs), Message("evaluate.step_pairs"))
            side_by_side(clips / f"{left}-{right}.mp4", clips / f"{left}.mp4", clips / f"{right}.mp4", CRF)
        report(0.95, Message("evaluate.step_page"))
        (new / PAGE_FILE).write_bytes(page(key, table, clips))
        measured = _measured(report, stop_requested)
        write_measures(measure_variants(project, variants, measured), new / MEASURES_FILE)
        write_key(key, new / KEY_FILE)
    film = videos.get("film")
    return Made(folder, key, len(pairs), len(table), left_out, film if isinstance(film, ImportedVideo) else None)


def _draw(
    project: Project,
    request: EvaluationRequest,
    variants: Sequence[Variant],
    videos: Mapping[Variant, Imported],
    scenes: Sequence[ClipScene],
    drawn: Sequence[EvaluationClip],
    clips: Path,
    stages: Stages,
    wording: Callable[[Message], str],
    report: Report,
    stop_requested: StopRequested,
) -> tuple[LeftOut, ...]:
    """Write the clips of all variants; who could not be drawn."""
    framing = Framing(request.view, request.player_ids, request.size, request.theme)
    left_out = dict[str, LeftOut]()
    for number, variant in enumerate(variants):
        files = {clips / f"{clip.code}.mp4": scenes[clip.excerpt - 1] for clip in drawn if clip.variant == variant}
        if variant == ("generated" if "generated" in variants else variants[0]):
            files[clips / f"{_PRACTICE}.mp4"] = scenes[-1]

        def shown(share: float, number: int = number) -> None:
            said = Message("evaluate.step_clips", {"number": number + 1, "count": len(variants)})
            report(0.3 + 0.6 * (number + share) / len(variants), said)

        def refuse(left: Sequence[LeftOut]) -> None:
            require_players(left, request.title, wording)

        imported = videos.get(variant)
        if isinstance(imported, ImportedVideo):
            cut_video(imported, request.size, files, shown, stop_requested)
        else:
            posed = None if imported is None else imported.posed
            found = draw_ours(project, variant, framing, files, stages, shown, stop_requested, refuse, posed)
            left_out |= {one.player.id: one for one in found}
    return tuple(left_out.values())


def _measured(report: Report, stop_requested: StopRequested) -> Callable[[float], None]:
    def measured(share: float) -> None:
        raise_if_stopped(stop_requested)
        report(0.95 + 0.05 * share, Message("evaluate.step_measures"))

    return measured


def _videos(
    project: Project,
    request: EvaluationRequest,
    variants: Sequence[Variant],
    report: Report,
    stop_requested: StopRequested,
) -> tuple[Project, dict[Variant, Imported]]:
    found: dict[Variant, Imported] = {}
    if request.film:
        found["film"], project = import_video(
            project,
            Path(restored(request.film)),
            request.film_offset_s,
            lambda share: report(
                0.15 * share, Message("evaluate.step_video", {"file": Path(restored(request.film)).name})
            ),
            stop_requested,
            request.follow_film,
        )
    if "keyframes" in variants and not holds_motion(restored(request.keyframes)):
        path = Path(restored(request.keyframes))
        found["keyframes"], _ = import_video(
            project,
            path,
            request.keyframes_offset_s,
            lambda share: report(0.15 + 0.05 * share, Message("evaluate.step_video", {"file": path.name})),
            stop_requested,
        )
    return project, found


def _scenes(
    performance: Performance,
    request: EvaluationRequest,
    videos: dict[Variant, Imported],
    report: Report,
    stop_requested: StopRequested,
) -> list[ClipScene]:
    """Every excerpt, and after them what is shown for practice."""
    spans = _spans(performance, request, videos)
    film, sounds = videos.get("film"), list[Block]()
    for number, span in enumerate(spans):
        if isinstance(film, ImportedVideo) and film.samples is not None:
            sounds.append(film.sound(Excerpt(span.first_frame_s, span.end_s)))
        else:
            sounds.append(
                mixdown(performance.project, span.first_frame_s, span.end_s, RATE_HZ, stop_requested=stop_requested)
            )
        report(0.25 + 0.05 * (number + 1) / len(spans), Message("evaluate.step_sound"))
    loud = equally_loud(sounds)
    return [ClipScene(span, sound, {}) for span, sound in zip(spans, loud, strict=True)]


def _spans(performance: Performance, request: EvaluationRequest, videos: dict[Variant, Imported]) -> list[FrameSpan]:
    """The frames of the excerpts and of the practice."""
    fps = Fraction(*request.fps)
    if request.bars is not None:
        bars = bars_span(performance, fps, request.bars, 0.0)
        excerpts: tuple[Excerpt, ...] = (Excerpt(bars.first_frame_s, bars.end_s),)
    else:
        covered = [video.covered_s for video in videos.values()]
        within = (max(first for first, _ in covered), min(last for _, last in covered)) if covered else None
        excerpts = choose_excerpts(performance.project, request.excerpts, request.excerpt_s, within)
    if not excerpts:
        raise AppError("evaluate.no_excerpt")
    for video in videos.values():
        for excerpt in excerpts:
            video.require_covered(excerpt)
    return [
        cut_span(performance.time_frame, fps, excerpt.from_s, excerpt.until_s)
        for excerpt in (*excerpts, practice_of(excerpts))
    ]


def _clips(
    project: Project, request: EvaluationRequest, variants: Sequence[Variant], scenes: Sequence[ClipScene]
) -> list[EvaluationClip]:
    """The clips with their codes, excerpt by excerpt."""
    names = {performer.id: performer.name for performer in project.performers}
    player = names[request.player_ids[0]] if len(request.player_ids) == 1 else ""
    places = [(number, scene, variant) for number, scene in enumerate(scenes, start=1) for variant in variants]
    drawn = codes(len(places), request.seed)
    return [
        EvaluationClip(
            code=code,
            variant=variant,
            excerpt=number,
            from_s=round(scene.span.first_frame_s, 3),
            until_s=round(scene.span.end_s, 3),
            view=request.view,
            player=player,
        )
        for code, (number, scene, variant) in zip(drawn, places, strict=True)
    ]
