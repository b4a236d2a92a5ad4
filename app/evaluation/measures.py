"""Measures of a variant without viewers: lag, quantity of motion, visibility of breathing, contact."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Final, Literal

import msgspec
import numpy as np

from app.arrays import AnyFloatArray, BoolArray, FloatArray, SingleArray
from app.contacts.breaks import Break
from app.contacts.controls import NoteFrames
from app.contacts.judge import ContactJudge
from app.errors import FileError, Progress
from app.evaluation.key import Variant
from app.evaluation.onset_lag import LagMeasure, measure_lag
from app.evaluation.variants import OURS, performance_of
from app.formats.atomic import atomic_write
from app.formats.files import read_file
from app.formats.json_data import decode_json
from app.motion.model import Motion
from app.performance.cast import Performer, performers_of
from app.performance.ensemble import Performance
from app.performance.motion import performance_curves, player_motion
from app.performance.span import whole_span
from app.plan.model import BreathEvent, FingeringEvent
from app.project.model import Project
from app.rig.skeleton import forward
from metadata.model import BREATH_MORPHS

MEASURES_FILE: Final = "measures.json"
FPS: Final = Fraction(60)
SEEN_HZ: Final = (0.3, 15.0)
"""Frequency range of visible motion in Hz; slower motion is drift."""
VERSION: Final = 1
_MOST_BYTES: Final = 16_000_000
_AROUND_BREATH_S: Final = 0.05
_LEAST_FRAMES: Final = 3


class Visible(msgspec.Struct, frozen=True):
    """Movement of a body part during breaths, and in equally long spans between them.

    Both are medians of highest minus lowest value over the breaths; None if there are no breaths.
    """

    at_breaths: float | None
    between: float | None


class BreathVisibility(msgspec.Struct, frozen=True):
    """Visibility of breathing.

    Attributes
    ----------
    breaths : int
        Number of breaths that were measured.
    chest_mm, shoulders_mm : Visible
        Height in millimetres above the hips of the upper chest, and of the middle of the shoulders.
    ribs, mouth : Visible
        Weights of the shapes for a wide chest and an open jaw, 0..1.
    """

    breaths: int
    chest_mm: Visible
    shoulders_mm: Visible
    ribs: Visible
    mouth: Visible


class VariantPlayerMeasures(msgspec.Struct, frozen=True):
    """Measures of one player of a variant.

    Attributes
    ----------
    lag : LagMeasure
        Lag of visible actions behind the sound.
    head_mm_s : float or None
        Quantity of motion in mm/s, see `quantity_of_motion_mm_s`.
    breath : BreathVisibility
        Visibility of the player's breaths.
    notes : int
        Number of notes in the measured frames.
    contact : float or None
        Share 0..1 of these notes during which every fingertip is within 1 mm of its place, judged as in exports.
    """

    player: str
    lag: LagMeasure
    head_mm_s: float | None
    breath: BreathVisibility
    notes: int
    contact: float | None


class VariantMeasures(msgspec.Struct, frozen=True):
    """Measures of all visible players of a variant."""

    variant: Variant
    players: tuple[VariantPlayerMeasures, ...]


class _File(msgspec.Struct, frozen=True):
    format: Literal["suisou-measures"]
    version: int
    variants: tuple[VariantMeasures, ...]


def measure(
    performance: Performance,
    variant: Variant = "generated",
    motions: Mapping[str, Motion] | None = None,
    progress: Progress = lambda share: None,
) -> VariantMeasures:
    """Measure every player of a performance.

    Parameters
    ----------
    performance : Performance
        Performance with the times of notes and breaths.
    motions : mapping of str to Motion, optional
        Visible motion by player id, if it differs from the performance's; only these players are measured.
    progress : callable
        Called with the completed share 0..1; an exception raised by it stops the work.
    """
    motions = motions_of(performance) if motions is None else motions
    performers = performers_of(performance, performance.project.players).made
    found = []
    for done, player_id in enumerate(motions):
        progress(done / len(motions))
        found.append(measure_player(performance, performers[player_id], motions[player_id]))
    progress(1.0)
    return VariantMeasures(variant, tuple(found))


def measure_variants(
    project: Project, variants: Sequence[Variant], progress: Progress = lambda share: None
) -> tuple[VariantMeasures, ...]:
    """Measure the generated variants of an evaluation against the times of the sounding notes.

    Parameters
    ----------
    progress : callable
        Called with the completed share 0..1; an exception raised by it stops the work.
    """
    ours = [variant for variant in OURS if variant in variants]
    sounding = Performance(project)
    found = []
    for number, variant in enumerate(ours):

        def shown(share: float, number: int = number) -> None:
            progress((number + share) / len(ours))

        seen = performance_of(project, variant)
        found.append(measure(sounding if variant == "shifted" else seen, variant, motions_of(seen), shown))
    return tuple(found)


def motions_of(performance: Performance) -> dict[str, Motion]:
    """Return the motions of all players at `FPS` by player id."""
    span = whole_span(performance.time_frame, FPS)
    performers = performers_of(performance, performance.project.players).made
    return {player_id: player_motion(performance, performer, span) for player_id, performer in performers.items()}


def measure_player(performance: Performance, performer: Performer, motion: Motion) -> VariantPlayerMeasures:
    """Measure one player's motion: lag of the controls, quantity of head motion, visible breathing, and contacts."""
    plan = performance.plan(performer.player)
    fps = float(motion.fps)
    times_s = motion.first_frame_s + np.arange(motion.frames) / fps
    sounding = NoteFrames(times_s, plan.fingerings).sounding
    skeleton = performer.character.skeleton
    names: list[str] = [name for name in ("head", *_CHEST, *_SHOULDERS, "hips") if name in skeleton.names]
    joints = forward(skeleton, motion.rotations, motion.hips_m, [skeleton.index(name) for name in names])
    places: dict[str, FloatArray] = {name: joints.of(skeleton.index(name))[0] for name in names}
    breaks = ContactJudge(performance_curves(performance, performer), performer.character, performer.model).breaks(
        motion
    )
    notes = [note for note in plan.fingerings if times_s[0] <= note.start_s and note.end_s <= times_s[-1]]
    return VariantPlayerMeasures(
        player=performer.player.name,
        lag=measure_lag(plan.fingerings, performer.instrument.controls, motion.controls, times_s),
        head_mm_s=quantity_of_motion_mm_s(places["head"], fps, sounding),
        breath=_breath_visibility(plan.breaths, times_s, places, motion.morphs),
        notes=len(notes),
        contact=_contact(notes, breaks),
    )


