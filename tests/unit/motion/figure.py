"""A synthetic body and two instruments: joints with human lengths, fixed grips, no mesh."""

from __future__ import annotations

import numpy as np

from app.rig import quaternion
from app.rig.grip.grip_pose import FingerTable, GripPose, HandHold, Lips, NodeMotion, StationTable
from app.rig.model import Character, Skeleton
from instrument_maps import hold as holding
from instrument_maps import model as maps
from instrument_maps import wind
from instrument_maps.model import InstrumentMap
from metadata.load import load_skeleton

OFFSETS_M = {
    "hips": (0.0, 0.98, 0.0),
    "spine": (0.0, 0.08, -0.02),
    "chest": (0.0, 0.08, 0.01),
    "upperChest": (0.0, 0.07, -0.01),
    "neck": (0.0, 0.34, 0.045),
    "head": (0.0, 0.10, 0.034),
    "jaw": (0.0, 0.01, 0.03),
    "leftEye": (0.031, 0.042, 0.086),
    "leftShoulder": (0.023, 0.266, 0.055),
    "leftUpperArm": (0.162, -0.028, -0.006),
    "leftLowerArm": (0.28, 0.0, 0.0),
    "leftHand": (0.266, 0.0, 0.0),
    "leftUpperLeg": (0.1, -0.02, 0.0),
    "leftLowerLeg": (0.0, -0.432, 0.0),
    "leftFoot": (0.0, -0.446, 0.0),
    "leftToes": (0.0, -0.05, 0.15),
}


def skeleton() -> Skeleton:
    """The joints of the bundled profile with a man's lengths."""
    profile = load_skeleton()
    names = tuple(joint.name for joint in profile.joints)
    offsets = []
    for name in names:
        offset = np.array(
            OFFSETS_M.get(name.replace("right", "left"), (0.0, 0.0, 0.0) if name == "root" else (0.03, 0, 0))
        )
        offsets.append(offset * ([-1.0, 1.0, 1.0] if name.startswith("right") else 1.0))
    parents = tuple(names.index(joint.parent) if joint.parent else -1 for joint in profile.joints)
    return Skeleton(names, parents, np.array(offsets, dtype=np.float64))


def character() -> Character:
    """A body without skin."""
    bones = skeleton()
    return Character("figure", bones, np.tile(np.eye(4), (len(bones.names), 1, 1)), (), {})


def _hand_rotation(side: str, fingers: tuple[float, float, float], palm: tuple[float, float, float]) -> np.ndarray:
    """Rotation of a hand whose fingers (+-X at rest) and palm (-Y at rest) point in given directions."""
    along = np.array(fingers) * (1.0 if side == "left" else -1.0)
    return quaternion.from_frames(along / np.linalg.norm(along), -np.array(palm))


def _finger(bones: Skeleton, side: str, finger: str, control: str | None) -> FingerTable:
    joints = tuple(bones.index(f"{side}{finger}{part}") for part in ("Proximal", "Intermediate", "Distal"))
    values = np.linspace(0.0, 1.0, 5) if control else np.zeros(1)
    bend = np.zeros((len(values), 3, 3))
    bend[..., 2] = (0.5 + 0.3 * values)[:, None] * (-1.0 if side == "left" else 1.0)
    station = StationTable((control,) if control else (), False, values, quaternion.from_rotation_vector(bend))
    return FingerTable(f"{side}.{finger.lower()}", joints, (station,))


def hold(bones: Skeleton, slide_m: float = 0.0, sliding: str = "right") -> GripPose:
    """Grip with both hands 20 cm in front of the lips; with ``slide_m`` the ``sliding`` hand moves out by it with a
    slide.
    """
    slide = None
    if slide_m:
        slide = NodeMotion("slide", np.array([0.0, 0.0, slide_m]), np.array([0.0, 0.0, 1.0]), 0.0, np.zeros(3))
    tables = {"left": (_finger(bones, "left", "Index", None),), "right": (_finger(bones, "right", "Index", "valve_1"),)}
    hands = []
    for side, sign in (("left", 1.0), ("right", -1.0)):
        moving = slide if side == sliding else None
        hands.append(
            HandHold(
                side=side,
                node="slide" if moving else "root",
                motion=moving,
                instrument_from_hand_m=np.array([sign * 0.06, -0.07, 0.11]),
                instrument_from_hand_rotation=_hand_rotation(side, (0.0, 0.0, 1.0), (-sign, 0.0, 0.0)),
                fingers=tables[side],
                elbow_direction=np.array([sign * 0.6, -0.8, 0.0]),
                contacts=(),
                penetration_m=0.0,
            )
        )
    lips = Lips(
        np.array([0.0, -0.035, 0.115]),
        {"jawOpen": np.array([0.0, -0.015, -0.002]), "mouthPucker": np.array([0.0, 0.0, 0.004])},
        {"mouthPucker": np.array([0.0, 0.0, 0.004])},
        np.array([0.0, -0.035, 0.115]),
    )
    return GripPose("figure", "thing", tuple(hands), lips)


def instrument_map(*controls: maps.Control) -> InstrumentMap:
    """Map with these controls and a usual carriage."""
    carriage = holding.Carriage((-10.0, 10.0, 40.0), (-5.0, 0.0, 5.0), (-10.0, 0.0, 10.0))
    lowered = holding.LoweredPlace((0.0, -0.30, 0.05), 40.0, 10.0, 0.0)
    return InstrumentMap(
        schema_version=1,
        id="thing",
        name=maps.InstrumentName("thing", "thing"),
        short_name="thing",
        plays=(),
        transposition_semitones=0,
        range=maps.Range(40, 80, 45, 75),
        model="thing.glb",
        embouchure=wind.Embouchure("cup"),
        mouthpiece=wind.Mouthpiece((0, 0, 0), (0, 0, 1), (0, 1, 0), 0.008, 0.013),
        controls=controls,
        contacts=(),
        hands=(),
        proxy=(),
        hold=holding.Hold("left", carriage, carriage, lowered, lowered),
        fingerings=(),
    )
