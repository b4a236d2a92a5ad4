"""Cache files of grips, since fitting takes seconds and inputs seldom change.

A grip is identified by a digest of all inputs and searched first among bundled ones, then in the user's cache. A
missing, damaged or outdated file is ignored, and the grip is fitted again.
"""

from __future__ import annotations

import contextlib
import hashlib
import logging
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import numpy.typing as npt

from app.arrays import FloatArray
from app.errors import FileError, Progress
from app.formats.atomic import atomic_write
from app.formats.cache import cache_folder
from app.formats.files import read_file
from app.formats.json_data import decode_json
from app.formats.other_computers import is_file
from app.rig.grip.body_size import face_size
from app.rig.grip.carriage import usual_posture
from app.rig.grip.finger_stations import asked_together, only_at
from app.rig.grip.fitting.fit_terms import FIT_VERSION, PLACES_VERSION, no_progress, require_landmarks
from app.rig.grip.grip_pose import GripPose, HandHold, Lips
from app.rig.grip.lips import fit_lips, needed_landmarks
from app.rig.model import Character, InstrumentModel
from app.rig.skeleton import ancestors, closure
from app.rig.skinning import mesh_named
from instrument_maps.load import bundled_maps
from instrument_maps.model import Control, InstrumentMap
from metadata.model import Body

_LOG = logging.getLogger(__name__)
MOST_BYTES = 2**22
"""Largest size of a file in bytes; bundled files have a twentieth of it."""
DIGITS = 6
"""Number of decimals: a millionth of a radian or metre is invisible, and files stay small."""


class _StoredHold(msgspec.Struct, frozen=True):
    """Parts of a grip that are slow to fit. Lips are not stored, since they depend on the face's weights.

    Additional data in files of older versions is ignored, since fitting anew takes a minute.
    """

    digest: str
    character_id: str
    instrument_id: str
    hands: tuple[HandHold, ...]


def digest_of(character: Character, model: InstrumentModel, instrument: InstrumentMap, body: Body) -> str:
    """Return the hexadecimal digest of all inputs of the hands in `fit_hold`."""
    digest = hashlib.blake2b(digest_size=16)
    digest.update(f"{FIT_VERSION}\n".encode())
    texts, arrays = _of_body(character, instrument)
    digest.update("\n".join(texts).encode())
    arrays = (*arrays, model.node_positions_m)
    if any(place is not None for place in only_at(instrument)):
        digest.update(f"{PLACES_VERSION}\n{asked_together(instrument)}\n".encode())
    for array in arrays:
        digest.update(str((array.dtype.str, array.shape)).encode())
        digest.update(np.ascontiguousarray(array).tobytes())
    # Names do not affect the hands; fingerings do only where several fingers act at once; and neither does the carriage
    # in an unusual posture or in a rest.
    usual = usual_posture(instrument)
    hands = (
        instrument.mouthpiece,
        tuple(map(_untimed, instrument.controls)),
        instrument.links,
        instrument.contacts,
        instrument.hands,
        instrument.proxy,
        (usual, instrument.hold.carriage(usual)),
        (instrument.embouchure.kind, instrument.embouchure.lips_apart_m),
    )
    if instrument.size != 1.0:
        digest.update(f"size {instrument.size}\n".encode())
    ranges = {name: (limit.flexion_deg, limit.sideways_deg, limit.twist_deg) for name, limit in body.limits.items()}
    digest.update(msgspec.json.encode((hands, ranges, body.postures), order="sorted"))
    return digest.hexdigest()


def _of_body(character: Character, instrument: InstrumentMap) -> tuple[list[str], tuple[npt.NDArray[Any], ...]]:
    """Return the properties of a body on which a fit of hands depends, as texts and arrays to be hashed: joints of the
    hands and the head, and skin of hands and lips.

    Hair, eyes, clothes and face shapes are not included.
    """
    if character.made_from is not None:
        texts, arrays = _of_body(character.made_from, instrument)
        return [*texts, character.made_of], arrays
    fixed, arrays = _of_original(character)
    has_lips = needed_landmarks(instrument) <= character.landmarks.keys()
    return [*fixed, *([] if has_lips else [f"face {face_size(character):.6f}"])], arrays


@lru_cache(maxsize=16)
def _of_original(character: Character) -> tuple[tuple[str, ...], tuple[npt.NDArray[Any], ...]]:
    """Return the properties of a body that is not made from another one, for all instruments."""
    skeleton = character.skeleton
    marks = {
        name: mark
        for name, mark in sorted(character.landmarks.items())
        if name.startswith(("left.", "right.", "lips.")) and ".foot." not in name
    }
    ends = [skeleton.index("head")]
    texts, arrays = list[str](), list[npt.NDArray[Any]]()
    for name, mark in marks.items():
        mesh = mesh_named(character, mark.mesh)
        rows = mark.vertices
        joints, weights = mesh.joints[rows], mesh.weights[rows]
        used = np.unique(joints[weights > 0.0])
        dense = np.stack([np.where(joints == joint, weights, 0.0).sum(axis=1) for joint in used], axis=1)
        texts.append(f"{name} {[skeleton.names[joint] for joint in used]}")
        arrays += [
            mesh.positions_m[rows],
            mesh.normals[rows],
            dense.astype(np.float32),
            character.joint_from_mesh[used],
        ]
        ends += used.tolist()
    hands = {skeleton.names.index(f"{side}Hand") for side in ("left", "right") if f"{side}Hand" in skeleton.names}
    ends += [joint for joint in range(len(skeleton.names)) if hands & set(ancestors(skeleton, joint))]
    chain = closure(skeleton, ends)
    texts += [f"{skeleton.names[joint]} of {skeleton.names[skeleton.parents[joint]]}" for joint in chain[1:]]
    arrays.append(skeleton.offsets_m[list(chain)])
    return tuple(texts), tuple(arrays)


