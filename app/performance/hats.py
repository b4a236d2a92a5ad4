"""Hats that are left off because the musician's instrument would go through them.

In bands the bearers of such instruments wear a cap or no hat. Shapes decide, in the still pose with the instrument at
the lips and lowered.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from typing import Final, cast

import numpy as np

from app.arrays import FloatArray
from app.errors import Message
from app.identity_cache import IdentityCache
from app.motion.contacts.ready_player import body_as_fitted
from app.performance.bodies import body_of, dressed_character, hold_of, model_of
from app.performance.supports import instrument_matrices, joints_of, still_pose
from app.plan.parameters import PlayerParameters
from app.project.performers import Player
from app.rig.characters.character_library import character_revision
from app.rig.characters.dressed_characters import hats_of
from app.rig.grip.carriage import carriage_rotation
from app.rig.grip.grip_pose import GripPose
from app.rig.grip.visible_share import spread
from app.rig.mesh import Mesh
from app.rig.model import Character, InstrumentModel
from app.rig.quaternion import rotate
from app.rig.skinning import patch
from instrument_maps.library import library
from instrument_maps.map_table import Posture as PostureName
from instrument_maps.model import InstrumentMap
from metadata.model import Body

MARGIN_M: Final = 0.02
"""Distance in metres from the instrument within which a hat is left off: of a sousaphone's player, who turns and nods,
the hat moves by up to 0.015 m in the instrument's frame while notes sound."""
_SPACING_M: Final = 0.008
"""Distance in metres between points of surfaces; at the margin it lengthens the distance by less than a millimetre."""
_ABOVE_LIPS_M: Final = np.array([[-0.14, 0.08, -0.35], [0.14, 0.60, 0.12]])
"""Box, seen from the lips of a player, in which hats are. An instrument that does not reach into it when it is played
is never compared with a hat."""

_MET: IdentityCache[tuple[str, ...]] = IdentityCache(128)
_NEAR: IdentityCache[bool] = IdentityCache(256)
_Case = tuple[str, int, str, str, int, str]
_KNOWN: set[_Case] = set()
"""Cases (`_case`) that are decided."""


def hats_left_off(played: Iterable[tuple[Player, InstrumentMap]], posture: PostureName) -> tuple[str, ...]:
    """Return the sorted names of the meshes of hats that a musician leaves off.

    Parameters
    ----------
    played : iterable of (Player, InstrumentMap)
        The musician as player of each instrument, and the fitted instrument (`app.performance.bodies.suited_to`). Grips
        are computed if a hat has to be compared with the instrument.
    posture : str
        Posture that is set for the musician.
    """
    return tuple(sorted({name for player, instrument in played for name in _met_by(player, instrument, posture)}))


def left_off_message(player: Player, instrument: InstrumentMap) -> Message | None:
    """Return a message that a hat is left off because of a fitted instrument; None if none is."""
    off = hats_left_off([(player, instrument)], player.parameters.posture)
    _KNOWN.add(_case(player))
    return Message("character.hat_left_off", {}) if off else None


def is_known(player: Player) -> bool:
    """Return whether it takes no time to find out if a player wears a hat."""
    return not hats_of(player.character_id, player.outfit) or _case(player) in _KNOWN


def _case(player: Player) -> _Case:
    """Return the values by which the wearing of a hat is decided."""
    revision = library().revisions.get(player.instrument_id, 0)
    own = player.character_id, character_revision(player.character_id), player.outfit.id
    return *own, player.instrument_id, revision, player.parameters.posture


def _met_by(player: Player, instrument: InstrumentMap, posture: PostureName) -> tuple[str, ...]:
    hats = hats_of(player.character_id, player.outfit)
    named = sys.intern(instrument.hold.possible(posture))
    # First what needs neither character nor grip, since most instruments are nowhere near a hat.
    if not hats or not _NEAR.step(_reaches_hats, model_of(instrument), instrument, named):
        return ()
    given = dressed_character(player), model_of(instrument), instrument, body_of(player)
    return _MET.step(_met, *given, hold_of(player, instrument), named, *hats)


