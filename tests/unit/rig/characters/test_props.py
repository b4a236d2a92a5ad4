"""Swords, shields and cups in a figure's hands are recognised; hands, rings and gloves are not mistaken for them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.cli import main
from app.rig.characters.load_character import read_character
from app.rig.characters.props import props_in_hands
from app.rig.skeleton import rest_positions
from tests.support.anime_figure import anime_body, block
from tests.support.estranged import foreign, write_glb

WOMAN = Path("tests/data/characters/woman_game_engine.glb")


def test_what_is_held_is_found_and_what_belongs_to_a_hand_is_not() -> None:
    reading = read_character(WOMAN)
    figure, joints = reading.figure, reading.joints.bones
    hand, ring, chest = joints["rightHand"], joints["leftRingProximal"], joints["chest"]
    slot = len(figure.bone_names)
    armed = replace(
        figure,
        bone_names=(*figure.bone_names, "slot"),
        parents=(*figure.parents, hand),
        translations_m=np.concatenate([figure.translations_m, np.zeros((1, 3))]),
        rotations=np.concatenate([figure.rotations, [[0.0, 0.0, 0.0, 1.0]]]),
        meshes=(
            *figure.meshes,
            block(figure.meshes[0], "Sword", hand, 0.9),
            block(figure.meshes[0], "Cup", slot, 0.1),
            block(figure.meshes[0], "Ring", ring, 0.02),
            block(figure.meshes[0], "Knuckles", hand, 0.08),
            block(figure.meshes[0], "Cape", chest, 1.2),
        ),
    )
    assert props_in_hands(armed, joints) == ("Sword", "Cup")
    assert props_in_hands(figure, joints) == ()


def test_hands_that_are_meshes_of_their_own_are_no_props() -> None:
    """In a figure of rigid pieces every mesh moves with one bone as a whole."""
    reading = read_character(WOMAN)
    figure, joints = reading.figure, reading.joints.bones
    pieces = tuple(
        block(figure.meshes[0], name, joints[name], 0.5)
        for name in ("leftHand", "rightHand", "leftLowerArm", "chest", "head")
    )
    assert props_in_hands(replace(figure, meshes=pieces), joints) == ()


def test_check_says_what_is_left_out_and_how_it_is_kept(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    body = foreign(anime_body(), extra=False)
    hand = body.joints["rightHand"]
    model = body.meshes[0]
    sword = block(model, "Sword", hand, 0.9)
    body.meshes[1:] = [sword]
    path = write_glb(tmp_path / "knight.vrm", body, vrm=1)
    main(["characters", "check", str(path)])
    said = capsys.readouterr().out
    assert "left out, because it hangs on a hand" in said
    assert "Sword" in said
    main(["characters", "check", str(path), "--keep-props"])
    assert "left out, because" not in capsys.readouterr().out


def test_an_anime_figure_has_a_large_head_and_half_hands() -> None:
    body = anime_body()
    places_m = rest_positions(body.skeleton)
    heights_m = np.concatenate([mesh.positions_m[:, 1] for mesh in body.meshes])
    hand_m = np.linalg.norm(
        places_m[body.skeleton.index("leftHand")] - places_m[body.skeleton.index("leftMiddleDistal")]
    )
    head_m = heights_m.max() - places_m[body.skeleton.index("head"), 1] + 0.07
    assert 0.21 < head_m / (heights_m.max() - heights_m.min()) < 0.27
    assert 0.06 < hand_m < 0.09
