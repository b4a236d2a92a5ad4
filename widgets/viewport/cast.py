"""The performers on the stage, prepared for drawing, and their poses as arrays of bone matrices.

All performers whose skeletons have the same joints are posed together, in arrays with a row for each.
"""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from app.arrays import FloatArray, IndexArray
from app.errors import AppError
from app.performance.bodies import body_of, dressed_character, lies_at, model_of, suited_to
from app.performance.chunks import Pose
from app.project.casting import StagePosition
from app.project.performers import Dancer, Player
from app.rig import quaternion
from app.rig.characters.character_library import character_library
from app.rig.model import Character, InstrumentModel, Skeleton
from app.rig.people.dressed import without
from app.rig.skeleton import rest_positions
from app.rig.supports.follow import support_matrices
from app.rig.supports.model import Supports
from instrument_maps.library import find_map
from instrument_maps.model import InstrumentMap
from metadata.model import Posture
from widgets.viewport.held_instruments import Instruments


@dataclass(frozen=True, eq=False)
class RenderAssets:
    """Meshes and skeletons for drawing a player or dancer.

    Attributes
    ----------
    character : Character
        The character.
    held : (InstrumentModel, InstrumentMap) or None
        Model and map of the instrument; None for a dancer.
    """

    character: Character
    held: tuple[InstrumentModel, InstrumentMap] | None

    @property
    def instrument(self) -> InstrumentModel:
        """The model of a player's instrument."""
        assert self.held is not None
        return self.held[0]

    @property
    def map(self) -> InstrumentMap:
        """The map of a player's instrument."""
        assert self.held is not None
        return self.held[1]


@dataclass(frozen=True, eq=False)
class Member:
    """A player or dancer on the stage.

    Attributes
    ----------
    player_id : str
        Id of the player or dancer.
    assets : RenderAssets
        Meshes and skeletons.
    world_from_player : (3, 4) float64
        Place on the stage.
    seat_m : (3,) float64 or None
        Middle of the seat's top in the player's frame; None if standing.
    musician_id : str
        Id of the musician whose body it is, which is drawn once; for a doubled instrument nothing else is drawn.
    stand_m : (3,) float64 or None
        Top of the stand for the instrument while the musician plays another, in the player's frame; None for no stand.
    supports : Supports or None
        Straps and chair; None if there are none, or not known yet.
    dances_on_foot : bool
        Whether the legs dance: those of a dancer, or of a player who dances standing.
    """

    player_id: str
    assets: RenderAssets
    world_from_player: FloatArray
    seat_m: FloatArray | None
    musician_id: str
    stand_m: FloatArray | None = None
    dances_on_foot: bool = False
    supports: Supports | None = None

    @property
    def has_body(self) -> bool:
        """True if the body is drawn."""
        return self.musician_id == self.player_id


def kit_of(player: Player, left_off: tuple[str, ...] = ()) -> RenderAssets:
    """Load the assets for drawing a player without the garments ``left_off``. Raises AppError if something is missing
    or damaged.
    """
    instrument_map = suited_to(player, find_map(player.instrument_id)).instrument
    return RenderAssets(without(dressed_character(player), left_off), (model_of(instrument_map), instrument_map))


def dancer_kit(dancer: Dancer) -> RenderAssets:
    """Load the assets for drawing a dancer. Raises AppError if the character is missing or damaged."""
    if dancer.character_id not in character_library().sources:
        raise AppError("project.character_missing", player=dancer.name, id=dancer.character_id)
    return RenderAssets(dressed_character(dancer), None)


def dancing_member(dancer: Dancer, assets: RenderAssets) -> Member:
    """Return a dancer at its place as a member of the stage."""
    return Member(dancer.id, assets, placed(dancer.stage), None, dancer.id, dances_on_foot=True)


def stand_of(player: Player, assets: RenderAssets, number: int) -> FloatArray | None:
    """Return the position (3,) of the top of the stand on which an unused instrument lies, in the player's frame;
    ``number`` counts the musician's instruments from 0. None if it is not known yet.
    """
    found = lies_at(player, find_map(player.instrument_id), number)
    if found is None:
        return None
    points = np.concatenate([mesh.positions_m for mesh in assets.instrument.meshes]).astype(np.float64)
    middle = (points.min(axis=0) + points.max(axis=0)) / 2.0
    # Attached to the point nearest to its centre.
    nearest = points[int(np.argmin(np.linalg.norm(points - middle, axis=1)))]
    top_m: FloatArray = found[0] + quaternion.rotate(found[1], nearest)
    return top_m


