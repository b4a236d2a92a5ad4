"""All differences of an asset's skeleton are found, and those that spoil an animation are distinguished from others."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from app.errors import Message
from app.export.check_skeleton import SkeletonDifference, check_skeleton, reported
from app.export.mannequin import MANNEQUIN, mannequin_target
from app.export.own_skeleton import own_target
from app.export.rig_options import EyeTurn
from app.export.target import TargetSkeleton
from app.messages import text
from app.rig import quaternion
from app.rig.characters.character_library import character_named
from app.rig.figure import Figure
from tests.support.foreign import PREFIX, foreign


@cache
def exported() -> tuple[TargetSkeleton, Figure]:
    character = foreign(character_named("woman_adult"))
    return own_target(character), character.own.figure


def renamed(figure: Figure, old: str, new: str) -> Figure:
    return replace(figure, bone_names=tuple(new if name == old else name for name in figure.bone_names))


def hung(figure: Figure, bone: str, parent: str) -> Figure:
    names = figure.bone_names
    parents = list(figure.parents)
    parents[names.index(bone)] = names.index(parent)
    return replace(figure, parents=tuple(parents))


def shifted(figure: Figure, bone: str, offset_m: float) -> Figure:
    translations = figure.translations_m.copy()
    translations[figure.bone_names.index(bone)] += [0.0, offset_m, 0.0]
    return replace(figure, translations_m=translations)


def turned(figure: Figure, bone: str, angle_deg: float) -> Figure:
    rotations = figure.rotations.copy()
    index = figure.bone_names.index(bone)
    turn = quaternion.from_axis_angle(np.array([0.0, 0.0, 1.0]), np.radians(angle_deg))
    rotations[index] = -quaternion.multiply(rotations[index], turn)  # the sign of a quaternion says nothing
    return replace(figure, rotations=rotations)


HAND, HEAD, HAIR = PREFIX + "leftHand", PREFIX + "head", "hair_1"


@pytest.mark.parametrize(("eyes", "asked"), [("shapes", set()), ("bones", {"eye_l", "eye_r"})])
def test_eyes_that_the_mannequin_lacks_are_told_where_bones_turn_them(eyes: EyeTurn, asked: set[str]) -> None:
    character = character_named("woman_adult")
    target = replace(mannequin_target(character.skeleton), eyes=eyes)
    asset = Figure(
        "asset", "gltf", tuple(MANNEQUIN), target.parents[:89], target.offsets_m[:89], target.rest[:89], ()
    )  # fmt: skip
    found = check_skeleton(target, asset)
    assert {(one.kind, one.bone, one.severe) for one in found} == {("requested", bone, False) for bone in asked}


def test_the_same_file_differs_in_nothing() -> None:
    target, figure = exported()
    assert check_skeleton(target, figure) == ()
    assert check_skeleton(target, replace(figure, rotations=-figure.rotations)) == ()


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (lambda f: renamed(f, HAND, "Hand_L"), SkeletonDifference("additional", HAND, severe=True)),
        (lambda f: renamed(f, "hair_2", "Braid"), SkeletonDifference("additional", "hair_2", severe=False)),
        (lambda f: renamed(f, "hair_2", "Braid"), SkeletonDifference("missing", "Braid", severe=False)),
        (lambda f: renamed(f, "Reference", "Rig"), SkeletonDifference("root", "Reference", True, "Reference", "Rig")),
        (lambda f: hung(f, HAIR, PREFIX + "neck"), SkeletonDifference("parent", HAIR, True, "hair_0", PREFIX + "neck")),
        (lambda f: shifted(f, HEAD, 0.004), SkeletonDifference("position", HEAD, severe=False, amount=4.0)),
        (lambda f: turned(f, HEAD, 2.5), SkeletonDifference("rotation", HEAD, severe=False, amount=2.5)),
        (
            lambda f: replace(f, translations_m=f.translations_m / 100.0),
            SkeletonDifference("unit", "", severe=True, amount=100.0),
        ),
    ],
)
def test_what_differs_is_found(change: Callable[[Figure], Figure], expected: SkeletonDifference) -> None:
    target, figure = exported()
    found = check_skeleton(target, change(figure))
    assert expected in found
    assert [difference.severe for difference in found] == sorted((d.severe for d in found), reverse=True)


def test_a_unit_that_the_reader_corrected_is_still_the_assets() -> None:
    target, figure = exported()
    corrected = replace(figure, notes=(Message("figure.scaled", {"file": "x", "height_m": 0.017, "factor": 100.0}),))
    assert check_skeleton(target, corrected)[0] == SkeletonDifference("unit", "", severe=True, amount=100.0)


def test_a_little_is_nothing() -> None:
    target, figure = exported()
    assert check_skeleton(target, turned(shifted(figure, HEAD, 0.0002), HAND, 0.05)) == ()


def test_an_asset_with_several_roots_is_not_ours() -> None:
    character = foreign(character_named("woman_adult"), roots=2)
    found = check_skeleton(own_target(character), character.own.figure)
    assert found[0] == SkeletonDifference("root", "root", severe=True, ours="root", theirs="Reference, prop_1")


def test_it_is_reported_in_words() -> None:
    target, figure = exported()
    asset = shifted(shifted(renamed(figure, HAND, "Hand_L"), HEAD, 0.004), PREFIX + "neck", 0.001)
    said = [text(message) for message in reported(check_skeleton(target, asset))]
    assert said[0] == f"1 animated bone is not in the asset, so its motion would be lost: {HAND}"
    assert f"2 bones have a different rest position from the asset, by up to 4.0 mm ({HEAD})" in said
    assert "1 bone of the asset is missing from the file and keeps its rest pose: Hand_L" in said
