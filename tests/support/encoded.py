"""Files as bytes, made by what writes them."""

from __future__ import annotations

from collections.abc import Sequence

from app.formats.bvh.clip import BvhClip
from app.formats.bvh.write import bvh_pieces
from app.formats.fbx.encode import Element, element_pieces
from app.formats.fbx.write import scene_elements
from app.formats.gltf.write import glb_pieces
from app.formats.scene import Scene


def encode_bvh(clip: BvhClip) -> bytes:
    """A BVH file."""
    return b"".join(bvh_pieces(clip))


def encode_elements(elements: Sequence[Element]) -> bytes:
    """An FBX file of these elements."""
    return b"".join(element_pieces(elements))


def encode_scene(scene: Scene) -> bytes:
    """An FBX file."""
    return encode_elements(scene_elements((scene,)))


def encode_glb(scene: Scene) -> bytes:
    """A GLB file."""
    return b"".join(glb_pieces((scene,)))
