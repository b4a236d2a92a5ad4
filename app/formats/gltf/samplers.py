"""Animation of a glTF file: a sampler for every bone's rotation and translation, and one for all morphs of a mesh."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

import numpy as np
import pygltflib as gltf

from app.arrays import AnyIntArray, SingleArray
from app.formats.continuous import continuous
from app.formats.cubics import span_slopes
from app.formats.gltf.document import GlbDocument
from app.formats.scene import Clip, Scene, SkinnedMesh

METRES = 0.01


class Samplers:
    """The animation of a file, to which clips are added.

    Parameters
    ----------
    document : GlbDocument
        Document to which the animation is added.
    clip : Clip
        The first clip, which gives frame rate and length.
    """

    def __init__(self, document: GlbDocument, clip: Clip) -> None:
        self._seconds = (np.arange(clip.frames) * clip.fps.denominator / clip.fps.numerator).astype(np.float32)
        self._document = document
        self._times: dict[bytes, int] = {}
        self._animation = gltf.Animation(
            name=clip.name,
            samplers=[],
            channels=[],
            extras={"frames": clip.frames, "framesPerSecond": f"{clip.fps.numerator}/{clip.fps.denominator}"},
        )
        document.gltf.animations.append(self._animation)

    def add_clip(
        self,
        scene: Scene,
        clip: Clip,
        first: int,
        meshes: Sequence[SkinnedMesh],
        mesh_nodes: Sequence[int],
        unanimated: Collection[int] = (),
    ) -> None:
        """Add the animation of a scene's bones, whose nodes begin at `first`, and of the morphs of meshes; bones in
        `unanimated` get no keys.
        """
        keys = clip.keys
        slopes_fps = float(clip.fps) if keys is not None and keys.curved else 0.0
        for bone in range(len(scene.bones)):
            if bone in unanimated:
                continue
            frames = None if keys is None else keys.bones[bone]
            if bone in clip.translations_cm:
                places = (np.asarray(clip.translations_cm[bone]) * METRES).astype(np.float32)
                self.add(first + bone, "translation", places, frames, slopes_fps=slopes_fps)
            turned = continuous(clip.rotations_xyzw[:, bone])
            self.add(first + bone, "rotation", turned, frames, slopes_fps=slopes_fps)
        for node, mesh in zip(mesh_nodes, meshes, strict=True):
            if weights_move(clip, mesh):
                weights = _weights(clip, (morph.name for morph in mesh.morphs))
                frames = None if keys is None else keys.face
                self.add(node, "weights", weights, frames, flat=True)

    def add(
        self,
        node: int,
        path: str,
        values: SingleArray,
        frames: AnyIntArray | None,
        *,
        flat: bool = False,
        slopes_fps: float = 0.0,
    ) -> None:
        """Animate one property of a glTF node; ``values`` (F, W) has a row for each frame. Keys are at the given frames
        or all; cubic if a frame rate ``slopes_fps`` is given, else linear. With ``flat`` every number is an element of
        the accessor, as for weights of morphs.
        """
        interpolation = gltf.ANIM_LINEAR
        if frames is not None:
            seen = values if slopes_fps else values[frames]
            frames = frames[:1] if (seen == values[0]).all() else frames
            if slopes_fps and len(frames) > 1:
                interpolation = gltf.ANIM_CUBICSPLINE
                values = _with_slopes(values, frames, slopes_fps)
            else:
                values = values[frames]
        times = self._input(frames)
        output = self._document.accessor("keys", values, flat=flat)
        self._animation.samplers.append(gltf.AnimationSampler(input=times, output=output, interpolation=interpolation))
        target = gltf.AnimationChannelTarget(node=node, path=path)
        self._animation.channels.append(gltf.AnimationChannel(sampler=len(self._animation.samplers) - 1, target=target))

    def _input(self, frames: AnyIntArray | None) -> int:
        """Return the index of the accessor with the times of keys at some frames (all if None)."""
        known = b"" if frames is None else frames.tobytes()
        if known not in self._times:
            seconds = self._seconds if frames is None else self._seconds[frames]
            self._times[known] = self._document.accessor("times", seconds, bounds=True)
        return self._times[known]


def _with_slopes(values: SingleArray, frames: AnyIntArray, fps: float) -> SingleArray:
    """Return the rows (3 K, W) that glTF stores for K cubic keys of width W: in-slope per second, value, and
    out-slope."""
    slopes = span_slopes(values.astype(np.float64), frames) * fps
    rows = np.zeros((len(frames), 3, values.shape[1]), np.float32)
    rows[:, 1] = values[frames]
    rows[1:, 0], rows[:-1, 2] = slopes[:, 1], slopes[:, 0]
    return rows.reshape(-1, values.shape[1])


def weights_move(clip: Clip | None, mesh: SkinnedMesh) -> bool:
    """Return whether a clip animates a mesh's morph targets."""
    return clip is not None and any(morph.name in clip.morph_weights for morph in mesh.morphs)


def _weights(clip: Clip, names: Iterable[str]) -> SingleArray:
    """Return the weights (F, T) of a mesh's T morph targets, given by name; 0 for those that the clip does
    not animate.
    """
    rest = np.zeros(clip.frames)
    return np.stack([clip.morph_weights.get(name, rest) for name in names], axis=1).astype(np.float32)