def member_of(
    player: Player,
    assets: RenderAssets,
    musician_id: str = "",
    stand_m: FloatArray | None = None,
    supports: Supports | None = None,
) -> Member:
    """Return a player at its place as a member of the stage; ``musician_id`` is the player whose body plays, if
    another.
    """
    musician_id = musician_id or player.id
    posture = body_of(player).postures[assets.map.hold.possible(player.parameters.posture)]
    seat_m = seat(assets.character.skeleton, posture) if musician_id == player.id else None
    on_foot = dances(player) and posture.seat_height_shank <= 0.0
    return Member(player.id, assets, placed(player.stage), seat_m, musician_id, stand_m, on_foot, supports)


def dances(player: Player) -> bool:
    """Return whether a player dances while playing."""
    return bool(player.parameters.choreography) and player.parameters.dance_amount > 0.0


def placed(stage: StagePosition) -> FloatArray:
    """Return the transform ``world_from_player`` (3, 4) of a place on the stage."""
    cosine, sine = math.cos(stage.turn_rad), math.sin(stage.turn_rad)
    return np.array([[cosine, 0.0, sine, stage.x_m], [0.0, 1.0, 0.0, 0.0], [-sine, 0.0, cosine, stage.z_m]])


def seat(skeleton: Skeleton, posture: Posture) -> FloatArray | None:
    """Return the middle (3,) of the top of the seat in a posture, in the player's frame; None if standing."""
    if posture.seat_height_shank <= 0.0:
        return None
    rest = rest_positions(skeleton)
    shank_m = float(np.linalg.norm(skeleton.offsets_m[skeleton.index("leftFoot")]))
    ankle_m = float(rest[skeleton.index("leftFoot")][1])
    # The flesh of the thigh is as thick below its bone as the seat is below the hollow of the knee.
    height_m = ankle_m + shank_m * posture.seat_height_shank - SITTING_FLESH_M
    return np.array([0.0, height_m, float(rest[skeleton.index("hips")][2]) + 0.02])


SITTING_FLESH_M = 0.095
"""Distance in metres from the height of the hip joint down to the seat."""


class SkeletonBatch:
    """Members whose skeletons have the same joints, posed together.

    Parameters
    ----------
    members : sequence of Member
        All members of the stage.
    rows : sequence of int
        Indices of those members that the batch has.
    """

    def __init__(self, members: Sequence[Member], rows: Sequence[int]) -> None:
        self.rows: IndexArray = np.array(rows, np.intp)
        characters = [members[row].assets.character for row in rows]
        skeleton = characters[0].skeleton
        self.joint_count = len(skeleton.names)
        order, self._levels = _levels(skeleton)
        self._order, self._back = order, np.argsort(order)
        self._hips = int(self._back[skeleton.index("hips")])
        self._offsets_m = np.array([character.skeleton.offsets_m[order] for character in characters])
        self._stages = np.array([members[row].world_from_player for row in rows])
        self._bind = np.array([character.joint_from_mesh for character in characters])

    def joints(self, rotations: FloatArray, hips_m: FloatArray) -> FloatArray:
        """Return the transforms ``world_from_joint`` (P, J, 3, 4) of J joints of P performers, from rotations (P, J, 4)
        and positions of the hips (P, 3).
        """
        local = np.empty((*rotations.shape[:2], 3, 4))
        local[..., :3] = quaternion.to_matrix(rotations[:, self._order])
        local[..., 3] = self._offsets_m
        local[:, self._hips, :, 3] = hips_m
        world = np.empty(local.shape)
        for joints, parents in self._levels:
            above = self._stages[:, None] if parents is None else world[:, parents]
            own = world[:, joints]
            np.matmul(above[..., :3], local[:, joints], out=own)
            own[..., 3] += above[..., 3]
        return world[:, self._back]

    def skinning(self, joints: FloatArray) -> FloatArray:
        """Return the skinning matrices ``world_from_mesh`` (P, J, 3, 4) of P performers with J joints."""
        matrices: FloatArray = joints @ self._bind
        return matrices


