"""Reading and checking of metadata tables; every fault names the file and the line or key path."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TypeVar, get_args

from app.errors import MapError
from metadata.face_model import EMBOUCHURE_WEIGHTS, FACE_WEIGHTS, UPPER_FACE, FaceMotion
from metadata.known_names import BoneNames, FaceNames
from metadata.model import ARKIT_MORPHS, Body, Controller, EmbouchureKind, Expression
from metadata.skeleton_profile import SkeletonProfile
from metadata.tables import ROOT, bundled, check_name, decoded, invalid, label

_KIND_FOLDERS = {
    "expression": "expressions",
    "body": "bodies",
    "skeleton": "skeletons",
    "bone_names": "bone_names",
    "face_names": "faces",
    "controller": "controllers",
}
GENERIC_CONTROLLER = "generic"
"""Name of the controller that is used if no other is recognised."""
_AXIS_TOLERANCE = 2e-3
_MORPHS = frozenset(ARKIT_MORPHS)

T = TypeVar("T")


def names(kind: str) -> tuple[str, ...]:
    """Names of the tables of a kind (a key of `_KIND_FOLDERS`), sorted."""
    return tuple(sorted(path.stem for path in (ROOT / _KIND_FOLDERS[kind]).glob("*.toml")))


def load_expressions() -> dict[str, Expression]:
    """Return every bundled expression by name."""
    return dict(_EXPRESSIONS())


def load_expression(name: str) -> Expression:
    """Return the bundled expression of a name. Raises MapError."""
    return _named("expression", _EXPRESSIONS(), name)


def load_skeleton(name: str = "vrm1") -> SkeletonProfile:
    """Return the bundled skeleton profile of a name. Raises MapError."""
    return _named("skeleton", _SKELETONS(), name)


def load_bone_names() -> Mapping[str, BoneNames]:
    """Return every bundled table of bone names by name. Raises MapError."""
    return _BONE_NAMES()


def load_face_names() -> Mapping[str, FaceNames]:
    """Return every bundled table of face morph names by name. Raises MapError."""
    return _FACE_NAMES()


def load_body(name: str = "adult") -> Body:
    """Return the bundled body of a name. Raises MapError."""
    return _named("body", _BODIES(), name)


def load_controller(name: str = GENERIC_CONTROLLER) -> Controller:
    """Return the bundled controller of a name. Raises MapError."""
    return _named("controller", _CONTROLLERS(), name)


def load_controllers() -> Mapping[str, Controller]:
    """Return every bundled controller by name."""
    return _CONTROLLERS()


def recognised_controller(port: str) -> Controller:
    """Return the wind controller to which a MIDI port name belongs; the generic one if it is unknown."""
    for controller in load_controllers().values():
        if any(re.search(pattern, port, re.IGNORECASE) for pattern in controller.ports):
            return controller
    return load_controller()


def read_controller(path: Path) -> Controller:
    """Read and check a controller. Raises MapError."""
    controller = _decode(path, Controller)
    _check_name(path, controller.name)
    for index, pattern in enumerate(controller.ports):
        try:
            re.compile(pattern)
        except re.error as error:
            raise _invalid(path, f"ports[{index}]", str(error)) from error
    for source in controller.breath:
        if controller.breath.count(source) > 1:
            raise _invalid(path, "breath", f"{source!r} appears twice")
    if controller.bite in controller.breath:
        raise _invalid(path, "bite", f"{controller.bite!r} is what breathes")
    return controller


def read_expression(path: Path) -> Expression:
    """Read and check an expression. Raises MapError."""
    expression = _decode(path, Expression)
    _check_name(path, expression.name)
    _check_morphs(path, "weights", expression.weights)
    return expression


def read_named_expression(path: Path) -> Expression:
    """Read and check an expression whose name may differ from that of its file. Raises MapError."""
    expression = decoded(path, Expression)
    if not expression.name.strip() or not expression.name.isprintable():
        raise invalid(path, "name", "must be a name on one line")
    _check_morphs(path, "weights", expression.weights, label(path))
    return expression


def read_skeleton(path: Path) -> SkeletonProfile:
    """Read and check a skeleton profile. Raises MapError."""
    profile = _decode(path, SkeletonProfile)
    _check_name(path, profile.name)
    seen: set[str] = set()
    for index, joint in enumerate(profile.joints):
        key = f"joints[{index}]"
        if joint.name in seen:
            raise _invalid(path, f"{key}.name", f"{joint.name!r} appears twice")
        if (joint.parent == "") != (index == 0):
            raise _invalid(path, f"{key}.parent", "the first joint, and only it, is the root")
        if joint.parent and joint.parent not in seen:
            raise _invalid(path, f"{key}.parent", f"{joint.parent!r} is not a joint above")
        if joint.kind not in profile.axes:
            raise _invalid(path, f"{key}.kind", f"no axes for {joint.kind!r}")
        seen.add(joint.name)
    for kind, axes in profile.axes.items():
        _check_axes(path, f"axes.{kind}", (axes.flexion, axes.sideways, axes.twist))
    for kind, turns in profile.turns.items():
        if kind not in profile.axes or len(set(turns)) != len(turns):
            raise _invalid(path, f"turns.{kind}", "must name each axis of a kind of joint once")
    for chain, joints in profile.chains.items():
        _check_joints(path, f"chains.{chain}", joints, seen)
    for side, fingers in profile.fingers.items():
        for finger, value in fingers.items():
            _check_joints(path, f"fingers.{side}.{finger}.joints", value.joints, seen)
    return profile


def read_bone_names(path: Path) -> BoneNames:
    """Read and check a table of bone names against the joints of the skeleton profile. Raises MapError."""
    table = _decode(path, BoneNames)
    _check_name(path, table.name)
    joints = {joint.name for joint in load_skeleton().joints} - {"root", "spine", "chest", "upperChest"}
    _check_joints(path, "middle", tuple(table.middle), joints)
    for joint, bones in table.sides.items():
        _check_joints(path, "sides", (f"left{joint}", f"right{joint}"), joints)
        for bone in bones:
            if bone.count("{side}") != 1:
                raise _invalid(path, f"sides.{joint}", f"{bone!r} must say {{side}} once")
    joint_of: dict[str, str] = {}
    for joint, keys in table.keys().items():
        for key in keys:
            if not key:
                raise _invalid(path, joint, "a name without letters or digits")
            if key in joint_of:
                raise _invalid(path, joint, f"{joint_of[key]} is called {key!r} too")
            joint_of[key] = joint
    return table


def read_face_names(path: Path) -> FaceNames:
    """Read and check a table of names of a face's morphs. Raises MapError."""
    table = _decode(path, FaceNames)
    _check_name(path, table.name)
    _check_morphs(path, "morphs", table.morphs)
    for shape in table.morphs:
        for way in table.ways(shape):
            if not way or "" in way:
                raise _invalid(path, f"morphs.{shape}", "a way that names nothing")
    return table


