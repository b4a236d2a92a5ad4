"""The instrument as one body plays it: of the size that its hands and arms ask for, touched by what the body has.

Messages, what an animator should know of a character with an instrument:

character.instrument_size : percent
    "plays an instrument of {percent} % ..."
character.no_fingers : side
    "the {side} hand has no fingers that bend: ..."
character.no_hand : side
    "the {side} hand has no skin: ..."
character.no_lips
    "there is no mouth ..."
character.lips_still
    "the mouth does not open ..."
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import msgspec
import numpy as np
import numpy.typing as npt

from app.errors import Message
from app.rig import quaternion
from app.rig.carriage import Upright, upright
from app.rig.grip_problem import seed_turn, travel
from app.rig.landmarks import JAW_MORPHS
from app.rig.lips import fit_lips
from app.rig.model import Character, InstrumentModel
from app.rig.skeleton import forward, rest_positions
from app.rig.skinning import landmark_joints, landmark_positions, mesh_named
from app.rig.stature import arm_m, arm_size, hand_size
from instrument_maps.model import FINGERS, Contact, Hand, HandSeed, InstrumentMap
from instrument_maps.size import scaled
from metadata.load import load_skeleton
from metadata.model import Body

FloatArray = npt.NDArray[np.float64]

REACH_SHARE, CARRIED_SHARE = 1.10, 1.70
"""A palm at its seed is at most so far from the shoulder, as a multiple of the arm: the hand will lie nearer, and on a
slide, far out, shoulders and trunk help. What the instruments ask of our own grown-ups, about."""
STEP = 0.01
"""Sizes are looked at so far apart."""
BENDS = 0.5
"""A finger is one of its own where its skin goes along with it by this weight."""


class Suited(NamedTuple):
    """An instrument as one body plays it, and what is to be told of that."""

    instrument: InstrumentMap
    told: tuple[Message, ...]


def suited(character: Character, instrument: InstrumentMap, body: Body, model: Callable[[], InstrumentModel]) -> Suited:
    """Suit an instrument to a body. One that lacks nothing and is of a grown-up's size gets the very map.

    Parameters
    ----------
    character : Character
    instrument : InstrumentMap
    body : Body
    model : callable
        Loads the map's model; asked only where arms are short.
    """
    held, told = _touched(character, instrument)
    size = _size(character, held, body, model)
    if size != 1.0:
        held = scaled(held, size)
        told = (Message("character.instrument_size", {"percent": round(100.0 * size)}), *told)
    return Suited(held, told)


def _touched(character: Character, instrument: InstrumentMap) -> tuple[InstrumentMap, tuple[Message, ...]]:
    """The map with those contacts that the body can have, and what it has not."""
    told = []
    contacts, hands = instrument.contacts, instrument.hands
    for side in dict.fromkeys(seed.hand for seed in instrument.hands):
        if not {f"{side}.hand", f"{side}.palm"} <= character.landmarks.keys():
            contacts = tuple(contact for contact in contacts if not contact.part.startswith(f"{side}."))
            hands = tuple(seed for seed in hands if seed.hand != side)
            told.append(Message("character.no_hand", {"side": side}))
            continue
        stiff = frozenset(finger for finger in FINGERS if not _bends(character, side, finger))
        if stiff and any(_of(contact, side) in stiff for contact in contacts):
            contacts = _guided(contacts, side, stiff)
            told.append(Message("character.no_fingers", {"side": side}))
    if "lips.contact" not in character.landmarks:
        told.append(Message("character.no_lips", {}))
    elif not _mouth_opens(character):
        told.append(Message("character.lips_still", {}))
    if contacts is instrument.contacts and hands is instrument.hands:
        return instrument, tuple(told)
    return msgspec.structs.replace(instrument, contacts=contacts, hands=hands), tuple(told)


def _of(contact: Contact, side: str) -> str:
    """Which finger of a hand a contact is with; empty where none."""
    hand, _, rest = contact.part.partition(".")
    return rest.partition(".")[0] if hand == side else ""


def _guided(contacts: tuple[Contact, ...], side: Hand, stiff: frozenset[str]) -> tuple[Contact, ...]:
    """Contacts with some fingers only guiding the hand: each to the first place that its parts have."""
    result: list[Contact] = []
    placed: set[str] = set()
    for contact in contacts:
        if _of(contact, side) not in stiff:
            result.append(contact)
        elif contact.part not in placed:
            placed.add(contact.part)
            result.append(msgspec.structs.replace(contact, control=None, together=(), when="always", grip="guide"))
    return tuple(result)


def _bends(character: Character, side: Hand, finger: str) -> bool:
    """Whether the skin of a finger's tip goes along with the finger."""
    mark = character.landmarks.get(f"{side}.{finger}.pad")
    if mark is None:
        return False
    joints = [character.skeleton.index(name) for name in load_skeleton().fingers[side][finger].joints]  # type: ignore[index]
    mesh = mesh_named(character, mark.mesh)
    own = np.isin(mesh.joints[mark.vertices], joints)
    return float((mesh.weights[mark.vertices] * own).sum(axis=1).mean()) > BENDS