def quantity_of_motion_mm_s(place_m: FloatArray, fps: float, counted: BoolArray) -> float | None:
    """Return the RMS speed of a point in mm/s between 0.3 and 15 Hz, or the range that the frame rate allows.

    Parameters
    ----------
    place_m : (F, 3) float64
        Position of the point in metres.
    counted : (F,) bool
        Frames to include, usually those with a note; the result is None if they are too few to filter.
    """
    period_frames = fps / SEEN_HZ[0]
    if not counted.any() or len(place_m) < period_frames:
        return None
    top_hz = min(SEEN_HZ[1], 0.45 * fps)
    from scipy.signal import butter, sosfiltfilt  # slow to import; refused input needs none

    sections = butter(2, (SEEN_HZ[0], top_hz), "band", fs=fps, output="sos")
    moved = np.asarray(sosfiltfilt(sections, place_m, axis=0))
    speed = np.linalg.norm(np.gradient(moved, axis=0), axis=1) * fps * 1000.0
    return round(float(np.sqrt(np.mean(np.square(speed[counted])))), 2)


_CHEST: Final = ("upperChest", "chest")
_SHOULDERS: Final = ("leftUpperArm", "rightUpperArm")


def _breath_visibility(
    breaths: Sequence[BreathEvent],
    times_s: FloatArray,
    places: Mapping[str, FloatArray],
    morphs: Mapping[str, SingleArray],
) -> BreathVisibility:
    drawn = [event for event in breaths if event.draws_air]
    spans, rests = [], []
    for event, following in zip(drawn, [*drawn[1:], None], strict=True):
        begin_s, end_s = event.start_s - _AROUND_BREATH_S, event.end_s + _AROUND_BREATH_S
        if begin_s >= times_s[0] and end_s <= times_s[-1]:
            spans.append(_frames(times_s, begin_s, end_s))
        until_s = min(times_s[-1], following.start_s - _AROUND_BREATH_S if following is not None else times_s[-1])
        middle_s, half_s = 0.5 * (end_s + until_s), 0.5 * (end_s - begin_s)
        if middle_s - half_s >= max(end_s, times_s[0]) and middle_s + half_s <= until_s:
            rests.append(_frames(times_s, middle_s - half_s, middle_s + half_s))
    still = np.zeros(len(times_s))
    hips = places["hips"][:, 1]
    chest = next((places[name][:, 1] - hips for name in _CHEST if name in places), still)
    sides = [places[name][:, 1] - hips for name in _SHOULDERS if name in places]
    shoulders = np.mean(sides, axis=0) if sides else still
    curves = (1000.0 * chest, 1000.0 * shoulders, morphs.get(BREATH_MORPHS[0], still), morphs.get("jawOpen", still))
    return BreathVisibility(len(spans), *(Visible(_range(curve, spans), _range(curve, rests)) for curve in curves))


def _frames(times_s: FloatArray, begin_s: float, end_s: float) -> slice:
    first, last = np.searchsorted(times_s, (begin_s, end_s))
    return slice(int(first), max(int(last), int(first) + _LEAST_FRAMES))


def _range(curve: AnyFloatArray, spans: Sequence[slice]) -> float | None:
    return round(float(np.median([np.ptp(curve[span]) for span in spans])), 4) if spans else None


def _contact(notes: Sequence[FingeringEvent], breaks: Sequence[Break]) -> float | None:
    """Return the share of notes during which all fingers and hands stay in place."""
    if not notes:
        return None
    off = [(found.start_s, found.end_s) for found in breaks if found.kind in ("touch", "hand")]
    kept = sum(not any(start_s < note.end_s and end_s >= note.start_s for start_s, end_s in off) for note in notes)
    return round(kept / len(notes), 4)


def write_measures(variants: Sequence[VariantMeasures], path: Path) -> None:
    """Write the measures of all variants to a JSON file, atomically. Raises FileError if it cannot be written."""
    content = msgspec.json.encode(_File("suisou-measures", VERSION, tuple(variants)))
    with atomic_write(path) as stream:
        stream.write(msgspec.json.format(content, indent=1) + b"\n")


def read_measures(path: Path) -> tuple[VariantMeasures, ...]:
    """Read the measures of every variant from a JSON file of an evaluation.

    Raises
    ------
    FileError
        The file cannot be read, is no file of measures, or of a newer version.
    """
    found = decode_json(read_file(path, _MOST_BYTES), _File, str(path), "results.not_measures")
    if found.version > VERSION:
        raise FileError("evaluate.newer_key", file=str(path))
    return found.variants
