"""Choice of the skeleton for a player's files, and its comparison with that of an Unreal asset."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from app.errors import Argument, Message
from app.export.bind_pose import CENTIMETRES, bound_meshes, rest_transforms
from app.export.check_skeleton import SkeletonDifference, check_skeleton, reported
from app.export.equipped_skeleton import equipped
from app.export.mannequin import mannequin_axes, mannequin_target
from app.export.own_skeleton import own_target
from app.export.rig import Rig
from app.export.target import SkeletonChoice, TargetSkeleton, normalised_target
from app.performance.cast import LeftOut
from app.project.performers import Dancer, Player
from app.rig import quaternion
from app.rig.characters.bone_placements import local_placements
from app.rig.figure import Figure
from app.rig.mesh import Mesh
from app.rig.model import Character

MOST_LISTED = 5
"""Greatest number of serious differences that are reported individually."""


@dataclass(frozen=True)
class CheckedTarget:
    """The skeleton of a player's files, with its differences from an asset's if one was given."""

    target: TargetSkeleton
    differences: tuple[SkeletonDifference, ...] = ()

    @property
    def messages(self) -> tuple[Message, ...]:
        """Return messages about differences from the requested skeleton and from the asset, most severe first."""
        return (*reported(self.differences), *self.target.messages)


def target_skeleton(character: Character, choice: SkeletonChoice, asset: Figure | None = None) -> TargetSkeleton:
    """Return the skeleton for a character's files.

    Parameters
    ----------
    character : Character
        The character; one of this program's only has the normalised skeleton.
    choice : SkeletonChoice
        The user's choice.
    asset : Figure, optional
        The asset of an export on the mannequin, which provides the rest rotations.
    """
    if choice == "ue5":
        return mannequin_target(character.skeleton, None if asset is None else mannequin_axes(asset))
    if choice == "own" and character.own is not None:
        return own_target(character)
    return normalised_target(character.skeleton)


def written_meshes(character: Character, target: TargetSkeleton) -> tuple[Mesh, ...]:
    """Return the meshes that a file on a target has: those of the user's file on its own skeleton, else the
    character's.
    """
    own = character.own if target.choice == "own" else None
    return bound_meshes(character, target) if own is None else own.figure.meshes


def checked_targets(
    characters: Mapping[str, Character],
    choice: SkeletonChoice,
    asset: Figure | None = None,
    rigs: Mapping[str, Rig] = MappingProxyType({}),
) -> dict[str, CheckedTarget]:
    """Return the skeleton that each character is exported on, by player id, with its differences from an asset's.

    Parameters
    ----------
    characters : mapping of str to Character
        Characters by player id.
    choice : SkeletonChoice
        The user's choice.
    asset : Figure, optional
        The asset to compare with; without it there are no differences.
    rigs : mapping of str to Rig
        Requested additions (sockets, twist bones), by player id.
    """
    result = {}
    for player_id, character in characters.items():
        target = target_skeleton(character, choice, asset)
        if player_id in rigs:
            target = equipped(target, character, rigs[player_id])
        compared = () if asset is None else check_skeleton(_as_bound(character, target), asset)
        result[player_id] = CheckedTarget(target, compared)
    return result


def _as_bound(character: Character, target: TargetSkeleton) -> TargetSkeleton:
    """Return a target with its bind pose as rest pose, as Unreal interprets a file.

    Only the normalised skeleton changes, whose nodes are in T-pose while the skin is bound in an A-pose.
    """
    if target.choice != "suisou":
        return target
    binds = rest_transforms(character, target).astype(np.float64)
    turned = quaternion.from_matrix(binds[:, :3, :3])
    offsets, rest = local_placements(target.parents, binds[:, :3, 3] / CENTIMETRES, turned)
    return replace(target, offsets_m=offsets, rest=rest)


def spoilt(
    players: Sequence[Player | Dancer],
    checked: Mapping[str, CheckedTarget],
    asset: Figure,
    wording: Callable[[Message], str],
) -> tuple[LeftOut, ...]:
    """Return the players whose files would lose motion or be corrupted on an asset's skeleton, with the reason."""
    found = []
    for player in players:
        severe = reported([difference for difference in checked[player.id].differences if difference.severe])
        if severe:
            detail = "; ".join(map(wording, severe[:MOST_LISTED])) + ("; ..." if len(severe) > MOST_LISTED else "")
            arguments: dict[str, Argument] = {"file": asset.file, "player": player.name, "detail": detail}
            found.append(LeftOut(player, Message("skeleton.differs", arguments)))
    return tuple(found)
