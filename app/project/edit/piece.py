"""Edits of the piece as a whole: new piece, title, frame rate, felt beat, acting, recording, own expressions."""

from __future__ import annotations

import math
import os
from dataclasses import replace
from fractions import Fraction
from typing import Any

import msgspec

from app.errors import UsageError
from app.plan.by_hand.corrections import Correction
from app.project import limits
from app.project.casting import ConductorPlace
from app.project.check import expression_faults
from app.project.edit.tempo import set_metre, set_tempo
from app.project.model import Project, preroll_of_new
from app.project.names import clean_name
from app.project.recording import AudioTrack
from app.project.video import VideoTrack
from app.score.model import Score
from app.score.tempo import TempoMap
from metadata.load import names
from metadata.model import Expression


def new_piece(
    title: str = "", bpm: float = 120.0, metre: tuple[int, int] = (4, 4), ticks_per_quarter: int = 480
) -> Project:
    """Create a piece without players, to be filled by hand or by recording. Raises UsageError for impossible values."""
    _check("ticks_per_quarter", ticks_per_quarter, limits.TICKS_PER_QUARTER)
    score = Score(clean_name(title)[: limits.MOST_NAME], ticks_per_quarter, TempoMap(ticks_per_quarter))
    project = set_metre(set_tempo(Project(score, ()), 0, bpm), 0, *metre)
    return _with(project, preroll_beats=preroll_of_new(project))


def set_title(project: Project, title: str) -> Project:
    """Set the title of the score; it may be empty, and is shortened if too long."""
    cleaned = clean_name(title)[: limits.MOST_NAME]
    if project.score.title in (title, cleaned):
        return project
    return replace(project, score=msgspec.structs.replace(project.score, title=cleaned))


def set_fps(project: Project, fps: Fraction) -> Project:
    """Set the frame rate of the piece, frames per second."""
    _check("fps", fps, limits.FPS)
    return _with(project, fps=Fraction(fps))


def set_preroll(project: Project, beats: float) -> Project:
    """Set the length of the pre-roll, in felt beats before the first note."""
    _check("preroll_beats", beats, limits.PREROLL_BEATS)
    return _with(project, preroll_beats=float(beats))


def set_section_intensity(project: Project, intensity: float) -> Project:
    """Set the factor for the acting of all players (1 leaves it unchanged)."""
    _check("section_intensity", intensity, limits.SECTION_INTENSITY)
    return _with(project, section_intensity=float(intensity))


def set_conductor(project: Project, place: ConductorPlace | None) -> Project:
    """Set the conductor's position; None removes the conductor."""
    if place is not None:
        _check("conductor.x_m", place.x_m, limits.STAGE_M)
        _check("conductor.z_m", place.z_m, limits.STAGE_M)
    return _with(project, conductor=place)


def set_felt_beat(project: Project, quarters: float | None) -> Project:
    """Set the length of the felt beat in quarters; None derives it from metre and tempo."""
    if quarters is None:
        return _with(project, felt_beat_quarters=None)
    _check("felt_beat_quarters", quarters, limits.FELT_BEAT_QUARTERS)
    return _with(project, felt_beat_quarters=float(quarters))


def set_seed(project: Project, seed: int) -> Project:
    """Set the seed of the performance; the players' own seeds stay."""
    _check("seed", seed, limits.SEED)
    return _with(project, seed=int(seed))


class PieceSettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Settings of the piece as a whole that the dialog edits; fields as in `Project`, plus the title of its score."""

    title: str
    fps: Fraction
    preroll_beats: float
    felt_beat_quarters: float | None
    seed: int
    section_intensity: float = 1.0
    conductor: ConductorPlace | None = None


def piece_settings(project: Project) -> PieceSettings:
    """Return the settings of a project's piece, as the dialog edits them."""
    values = {field: getattr(project, field) for field in PieceSettings.__struct_fields__ if field != "title"}
    return PieceSettings(title=project.score.title, **values)


def usual_settings(title: str, project: Project | None = None) -> PieceSettings:
    """Return the default settings of a new piece with a title; the pre-roll follows the tempo of ``project``
    if given.
    """
    usual = piece_settings(new_piece(title))
    if project is None:
        return usual
    return msgspec.structs.replace(usual, preroll_beats=preroll_of_new(project))


def set_piece_settings(project: Project, settings: PieceSettings) -> Project:
    """Set all settings of a piece together; returns the same project if none changes.

    Raises
    ------
    UsageError
        A value is outside its range.
    """
    project = set_fps(set_title(project, settings.title), settings.fps)
    project = set_felt_beat(set_preroll(project, settings.preroll_beats), settings.felt_beat_quarters)
    project = set_section_intensity(set_seed(project, settings.seed), settings.section_intensity)
    return set_conductor(project, settings.conductor)


def set_audio(project: Project, path: str | os.PathLike[str] | None) -> Project:
    """Set the recording to play with the piece; None for the built-in synthesiser. A new recording starts with the
    previous one's offset.
    """
    if path is None:
        return _with(project, audio=None)
    text, before = _path(path), project.audio
    if before is None:
        return _with(project, audio=AudioTrack(text))
    return _with(project, audio=msgspec.structs.replace(before, path=text))