def read_body(path: Path) -> Body:
    """Read and check a body against its skeleton profile. Raises MapError."""
    body = _decode(path, Body)
    _check_name(path, body.name)
    if body.skeleton not in names("skeleton"):
        raise _invalid(path, "skeleton", f"no skeleton profile {body.skeleton!r}")
    profile = load_skeleton(body.skeleton)
    kinds = {joint.kind for joint in profile.joints}
    for kind, limits in body.limits.items():
        if kind not in kinds:
            raise _invalid(path, f"limits.{kind}", f"no joint of {body.skeleton!r} is of this kind")
        for field in ("flexion_deg", "sideways_deg", "twist_deg"):
            low, high = getattr(limits, field)
            if not -180.0 <= low <= 0.0 <= high <= 180.0:
                raise _invalid(path, f"limits.{kind}.{field}", "must hold 0 and lie within -180..180")
    missing = sorted(kinds - set(body.limits) - {"root"})
    if missing:
        raise _invalid(path, "limits", f"no limits for {', '.join(missing)}")
    for name in ("standing", "seated"):
        if name not in body.postures:
            raise _invalid(path, "postures", f"no posture {name!r}")
    names_known = {joint.name for joint in profile.joints}
    for name, posture in body.postures.items():
        _check_joints(path, f"postures.{name}.spine_deg", tuple(posture.spine_deg), names_known)
    for kind in get_args(EmbouchureKind):
        if kind not in body.embouchure:
            raise _invalid(path, "embouchure", f"no embouchure {kind!r}")
    for kind, embouchure in body.embouchure.items():
        for field in EMBOUCHURE_WEIGHTS:
            _check_morphs(path, f"embouchure.{kind}.{field}", getattr(embouchure, field))
        if embouchure.vibrato_hz[0] > embouchure.vibrato_hz[1]:
            raise _invalid(path, f"embouchure.{kind}.vibrato_hz", "the lowest rate comes first")
    _check_face(path, body.face)
    return body


def _check_face(path: Path, face: FaceMotion) -> None:
    for field in FACE_WEIGHTS:
        weights = getattr(face, field)
        _check_morphs(path, f"face.{field}", weights)
        for morph in weights:
            if not morph.startswith(UPPER_FACE):
                raise _invalid(path, f"face.{field}.{morph}", "the mouth belongs to the embouchure")
    if face.left_right[0] > face.left_right[1]:
        raise _invalid(path, "face.left_right", "the smallest difference comes first")


def _named(kind: str, tables: Mapping[str, T], name: str) -> T:
    try:
        return tables[name]
    except KeyError:
        raise MapError("metadata.missing", kind=kind, name=name, known=", ".join(tables)) from None


def _decode(path: Path, type_: type[T]) -> T:
    return decoded(path, type_, path.name)


def _invalid(path: Path, key: str, detail: str) -> MapError:
    return invalid(path, key, detail, path.name)


def _check_name(path: Path, name: str) -> None:
    check_name(path, name, path.name)


def _check_morphs(path: Path, key: str, weights: Iterable[str], file: str | None = None) -> None:
    for morph in weights:
        if morph not in _MORPHS:
            raise invalid(path, f"{key}.{morph}", "not one of the 52 ARKit morph targets", file or path.name)


def _check_joints(path: Path, key: str, joints: tuple[str, ...], known: set[str]) -> None:
    for joint in joints:
        if joint not in known:
            raise _invalid(path, key, f"no joint {joint!r}")


def _check_axes(path: Path, key: str, axes: tuple[tuple[float, float, float], ...]) -> None:
    for i, a in enumerate(axes):
        for j, b in enumerate(axes):
            dot = sum(p * q for p, q in zip(a, b, strict=True))
            if abs(dot - (i == j)) > _AXIS_TOLERANCE:
                raise _invalid(path, key, "axes must be unit vectors at right angles")


_EXPRESSIONS = bundled(_KIND_FOLDERS["expression"], read_expression, Expression)
_BODIES = bundled(_KIND_FOLDERS["body"], read_body, Body)
_SKELETONS = bundled(_KIND_FOLDERS["skeleton"], read_skeleton, SkeletonProfile)
_BONE_NAMES = bundled(_KIND_FOLDERS["bone_names"], read_bone_names, BoneNames)
_FACE_NAMES = bundled(_KIND_FOLDERS["face_names"], read_face_names, FaceNames)
_CONTROLLERS = bundled(_KIND_FOLDERS["controller"], read_controller, Controller)
