"""Scenes of an export's characters and instruments, on the requested skeletons and with the requested keys."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from app.export.attachment import own_path
from app.export.character import character_scene
from app.export.eyes import looking_ahead
from app.export.face_curves import with_curve_names, written_weights
from app.export.file_names import figure_stems
from app.export.formats import FileFormat
from app.export.humanoid import humanoid_scene
from app.export.instrument import instrument_scene
from app.export.plain_surfaces import with_plain_surfaces
from app.export.request import CastDancing, CastMusician, ExportRequest
from app.export.scene_keys import keyed_character, keyed_instrument
from app.export.supports import supports_scene
from app.export.target import TargetSkeleton, instrument_path
from app.formats.keys import KeyChoice
from app.formats.scene import Scene
from app.motion.model import Motion
from app.performance.cast import Performer
from app.performance.motion import player_motion
from app.performance.supports import HeldInstrument, instrument_matrices, joints_of, supports_of
from app.rig.model import Character
from app.rig.supports.model import Supports


def musician_scene(
    request: ExportRequest, musician: CastMusician, motion: Motion, kind: FileFormat | None = None
) -> Scene:
    """Return the scene of a musician's character, with sockets for the instruments.

    Parameters
    ----------
    motion : Motion
        Motion of the player of the first instrument.
    kind : FileFormat, optional
        File format, which may require its own skeleton.
    """
    name, target = figure_stems(request.performance)[musician.player.id]["character"], musician.target
    if kind is not None and kind.humanoid:
        return _animation_scene(request, musician.character, motion, name, musician.target_in(kind))
    motions = [motion] if target.sockets else []
    if target.sockets:
        motions += [player_motion(request.performance, double, request.span) for double in musician.performers[1:]]
    scene = character_scene(
        musician.character,
        motion,
        name,
        request.creator,
        target,
        tuple(map(instrument_path, motions)),
        face_parts=request.face.parts,
    )
    scene = with_curve_names(_surfaced(scene, request, musician.character), request.face.names)
    models = [one.model for one in musician.performers]
    return keyed_character(scene, request.keys, request.formats, musician.character, target, models)


def held_scene(request: ExportRequest, musician: CastMusician, performer: Performer, motion: Motion) -> Scene:
    """Return the scene of one of a musician's instruments, moved by ``motion``, that of its player."""
    name, path = figure_stems(request.performance)[performer.player.id]["instrument"], own_path(musician.target, motion)
    scene = instrument_scene(performer.instrument, performer.model, motion, name, request.creator, path)
    return keyed_instrument(scene, request.keys, request.formats)


def props_scene(request: ExportRequest, musician: CastMusician, supports: Supports, motions: Sequence[Motion]) -> Scene:
    """Return the scene of a musician's straps and chair; ``motions`` are those of the player of each instrument."""
    name = figure_stems(request.performance)[musician.player.id]["props"]
    joints = joints_of(musician.character, motions[0])
    held = [instrument_matrices(motion) for motion in motions]
    scene = supports_scene(supports, joints, held, motions[0].fps, name, request.creator, musician.target.place)
    return keyed_instrument(scene, request.keys, request.formats)


def supports_of_musician(request: ExportRequest, musician: CastMusician) -> Supports | None:
    """Return the straps and chair of a musician; None if there are none or they are not exported."""
    if not request.with_props:
        return None
    held = [HeldInstrument(one.player, one.instrument, one.grip) for one in musician.performers]
    return supports_of(musician.character, held)


def dancer_scene(request: ExportRequest, cast: CastDancing, motion: Motion, kind: FileFormat | None = None) -> Scene:
    """Return the scene of a dancer's character with its motion; ``kind`` as in `musician_scene` is the file format it
    is for."""
    name, character = figure_stems(request.performance)[cast.dancer.id]["character"], cast.character
    if kind is not None and kind.humanoid:
        return _animation_scene(request, character, motion, name, cast.target_in(kind))
    scene = character_scene(character, motion, name, request.creator, cast.target, face_parts=request.face.parts)
    scene = with_curve_names(_surfaced(scene, request, character), request.face.names)
    return keyed_character(scene, request.keys, request.formats, character, cast.target)


def _surfaced(scene: Scene, request: ExportRequest, character: Character) -> Scene:
    """Return the scene of a character with plain surfaces if the files have no textures; a character from the user's
    file keeps its materials.
    """
    return with_plain_surfaces(scene) if request.has_plain_surfaces and character.own is None else scene


def _animation_scene(
    request: ExportRequest, character: Character, motion: Motion, name: str, target: TargetSkeleton
) -> Scene:
    if "gaze" not in request.face.parts:
        motion = looking_ahead(character, motion)
    scene = humanoid_scene(character, motion, name, request.creator, target)
    assert scene.clip is not None
    # VRM has its own names of expressions and its own gaze.
    weights = written_weights(scene.clip.morph_weights, request.face.parts)
    scene = replace(scene, clip=replace(scene.clip, morph_weights=weights))
    # Viewers rotate the keys of an animation to the rest pose of their figure, and some ignore tangents in doing so.
    keys: KeyChoice = "every" if request.keys == "every" else "linear"
    return keyed_character(scene, keys, request.formats, character, target)
