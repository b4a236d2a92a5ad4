"""glTF 2.0 and VRM files -> plain values."""

from app.formats.gltf.model import GltfMaterial, GltfMesh, GltfModel, GltfMorph, GltfNode, GltfPrimitive, GltfSkin
from app.formats.gltf.read import decode_gltf, read_glb

__all__ = [
    "GltfMaterial",
    "GltfMesh",
    "GltfModel",
    "GltfMorph",
    "GltfNode",
    "GltfPrimitive",
    "GltfSkin",
    "decode_gltf",
    "read_glb",
]
