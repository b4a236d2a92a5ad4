"""Adaptation of an instrument to one body: its size for hands and arms, and the contacts that the body can make."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import msgspec
import numpy as np

from app.arrays import FloatArray
from app.errors import Message
from app.rig import quaternion
from app.rig.characters.landmarks import JAW_MORPHS
from app.rig.grip.body_size import arm_m, arm_size, hand_size, sized_model
from app.rig.grip.carriage import Upright, upright
from app.rig.grip.fitting.grip_files import usual_wrists
from app.rig.grip.fitting.hand_problem import seed_turn
from app.rig.grip.fitting.touch_targets import travel
from app.rig.grip.lips import fit_lips
from app.rig.grip.visible_share import LEAST_IN_SIGHT, visible_share
from app.rig.instrument import load_instrument
from app.rig.model import Character, InstrumentModel
from app.rig.skeleton import forward, rest_positions
from app.rig.skinning import landmark_joints, landmark_positions, mesh_named
from instrument_maps.hold import Carriage, Contact, HandSeed
from instrument_maps.library import find_map, model_path
from instrument_maps.map_table import Hand
from instrument_maps.model import FINGERS, InstrumentMap
from instrument_maps.size import scaled
from metadata.load import load_body, load_skeleton
from metadata.model import Body

REACH_SHARE, CARRIED_SHARE = 0.95, 1.70
"""Greatest distance of a wrist from its shoulder relative to the arm's length; second value for a hand on a slide,
helped by shoulders and trunk. About the need of adults.
"""
MOST_ASKED = (1.05, 1.2)
"""Shares of those distances that an arm of usual length may be asked for; beyond, the mouth is too far from the
shoulder, as in a head wider than the trunk. Bodies of usual proportions need at most 0.9, with a slide 1.15.
"""
LEAST_IN_HANDS = 0.7
"""Least size of an instrument in hands of usual size, relative to theirs: a smaller one disappears in them."""
LOWERED, WORTH = (0.0, 0.5, 1.0, -0.5), 0.02
"""Shares of the way to the lowest carriage that are tried, and the least gain in size for one other than the
default.
"""
SAME = (0.95, 1.06)
"""Sizes of hands and arms relative to an adult's that use the adult's instrument."""
IN_SIGHT_STEP = 0.1
"""Step between sizes tried for hands so thick that they hide a smaller instrument."""
STEP = 0.01
"""Step between tried sizes of an instrument."""
BENDS = 0.5
"""Weight of the skin above which it moves with a finger, so that the finger counts as existing."""


class FittedInstrument(NamedTuple):
    """An instrument's map adapted to a body, and notes for the user about that."""

    instrument: InstrumentMap
    reported: tuple[Message, ...]


def fitted_to_body(
    character: Character, instrument: InstrumentMap, body: Body, model: Callable[[], InstrumentModel]
) -> FittedInstrument:
    """Fit an instrument to a body. An adult body with all parts gets the map unchanged.

    Parameters
    ----------
    model : callable
        Loads the map's model; called only if a hand's place on it is not known from an adult's grip.
    """
    held, reported = _touched(character, instrument)
    reached = _carried(character, held, body, model)
    held = _in_sight(character, reached, body, model)
    if held is not reached:
        sizes = {"percent": round(100.0 * held.size), "smaller": round(100.0 * reached.size)}
        reported = (Message("character.instrument_in_sight", {**sizes}), *reported)
    elif held.size != 1.0:
        reported = (Message("character.instrument_size", {"percent": round(100.0 * held.size)}), *reported)
    return FittedInstrument(held, reported)


def notes_on_body(character: Character) -> tuple[Message, ...]:
    """Return notes about a character's body that are independent of the instrument, found with a reference
    instrument."""
    body = load_body()
    instrument = find_map(body.checked_with)
    return fitted_to_body(
        character, instrument, body, lambda: load_instrument(model_path(instrument), instrument)
    ).reported


def _touched(character: Character, instrument: InstrumentMap) -> tuple[InstrumentMap, tuple[Message, ...]]:
    """Return the instrument's map with only those contacts that are possible for the body, and notes about the
    others."""
    reported = []
    contacts, hands = instrument.contacts, instrument.hands
    for side in dict.fromkeys(seed.hand for seed in instrument.hands):
        if not {f"{side}.hand", f"{side}.palm"} <= character.landmarks.keys():
            contacts = tuple(contact for contact in contacts if not contact.part.startswith(f"{side}."))
            hands = tuple(seed for seed in hands if seed.hand != side)
            reported.append(Message("character.no_hand", {"side": side}))
            continue
        stiff = frozenset(finger for finger in FINGERS if not bends(character, side, finger))
        if stiff and any(_of(contact, side) in stiff for contact in contacts):
            contacts = _guided(contacts, side, stiff)
            reported.append(_stiff(side, stiff))
    if "lips.contact" not in character.landmarks:
        reported.append(Message("character.no_lips", {}))
    elif not mouth_opens(character):
        reported.append(Message("character.lips_still", {}))
    if contacts is instrument.contacts and hands is instrument.hands:
        return instrument, tuple(reported)
    return msgspec.structs.replace(instrument, contacts=contacts, hands=hands), tuple(reported)