def _reaches_hats(model: InstrumentModel, instrument: InstrumentMap, posture: str) -> bool:
    """Return whether an instrument as carried in a posture reaches into the box in which hats are."""
    carriage = instrument.hold.carriage(cast(PostureName, posture))
    turn = carriage_rotation(carriage.pitch_down_deg[1], carriage.yaw_left_deg[1], carriage.roll_left_deg[1])
    rim_m = np.asarray(instrument.mouthpiece.position_m)
    for mesh in model.meshes:
        places_m = rotate(turn, mesh.positions_m - rim_m)
        if _reaching(places_m[None], _ABOVE_LIPS_M)[0] and _reaching(places_m[mesh.triangles], _ABOVE_LIPS_M).any():
            return True
    return False


def _met(
    character: Character,
    model: InstrumentModel,
    instrument: InstrumentMap,
    body: Body,
    grip: GripPose,
    posture: str,
    *hats: str,
) -> tuple[str, ...]:
    """Return those hats of a dressed character that come within the margin of an instrument."""
    parameters = PlayerParameters(posture=cast(PostureName, posture))
    player = body_as_fitted(parameters, instrument, character, grip, body)
    found = set[str]()
    for lowered in (0.0, 1.0):
        if found.issuperset(hats):
            break
        still = still_pose(player, lowered)
        world_from_instrument = instrument_matrices(still)[0]
        world_from_joint = np.tile(np.eye(4), (1, len(character.skeleton.names), 1, 1))
        world_from_joint[:, :, :3] = joints_of(character, still)
        for mesh in character.meshes:
            if mesh.name in set(hats) - found:
                places_m = patch(character, mesh, np.arange(len(mesh.positions_m))).deformed(world_from_joint)[0]
                placed_m = (places_m - world_from_instrument[:, 3]) @ world_from_instrument[:, :3]
                if _meets(placed_m[mesh.triangles], model.meshes):
                    found.add(mesh.name)
    return tuple(sorted(found))


def _meets(hat: FloatArray, parts: Iterable[Mesh]) -> bool:
    """Return whether the triangles (T, 3, 3) of a hat come within the margin of an instrument's meshes."""
    from scipy.spatial import cKDTree  # slow to import; needed for few instruments

    near = np.concatenate([np.zeros((0, 3)), *_points_within(parts, _box(hat.reshape(-1, 3)))])
    if not len(near):
        return False
    own = _within(spread(hat, _SPACING_M), _box(near))
    return len(own) > 0 and bool(np.isfinite(cKDTree(own).query(near, distance_upper_bound=MARGIN_M)[0]).any())


def _box(points: FloatArray) -> FloatArray:
    """Return the box (2, 3) of points within the margin of some points (P, 3)."""
    return np.stack([points.min(axis=0) - MARGIN_M, points.max(axis=0) + MARGIN_M])


def _within(points: FloatArray, box_m: FloatArray) -> FloatArray:
    """Return those of some points (P, 3) that are in a box."""
    inside: FloatArray = points[((points >= box_m[0]) & (points <= box_m[1])).all(axis=1)]
    return inside


def _points_within(parts: Iterable[Mesh], box_m: FloatArray) -> Iterator[FloatArray]:
    """Yield points (P, 3) of meshes within a box (2, 3)."""
    for mesh in parts:
        corners = mesh.positions_m.astype(np.float64)[mesh.triangles]
        yield _within(spread(corners[_reaching(corners, box_m)], _SPACING_M), box_m)


def _reaching(corners: FloatArray, box_m: FloatArray) -> FloatArray:
    """Return for each of T sets of N points (T, N, 3), such as triangles, whether its own box overlaps a box (2, 3)."""
    return np.asarray(((corners.max(axis=1) >= box_m[0]) & (corners.min(axis=1) <= box_m[1])).all(axis=1))
