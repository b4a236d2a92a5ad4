"""Straps for a body and its instruments: around the neck, over both shoulders, or across the seat."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from app.arrays import FloatArray
from app.formats.scene import Material
from app.rig.mesh import Mesh
from app.rig.model import Skeleton
from app.rig.supports.band import Shares, SurfaceStrip, band, mesh_of, tube
from app.rig.supports.bands_on_body import BandRoute, LegShape, joined_behind, leg_of, tapering
from app.rig.supports.model import GROWN_UP_M, BoneRole, Hook, Strap, StrapLeg, SupportBone
from app.rig.supports.taut_string import PosedTrunk
from instrument_maps.hold import SupportKind

_MATERIALS: Final = (
    Material("strap", (0.018, 0.018, 0.020, 1.0), 0.0, 0.85),
    Material("strap_leather", (0.030, 0.020, 0.014, 1.0), 0.0, 0.55),
    Material("strap_metal", (0.62, 0.60, 0.56, 1.0), 1.0, 0.32),
)
_WEB, _LEATHER, _METAL = range(3)
_CORD_M: Final = {"neck_strap": 0.075, "harness": 0.060, "seat_strap": 0.0}
_HOOK_M = 0.030
"""Length in metres of the snap hook at a cord's lower end."""
_SEAT_HALF_M = 0.019


@dataclass(frozen=True, eq=False)
class Sitter:
    """Seat of a seated player, in the player's frame: the middle (3,) of its top and half its width, in metres."""

    middle_m: FloatArray
    half_width_m: float


@dataclass(frozen=True, eq=False)
class MadeStrap:
    """A strap with its mesh and bones. The mesh's joints are numbered within the strap: first the joints that it is
    tied to, then its own bones.
    """

    strap: Strap
    mesh: Mesh
    bones: tuple[SupportBone, ...]


@dataclass(frozen=True, eq=False)
class Wearer:
    """A body in the pose in which straps are made.

    Attributes
    ----------
    skeleton : Skeleton
        Skeleton of the character.
    joints : (J, 3, 4) float64
        ``world_from_joint`` in the player's frame.
    trunk : PosedTrunk
        Skin and clothes of the trunk in that pose.
    sitter : Sitter or None
        Seat; None if the player stands.
    """

    skeleton: Skeleton
    joints: FloatArray
    trunk: PosedTrunk
    sitter: Sitter | None

    def at(self, *names: str) -> FloatArray:
        """Return the position (3,) of the first of the named joints that the skeleton has, metres."""
        name = next(one for one in names if one in self.skeleton.names)
        place: FloatArray = self.joints[self.skeleton.index(name), :, 3]
        return place

    @property
    def neck_m(self) -> FloatArray:
        """Position (3,) of the base of the neck in metres; estimated from shoulders and head if the skeleton has no
        neck.
        """
        if "neck" in self.skeleton.names:
            return self.at("neck")
        shoulders = 0.5 * (self.at("leftUpperArm") + self.at("rightUpperArm"))
        return shoulders + 0.35 * (self.at("head") - shoulders)

    @property
    def half_shoulders_m(self) -> float:
        """Half the distance between the shoulder joints in metres."""
        return 0.5 * float(np.linalg.norm(self.at("leftUpperArm") - self.at("rightUpperArm")))

    @property
    def chest(self) -> int:
        """Index of the joint of the chest, with which a strap rotates."""
        name = next(one for one in ("upperChest", "chest", "spine") if one in self.skeleton.names)
        return self.skeleton.index(name)


def made_strap(
    kind: SupportKind,
    wearer: Wearer,
    hooks: Sequence[Hook],
    ends_m: tuple[FloatArray, FloatArray],
    number: int,
) -> MadeStrap | None:
    """Make a strap.

    Parameters
    ----------
    hooks : sequence of Hook
        Places on the instruments where it is hooked in.
    ends_m : two of (3,) float64
        Its lower end in the player's frame, with the instrument played and with it lowered.
    number : int
        Index among the musician's straps.

    Returns
    -------
    MadeStrap or None
        None if this body cannot wear it.
    """
    hook_m, low_m = ends_m
    if kind == "seat_strap":
        return None if wearer.sitter is None else _seat_strap(wearer.sitter, hooks, hook_m, number)
    size = wearer.half_shoulders_m / GROWN_UP_M
    cord_m = size * _CORD_M[kind]
    up = wearer.neck_m + size * np.array([0.0, -0.04, 0.07]) - hook_m
    meet_m = hook_m + cord_m * up / np.linalg.norm(up)
    routes = _neck_routes(wearer, size) if kind == "neck_strap" else _harness_routes(wearer, size)
    low_meet_m = low_m + cord_m * _unit(wearer.neck_m + size * np.array([0.0, -0.04, 0.07]) - low_m)
    shapes = [leg_of(wearer.trunk, route, meet_m, low_meet_m) for route in routes]
    legs = [shape for shape in shapes if shape is not None]
    if len(legs) < 2:
        return None
    if kind == "neck_strap":
        legs = joined_behind(*legs)
    tops = np.mean([shape.leg.top_m for shape in legs], axis=0)
    strap = Strap(
        kind=kind,
        legs=tuple(shape.leg for shape in legs),
        hooks=tuple(hooks),
        cord_m=cord_m,
        root_m=wearer.neck_m,
        meet_m=meet_m,
        hook_m=hook_m,
        turning=wearer.chest,
        low_m=low_m,
        hanging_m=_hanging(wearer, tops, float(np.linalg.norm(hook_m - tops))),
    )
    return _on_bones(strap, legs, number)


