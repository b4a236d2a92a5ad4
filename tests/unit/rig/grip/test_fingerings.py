"""Every fingering of every bundled map in the grip of every bundled body: the poses used in motion, contacts in place,
open holes open, and no hand inside the instrument.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import pytest

from app.contacts.bounds import CLEAR_MM, bound_mm
from app.rig import quaternion, skinning
from app.rig.characters.character_library import bundled_characters, character_named
from app.rig.grip import instrument_proxy
from app.rig.grip.finger_poses import finger_rotations
from app.rig.grip.finger_stations import aside_m, asked_together, only_at, stations, stations_of_notes, worked_by
from app.rig.grip.fitting.grip_files import hold_for
from app.rig.grip.grip_pose import FingerTable, GripPose, HandHold, StationBlend, giving_for, hand_targets, wrist_given
from app.rig.instrument import node_transforms
from app.rig.model import Character, InstrumentModel
from app.rig.skeleton import JointTransforms, forward
from instrument_maps.hold import Contact
from instrument_maps.load import bundled_maps
from instrument_maps.model import InstrumentMap
from metadata.load import load_body
from tests.support.deformed import deform
from tests.support.models import bundled_instrument

WAITS_MM, WAY_MM = 3.0, 4.0
"""Greatest depth in millimetres in the instrument of a waiting finger, as for the whole hand, and of a moving one,
which passes in a few hundredths of a second.
"""
THROWN_DEG = 40.0
"""Greatest rotation in degrees of a joint in a hundredth of its move."""
STILL_DEEPER_MM = {("woman_adult", "clarinet_A"): 5.5}
"""Moves to side keys that intersect the instrument at any tried height, with their depth in millimetres."""

PAIRS = [(character, instrument) for character in bundled_characters() for instrument in bundled_maps()]


@dataclass(frozen=True)
class Fingered:
    """A body in all fingerings of a map, one per frame."""

    character: Character
    instrument: InstrumentMap
    model: InstrumentModel
    hold: GripPose
    labels: list[str]
    working: dict[str, np.ndarray]
    controls: dict[str, np.ndarray]
    placed: dict[str, StationBlend]

    def __len__(self) -> int:
        return len(self.labels)

    def posed(self, raised: float = 0.0) -> JointTransforms:
        rotations = np.tile(quaternion.IDENTITY, (len(self), len(self.character.skeleton.names), 1))
        fingers = finger_rotations(self.hold, self.controls, len(self), self.placed, raised)
        rotations[:, list(self.hold.finger_joints)] = fingers
        return forward(self.character.skeleton, rotations)

    @cached_property
    def playing(self) -> JointTransforms:
        return self.posed()

    def on_instrument(self, hand: HandHold, joints: JointTransforms, points: np.ndarray) -> np.ndarray:
        """Points (F, V, 3) of the body in the instrument's frame."""
        wrist, _ = joints.of(self.character.skeleton.index(f"{hand.side}Hand"))
        still, unturned = np.zeros((len(self), 3)), np.tile(quaternion.IDENTITY, (len(self), 1))
        place, turn = hand_targets(hand, still, unturned, self.controls, self.placed)
        return place[:, None] + quaternion.rotate(turn[:, None], points - wrist[:, None])

    def points_m(self, contact: Contact) -> np.ndarray:
        """Positions (F, 3) of a contact of the map in metres."""
        place, turn = node_transforms(self.model, self.instrument, self.controls, len(self))
        node = self.model.node_names.index(contact.node)
        aside = aside_m(contact, self.instrument, self.controls.get(contact.control or "", np.ones(len(self))))
        return place[:, node] + quaternion.rotate(turn[:, node], np.asarray(contact.position_m) + aside)

    def counts(self, index: int) -> np.ndarray:
        """Mask (F,) of the fingerings in which a contact must be kept."""
        contact, place = self.instrument.contacts[index], only_at(self.instrument)[index]
        if place is not None:
            return self.working[place[0]] == place[1]
        if contact.control is None or contact.when == "always":
            return np.ones(len(self), dtype=np.bool_)
        rest = self.controls[contact.control] == self.instrument.control(contact.control).rest_value
        return rest == (contact.when == "released")


