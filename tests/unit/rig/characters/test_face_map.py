"""ARKit's shapes from a face's own morphs: by names, by the file's expressions, and by the user's settings."""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.errors import FileError
from app.messages import WORDINGS
from app.motion.faces.morph_weights import usual_morphs
from app.rig.characters.face_map import map_morphs
from app.rig.characters.load_character import load_character
from app.rig.characters.read_figure import read_figure
from app.rig.grip.lips import fit_lips
from instrument_maps.load import bundled_maps
from metadata.known_names import FaceNames
from metadata.load import load_body, load_face_names
from metadata.model import ARKIT_MORPHS
from tests.support.skeletons import face_of

CHARACTERS = Path(__file__).parents[3] / "data" / "characters"


def words(shape: str) -> str:
    """Convert ``eyeBlinkLeft`` to ``Eye_Blink_Left``."""
    return "".join(f"_{letter}" if letter.isupper() else letter for letter in shape[0].upper() + shape[1:])[1:]


def short(shape: str) -> str:
    return shape.removesuffix("Left") + "_L" if shape.endswith("Left") else shape.replace("Right", "_R")


def explus(shape: str) -> str:
    """Names with Character Creator's numbers, which have no meaning."""
    return f"A{ARKIT_MORPHS.index(shape) + 1:02d}_{words(shape)}"


@pytest.mark.parametrize(
    "spelling",
    [
        str,
        str.lower,
        words,
        short,
        explus,
        lambda shape: f"Wolf3D_Head.{shape}",
        lambda shape: f"head_lod0_mesh__{shape}",
        lambda shape: f"Genesis8_1Female__facs_bs_{shape[0].upper()}{shape[1:]}_div2",
    ],
    ids=["arkit", "lower", "words", "short", "explus", "wolf3d", "prefixed", "daz"],
)
def test_arkit_shapes_are_known_in_every_spelling(spelling: Callable[[str], str]) -> None:
    mapping = map_morphs(face_of([spelling(shape) for shape in ARKIT_MORPHS]))
    assert mapping.morphs == {shape: {spelling(shape): 1.0} for shape in ARKIT_MORPHS}
    assert mapping.missing == ()
    assert mapping.profile == "arkit"


@pytest.mark.parametrize("table", load_face_names().values(), ids=lambda table: table.name)
def test_every_table_makes_all_its_shapes(table: FaceNames) -> None:
    ways = {shape: {way: 1.0} if isinstance(way, str) else way for shape, (way, *_) in table.morphs.items()}
    names = list(dict.fromkeys(name for way in ways.values() for name in way))
    if table.of == "expressions":
        figure = face_of([f"own{name}" for name in names], {name: {f"own{name}": 0.5} for name in names})
        expected = {shape: {f"own{name}": 0.5 * weight for name, weight in way.items()} for shape, way in ways.items()}
    else:
        figure, expected = face_of(names), ways
    mapping = map_morphs(figure)
    assert {shape: mapping.morphs[shape] for shape in expected} == expected
    for shape in expected:
        sides = [one for one in ("Left", "Right") if shape.endswith(one)]
        if sides and shape not in ("jawLeft", "jawRight", "mouthLeft", "mouthRight"):
            other = shape.removesuffix(sides[0]) + ("Right" if sides[0] == "Left" else "Left")
            assert other in expected


def test_a_shape_of_four_quarters_takes_them_all() -> None:
    quarters = [f"CTRL_expressions_mouthFunnel{quarter}" for quarter in ("UL", "UR", "DL", "DR")]
    assert map_morphs(face_of(quarters)).morphs == {"mouthFunnel": dict.fromkeys(quarters, 1.0)}
    assert "mouthFunnel" in map_morphs(face_of(quarters[:3])).missing


def test_names_of_unity_chan_behind_the_names_of_their_nodes() -> None:
    mapping = map_morphs(
        face_of(["blendShape1.MTH_A", "blendShape1.MTH_U", "blendShape2.EYE_DEF_C", "blendShape3.BLW_ANG1"])
    )
    assert mapping.profile == "unity_chan"
    assert mapping.morphs["jawOpen"] == {"blendShape1.MTH_A": 1.0}
    assert mapping.morphs["eyeBlinkRight"] == {"blendShape2.EYE_DEF_C": 0.5}
    assert mapping.morphs["browDownLeft"] == {"blendShape3.BLW_ANG1": 0.5}