def set_offset(project: Project, offset_s: float, confidence: float | None = None) -> Project:
    """Set the performance time of the recording's first sample; ``confidence`` 0..1 if it was estimated."""
    if project.audio is None:
        raise UsageError("piece.no_recording")
    return _placed(project, project.audio.path, offset_s, confidence)


def set_video(project: Project, path: str | os.PathLike[str] | None) -> Project:
    """Set the reference video; None removes it.

    A new video starts with the previous one's offset; the first one starts with the recording's offset if that is its
    own sound.
    """
    if path is None:
        return _with(project, video=None)
    text, before, audio = _path(path), project.video, project.audio
    if before is not None:
        return _with(project, video=msgspec.structs.replace(before, path=text))
    if audio is not None and audio.path == text:
        return _with(project, video=VideoTrack(text, audio.offset_s, audio.confidence))
    return _with(project, video=VideoTrack(text))


def set_video_offset(project: Project, offset_s: float, confidence: float | None = None) -> Project:
    """Set the performance time at which the reference video begins; ``confidence`` 0..1 if it was estimated."""
    if project.video is None:
        raise UsageError("piece.no_video")
    return _placed(project, project.video.path, offset_s, confidence)


def relocate(project: Project, before: str | os.PathLike[str], after: str | os.PathLike[str] | None) -> Project:
    """Change the path of a recording or reference video, keeping its offset; None removes it."""
    path, gone = None if after is None else _path(after), os.fspath(before)
    for name in ("audio", "video"):
        track = getattr(project, name)
        if track is not None and track.path == gone:
            project = _with(project, **{name: None if path is None else msgspec.structs.replace(track, path=path)})
    return project


def _path(path: str | os.PathLike[str]) -> str:
    text = os.path.abspath(path)  # noqa: PTH100 - a symbolic link is what the user chose
    if "\0" in text or len(text) > limits.MOST_TEXT:
        raise UsageError("piece.path_unusable", path=ascii(text))
    return text


def _placed(project: Project, path: str, offset_s: float, confidence: float | None) -> Project:
    """Set the offset of a file, for both recording and video if they are the same file."""
    _check("offset_s", offset_s, limits.OFFSET_S)
    if confidence is not None:
        _check("confidence", confidence, (0.0, 1.0))
        confidence = float(confidence)
    for name in ("audio", "video"):
        track = getattr(project, name)
        if track is not None and track.path == path:
            placed = msgspec.structs.replace(track, offset_s=float(offset_s), confidence=confidence)
            project = _with(project, **{name: placed})
    return project


def put_expression(project: Project, expression: Expression, former_name: str | None = None) -> Project:
    """Store an expression of the animator in the project.

    Parameters
    ----------
    expression : Expression
        Expression; it replaces one of the same name, and in this project overrides a bundled one of that name.
    former_name : str, optional
        Previous name: the expression of that name is removed, and corrections that use it are renamed.
    """
    expression = msgspec.structs.replace(expression, name=_expression_name(expression.name))
    for place, detail in expression_faults(expression, ""):
        raise UsageError("expression.invalid", name=expression.name, place=place.lstrip("."), detail=detail)
    own = {item.name: item for item in project.expressions}
    if former_name is None or former_name == expression.name:
        if own.get(expression.name) == expression:
            return project
        return replace(project, expressions=tuple({**own, expression.name: expression}.values()))
    if former_name not in own:
        raise UsageError("expression.none_of_name", name=former_name)
    if expression.name in own or expression.name in names("expression"):
        raise UsageError("expression.name_taken", name=expression.name)
    renamed = tuple(expression if item.name == former_name else item for item in project.expressions)
    corrections = {
        player: tuple(_showing(correction, former_name, expression.name) for correction in items)
        for player, items in project.corrections.items()
    }
    return replace(project, expressions=renamed, corrections=corrections)


def remove_expression(project: Project, name: str) -> Project:
    """Remove a user's expression from the piece. Corrections that use it stay, without effect until an expression of
    that name exists again.
    """
    kept = tuple(item for item in project.expressions if item.name != name)
    if len(kept) == len(project.expressions):
        raise UsageError("expression.none_of_name", name=name)
    return replace(project, expressions=kept)


def _expression_name(name: str) -> str:
    cleaned = clean_name(name)[: limits.MOST_NAME]
    if not cleaned:
        raise UsageError("expression.no_name")
    return cleaned


def _showing(correction: Correction, former: str, name: str) -> Correction:
    if getattr(correction, "expression", None) != former:
        return correction
    changed: Any = msgspec.structs.replace(correction, expression=name)
    result: Correction = changed
    return result


def _check(what: str, value: float | Fraction, bounds: tuple[float | Fraction, float | Fraction]) -> None:
    if not math.isfinite(value) or not bounds[0] <= value <= bounds[1]:
        raise UsageError("piece.value_outside", what=what, low=float(bounds[0]), high=float(bounds[1]))


def _with(project: Project, **fields: Any) -> Project:
    if all(getattr(project, name) == value for name, value in fields.items()):
        return project
    return replace(project, **fields)