def _untimed(control: Control) -> Control:
    """Return a control without its timing, which does not influence the grip."""
    return msgspec.structs.replace(
        control,
        move_window_s=0.0,
        move_note_share=0.0,
        max_speed_m_s=None,
        unhurried_speed_m_s=None,
        held_min_s=None,
        attack_s=None,
    )


def bundled_path(character_id: str, instrument_id: str) -> Path:
    """Return the path of the bundled grip of a bundled character on an instrument."""
    return Path(str(files("resources"))) / "holds" / f"{character_id}.{instrument_id}.json"


@lru_cache(maxsize=128)
def usual_wrists(instrument_id: str) -> Mapping[str, tuple[FloatArray, FloatArray]]:
    """Return the wrists of a bundled adult in an instrument's frame by side: position (3,) and rotation (4,); empty for
    an instrument without a bundled grip.
    """
    for path in sorted(bundled_path("*", instrument_id).parent.glob(f"*.{instrument_id}.json")):
        with contextlib.suppress(FileError):
            kept = _read(path)
            return {
                hand.side: (
                    np.atleast_2d(hand.instrument_from_hand_m)[0],
                    np.atleast_2d(hand.instrument_from_hand_rotation)[0],
                )
                for hand in kept.hands
            }
    return {}


def write_hold(path: Path, digest: str, grip: GripPose) -> None:
    """Write a grip to a file, which is replaced only once it is complete. Raises FileError."""
    with atomic_write(path) as file:
        stored = _StoredHold(digest, grip.character_id, grip.instrument_id, grip.hands)
        file.write(msgspec.json.encode(stored, enc_hook=_plain))


def stored(grip: GripPose) -> GripPose:
    """Return a grip with the rounding that it has after being written to a file and read."""
    kept = _StoredHold("", grip.character_id, grip.instrument_id, grip.hands)
    back = msgspec.json.decode(msgspec.json.encode(kept, enc_hook=_plain), type=_StoredHold, dec_hook=_array)
    return replace(grip, hands=back.hands)


def read_hold(path: Path, digest: str, lips: Lips) -> GripPose | None:
    """Read the grip with a digest; None if the file does not contain it."""
    try:
        stored = _read(path)
    except FileError:
        return None
    if stored.digest != digest:
        return None
    return GripPose(stored.character_id, stored.instrument_id, stored.hands, lips)


def own_hold(character: Character, model: InstrumentModel, instrument: InstrumentMap, body: Body) -> GripPose | None:
    """Return the bundled grip of a person whose hands are those of another body; None if there is none, since the other
    body's grip is good enough for the person.
    """
    path = bundled_path(character.id, instrument.id)
    if not is_file(path):
        return None
    return read_hold(path, digest_of(character, model, instrument, body), fit_lips(character, instrument, body))


def hold_for(
    character: Character,
    model: InstrumentModel,
    instrument: InstrumentMap,
    body: Body,
    progress: Progress = no_progress,
) -> GripPose:
    """Return a body's grip on an instrument: the stored one, or a new fit that is then cached.

    A bundled grip that is out of date is logged, since everyone would wait for its fit. ``progress`` is called during
    the fit, and may stop it (`fit_hold`).
    """
    require_landmarks(character, instrument)
    digest = digest_of(character, model, instrument, body)
    cached = cache_folder("holds") / f"{digest}.json"
    lips = fit_lips(character, instrument, body)
    for path in (bundled_path(character.id, instrument.id), cached):
        grip = read_hold(path, digest, lips)
        if grip is not None:
            return grip
    if bundled_maps().get(instrument.id) is instrument and is_file(bundled_path(character.id, instrument.id)):
        name = bundled_path(character.id, instrument.id).name
        _LOG.warning("%s is out of date and fitted anew: run python -m resources.build.build_holds", name)
    from app.rig.grip.fitting.fit import fit_hold  # slow to import; holds are rarely fitted

    grip = stored(fit_hold(character, model, instrument, body, progress))
    # If the cache cannot be written, only the next run takes some seconds longer.
    with contextlib.suppress(OSError, FileError):
        cached.parent.mkdir(parents=True, exist_ok=True)
        write_hold(cached, digest, grip)
    return grip


def _read(path: Path) -> _StoredHold:
    return decode_json(read_file(path, MOST_BYTES), _DECODER, str(path))


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return np.round(value, DIGITS).tolist()
    raise NotImplementedError(type(value))


def _array(kind: Any, value: Any) -> Any:
    try:
        return np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise msgspec.ValidationError(f"expected numbers for {kind}") from error


# Created while the import lock is held: msgspec crashes if two threads use a type for the first time at once.
_DECODER = msgspec.json.Decoder(_StoredHold, dec_hook=_array)
