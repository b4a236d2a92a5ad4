"""A skeleton and its motion, with the contents of a BVH file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from app.arrays import AnyFloatArray
from app.errors import Message

AXES = "XYZ"
POSITIONS = tuple(f"{axis}position" for axis in AXES)


@dataclass(frozen=True, eq=False)
class BvhClip:
    """A skeleton and its motion; centimetres, right-handed, Y up.

    Attributes
    ----------
    names : tuple of str
        Joint names, parents first; the first joint is the only root.
    parents : tuple of int
        Index of the parent of each joint; -1 for the root.
    offsets_cm : ndarray, shape (J, 3)
        Offset relative to the parent; zero for the root.
    end_sites_cm : mapping of int to ndarray, shape (3,)
        End points of the joints without children, relative to the joint.
    root_translation_cm : ndarray, shape (F, 3)
        Position of the root in each of F frames.
    rotations_xyzw : ndarray, shape (F, J, 4)
        Rotation relative to the parent.
    translations_cm : mapping of int to ndarray, shape (F, 3)
        Positions, relative to the parent, of joints below the root that leave their offset; only in files of other
        programs.
    rate_guess : Message or None
        Interpretation of the frame time, if the file does not have it in seconds.
    guesses : tuple of Message
        Other guesses made because the file is contradictory or unusual.
    figures : tuple of str
        Names of the roots of all skeletons in a file with several, made unique by numbers.
    figure : str
        Name of this skeleton in `figures`.
    orders : tuple of str
        Order of each joint's rotation channels for writing; empty for Z, X, Y.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    offsets_cm: AnyFloatArray
    end_sites_cm: Mapping[int, AnyFloatArray]
    fps: Fraction
    root_translation_cm: AnyFloatArray
    rotations_xyzw: AnyFloatArray
    translations_cm: Mapping[int, AnyFloatArray] = field(default_factory=dict)
    rate_guess: Message | None = None
    guesses: tuple[Message, ...] = ()
    figures: tuple[str, ...] = ()
    figure: str = ""
    orders: tuple[str, ...] = ()