def _mouth_opens(character: Character) -> bool:
    mesh = mesh_named(character, character.landmarks["lips.contact"].mesh)
    return any(morph.name in JAW_MORPHS for morph in mesh.morphs)


def _size(character: Character, instrument: InstrumentMap, body: Body, model: Callable[[], InstrumentModel]) -> float:
    """The size nearest to 1 at which hands of this size play and both arms reach; where they never do, the one at which
    they come nearest."""
    low, high = instrument.hold.size_range
    wanted = min(max(hand_size(character.skeleton), low), high)
    arms = [arm_size(character.skeleton, seed.hand) for seed in instrument.hands]
    if min(arms, default=1.0) < 1.0:
        sizes = np.append(np.arange(wanted, low, -STEP), low)
        stand = upright(character, instrument, body, fit_lips(character, instrument, body))
        asked = np.max(
            [_asked(character, instrument, model(), seed, stand, sizes) for seed in instrument.hands], axis=0
        )
        reached = np.flatnonzero(asked <= 1.0)
        wanted = float(sizes[reached[0] if len(reached) else int(asked.argmin())])
    return round(wanted, 2)


def _asked(
    character: Character,
    instrument: InstrumentMap,
    model: InstrumentModel,
    seed: HandSeed,
    stand: Upright,
    sizes: FloatArray,
) -> FloatArray:
    """How much of what an arm can do each size (S,) asks of it; where it is beyond 1 the hand is not reached."""
    skeleton = character.skeleton
    rim_m = np.asarray(instrument.mouthpiece.position_m)
    mouth_m = stand.instrument_m + quaternion.rotate(stand.instrument_rotation, rim_m)
    back = quaternion.conjugate(stand.instrument_rotation)
    shoulder_m = quaternion.rotate(back, stand.joints_m[skeleton.index(f"{seed.hand}UpperArm")] - mouth_m)
    place_m = model.node_positions_m[model.node_names.index(seed.node)] + seed.palm_position_m - rim_m
    carrier = next((control for control in instrument.controls if control.node == seed.node), None)
    asked = np.zeros(len(sizes))
    for way_m, share in (
        (np.zeros(3), REACH_SHARE),
        (np.zeros(3) if carrier is None else travel(carrier), CARRIED_SHARE),
    ):
        wrists_m = np.multiply.outer(sizes, place_m + way_m) - quaternion.rotate(
            seed_turn(seed), _palm_m(character, seed.hand)
        )
        far_m = np.linalg.norm(wrists_m - shoulder_m, axis=1)
        asked = np.maximum(asked, far_m / (share * arm_m(skeleton, seed.hand)))
    return asked


def _palm_m(character: Character, side: Hand) -> FloatArray:
    """The middle of the palm's skin in the wrist's frame at rest."""
    skeleton = character.skeleton
    name = f"{side}.palm"
    still = forward(
        skeleton, np.tile(quaternion.IDENTITY, (1, len(skeleton.names), 1)), joints=landmark_joints(character, (name,))
    )
    palm_m: FloatArray = landmark_positions(character, (name,), still)[0, 0]
    palm_m -= rest_positions(skeleton)[skeleton.index(f"{side}Hand")]
    return palm_m