def test_names_of_mmd_in_half_and_full_width() -> None:
    mapping = map_morphs(face_of(["あ", "う", "お", "まばたき", "ウィンク２", "ｳｨﾝｸ２右", "下"]))
    assert mapping.profile == "mmd"
    assert mapping.morphs["jawOpen"] == {"あ": 1.0}
    assert mapping.morphs["eyeBlinkLeft"] == {"ウィンク２": 1.0}
    assert mapping.morphs["eyeBlinkRight"] == {"ｳｨﾝｸ２右": 1.0}
    assert mapping.morphs["browDownRight"] == {"下": 0.5}


def test_lashes_close_with_their_eyes() -> None:
    lids = [f"Genesis8Female__eCTRLEyesClosed{side}" for side in "LR"]
    lashes = [f"Genesis8FemaleEyelashes__eCTRLEyesClosed{side}" for side in "LR"]
    mapping = map_morphs(face_of([*lids, *lashes]))
    assert mapping.profile == "daz"
    assert mapping.morphs["eyeBlinkLeft"] == {lids[0]: 1.0, lashes[0]: 1.0}
    assert mapping.morphs["eyeBlinkRight"] == {lids[1]: 1.0, lashes[1]: 1.0}


def test_correctives_are_not_the_shapes_they_correct() -> None:
    own = [
        "mouthSmileLeft",
        "mouthSmileRight",
        "jawOpen",
        "mouthSmileLeft_fix1",
        "mouthSmileRight_fix1",
        "jawOpen_fix2",
    ]
    for prefix in ("", "head__"):
        mapping = map_morphs(face_of([prefix + name for name in own]))
        assert mapping.morphs["mouthSmileLeft"] == {f"{prefix}mouthSmileLeft": 1.0}
        assert mapping.morphs["jawOpen"] == {f"{prefix}jawOpen": 1.0}


def test_what_the_best_table_leaves_out_is_taken_from_others() -> None:
    """A face of VRoid Studio whose file defines the gaze by expressions."""
    mapping = map_morphs(
        face_of(
            ["Fcl_MTH_A", "Fcl_MTH_U", "Fcl_EYE_Close_L", "Fcl_EYE_Close_R", "eyes up"],
            {"lookUp": {"eyes up": 0.8}, "aa": {"Fcl_MTH_A": 1.0}},
        )
    )
    assert mapping.profile == "vroid"
    assert mapping.morphs["eyeLookUpLeft"] == {"eyes up": 0.4}
    assert mapping.morphs["jawOpen"] == {"Fcl_MTH_A": 1.0}


def test_a_face_without_morphs_makes_nothing() -> None:
    mapping = map_morphs(face_of([]))
    assert (mapping.profile, dict(mapping.morphs), mapping.missing) == ("", {}, ARKIT_MORPHS)
    assert map_morphs(face_of(["Hat_On", "Shirt thin"])).missing == ARKIT_MORPHS


HALF_BLINK = {"eyeBlinkLeft": {"Blink": 0.5}, "eyeBlinkRight": {"Blink": 0.5}}
EXPECTED = {
    "elder_vrm0.vrm": HALF_BLINK
    | {"jawOpen": {"Mouth_A": 1.0}, "mouthFunnel": {"Mouth_O": 0.7}, "mouthPucker": {"Mouth_U": 0.8}}
    | {f"mouthSmile{side}": {"Smile": 0.5} for side in ("Left", "Right")}
    | {f"mouthStretch{side}": {"Mouth_I": 0.4} for side in ("Left", "Right")},
    "toddler_vrm1.vrm": {"browInnerUp": {"Fcl_BRW_Surprised": 0.5}}
    | {f"browOuterUp{side}": {"Fcl_BRW_Surprised": 0.25} for side in ("Left", "Right")}
    | {f"eyeBlink{side}": {f"Fcl_EYE_Close_{side[0]}": 1.0} for side in ("Left", "Right")}
    | {"jawOpen": {"Fcl_MTH_A": 1.0}, "mouthFunnel": {"Fcl_MTH_O": 0.7}, "mouthPucker": {"Fcl_MTH_U": 0.8}}
    | {f"mouthSmile{side}": {"Fcl_MTH_Fun": 0.5} for side in ("Left", "Right")}
    | {f"mouthStretch{side}": {"Fcl_MTH_I": 0.4} for side in ("Left", "Right")},
    "child_mixamo.fbx": {},
    "woman_game_engine.glb": {},
}


@pytest.mark.parametrize("name", EXPECTED)
def test_faces_of_foreign_characters(name: str) -> None:
    mapping = map_morphs(read_figure(CHARACTERS / name))
    assert mapping.morphs == EXPECTED[name]
    assert set(mapping.missing) == set(ARKIT_MORPHS) - set(EXPECTED[name])