def _stiff(side: Hand, stiff: frozenset[str]) -> Message:
    """Return a warning about fingers that do not bend: all or some of a hand's."""
    if len(stiff) == len(FINGERS):
        return Message("character.no_fingers", {"side": side})
    lacking = [finger for finger in FINGERS if finger in stiff]
    return Message("character.some_fingers", {"side": side, "count": len(lacking), "fingers": " ".join(lacking)})


def _of(contact: Contact, side: str) -> str:
    """Return the name of the finger of a hand that a contact uses; empty if none."""
    hand, _, rest = contact.part.partition(".")
    return rest.partition(".")[0] if hand == side else ""


def _guided(contacts: tuple[Contact, ...], side: Hand, stiff: frozenset[str]) -> tuple[Contact, ...]:
    """Return the contacts with only one for each part of a finger in ``stiff``, which then merely guides the hand."""
    result: list[Contact] = []
    placed: set[str] = set()
    for contact in contacts:
        if _of(contact, side) not in stiff:
            result.append(contact)
        elif contact.part not in placed:
            placed.add(contact.part)
            result.append(msgspec.structs.replace(contact, control=None, together=(), when="always", grip="guide"))
    return tuple(result)


def bends(character: Character, side: Hand, finger: str) -> bool:
    """Return whether the skin of a fingertip moves with the finger."""
    mark = character.landmarks.get(f"{side}.{finger}.pad")
    if mark is None:
        return False
    joints = [character.skeleton.index(name) for name in load_skeleton().fingers[side][finger].joints]  # type: ignore[index]
    mesh = mesh_named(character, mark.mesh)
    own = np.isin(mesh.joints[mark.vertices], joints)
    return float((mesh.weights[mark.vertices] * own).sum(axis=1).mean()) > BENDS


def mouth_opens(character: Character) -> bool:
    """Return whether a character has a mouth with a morph that opens it."""
    if "lips.contact" not in character.landmarks:
        return False
    mesh = mesh_named(character, character.landmarks["lips.contact"].mesh)
    return any(morph.name in JAW_MORPHS for morph in mesh.morphs)


def _carried(
    character: Character, instrument: InstrumentMap, body: Body, model: Callable[[], InstrumentModel]
) -> InstrumentMap:
    """Return the instrument's map with its size as near to 1 as hands and arms allow, with a lower carriage if that
    permits a larger size; if short arms do not reach at any size, with the best one.

    Arms of usual length get a smaller instrument only if the mouth is so far from them that they need it, and reach it
    then: hands beside a larger one at least leave it in sight.
    """
    low, high = instrument.hold.size_range
    hands = _hands(character)
    requested = 1.0 if SAME[0] < hands < SAME[1] else round(min(max(hands, low), high), 2)
    mouth, most = fit_lips(character, instrument, body), dict.fromkeys(instrument.hands, 1.0)
    long = min((arm_size(character.skeleton, seed.hand) for seed in instrument.hands), default=1.0) > SAME[0]
    if long:
        slides = {control.node for control in instrument.controls}
        most = {seed: MOST_ASKED[seed.node in slides] for seed in instrument.hands}
        low = max(low, round(LEAST_IN_HANDS * requested, 2))

    def asked_of(moved: InstrumentMap, sizes: FloatArray) -> FloatArray:
        stand = upright(character, moved, body, mouth)
        shares = [_asked(character, moved, model, seed, stand, sizes) / most[seed] for seed in instrument.hands]
        return np.asarray(np.max(shares, axis=0))

    if long and (not instrument.hands or float(asked_of(instrument, np.array([requested]))[0]) <= 1.0):
        return scaled(instrument, requested)
    sizes = np.append(np.arange(requested, low, -STEP), low)
    best, found = (-np.inf, 0.0), instrument
    for share in LOWERED:
        moved = _lowered(instrument, share)
        asked = asked_of(moved, sizes)
        reached = np.flatnonzero(asked <= 1.0)
        row = reached[0] if len(reached) else int(asked.argmin())
        judged = (-max(float(asked[row]), 1.0), float(sizes[row]))
        if judged > (best[0] + WORTH, best[1]) or (judged[0] >= best[0] and judged[1] > best[1] + WORTH):
            best, found = judged, moved
    if long and best[0] < -1.0:
        return scaled(instrument, requested)
    return scaled(found, round(best[1], 2))


