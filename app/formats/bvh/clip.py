"""A skeleton and its motion as BVH files have them."""

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
        Joints, parents first; the first is the one root.
    parents : tuple of int
        -1 for the root.
    offsets_cm : ndarray, shape (J, 3)
        Relative to the parent; the root's is zero.
    end_sites_cm : mapping of int to ndarray, shape (3,)
        Ends of the joints that have no child.
    root_translation_cm : ndarray, shape (F, 3)
    rotations_xyzw : ndarray, shape (F, J, 4)
        Relative to the parent.
    translations_cm : mapping of int to ndarray, shape (F, 3)
        Joints below the root that are not always at their offset, relative to the parent; only in files of others.
    rate_guess : Message or None
        How the frame time of a file was understood that does not have it in seconds.
    guesses : tuple of Message
        What else had to be guessed where a file contradicts itself or the usual.
    figures : tuple of str
        Names of all skeletons of the file where it has several, this one among them: those of their roots, numbered
        where they are the same.
    figure : str
        Which of `figures` this one is.
    orders : tuple of str
        Order of each joint's rotation channels, for a file that is to be written; empty: Z, X, Y.
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
