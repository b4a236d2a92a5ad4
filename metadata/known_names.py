"""Tables of the names that other programs give bones and morphs, and keys by which names are compared."""

from __future__ import annotations

import re
import unicodedata
from typing import Annotated, Literal, TypeAlias

import msgspec

from metadata.face_model import EmbouchureKind as EmbouchureKind
from metadata.face_model import EmbouchureWeights as EmbouchureWeights
from metadata.face_model import FaceMotion as FaceMotion
from metadata.units import AmplitudeScale as AmplitudeScale
from metadata.units import Axis as Axis
from metadata.units import Delay as Delay
from metadata.units import Fraction01 as Fraction01
from metadata.units import NotNegative as NotNegative
from metadata.units import Positive as Positive
from metadata.units import Range as Range
from metadata.units import at_amplitude as at_amplitude


def bone_key(name: str) -> str:
    """Reduce a bone's or a morph's name for comparison: no namespace, case or separators.

    Full-width digits and letters are plain ones; ``Armature|mixamorig:Left_Arm`` and ``leftarm`` are the same.
    """
    last = re.split(r"[:|]", unicodedata.normalize("NFKC", name).rstrip(":|"))[-1]
    return "".join(letter for letter in last.casefold() if letter.isalnum())


class BoneNames(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Names of the bones of a kind of character. Names are compared by `bone_key`; a prefix that all bones of a figure
    share needs no mention.

    Attributes
    ----------
    name : str
        Id; the file's name.
    title : str
        The makers or programs that name bones so.
    source : str
        Where the names are known from.
    left, right : tuple of str
        What ``{side}`` stands for.
    spine : tuple of tuple of str
        Every bone between hips and neck, upwards, each with its names; which of them are spine, chest and upper chest
        depends on how many a figure has.
    middle : dict of str to tuple of str
        Names of ``hips``, ``neck``, ``head``, ``jaw``; the first that a figure has counts.
    sides : dict of str to tuple of str
        The same for the joints of both sides, by the joint's name without its side, with ``{side}`` in each.
    """

    name: str
    title: str
    source: str
    left: Annotated[tuple[str, ...], msgspec.Meta(min_length=1)]
    right: Annotated[tuple[str, ...], msgspec.Meta(min_length=1)]
    spine: Annotated[tuple[tuple[str, ...], ...], msgspec.Meta(min_length=1)]
    middle: dict[str, tuple[str, ...]]
    sides: dict[str, tuple[str, ...]]

    def keys(self) -> dict[str, tuple[str, ...]]:
        """`bone_key` of each name, by joint; the spine's are ``spine.0``, ``spine.1`` ... upwards."""
        found = {f"spine.{index}": names for index, names in enumerate(self.spine)} | self.middle
        for side, words in (("left", self.left), ("right", self.right)):
            for joint, names in self.sides.items():
                found[side + joint] = tuple(name.replace("{side}", word) for name in names for word in words)
        return {joint: tuple(dict.fromkeys(map(bone_key, names))) for joint, names in found.items()}


def morph_key(name: str) -> str:
    """Reduce as `bone_key` does, and drop the name of a mesh or blend shape node before a dot, or ExPlus's number
    (``A14_``)."""
    return bone_key(re.sub(r"^A\d\d[_ ]", "", unicodedata.normalize("NFKC", name).rsplit(".", 1)[-1]))


Parts: TypeAlias = dict[str, Fraction01]
"""Weights of a figure's own morphs that make one shape."""


class FaceNames(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """Names of the morphs of a kind of face, and the sums of them that make ARKit's shapes.

    Attributes
    ----------
    name : str
        Id; the file's name.
    title, source : str
        As in `BoneNames`.
    of : str
        Whether the names are those of morphs or of the file's expressions.
    morphs : dict of str to tuple
        By ARKit shape the ways to make it, the best first: a name, or weights of several. A way counts where a figure
        has all that it names. Names are compared by `morph_key`.
    """

    name: str
    title: str
    source: str
    morphs: dict[str, Annotated[tuple[str | Parts, ...], msgspec.Meta(min_length=1)]]
    of: Literal["morphs", "expressions"] = "morphs"

    def ways(self, shape: str) -> tuple[Parts, ...]:
        """The ways to make a shape as weights; names as they are compared."""
        ways = ({way: 1.0} if isinstance(way, str) else way for way in self.morphs.get(shape, ()))
        return tuple({morph_key(name): weight for name, weight in way.items()} for way in ways)