def test_a_character_of_another_maker_makes_faces() -> None:
    character = load_character(CHARACTERS / "toddler_vrm1.vrm")
    made = {morph.name: morph for mesh in character.meshes for morph in mesh.morphs}
    assert set(made) == set(EXPECTED["toddler_vrm1.vrm"])
    own = {morph.name: morph for mesh in read_figure(CHARACTERS / "toddler_vrm1.vrm").meshes for morph in mesh.morphs}
    size = {name: float(abs(morph.deltas_m).max()) for name, morph in (made | own).items()}
    assert size["mouthPucker"] == pytest.approx(0.8 * size["Fcl_MTH_U"], rel=0.05)
    assert size["jawOpen"] == pytest.approx(size["Fcl_MTH_A"], rel=0.05)


@settings(max_examples=25, deadline=None)
@given(
    table=st.sampled_from(sorted(name for name, table in load_face_names().items() if table.of == "morphs")),
    seed=st.integers(0, 2**32 - 1),
    prefix=st.sampled_from(["", "Face.", "Wolf3D_Head.", "ns:face|", "Face.M_F00_000_00_"]),
)
def test_order_prefixes_and_other_morphs_change_nothing(table: str, seed: int, prefix: str) -> None:
    ways = load_face_names()[table].morphs
    names = sorted({name for way, *_ in ways.values() for name in ([way] if isinstance(way, str) else way)})
    plain = map_morphs(face_of(names))
    dice = random.Random(seed)
    # Single letters are names only where nothing stands before them.
    if prefix.endswith("_") and any(len(name) < 4 for name in names):
        prefix = ""
    shuffled = [prefix + name for name in dice.sample(names, len(names))]
    shuffled[dice.randrange(len(shuffled)) : 0] = ["Hat_On", "Shirt thin", "Toe_03"]
    mapping = map_morphs(face_of(shuffled))
    assert mapping.profile == plain.profile
    assert mapping.morphs == {
        shape: {prefix + name: weight for name, weight in own.items()} for shape, own in plain.morphs.items()
    }


def test_the_users_choice_wins() -> None:
    figure = face_of(["Mouth_A", "Mouth_O", "Blink"])
    mapping = map_morphs(figure, {"jawOpen": {"Mouth_O": 0.5, "Mouth_A": 0.25}, "eyeBlinkLeft": {}})
    assert mapping.morphs["jawOpen"] == {"Mouth_O": 0.5, "Mouth_A": 0.25}
    assert "eyeBlinkLeft" in mapping.missing
    assert mapping.morphs["eyeBlinkRight"] == {"Blink": 0.5}


@pytest.mark.parametrize(
    ("requested", "message", "named"),
    [
        ({"jawOpen": {"Mouth_X": 1.0}}, "figure.no_morph", {"morph": "Mouth_X", "shape": "jawOpen"}),
        ({"jawWide": {"Mouth_A": 1.0}}, "figure.no_shape", {"shape": "jawWide"}),
    ],
)
def test_a_correction_that_names_nothing_is_refused(
    requested: dict[str, dict[str, float]], message: str, named: dict[str, str]
) -> None:
    with pytest.raises(FileError) as caught:
        map_morphs(face_of(["Mouth_A"]), requested)
    assert caught.value.message.id == message
    assert named.items() <= caught.value.message.arguments.items()
    assert WORDINGS[message][0].format(**caught.value.message.arguments)


def test_a_smile_of_the_whole_face_turns_no_eyes() -> None:
    expressions = {"aa": {"ah": 1.0}, "happy": {"oh": 0.5, "up": 0.25}, "lookUp": {"up": 1.0}}
    made = map_morphs(face_of(["ah", "oh", "up"], expressions)).morphs
    assert made["mouthSmileLeft"] == {"oh": pytest.approx(0.2)}
    assert made["eyeLookUpLeft"] == {"up": 0.5}


@pytest.mark.parametrize("name", ["elder_vrm0.vrm", "toddler_vrm1.vrm"])
def test_a_face_of_vowels_still_forms_an_embouchure(name: str) -> None:
    """Its lips are closed at rest, wherever the edge of an upper lip is found that a vowel moves by half."""
    instrument, body = bundled_maps()["clarinet_Bb"], load_body()
    lips = fit_lips(load_character(CHARACTERS / name), instrument, body)
    usual = usual_morphs(body.embouchure[instrument.embouchure.kind], lips)
    assert usual["mouthFunnel"] > 0.2
    assert usual[lips.jaw] < 0.5
    parted_m = lips.gap_m({shape: np.array([weight]) for shape, weight in usual.items()}, 1)[0]
    assert parted_m == pytest.approx(lips.apart_m, abs=1e-4)