def _on_bones(strap: Strap, legs: Sequence[LegShape], number: int) -> MadeStrap:
    joints = sorted({int(joint) for leg in legs for joint in np.flatnonzero(leg.weights.any(axis=0))})
    of_joint = {joint: index for index, joint in enumerate(joints)}
    bones = [SupportBone("", "joint", np.zeros(3), joint=joint) for joint in joints]
    strips = list[SurfaceStrip]()
    for index, leg in enumerate(legs):
        strips += leg.strips(of_joint, len(bones))
        bones += leg_bones(strap, leg.leg, number, index)
    bones.append(SupportBone(f"{strap.kind}_hook", "cord", strap.hook_m, strap=number))
    strips += _cord(strap, len(bones) - 1)
    return MadeStrap(strap, mesh_of(strap.kind, strips, _MATERIALS), tuple(bones))


def leg_bones(strap: Strap, leg: StrapLeg, number: int, index: int) -> list[SupportBone]:
    """Return the three bones (top, middle, end) that bend one leg of a strap."""
    middle_m = 0.5 * (leg.top_m + strap.meet_m)
    places: tuple[tuple[BoneRole, FloatArray], ...] = (
        ("top", leg.top_m),
        ("middle", middle_m),
        ("end", strap.meet_m),
    )
    return [
        SupportBone(f"{strap.kind}_{index + 1}_{role}", role, place_m, strap=number, leg=index)
        for role, place_m in places
    ]


def _neck_routes(wearer: Wearer, size: float) -> list[BandRoute]:
    """Return the courses of both legs of a neck strap: a pad behind the neck, webbing in front."""
    neck = wearer.neck_m
    half = tapering([(0.0, size * 0.016), (0.45, size * 0.016), (0.8, size * 0.010), (1.0, size * 0.009), (2.0, 0.005)])
    up, behind = np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.052, -0.08])
    return [
        BandRoute(
            neck + size * behind,
            neck + size * np.array([side * 0.066, -0.012, 0.0]),
            0.75 * up,
            np.array([-0.6 * side, 0.6, 0.0]),
            half,
        )
        for side in (1.0, -1.0)
    ]


def _harness_routes(wearer: Wearer, size: float) -> list[BandRoute]:
    """Return the courses of the four bands of a harness from between the shoulder blades: two over the shoulders, two
    around the ribs.
    """
    neck, hips = wearer.neck_m, wearer.at("hips")
    back = neck + 0.34 * (hips - neck) + size * np.array([0.0, 0.0, -0.09])
    over = tapering([(0.0, size * 0.017), (0.6, size * 0.020), (1.0, size * 0.014), (2.0, 0.007)])
    around = tapering([(0.0, size * 0.014), (1.0, size * 0.012), (2.0, 0.007)])
    up, shoulder = np.array([0.0, 1.0, 0.0]), 0.56 * wearer.half_shoulders_m
    routes = list[BandRoute]()
    for side in (1.0, -1.0):
        inner = np.array([-side, 0.0, 0.0])
        via = neck + np.array([side * shoulder, 0.0, 0.0])
        routes.append(BandRoute(back, via, 0.7 * inner + 0.7 * up, inner, over))
    for side in (1.0, -1.0):
        rib = neck + 0.52 * (hips - neck) + np.array([side * wearer.half_shoulders_m, 0.0, 0.0])
        routes.append(BandRoute(back, rib, up, up, around, around=True))
    return routes


def _hanging(wearer: Wearer, tops: FloatArray, reach_m: float) -> FloatArray:
    """Return the lower end (3,) of a strap of length ``reach_m`` that hangs from ``tops`` in front of the body."""
    low = tops - np.array([0.0, reach_m, 0.0])
    points = wearer.trunk.vertices_m
    near = (np.abs(points[:, 0] - low[0]) < 0.08) & (points[:, 1] > low[1] - 0.03) & (points[:, 1] < tops[1])
    ahead = float(points[near, 2].max()) + 0.012 if near.any() else tops[2]
    down = np.sqrt(max(reach_m**2 - (ahead - tops[2]) ** 2, 1e-4))
    return np.array([tops[0], tops[1] - down, ahead])


