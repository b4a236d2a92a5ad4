"""Keyframe reduction of the scenes of an export as requested, and counting of keys."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from app.export.formats import Format, requested
from app.export.joint_playback import JointPlayback
from app.export.key_reduction_landmarks import character_marks, part_marks
from app.export.playback import ScenePlayback
from app.export.reduced_keys import INSTRUMENT_MM, PLACE_MM, reduced
from app.export.target import TargetSkeleton
from app.formats.keys import KeyChoice
from app.formats.scene import Scene
from app.rig.model import Character, InstrumentModel


class KeyCount(msgspec.Struct, frozen=True):
    """Number of keys in a performer's files, and the number that a key on every frame would give.

    A key is one bone's rotation or translation, or one morph's weight, at one frame.
    """

    written: int
    every: int


def keyed_character(
    scene: Scene,
    keys: KeyChoice,
    formats: frozenset[Format],
    character: Character,
    target: TargetSkeleton,
    models: Sequence[InstrumentModel] = (),
) -> Scene:
    """Return a character's scene with its keys reduced as requested.

    Parameters
    ----------
    scene : Scene
        Scene from `app.export.character.character_scene`.
    keys : KeyChoice
        Requested choice of keys.
    formats : frozenset of str
        Formats in which it is written.
    character : Character
        The character.
    target : TargetSkeleton
        Skeleton of the scene.
    models : sequence of InstrumentModel
        Models of the musician's instruments: the deviation of attached ones is bounded too.
    """
    if keys == "every" or scene.clip is None:
        return scene
    joints = JointPlayback(ScenePlayback(scene, scene.clip), target, character)
    hanging = {bone: models[number].meshes for bone, number in target.sockets.items()}
    return reduced(
        scene, character_marks(joints, character, hanging), PLACE_MM, _by_pose(formats), curved=keys == "reduced"
    )


def keyed_instrument(scene: Scene, keys: KeyChoice, formats: frozenset[Format]) -> Scene:
    """Return an instrument's scene with its keys reduced as requested."""
    if keys == "every" or scene.clip is None:
        return scene
    marks = part_marks(ScenePlayback(scene, scene.clip))
    return reduced(scene, marks, INSTRUMENT_MM, _by_pose(formats), curved=keys == "reduced")


def _by_pose(formats: frozenset[Format]) -> bool:
    return any(kind.keys_by_pose for kind in requested(formats))


def key_count(*scenes: Scene) -> KeyCount:
    """Return the number of keys of some scenes together."""
    written = every = 0
    for scene in scenes:
        clip = scene.clip
        if clip is None:
            continue
        everything = [*range(len(scene.bones)), *clip.translations_cm]
        every += clip.frames * (len(everything) + len(clip.morph_weights))
        if clip.keys is None:
            written += clip.frames * (len(everything) + len(clip.morph_weights))
        else:
            written += sum(len(clip.keys.bones[bone]) for bone in everything)
            written += sum(map(len, clip.keys.morphs.values()))
    return KeyCount(written, every)
