"""Binary FBX, both ways: bytes, elements, scenes of bones, skinned meshes and one clip, and a text dump."""

from app.formats.fbx.join import join_meshes
from app.formats.fbx.read import read_scene
from app.formats.fbx.scene import FbxBone, FbxClip, FbxMaterial, FbxMesh, FbxMorph, FbxScene
from app.formats.fbx.write import encode_scene, write_scene

__all__ = [
    "FbxBone",
    "FbxClip",
    "FbxMaterial",
    "FbxMesh",
    "FbxMorph",
    "FbxScene",
    "encode_scene",
    "join_meshes",
    "read_scene",
    "write_scene",
]