class Stage:
    """All performers, and the matrices of their last pose.

    Parameters
    ----------
    members : sequence of Member
        All performers.

    Attributes
    ----------
    bones : (N, B, 3, 4) float32
        ``world_from_rest`` of joints, then of the instrument's nodes (from `first_node`), then of the seat and of the
        stand, then of straps and chair (from `first_support`); all 0 for performers without a pose.
    joints : (N, J, 3, 4) float64
        ``world_from_joint``.
    heads : (N,) int
        Index of the head joint.
    shown : (N,) bool
        Whether each performer has a pose.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        self.members = tuple(members)
        count = len(self.members)
        self.first_node = max((len(member.assets.character.skeleton.names) for member in members), default=0)
        self._instruments = Instruments([member.assets.held for member in members])
        self.seat_bone = self.first_node + self._instruments.nodes
        self.stand_bone = self.seat_bone + 1
        self.first_support = self.stand_bone + 1
        most = max((len(member.supports.bones) for member in members if member.supports is not None), default=0)
        self.bones = np.zeros((count, self.first_support + most, 3, 4), np.float32)
        self._strapped = [
            (row, self._of_musician(members, member.musician_id))
            for row, member in enumerate(members)
            if member.supports is not None and member.supports.straps
        ]
        self.joints = np.zeros((count, self.first_node, 3, 4))
        self.heads = np.array([member.assets.character.skeleton.index("head") for member in members], np.intp)
        self.poses: list[Pose | None] = [None] * count
        self.shown = np.zeros(count, dtype=bool)
        skeletons = [member.assets.character.skeleton for member in members]
        self._troupes = [
            SkeletonBatch(members, rows) for rows in _grouped([(own.names, own.parents) for own in skeletons])
        ]
        self._stages = np.array([member.world_from_player for member in members]).reshape(-1, 3, 4)
        self._rotations = np.tile(quaternion.IDENTITY, (count, self.first_node, 1))
        self._hips_m = np.zeros((count, 3))
        self._held_m = np.zeros((count, 3))
        self._held_turns = np.tile(quaternion.IDENTITY, (count, 1))
        for row, member in enumerate(members):
            if member.seat_m is not None:
                self.bones[row, self.seat_bone, :, :3] = member.world_from_player[:, :3]
                self.bones[row, self.seat_bone, :, 3] = _moved(member.world_from_player, member.seat_m)
            if member.stand_m is not None:
                # Raised to the height of the stand.
                self.bones[row, self.stand_bone, :, :3] = member.world_from_player[:, :3]
                self.bones[row, self.stand_bone, :, 1] *= member.stand_m[1]
                self.bones[row, self.stand_bone, :, 3] = _moved(member.world_from_player, member.stand_m)

        for row, member in enumerate(members):
            if member.supports is not None:
                self.bones[row, self.first_support : self.first_support + len(member.supports.bones)] = (
                    member.world_from_player
                )

    @staticmethod
    def _of_musician(members: Sequence[Member], musician_id: str) -> list[int]:
        """Return the rows of the stage that belong to a musician: the body and every instrument."""
        return [row for row, member in enumerate(members) if member.musician_id == musician_id]

    def pose(self, poses: Mapping[str, Pose | None]) -> bool:
        """Apply poses, by player id, to all performers, and return whether anything changed."""
        fresh = False
        for row, member in enumerate(self.members):
            pose = poses.get(member.player_id)
            # A player whose character just changed may have a pose of the former one for a moment.
            if (
                pose is not None
                and pose is not self.poses[row]
                and len(pose.rotations) == len(member.assets.character.skeleton.names)
            ):
                self._take(row, pose)
                fresh = True
        if not fresh:
            return False
        for troupe in self._troupes:
            count = troupe.joint_count
            joints = troupe.joints(self._rotations[troupe.rows, :count], self._hips_m[troupe.rows])
            joints[~self.shown[troupe.rows]] = 0.0
            self.bones[troupe.rows, :count] = troupe.skinning(joints)
            self.joints[troupe.rows, :count] = joints
        held = np.empty((len(self.members), 3, 4))
        rotation = self._stages[..., :3]
        held[..., :3] = rotation @ quaternion.to_matrix(self._held_turns)
        held[..., 3] = (rotation @ self._held_m[..., None])[..., 0] + self._stages[..., 3]
        held[~self.shown] = 0.0
        self.bones[:, self.first_node : self.seat_bone] = self._instruments.matrices(held)
        for row, played in self._strapped:
            self._hang(row, played, held)
        return True

    def _hang(self, row: int, played: Sequence[int], held: FloatArray) -> None:
        """Place a musician's straps and chair by the body in the row ``row``, and by the instruments in the rows
        ``played``, whose transforms are ``held``.
        """
        supports = self.members[row].supports
        assert supports is not None
        stage = self._stages[row]
        instruments = [_within(stage, held[one])[None] for one in played]
        joints = _within(stage, self.joints[row, : len(supports.joints)])[None]
        matrices = support_matrices(supports, joints, instruments)[0]
        world = stage[:, :3] @ matrices
        world[..., 3] += stage[:, 3]
        own = slice(self.first_support, self.first_support + len(matrices))
        self.bones[row, own] = world if self.shown[played].all() else 0.0

    def _take(self, row: int, pose: Pose) -> None:
        self.poses[row] = pose
        self.shown[row] = True
        self._rotations[row, : len(pose.rotations)] = pose.rotations
        self._hips_m[row] = pose.hips_m
        self._held_m[row] = pose.instrument_position_m
        self._held_turns[row] = pose.instrument_rotation
        self._instruments.work(row, pose.controls)

    def index(self, player_id: str) -> int | None:
        """Return the row of a performer; None if it is missing."""
        for row, member in enumerate(self.members):
            if member.player_id == player_id:
                return row
        return None

    def rows(self, player_ids: Sequence[str]) -> list[int]:
        """Return the rows of performers in the given order, without missing ones."""
        rows = [self.index(player_id) for player_id in player_ids]
        return [row for row in rows if row is not None]

    def joint_m(self, row: int, name: str) -> FloatArray:
        """Position (3,) of a joint of the member ``row`` in the world, metres."""
        skeleton = self.members[row].assets.character.skeleton
        place: FloatArray = self.joints[row, skeleton.index(name), :, 3]
        return place

    def node_matrix(self, row: int, node: int = 0) -> FloatArray:
        """Return the transform ``world_from_rest`` (3, 4) of a node of an instrument."""
        matrix: FloatArray = self.bones[row, self.first_node + node].astype(np.float64)
        return matrix


def _levels(skeleton: Skeleton) -> tuple[IndexArray, list[tuple[slice, IndexArray | None]]]:
    """Return an order of the joints by depth in the hierarchy, and for each depth the range in that order, with the
    places there of the joints' parents; None for the root.
    """
    depth: list[int] = []
    for parent in skeleton.parents:
        depth.append(0 if parent < 0 else depth[parent] + 1)
    order = np.argsort(depth, kind="stable")
    place = np.argsort(order)
    ends = np.searchsorted(np.array(depth)[order], np.arange(max(depth) + 2))
    levels: list[tuple[slice, IndexArray | None]] = []
    for start, end in pairwise(ends):
        parents = place[[skeleton.parents[joint] for joint in order[start:end]]] if start else None
        levels.append((slice(int(start), int(end)), parents))
    return order, levels


def _grouped(keys: Sequence[Hashable]) -> list[list[int]]:
    groups: dict[Hashable, list[int]] = {}
    for row, key in enumerate(keys):
        groups.setdefault(key, []).append(row)
    return list(groups.values())


def _within(stage: FloatArray, transforms: FloatArray) -> FloatArray:
    """Return transforms (..., 3, 4), given in the world, relative to a place (3, 4) on the stage."""
    back = stage[:, :3].T
    turned: FloatArray = back @ transforms
    turned[..., 3] -= back @ stage[:, 3]
    return turned


def _moved(matrix: FloatArray, point: FloatArray) -> FloatArray:
    moved: FloatArray = matrix[:, :3] @ point + matrix[:, 3]
    return moved