def _cord(strap: Strap, bone: int) -> list[SurfaceStrip]:
    """Return the surfaces of slider, cord and snap hook in the pose in which the strap was made."""
    only: Shares = [(bone, 1.0)]
    way = strap.meet_m - strap.hook_m
    length = float(np.linalg.norm(way))
    up = way / length
    rigid = [only] * 12

    def line(*heights: float) -> FloatArray:
        return strap.hook_m + np.outer(np.array(heights), up)

    slider = line(length + 0.009, length + 0.009, length + 0.007, length - 0.007, length - 0.009, length - 0.009)
    radii = np.array([0.0, 0.0055, 0.0075, 0.0075, 0.0055, 0.0])
    cord = line(length - 0.004, _HOOK_M - 0.004)
    swivel = line(_HOOK_M, _HOOK_M, _HOOK_M - 0.008, _HOOK_M - 0.010, _HOOK_M - 0.010)
    strips = [
        tube(slider, radii, rigid[:6], _LEATHER, 12),
        tube(cord, np.full(2, 0.0026), rigid[:2], _WEB, 8),
        tube(swivel, np.array([0.0, 0.0042, 0.0046, 0.0030, 0.0]), rigid[:5], _METAL, 12),
    ]
    return [*strips, _loop(strap.hook_m, up, only)]


def _loop(hook_m: FloatArray, up: FloatArray, only: Shares) -> SurfaceStrip:
    """Return the surface of the hook, a loop of wire whose lowest point is at ``hook_m``; ``up`` is the direction of
    the cord, ``only`` its bone.
    """
    side = np.cross(up, np.array([0.0, 0.0, 1.0]))
    side /= max(float(np.linalg.norm(side)), 1e-9)
    high, wide = 0.5 * (_HOOK_M - 0.010), 0.0062
    turns = np.linspace(0.0, 2.0 * np.pi, 21)
    ring = hook_m + (high - high * np.cos(turns))[:, None] * up + (wide * np.sin(turns))[:, None] * side
    return tube(ring, np.full(len(turns), 0.0014), [only] * len(turns), _METAL, 8)


def _seat_strap(sitter: Sitter, hooks: Sequence[Hook], hook_m: FloatArray, number: int) -> MadeStrap:
    """Return a strap for the seat: a band across it, under the thighs, and from its edge down to the hook."""
    side = 1.0 if hook_m[0] >= sitter.middle_m[0] else -1.0
    ahead = np.clip(hook_m[2] - sitter.middle_m[2], -0.02, 0.12)
    over = sitter.middle_m + np.array([0.0, 0.0, ahead])
    half = sitter.half_width_m
    across = np.array([-side * 0.85 * half, -side * 0.3 * half, side * 0.3 * half, side * (half - 0.012)])
    line = over + np.outer(across, [1.0, 0.0, 0.0])
    edge = over + np.array([side * (half + 0.004), -0.008, 0.0])
    hooked = np.linspace(0.0, 1.0, 10)[:, None]
    leg = StrapLeg((), (), edge, np.array([side, 0.0, 0.0]))
    reach_m = float(np.linalg.norm(hook_m - edge))
    strap = Strap(
        "seat_strap", (leg,), tuple(hooks), 0.0, edge, hook_m, hook_m, -1, hook_m,
        edge + np.array([side * 0.01, -reach_m, 0.0]),
    )  # fmt: skip
    bones = [SupportBone("seat_strap_seat", "still", edge), *leg_bones(strap, leg, number, 0)]
    bones.append(SupportBone("seat_strap_hook", "cord", hook_m, strap=number))
    centre = np.concatenate([line, edge + hooked * (hook_m - edge)])
    shares: list[Shares] = [[(0, 1.0)]] * len(line)
    shares += [[(1, (1 - t) ** 2), (2, 2 * t * (1 - t)), (3, t**2)] for t in hooked[:, 0].tolist()]
    ways = _unit(np.gradient(centre, axis=0))
    forward = np.tile([0.0, 0.0, 1.0], (len(centre), 1))
    outwards = _unit(np.cross(forward, ways)) * side
    widths = np.where(
        np.arange(len(centre)) < len(line),
        _SEAT_HALF_M,
        np.interp(np.arange(len(centre)), [4, 13], [_SEAT_HALF_M, 0.008]),
    )
    thick, over = np.full(len(centre), 0.0025), np.full(len(centre), 0.0005)
    strips = band(centre, _unit(np.cross(ways, outwards)), outwards, widths, thick, shares, over, _WEB)
    strips.append(_loop(hook_m, _unit(edge - hook_m), [(4, 1.0)]))
    return MadeStrap(strap, mesh_of("seat_strap", strips, _MATERIALS), tuple(bones))


def _unit(ways: FloatArray) -> FloatArray:
    found: FloatArray = ways / np.maximum(np.linalg.norm(ways, axis=-1, keepdims=True), 1e-9)
    return found
