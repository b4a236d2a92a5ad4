"""Makes an evaluation from a project and a video of real players: clips, questionnaire, key and measures."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Final, TypeAlias

from app.audio.mix import mixdown
from app.audio.track import RATE_HZ, Block
from app.encoding import restored
from app.errors import AppError, FileError, Message, StopRequested, raise_if_stopped
from app.evaluation.clips import CRF, ClipScene, PerformanceRenderer, Stages, cut_video, draw_ours
from app.evaluation.design import codes, new_id, orders, pairs_of
from app.evaluation.excerpts import Excerpt, choose_excerpts, practice_of
from app.evaluation.imported_videos import ImportedVideo, import_video
from app.evaluation.key import KEY_FILE, VERSION, EvaluationClip, EvaluationKey, Variant, write_key
from app.evaluation.keyframes import Keyframes, holds_motion, read_keyframes
from app.evaluation.loudness import equally_loud
from app.evaluation.measures import MEASURES_FILE, measure_variants, write_measures
from app.evaluation.page import PAGE_FILE, page
from app.evaluation.request import EvaluationRequest, aspects_of, variants_of
from app.evaluation.variants import performance_of
from app.export.folder import files_into
from app.export.video import side_by_side
from app.performance.cast import LeftOut
from app.performance.chunks import Posed
from app.performance.ensemble import Performance
from app.performance.span import FrameSpan, bars_span, cut_span
from app.project.model import Project

Report: TypeAlias = Callable[[float, Message], None]
Imported: TypeAlias = ImportedVideo | Keyframes
"""Other animation for comparison, with its position in the piece."""
CLIPS: Final = "clips"
_PRACTICE: Final = "practice"


@dataclass(frozen=True)
class Made:
    """Result of making an evaluation.

    Attributes
    ----------
    left_out : tuple of LeftOut
        Performers that could not be drawn.
    video : ImportedVideo or None
        Film of real players with its position.
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
    """Write an evaluation completely or not at all.

    ``stages`` renders performances; ``wording`` words the reasons for performers that cannot be drawn; ``report``
    receives the completed share 0..1 and the current work.

    Raises
    ------
    AppError
        The request does not fit, a video cannot be used, no performer can be drawn, or files cannot be written.
    Cancelled
        ``stop_requested`` returned true.
    """
    variants = variants_of(request)
    folder = Path(restored(request.folder))
    if os.path.lexists(folder / KEY_FILE):
        raise FileError("evaluate.there_already", file=str(folder))
    project, videos = _videos(project, request, variants, report, stop_requested)
    performance = Performance(project)
    performance.hold(stop_requested, lambda share: report(0.2 + 0.05 * share, Message("evaluate.step_holds")))
    videos |= _keyframes(performance, request, variants)
    scenes = _scenes(performance, request, videos, report, stop_requested)
    drawn = _clips(project, request, variants, scenes[:-1])
    pairs = pairs_of([(clip.code, clip.variant, clip.excerpt) for clip in drawn])
    pairs = pairs if request.presentation != "single" else ()
    table = orders(tuple(clip.code for clip in drawn) if request.presentation != "pair" else (), pairs)
    key = _key(project, request, drawn)

    def reported(share: float, said: Message) -> None:
        raise_if_stopped(stop_requested)
        report(share, said)

    def stage_of(shown: Performance, posed: Posed | None) -> AbstractContextManager[PerformanceRenderer]:
        return stages(shown, request.theme, stop_requested, posed)

    with files_into(folder) as new:
        clips = new / CLIPS
        clips.mkdir()
        files = _files(clips, variants, drawn, scenes)
        left_out = _draw(project, request, videos, files, stage_of, wording, reported)
        for number, (left, right) in enumerate(pairs):
            report(0.9 + 0.05 * number / len(pairs), Message("evaluate.step_pairs"))
            side_by_side(clips / f"{left}-{right}.mp4", clips / f"{left}.mp4", clips / f"{right}.mp4", CRF)
        report(0.95, Message("evaluate.step_page"))
        (new / PAGE_FILE).write_bytes(page(key, table, clips))
        measures = measure_variants(
            project, variants, lambda share: reported(0.95 + 0.05 * share, Message("evaluate.step_measures"))
        )
        write_measures(measures, new / MEASURES_FILE)
        write_key(key, new / KEY_FILE)
    film = videos.get("film")
    return Made(folder, key, len(pairs), len(table), left_out, film if isinstance(film, ImportedVideo) else None)


def _files(
    clips: Path, variants: Sequence[Variant], drawn: Sequence[EvaluationClip], scenes: Sequence[ClipScene]
) -> dict[Variant, dict[Path, ClipScene]]:
    """Assign video files to variants, each with the scene to film; the practice clip is one of a generated variant."""
    files = {
        variant: {clips / f"{clip.code}.mp4": scenes[clip.excerpt - 1] for clip in drawn if clip.variant == variant}
        for variant in variants
    }
    files["generated" if "generated" in variants else variants[0]][clips / f"{_PRACTICE}.mp4"] = scenes[-1]
    return files


def _draw(
    project: Project,
    request: EvaluationRequest,
    videos: Mapping[Variant, Imported],
    files: Mapping[Variant, Mapping[Path, ClipScene]],
    stage_of: Callable[[Performance, Posed | None], AbstractContextManager[PerformanceRenderer]],
    wording: Callable[[Message], str],
    report: Report,
) -> tuple[LeftOut, ...]:
    """Draw and write the video clips of all variants, and return the performers that could not be drawn."""
    left_out = dict[str, LeftOut]()
    for number, (variant, own) in enumerate(files.items()):

        def shown(share: float, number: int = number) -> None:
            said = Message("evaluate.step_clips", {"number": number + 1, "count": len(files)})
            report(0.3 + 0.6 * (number + share) / len(files), said)

        imported = videos.get(variant)
        if isinstance(imported, ImportedVideo):
            cut_video(imported, request.size, own, shown)
        else:
            stage = stage_of(performance_of(project, variant), None if imported is None else imported.posed)
            left_out |= {one.player.id: one for one in draw_ours(stage, request, own, wording, shown)}
    return tuple(left_out.values())


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


def _keyframes(
    performance: Performance, request: EvaluationRequest, variants: Sequence[Variant]
) -> dict[Variant, Keyframes]:
    """Read the other animation for comparison if the user gave it as motion files; empty if there is none, or if it is
    a video.
    """
    path = Path(restored(request.keyframes))
    if "keyframes" not in variants or not holds_motion(path):
        return {}
    return {"keyframes": read_keyframes(performance, path, request.player_ids, request.keyframes_offset_s)}


def _scenes(
    performance: Performance,
    request: EvaluationRequest,
    videos: dict[Variant, Imported],
    report: Report,
    stop_requested: StopRequested,
) -> list[ClipScene]:
    """Build the scenes of all excerpts, followed by that of the practice clip."""
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
    """Choose the frames of all excerpts, followed by those of the practice clip."""
    fps = Fraction(*request.fps)
    if request.bars is not None:
        bars = bars_span(performance, fps, request.bars)
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
    """Return the clips of an evaluation, each one excerpt in one variant with a random code, in order of excerpts."""
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


def _key(project: Project, request: EvaluationRequest, drawn: Sequence[EvaluationClip]) -> EvaluationKey:
    clips = tuple(sorted(drawn, key=lambda clip: clip.code))
    aspects = aspects_of(request.view, len(project.seen))
    return EvaluationKey("suisou-evaluation", VERSION, new_id(), request.title, request.seed, clips, aspects)