@pytest.fixture(scope="module", params=PAIRS, ids="-".join)
def fingered(request: pytest.FixtureRequest) -> Fingered:
    character, instrument = character_named(request.param[0]), bundled_maps()[request.param[1]]
    model = bundled_instrument(instrument)
    kinds = {repr((sorted(one.controls.items()), sorted(one.fingers.items()))): one for one in instrument.fingerings}
    rows = list(kinds.values())
    working = stations_of_notes(instrument, ((row.controls, row.fingers) for row in rows))
    controls = {
        control.name: np.array([row.controls.get(control.name, control.rest_value) for row in rows])
        for control in instrument.controls
    }
    places = {finger: np.maximum(numbers, 0) for finger, numbers in working.items()}
    placed = {finger: StationBlend(place, place, np.zeros(len(rows))) for finger, place in places.items()}
    hold = hold_for(character, model, instrument, load_body())
    return Fingered(character, instrument, model, hold, [row.label for row in rows], working, controls, placed)


def test_every_contact_is_within_its_bound_in_every_fingering(fingered: Fingered) -> None:
    joints = fingered.playing
    for hand in fingered.hold.hands:
        for index, contact in enumerate(fingered.instrument.contacts):
            if not contact.part.startswith(f"{hand.side}."):
                continue
            skin = skinning.landmark_positions(fingered.character, [contact.part], joints)
            there = fingered.on_instrument(hand, joints, skin)[:, 0]
            gaps_mm = 1000.0 * np.linalg.norm(there - fingered.points_m(contact), axis=1)
            off = np.flatnonzero(fingered.counts(index) & (gaps_mm > bound_mm(contact)))
            reported = [(fingered.labels[k], round(float(gaps_mm[k]), 2)) for k in off]
            assert not reported, (contact.part, contact.control or contact.node)


def test_holes_are_left_open(fingered: Fingered) -> None:
    """Tested for every finger that could close them while it is used elsewhere or not at all."""
    joints = fingered.playing
    for hand in fingered.hold.hands:
        for contact in fingered.instrument.contacts:
            works = [fingered.instrument.control(name) for name in worked_by(contact, fingered.instrument)]
            bare = [control.name for control in works if control.motion is None]
            if not contact.part.startswith(f"{hand.side}.") or not bare:
                continue
            skin = skinning.landmark_positions(fingered.character, [contact.part], joints)
            gaps_mm = 1000.0 * np.linalg.norm(
                fingered.on_instrument(hand, joints, skin)[:, 0] - fingered.points_m(contact), axis=1
            )
            for name in bare:
                shut = np.flatnonzero((fingered.controls[name] == 0.0) & (gaps_mm <= CLEAR_MM))
                reported = [(fingered.labels[k], round(float(gaps_mm[k]), 2)) for k in shut]
                assert not reported, (contact.part, name)


def test_a_hand_that_gives_way_for_two_fingers_stays_outside(fingered: Fingered) -> None:
    hands = [hand for hand in fingered.hold.hands if any(lean.beside for lean in hand.leans)]
    joints = fingered.playing if hands else None
    bodies = instrument_proxy.bodies(fingered.instrument.proxy, fingered.model.node_names)
    nodes, turns = node_transforms(fingered.model, fingered.instrument, fingered.controls, len(fingered))
    for hand in hands:
        mark = fingered.character.landmarks[f"{hand.side}.hand"]
        mesh = skinning.mesh_named(fingered.character, mark.mesh)
        part = skinning.patch(fingered.character, mesh, mark.vertices)
        skin = fingered.on_instrument(hand, joints, deform(part, joints))
        for lean in hand.leans:
            at = np.all([fingered.working[finger] == place for finger, place in lean.places], axis=0)
            for frame in np.flatnonzero(at if lean.beside else at & False):
                placed = instrument_proxy.InstrumentNodes(nodes[frame], quaternion.to_matrix(turns[frame]))
                depth, _ = instrument_proxy.inside(bodies, placed, skin[frame], np.zeros(len(skin[frame])))
                assert depth.max() <= 0.003, (lean.places, fingered.labels[frame])


def test_a_hand_gives_way_for_two_fingers_only_where_a_fingering_asks_for_both(fingered: Fingered) -> None:
    asked = {frozenset(pair) for pair in asked_together(fingered.instrument)}
    for hand in fingered.hold.hands:
        for lean in hand.leans:
            assert all(0 < place < len(stations(fingered.instrument)[finger]) for finger, place in lean.places)
            if lean.beside:
                assert frozenset(lean.places) in asked
                assert all(finger.startswith(f"{hand.side}.") for finger, _ in lean.places)