def _in_sight(
    character: Character, instrument: InstrumentMap, body: Body, model: Callable[[], InstrumentModel]
) -> InstrumentMap:
    """Return the instrument's map, larger if hands that do not bend would hide most of it: as small as leaves enough in
    sight, else of the size that leaves most.

    Arms may then be too short, which is reported; an instrument inside the hands is not seen at all.
    """
    sides = {seed.hand for seed in instrument.hands}
    if not any(not bends(character, side, finger) for side in sides for finger in FINGERS):
        return instrument
    whole, shape, lips = scaled(instrument, 1.0 / instrument.size), model(), fit_lips(character, instrument, body)
    places = {
        seed.hand: (*_palm_place(character, whole, model, seed), palm_middle_m(character, seed.hand))
        for seed in whole.hands
    }

    def seen(size: float) -> float:
        wrists = {
            side: (size * place_m - quaternion.rotate(turn, palm_m), turn)
            for side, (place_m, turn, palm_m) in places.items()
        }
        return visible_share(character, sized_model(shape, size), scaled(whole, size), body, lips, wrists, {}).least

    best, most = instrument.size, seen(instrument.size)
    for size in np.arange(instrument.size + IN_SIGHT_STEP, instrument.hold.size_range[1], IN_SIGHT_STEP):
        if most >= LEAST_IN_SIGHT:
            break
        share = seen(round(float(size), 2))
        if share > most:
            best, most = round(float(size), 2), share
    return instrument if best == instrument.size else scaled(whole, best)


def _hands(character: Character) -> float:
    """Return the size of the hands relative to an adult's. For hands that were added and are invisible, the size of the
    arms.
    """
    skeleton, own = character.skeleton, character.own
    if own is not None and any(
        own.bone_of_joint[skeleton.index(f"{side}MiddleDistal")] < 0 for side in ("left", "right")
    ):
        return min(arm_size(skeleton, "left"), arm_size(skeleton, "right"))
    return hand_size(skeleton)


def _lowered(instrument: InstrumentMap, share: float) -> InstrumentMap:
    """Return the instrument's map with its default carriage lowered (bell down) by a share of its range."""

    def lower(carriage: Carriage | None) -> Carriage | None:
        if carriage is None:
            return None
        highest, usual, lowest = carriage.pitch_down_deg
        return msgspec.structs.replace(carriage, pitch_down_deg=(highest, usual + share * (lowest - usual), lowest))

    if share == 0.0:
        return instrument
    grip = instrument.hold
    grip = msgspec.structs.replace(grip, standing=lower(grip.standing), seated=lower(grip.seated))
    return msgspec.structs.replace(instrument, hold=grip)


def _asked(
    character: Character,
    instrument: InstrumentMap,
    model: Callable[[], InstrumentModel],
    seed: HandSeed,
    stand: Upright,
    sizes: FloatArray,
) -> FloatArray:
    """Return for S sizes of the instrument (S,) the distance that an arm must reach relative to its length; beyond 1 it
    cannot.

    The palm is placed as in a bundled grip of an adult, else as the map suggests (``seed``).
    """
    skeleton, side = character.skeleton, seed.hand
    rim_m = np.asarray(instrument.mouthpiece.position_m)
    mouth_m = stand.instrument_m + quaternion.rotate(stand.instrument_rotation, rim_m)
    back = quaternion.conjugate(stand.instrument_rotation)
    shoulder_m = quaternion.rotate(back, stand.joints_m[skeleton.index(f"{side}UpperArm")] - mouth_m)
    palm_m = palm_middle_m(character, side)
    place_m, turn = _palm_place(character, instrument, model, seed)
    carrier = next((control for control in instrument.controls if control.node == seed.node), None)
    ways_m = np.zeros((2, 3)) if carrier is None else np.stack([np.zeros(3), travel(carrier)])
    asked = np.zeros(len(sizes))
    for way_m, share in zip(ways_m, (REACH_SHARE, CARRIED_SHARE), strict=True):
        wrists_m = np.multiply.outer(sizes, place_m - rim_m + way_m) - quaternion.rotate(turn, palm_m)
        asked = np.maximum(asked, np.linalg.norm(wrists_m - shoulder_m, axis=1) / (share * arm_m(skeleton, side)))
    return asked


def _palm_place(
    character: Character, instrument: InstrumentMap, model: Callable[[], InstrumentModel], seed: HandSeed
) -> tuple[FloatArray, FloatArray]:
    """Return the middle (3,) of a palm on an instrument of the usual size, and the rotation (4,) of its wrist."""
    known = usual_wrists(instrument.id).get(seed.hand)
    if known is None:
        nodes = model()
        return (
            nodes.node_positions_m[nodes.node_names.index(seed.node)] + seed.palm_position_m,
            seed_turn(seed),
        )
    wrist_m, turn = known
    palm_m = palm_middle_m(character, seed.hand)
    return wrist_m + quaternion.rotate(turn, palm_m / _hands(character)), turn


def palm_middle_m(character: Character, side: Hand) -> FloatArray:
    """Return the middle (3,) of the palm's skin in the wrist's frame at rest."""
    skeleton = character.skeleton
    name = f"{side}.palm"
    still = forward(
        skeleton, np.tile(quaternion.IDENTITY, (1, len(skeleton.names), 1)), joints=landmark_joints(character, (name,))
    )
    palm_m: FloatArray = landmark_positions(character, (name,), still)[0, 0]
    palm_m -= rest_positions(skeleton)[skeleton.index(f"{side}Hand")]
    return palm_m
