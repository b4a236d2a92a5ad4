"""Hats that would go through instruments: found by the shapes of both, left off, and said."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from msgspec import structs
from scipy.spatial import cKDTree

from app.motion.contacts.ready_player import body_as_fitted
from app.performance import hats
from app.performance.bodies import body_of, dressed_character, hold_of, model_of, suited_to
from app.performance.ensemble import Performance
from app.performance.hats import hats_left_off, left_off_message
from app.performance.supports import instrument_matrices, joints_of, still_pose
from app.plan.parameters import PlayerParameters
from app.project.casting import StagePosition
from app.project.performers import Player
from app.rig.people.dressed import without
from app.rig.people.wardrobe import OutfitChoice
from instrument_maps.load import bundled_maps
from instrument_maps.map_table import Posture
from instrument_maps.model import InstrumentMap
from tests.property.performance.edits import piece

SOUSAPHONE, TRUMPET = "sousaphone_BBb", "trumpet_Bb"
SHORT, MIDDLE, TALL = "child_hina", "woman_adult", "cast_thomas"


def player(character: str, instrument: str, posture: Posture = "standing", outfit: str = "marching") -> Player:
    parameters, place = PlayerParameters(posture=posture), StagePosition(0.0, 0.0, 0.0)
    return Player("p", "", "", instrument, character, parameters, place, outfit=OutfitChoice(outfit))


def held(one: Player) -> InstrumentMap:
    return suited_to(one, bundled_maps()[one.instrument_id]).instrument


def left_off(one: Player) -> tuple[str, ...]:
    return hats_left_off([(one, held(one))], one.parameters.posture)


def places(one: Player) -> tuple[np.ndarray, np.ndarray]:
    """Corners (T, 3, 3) of the triangles of the hat and of those of the instrument in the still pose."""
    instrument, character = held(one), dressed_character(one)
    grip = hold_of(one, instrument)
    pose = still_pose(body_as_fitted(one.parameters, instrument, character, grip, body_of(one)))
    (hat,) = (mesh for mesh in character.meshes if mesh.name == "shako")
    head = character.skeleton.index("head")
    matrix = joints_of(character, pose)[0, head] @ character.joint_from_mesh[head]
    hat_m = hat.positions_m @ matrix[:, :3].T + matrix[:, 3]
    place = instrument_matrices(pose)[0]
    corners = np.concatenate([mesh.positions_m[mesh.triangles] for mesh in model_of(instrument).meshes])
    return hat_m[hat.triangles], corners @ place[:, :3].T + place[:, 3]


def pierced(hat: np.ndarray, others: np.ndarray) -> int:
    """Number of edges of a hat that go through triangles (Moeller and Trumbore 1997)."""
    low, high = hat.min(axis=(0, 1)), hat.max(axis=(0, 1))
    others = others[((others.max(axis=1) >= low) & (others.min(axis=1) <= high)).all(axis=1)]
    first, second = (others[:, corner] - others[:, 0] for corner in (1, 2))
    count = 0
    for start, end in zip(hat.reshape(-1, 3), np.roll(hat, -1, axis=1).reshape(-1, 3), strict=True):
        along = end - start
        across = np.cross(along, second)
        size = np.where(np.abs(turn := (first * across).sum(axis=1)) < 1e-15, np.inf, turn)
        u = ((start - others[:, 0]) * across).sum(axis=1) / size
        normal = np.cross(start - others[:, 0], first)
        v, share = (normal @ along) / size, (second * normal).sum(axis=1) / size
        count += int(((u >= 0) & (v >= 0) & (u + v <= 1) & (share > 0) & (share < 1)).any())
    return count


@pytest.mark.parametrize("character", [SHORT, MIDDLE, TALL])
def test_the_plume_would_be_in_the_sousaphones_bell(character: str) -> None:
    one = player(character, SOUSAPHONE)
    assert pierced(*places(one)) > 5
    assert left_off(one) == ("shako",)


@pytest.mark.parametrize("posture", ["standing", "seated"])
@pytest.mark.parametrize("instrument", [TRUMPET, "tuba_BBb", "euphonium_Bb_bassclef", "bassoon", "flute"])
def test_other_players_keep_their_hats(instrument: str, posture: Posture) -> None:
    one = player(MIDDLE, instrument, posture)
    hat, others = places(one)
    far_m, _ = cKDTree(others.reshape(-1, 3)).query(hat.reshape(-1, 3))
    assert pierced(hat, others) == 0
    assert far_m.min() > 0.05
    assert left_off(one) == ()
    assert left_off_message(one, held(one)) is None


def test_without_a_hat_nothing_is_left_off_and_no_figure_is_loaded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hats, "dressed_character", None)
    assert left_off(player(MIDDLE, SOUSAPHONE, outfit="concert_black")) == ()
    assert left_off(player(MIDDLE, TRUMPET)) == ()


def test_a_musician_leaves_it_off_for_any_of_the_instruments() -> None:
    both = [player(MIDDLE, TRUMPET), player(MIDDLE, SOUSAPHONE)]
    assert hats_left_off([(one, held(one)) for one in both], "standing") == ("shako",)


def test_the_rest_of_the_outfit_is_the_same_under_an_id_of_its_own() -> None:
    worn = dressed_character(player(MIDDLE, SOUSAPHONE))
    bare = without(worn, ("shako",))
    assert {mesh.name for mesh in worn.meshes} - {mesh.name for mesh in bare.meshes} == {"shako"}
    assert bare.id == f"{worn.id}-without_shako"
    assert bare is without(worn, ("shako",))
    assert without(worn, ()) is worn


def test_it_is_a_problem_of_that_player_alone() -> None:
    project = piece()
    changed = {0: (SOUSAPHONE, "marching"), 1: (TRUMPET, "marching"), 2: (SOUSAPHONE, "")}
    players = list(project.players)
    for number, (instrument, outfit) in changed.items():
        worn = OutfitChoice(outfit)
        players[number] = structs.replace(
            players[number], instrument_id=instrument, character_id=MIDDLE, outfit=worn, doubles=""
        )
    performance = Performance(replace(project, players=tuple(players)))
    said = ["character.hat_left_off" in {one.message.id for one in performance.problems(p.id)} for p in players[:3]]
    assert said == [True, False, False]


def test_hats_are_not_compared_in_the_windows_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hats, "_KNOWN", set())
    project = piece()
    worn = structs.replace(project.players[0], instrument_id=TRUMPET, outfit=OutfitChoice("marching"))
    project = replace(project, players=(worn, *project.players[1:]))
    assert not Performance(project).prepare_within(600.0)
    Performance(project).prepare()
    assert Performance(project).prepare_within(600.0)