def test_giving_way_for_two_grows_with_both(fingered: Fingered) -> None:
    for hand in fingered.hold.hands:
        for lean in (lean for lean in hand.leans if lean.beside):
            alone = replace(hand, leans=(lean,))
            still, unturned = np.zeros((3, 3)), np.tile(quaternion.IDENTITY, (3, 1))
            home = np.zeros(3)
            (first, a), (second, b) = lean.places
            placed = {
                first: StationBlend(home, np.full(3, a), np.array([0.0, 0.5, 1.0])),
                second: StationBlend(home, np.full(3, b), np.array([1.0, 0.5, 1.0])),
            }
            place, _ = hand_targets(alone, still, unturned, {}, placed)
            moved = place - wrist_given(hand, [])[0]
            np.testing.assert_allclose(moved, np.multiply.outer([0.0, 0.25, 1.0], lean.moved_m), atol=1e-12)


def test_fingers_keep_out_of_the_instrument_on_their_ways_and_where_they_wait(fingered: Fingered) -> None:
    """From home to every other station and back, waiting high or low, as long as the hand is not offset."""
    most_mm = STILL_DEEPER_MM.get((fingered.character.id, fingered.instrument.id), WAY_MM)
    shares = np.linspace(0.0, 1.0, 21)
    still = {one.name: np.full(len(shares), one.rest_value) for one in fingered.instrument.controls}
    bodies = instrument_proxy.bodies(fingered.instrument.proxy, fingered.model.node_names)
    nodes, turns = node_transforms(fingered.model, fingered.instrument, still, len(shares))
    at_rest = instrument_proxy.InstrumentNodes(nodes[0], quaternion.to_matrix(turns[0]))
    for hand in fingered.hold.hands:
        for table in hand.fingers:
            skin = _skin_of(fingered.character, hand, table)
            for place in range(1, len(table.stations)):
                home, there = np.zeros(len(shares)), np.full(len(shares), float(place))
                placed = {
                    table.finger: StationBlend(home, there, shares),
                    giving_for(table.finger): StationBlend(home, there, home),
                }
                on_way = replace(fingered, labels=[f"{share:.2f}" for share in shares], controls=still, placed=placed)
                for raised in (0.0, 1.0):
                    joints = on_way.posed(raised)
                    points = on_way.on_instrument(hand, joints, deform(skin, joints))
                    depth, _ = instrument_proxy.inside(
                        bodies, at_rest, points.reshape(-1, 3), np.zeros(points[..., 0].size)
                    )
                    deep_mm = 1000.0 * depth.reshape(points.shape[:2]).max(axis=1)
                    worst = int(np.argmax(deep_mm))
                    assert deep_mm[worst] <= most_mm, (table.finger, place, on_way.labels[worst], raised)
                    assert deep_mm[-1] <= WAITS_MM, (table.finger, place, raised)


def _skin_of(character: Character, hand: HandHold, table: FingerTable) -> skinning.Patch:
    """Return the patch of skin that moves mostly with a finger."""
    mark = character.landmarks[f"{hand.side}.hand"]
    mesh = skinning.mesh_named(character, mark.mesh)
    carried = np.isin(mesh.joints[mark.vertices], table.joints) * mesh.weights[mark.vertices]
    return skinning.patch(character, mesh, mark.vertices[carried.sum(axis=1) > 0.5])


def test_no_finger_is_thrown_about_on_its_way(fingered: Fingered) -> None:
    """A finger that cannot be raised as requested formerly jumped between the ends of its joints' ranges."""
    shares = np.linspace(0.0, 1.0, 121)
    still = {one.name: np.full(len(shares), one.rest_value) for one in fingered.instrument.controls}
    home = np.zeros(len(shares))
    for hand in fingered.hold.hands:
        for table in hand.fingers:
            columns = [fingered.hold.finger_joints.index(joint) for joint in table.joints]
            for place in range(1, len(table.stations)):
                there = np.full(len(shares), float(place))
                placed = {
                    table.finger: StationBlend(home, there, shares),
                    giving_for(table.finger): StationBlend(home, there, home),
                }
                found = finger_rotations(fingered.hold, still, len(shares), placed)[:, columns]
                steps = quaternion.multiply(quaternion.conjugate(found[:-1]), found[1:])
                most_deg = np.rad2deg(np.linalg.norm(quaternion.to_rotation_vector(steps), axis=-1)).max()
                assert most_deg < THROWN_DEG, (table.finger, place)
