"""An instrument suited to a body: its size, the touches within the body's reach, and the reported ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.arrays import BoolArray
from app.messages import text
from app.motion.contacts.help_for_far_hands import forwards_axis
from app.performance.bodies import model_of, suited_to
from app.plan.parameters import PlayerParameters
from app.project.casting import StagePosition
from app.project.performers import Player
from app.rig.characters.character_library import bundled_characters, character_named, our_characters
from app.rig.characters.landmarks import found_landmarks
from app.rig.grip.body_size import sized_body, sized_character, sized_model
from app.rig.grip.fitting.fitted_instrument import FittedInstrument, fitted_to_body
from app.rig.mesh import Mesh
from app.rig.model import Character
from app.rig.people.bundled_people import hands_id
from app.rig.skeleton import forward
from app.rig.skinning import landmark_positions
from instrument_maps.load import bundled_maps
from instrument_maps.size import scaled
from metadata.load import load_body
from tests.support.bodies import BODIES, Proportions, odd_body, of_proportions
from tests.support.models import bundled_instrument

MAPS = bundled_maps()


def suit(character: Character, instrument_id: str) -> FittedInstrument:
    instrument = MAPS[instrument_id]
    return fitted_to_body(character, instrument, load_body(), lambda: bundled_instrument(instrument))


def reported(found: FittedInstrument) -> list[str]:
    return [message.id for message in found.reported]


@pytest.mark.parametrize("id", [id for id in our_characters() if hands_id(id) in bundled_characters()])
def test_a_grown_up_plays_the_very_instruments(id: str) -> None:
    character = character_named(id)
    found = {name: suit(character, name) for name in MAPS}
    assert found == {name: FittedInstrument(whole, ()) for name, whole in MAPS.items()}
    assert all(found[name].instrument is whole for name, whole in MAPS.items())


@pytest.mark.parametrize("id", [id for id in our_characters() if hands_id(id) not in bundled_characters()])
def test_a_child_of_ours_plays_instruments_in_their_size_with_all_touches(id: str) -> None:
    """Foreign characters with such hands get smaller instruments; bundled children use the size of a school band's
    instruments.
    """
    player = Player("p", "P", "p", "", id, PlayerParameters(), StagePosition(0.0, 0.0, 0.0))
    for whole in MAPS.values():
        found = suited_to(player, whole)
        assert found.reported == ()
        assert found.instrument.size == 1.0
        assert found.instrument.contacts is whole.contacts
        assert found.instrument.hands is whole.hands
        assert model_of(found.instrument) is model_of(whole)
    assert 0.8 < suit(character_named(id), "trumpet_Bb").instrument.size < 0.95


@pytest.mark.parametrize("instrument_id", ["trumpet_Bb", "flute", "trombone_tenor_F_attachment", "clarinet_Bb"])
def test_a_child_plays_a_smaller_one(instrument_id: str) -> None:
    whole, found = MAPS[instrument_id], suit(odd_body("child"), instrument_id)
    size = found.instrument.size
    assert 0.5 <= size < 0.8
    assert found.reported[0].id == "character.instrument_size"
    assert found.reported[0].arguments == {"percent": round(100 * size)}
    for small, large in zip(found.instrument.contacts, whole.contacts, strict=True):
        assert small.position_m == pytest.approx(tuple(size * x for x in large.position_m))
        assert (small.part, small.normal, small.control) == (large.part, large.normal, large.control)
    for control, usual in zip(found.instrument.controls, whole.controls, strict=True):
        assert control.travel_m == pytest.approx(size * usual.travel_m)
        assert control.move_window_s == usual.move_window_s
    assert found.instrument.fingerings is whole.fingerings


@pytest.mark.parametrize(
    ("head", "neck", "least", "most"), [(1.8, 1.0, 1.0, 1.0), (3.2, 1.0, 0.7, 0.85), (3.2, 1.6, 1.0, 1.0)]
)
def test_a_head_so_large_that_usual_arms_do_not_reach_the_mouth_gets_a_smaller_one_if_that_helps(
    head: float, neck: float, least: float, most: float
) -> None:
    body = of_proportions(character_named("man_adult"), Proportions(head=head, neck=neck), "head")
    assert least <= suit(body, "trumpet_Bb").instrument.size <= most


def test_the_map_says_how_small_its_instrument_may_be() -> None:
    import msgspec

    whole = MAPS["trumpet_Bb"]
    narrow = msgspec.structs.replace(whole, hold=msgspec.structs.replace(whole.hold, size_range=(0.9, 1.0)))
    found = fitted_to_body(odd_body("child"), narrow, load_body(), lambda: bundled_instrument(whole))
    assert found.instrument.size == 0.9


def test_twice_scaled_is_scaled_once() -> None:
    whole = MAPS["trombone_tenor_F_attachment"]
    back = scaled(scaled(whole, 0.5), 2.0)
    assert back == whole
    assert scaled(whole, 1.0) is whole


def test_fingers_that_do_not_bend_guide_the_hand() -> None:
    found = suit(odd_body("mitten"), "flute")
    assert reported(found) == ["character.no_fingers", "character.no_fingers"]
    fingers = [contact for contact in found.instrument.contacts if ".palm" not in contact.part]
    assert {contact.grip for contact in fingers} == {"guide"}
    assert len({contact.part for contact in fingers}) == len(fingers)
    assert all(contact.control is None for contact in fingers)
    assert found.instrument.controls is MAPS["flute"].controls


def test_mittens_that_would_hide_an_instrument_get_a_larger_one() -> None:
    usual = odd_body("mitten")
    body = of_proportions(usual, Proportions(arm=0.5, hand=1.2, thick=3.5), "thick")
    found = suit(
        replace(body, landmarks=found_landmarks(body.skeleton, body.joint_from_mesh, body.meshes)), "clarinet_Bb"
    )
    size = found.reported[0].arguments
    assert found.reported[0].id == "character.instrument_in_sight"
    assert size["percent"] == round(100 * found.instrument.size) >= 90
    assert 60 <= size["smaller"] <= 75


def test_a_hand_of_four_fingers_is_said_to_lack_one_and_keeps_the_others() -> None:
    whole = odd_body("unmarked")
    names, table = whole.skeleton.names, np.arange(len(whole.skeleton.names), dtype=np.int32)
    for joint, name in enumerate(names):
        if "Little" in name:
            table[joint] = names.index(f"{name.partition('Little')[0]}Hand")
    meshes = tuple(replace(mesh, joints=table[mesh.joints]) for mesh in whole.meshes)
    body = replace(whole, meshes=meshes)
    body = replace(body, landmarks=found_landmarks(body.skeleton, body.joint_from_mesh, meshes))
    found = suit(body, "flute")
    assert reported(found) == ["character.some_fingers", "character.some_fingers"]
    assert "little finger" in text(found.reported[0])
    grips = {contact.part: contact.grip for contact in found.instrument.contacts}
    assert all((grip == "guide") == (".little." in part) for part, grip in grips.items() if ".palm" not in part)


def test_fingertips_in_another_mesh_than_the_hand_bend() -> None:
    """In fingerless gloves, the tips belong to the body's mesh and the rest to the clothes'."""
    whole = odd_body("unmarked")
    body = next(mesh for mesh in whole.meshes if (mesh.name == whole.landmarks["left.hand"].mesh))
    distal = [joint for joint, name in enumerate(whole.skeleton.names) if name.endswith("Distal")]
    of_tip = np.where(np.isin(body.joints, distal), body.weights, 0.0).sum(axis=1) > 0.3
    tips, rest = of_tip[body.triangles].all(axis=1), ~of_tip[body.triangles].any(axis=1)
    split = [_part(body, name, rows) for name, rows in (("glove", rest), ("tips", tips))]
    meshes = (*(mesh for mesh in whole.meshes if mesh is not body), *split)
    marks = found_landmarks(whole.skeleton, whole.joint_from_mesh, meshes)
    assert {marks[f"left.{finger}.pad"].mesh for finger in ("index", "middle", "ring", "little")} == {"tips"}
    assert marks["left.palm"].mesh == "glove"
    assert reported(suit(replace(whole, meshes=meshes, landmarks=marks), "trumpet_Bb")) == []


def _part(mesh: Mesh, name: str, rows: BoolArray) -> Mesh:
    """Some triangles of a mesh with their vertices."""
    used = np.unique(mesh.triangles[rows])
    place = np.zeros(len(mesh.positions_m), np.int32)
    place[used] = np.arange(len(used))
    moved = {morph.name: np.isin(morph.vertices, used) for morph in mesh.morphs}
    return replace(
        mesh,
        name=name,
        positions_m=mesh.positions_m[used],
        normals=mesh.normals[used],
        uvs=mesh.uvs[used],
        triangles=place[mesh.triangles[rows]],
        triangle_materials=mesh.triangle_materials[rows],
        joints=mesh.joints[used],
        weights=mesh.weights[used],
        morphs=tuple(
            replace(
                morph,
                vertices=place[morph.vertices[moved[morph.name]]],
                deltas_m=morph.deltas_m[moved[morph.name]],
                normal_deltas=None,
            )
            for morph in mesh.morphs
        ),
    )


def test_what_a_body_lacks_is_reported_and_nothing_raises() -> None:
    assert reported(suit(odd_body("still_face"), "trumpet_Bb")) == ["character.lips_still"]
    whole = odd_body("unmarked")
    assert suit(whole, "trumpet_Bb").reported == ()
    no_lips = replace(whole, landmarks={k: v for k, v in whole.landmarks.items() if "lips" not in k})
    assert reported(suit(no_lips, "clarinet_Bb")) == ["character.no_lips"]
    one_hand = replace(whole, landmarks={k: v for k, v in whole.landmarks.items() if not k.startswith("left")})
    found = suit(one_hand, "clarinet_Bb")
    assert reported(found) == ["character.no_hand"]
    assert {seed.hand for seed in found.instrument.hands} == {"right"}
    assert all(contact.part.startswith("right.") for contact in found.instrument.contacts)


@pytest.mark.parametrize("id", BODIES)
def test_every_body_has_all_places_that_instruments_touch(id: str) -> None:
    body = odd_body(id)
    needed = {contact.part for instrument in MAPS.values() for contact in instrument.contacts}
    assert needed | {"left.hand", "right.hand", "lips.contact", "lips.upper", "lips.lower"} <= set(body.landmarks)
    found = found_landmarks(body.skeleton, body.joint_from_mesh, body.meshes)
    assert set(found) >= needed


def test_a_still_face_has_its_mouth_where_it_would_open() -> None:
    for id in ("child", "big_head", "unmarked", "eyeless"):
        named = odd_body(id)
        still = replace(named, meshes=tuple(replace(mesh, morphs=()) for mesh in named.meshes))
        found = replace(still, landmarks=found_landmarks(still.skeleton, still.joint_from_mesh, still.meshes))
        rest = forward(still.skeleton, np.tile([0.0, 0.0, 0.0, 1.0], (1, len(still.skeleton.names), 1)))
        mouth = ["lips.contact"]
        off = landmark_positions(found, mouth, rest) - landmark_positions(named, mouth, rest)
        assert np.linalg.norm(off) < 0.007, id


def test_a_shoulder_without_a_clavicle_moves_no_one_anywhere() -> None:
    body = odd_body("unmarked")
    offsets_m = body.skeleton.offsets_m.copy()
    for side in ("left", "right"):
        shoulder, arm = (body.skeleton.index(f"{side}{part}") for part in ("Shoulder", "UpperArm"))
        offsets_m[shoulder] += offsets_m[arm]
        offsets_m[arm] = 0.0
    skeleton = replace(body.skeleton, offsets_m=offsets_m)
    for side, sign in (("left", -1.0), ("right", 1.0)):
        np.testing.assert_array_equal(forwards_axis(skeleton, side), [0.0, sign, 0.0])
        usual = forwards_axis(body.skeleton, side)
        assert usual @ np.array([0.0, sign, 0.0]) > 0.9


def test_a_body_sized_as_a_whole_keeps_its_shape() -> None:
    body = odd_body("child")
    large = sized_character(body, 2.0)
    marks = sorted(name for name in body.landmarks if "pad" in name)
    poses = [
        forward(one.skeleton, np.tile([0.0, 0.0, 0.0, 1.0], (1, len(one.skeleton.names), 1))) for one in (body, large)
    ]
    small_m, large_m = (landmark_positions(one, marks, pose) for one, pose in zip((body, large), poses, strict=True))
    np.testing.assert_allclose(large_m, 2.0 * small_m, atol=1e-6)
    model = bundled_instrument(MAPS["flute"])
    assert sized_model(model, 1.0) is model
    sway = load_body().sway
    assert sized_body(load_body(), 0.5).sway.bob_m == tuple(0.5 * part for part in sway.bob_m)
    assert sized_body(load_body(), 0.5).sway.side_deg == sway.side_deg
