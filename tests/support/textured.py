"""A small textured scene: a square with a letter in one corner of its picture, which reveals mirroring."""

from __future__ import annotations

import io
from fractions import Fraction

import numpy as np
from PIL import Image

from app.formats.scene import Bone, Clip, Material, Scene, SkinnedMesh
from app.formats.textures import MaterialTextures, TextureUse, texture_of

SIDE_PX = 64


def encoded(pixels: np.ndarray, kind: str = "PNG") -> bytes:
    """Encode pixels as an image file."""
    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, kind)
    return stream.getvalue()


def letter() -> np.ndarray:
    """Pixels (64, 64, 4) of white with a red F in the upper left corner; the lower right quarter is cut out."""
    picture = np.full((SIDE_PX, SIDE_PX, 4), 255, np.uint8)
    picture[SIDE_PX // 2 :, SIDE_PX // 2 :, 3] = 0
    for rows, columns in ((slice(4, 28), slice(4, 9)), (slice(4, 9), slice(4, 22)), (slice(14, 18), slice(4, 17))):
        picture[rows, columns] = (220, 10, 10, 255)
    return picture


def slope() -> np.ndarray:
    """Pixels of a normal map that tilts towards the top of the picture (green above half)."""
    return np.full((8, 8, 3), (128, 200, 230), np.uint8)


def roughness() -> np.ndarray:
    """Pixels of occlusion, roughness and metal."""
    return np.full((8, 8, 3), (255, 64, 0), np.uint8)


def card_material() -> Material:
    """Material with every kind of texture; the normal map is tiled."""
    surface = TextureUse(texture_of("card orm", encoded(roughness(), "JPEG")))
    return Material(
        "card",
        (1.0, 1.0, 1.0, 1.0),
        0.0,
        1.0,
        True,
        MaterialTextures(
            color=TextureUse(texture_of("../card: color", encoded(letter()))),
            normal=TextureUse(texture_of("card normal", encoded(slope())), (4.0, 3.0), (0.25, 0.0)),
            metallic_roughness=surface,
            occlusion=surface,
            normal_scale=0.5,
        ),
        "mask",
        0.4,
    )


def textured_scene(*materials: Material) -> Scene:
    """A square of 20 cm that faces +Z, its UVs v up, for each material, one above the other; a bone, two frames."""
    materials = materials or (card_material(),)
    corners = np.array([(-10, 0, 0), (10, 0, 0), (10, 20, 0), (-10, 20, 0)], float)
    count = len(materials)
    mesh = SkinnedMesh(
        name="card_mesh",
        vertices_cm=np.concatenate([corners + np.array((0.0, 25.0 * number, 0.0)) for number in range(count)]),
        faces=np.concatenate([np.array([(0, 1, 2), (0, 2, 3)]) + 4 * number for number in range(count)]),
        normals=np.tile([0.0, 0.0, 1.0], (4 * count, 1)),
        uvs=np.tile(np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float), (count, 1)),
        materials=materials,
        face_materials=np.repeat(np.arange(count), 2),
        joint_indices=np.zeros((4 * count, 1), int),
        weights=np.ones((4 * count, 1)),
        world_from_bone_bind=np.eye(4)[None],
    )
    still = np.tile([0.0, 0.0, 0.0, 1.0], (2, 1, 1))
    bone = Bone("root", -1, np.zeros(3), np.array([0.0, 0.0, 0.0, 1.0]))
    return Scene((bone,), (mesh,), Clip("card", Fraction(30), 2, still), name="card")
