"""Reading of a player's and an instrument's file in blocks of frames, once for all measurements."""

from __future__ import annotations

from collections.abc import Set

import numpy as np

from app.arrays import AnyFloatArray, AnyIntArray, BoolArray, FloatArray, IntArray, SingleArray
from app.contacts.depths import HandDepths
from app.contacts.touches import LIPS, UPPER_LIP, Traces
from app.export.joint_playback import JointPlayback
from app.export.playback import Middles, PlaybackBones, ScenePlayback, Surface
from app.formats.scene import SkinnedMesh
from app.rig.model import Character
from app.rig.skinning import Skin
from instrument_maps.model import ROOT, InstrumentMap

SOLES = ("left.foot.sole", "right.foot.sole")
_CHUNK = 512
"""Number of frames read at a time, so that they fit a processor core's cache."""
_TORSO = ("hips", "neck")
_HANDS = ("left.hand", "right.hand")


class Walk:
    """Reader of a player's and an instrument's file in blocks of frames.

    Parameters
    ----------
    joints : JointPlayback
        The player's file.
    held : ScenePlayback
        The instrument's file.
    character : Character
        The player's character.
    instrument : InstrumentMap
        Map of the instrument.
    """

    def __init__(
        self, joints: JointPlayback, held: ScenePlayback, character: Character, instrument: InstrumentMap
    ) -> None:
        self._player, self._held = joints.playback, held
        frames = self._player.clip.frames
        requested = {contact.part for contact in instrument.contacts} | {*SOLES, LIPS, UPPER_LIP}
        skins = _skins(joints, character, requested | {*_HANDS})
        self.hands = [HandDepths(skins[name], instrument.proxy) for name in _HANDS if name in skins]
        low = joints.bone(_TORSO[0])
        high = joints.bone(_TORSO[1], "head")  # the neck is optional in VRM; the head is the next joint above it
        self._limbs = PlaybackBones(self._player, {low, high}.union(*(skin.joints.tolist() for skin in skins.values())))
        self._low, self._high = self._limbs.rows([low, high])
        self._carriers = [self._limbs.rows(hand.joints.tolist()) for hand in self.hands]
        self._middles = Middles({name: skins[name] for name in sorted(requested & skins.keys())}, self._limbs)
        bone_of_node = {part.node: part.name for part in instrument.moving_parts} | {ROOT: held.bone_names[0]}
        self._nodes = tuple(bone_of_node)
        bones = [held.bone_names.index(bone) for bone in bone_of_node.values()]
        self._parts = PlaybackBones(held, bones)
        self._node_rows = self._parts.rows(bones)
        self._marks_m = np.empty((len(self._middles.names), 3, frames))
        self._placed = np.empty((len(bones), 3, 4, frames))
        self._torso = np.empty((2, frames))

    def read(self, first: int, last: int, chosen: BoolArray) -> list[SingleArray]:
        """Read the frames ``first`` .. ``last - 1``; return for each hand ``world_from_joint`` (n, J, 3, 4) of the J
        joints that move it, at the n of these frames that ``chosen`` (F,) selects.
        """
        at = np.flatnonzero(chosen[first:last]) + first
        # In memory the axes are (N, 3, J, 4), the order in which depths are computed.
        found = [np.empty((len(at), 3, len(rows), 4), np.float32) for rows in self._carriers]
        room = self._limbs.room(_CHUNK)
        for begin in range(first, last, _CHUNK):
            end = min(begin + _CHUNK, last)
            world = self._limbs.world(begin, end, room)
            self._marks_m[..., begin:end] = self._middles.places_m(world, self._player.morphs(begin, end))
            self._placed[..., begin:end] = self._parts.world(begin, end)[self._node_rows]
            upright = world[self._high, :, 3] - world[self._low, :, 3]
            self._torso[:, begin:end] = np.arctan2(upright[[0, 2]], upright[1])
            own = slice(*np.searchsorted(at, [begin, end]).tolist())
            shown = slice(None) if own.stop - own.start == end - begin else at[own] - begin
            for joints, rows in zip(found, self._carriers, strict=True):
                for joint, row in enumerate(rows):
                    joints[own, :, joint] = world[row][..., shown].transpose(2, 0, 1)
        return [joints.swapaxes(1, 2) for joints in found]

    def morphs(self, frames: AnyIntArray) -> dict[str, AnyFloatArray]:
        """Return the weights (N,) of each morph at N frames."""
        return {name: np.asarray(weights)[frames] for name, weights in self._player.clip.morph_weights.items()}

    def nodes(self, frames: AnyIntArray) -> dict[str, FloatArray]:
        """Return ``world_from_node`` (N, 4, 4) of each of the instrument's nodes at N frames of the block that was read
        last.
        """
        result = np.zeros((len(self._nodes), len(frames), 4, 4))
        result[:, :, :3] = self._placed[..., frames].transpose(0, 3, 1, 2)
        result[:, :, 3, 3] = 1.0
        return dict(zip(self._nodes, result, strict=True))

    @property
    def torso_rad(self) -> FloatArray:
        """Return the angles of the torso (F, 2) in radians: sideways and forward."""
        return self._torso.T

    @property
    def traces(self) -> Traces:
        """Return the positions of all tracked points in all frames that were read."""
        marks_m = {name: self._marks_m[row].T for row, name in enumerate(self._middles.names)}
        nodes = {name: self._placed[row].transpose(2, 0, 1) for row, name in enumerate(self._nodes)}
        return Traces(marks_m, nodes)


def _skins(joints: JointPlayback, character: Character, names: Set[str]) -> dict[str, Skin]:
    """Return the vertices and weights of the named landmarks in the meshes of the exported file, by landmark."""
    meshes: dict[int, tuple[SkinnedMesh, dict[str, IntArray]]] = {}
    for name in sorted(names & character.landmarks.keys()):
        mesh, vertices = joints.surface(character.landmarks[name])
        meshes.setdefault(id(mesh), (mesh, {}))[1][name] = vertices
    skins: dict[str, Skin] = {}
    for mesh, places in meshes.values():
        whole, first = Surface(joints.playback, mesh, np.concatenate([*places.values()])).skin, 0
        for name, vertices in places.items():
            skins[name] = whole.part(np.arange(first, first + len(vertices)))
            first += len(vertices)
    return skins


def bone_deviation_m(joints: JointPlayback) -> FloatArray:
    """Return for each frame (F,) the largest deviation of any bone's length from its rest length, in metres; only bones
    that translate can deviate.
    """
    player = joints.playback
    result = np.zeros(player.clip.frames)
    for bone in player.clip.translations_cm:
        if joints.rigid[bone]:
            lengths_m = np.linalg.norm(player.bone_translations_m(bone), axis=1)
            np.maximum(result, np.abs(lengths_m - np.linalg.norm(player.rest_m[bone])), out=result)
    return result
