"""Files as bytes, made by the program's writers."""

from __future__ import annotations

from collections.abc import Sequence

from app.formats.bvh.clip import BvhClip
from app.formats.bvh.write import bvh_pieces
from app.formats.fbx.encode import Element, element_pieces
from app.formats.fbx.write import scene_elements
from app.formats.gltf.write import glb_pieces
from app.formats.scene import Scene


def encode_bvh(clip: BvhClip) -> bytes:
    """Encode a BVH file."""
    return b"".join(bvh_pieces(clip))


def encode_elements(elements: Sequence[Element]) -> bytes:
    """Encode an FBX file from elements."""
    return b"".join(element_pieces(elements))


def encode_scene(scene: Scene) -> bytes:
    """Encode an FBX file from a scene."""
    return encode_elements(scene_elements((scene,)))


def encode_glb(scene: Scene) -> bytes:
    """Encode a GLB file."""
    return b"".join(glb_pieces((scene,)))
