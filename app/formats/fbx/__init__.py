"""Binary FBX, both ways: bytes, elements, scenes of bones, skinned meshes and one clip."""

from app.formats.fbx.read import read_scene
from app.formats.fbx.write import encode_scene, write_scene
from app.formats.join import join_meshes
from app.formats.scene import Bone, Clip, Material, MorphTarget, Scene, SkinnedMesh

__all__ = [
    "Bone",
    "Clip",
    "Material",
    "MorphTarget",
    "Scene",
    "SkinnedMesh",
    "encode_scene",
    "join_meshes",
    "read_scene",
    "write_scene",
]
