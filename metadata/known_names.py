"""Tables of other programs' names for bones and morphs, and keys for comparing names."""

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
    """Return a bone's or morph's name reduced for comparison: without namespace, case and separators.

    Full-width digits and letters become plain ones; ``Armature|mixamorig:Left_Arm`` and ``leftarm`` are equal.
    """
    last = re.split(r"[:|]", unicodedata.normalize("NFKC", name).rstrip(":|"))[-1]
    return "".join(letter for letter in last.casefold() if letter.isalnum())


class BoneNames(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Names of the bones of a kind of character. Names are compared by `bone_key`; a prefix common to all bones of a
    figure is ignored.

    Attributes
    ----------
    name : str
        Id, equal to the file name.
    title : str
        Programs that use these names.
    source : str
        Source of the names.
    left, right : tuple of str
        Texts for which ``{side}`` stands in the names.
    spine : tuple of tuple of str
        Names of every bone between hips and neck, upwards; their number in a figure determines which are spine, chest
        and upper chest.
    middle : dict of str to tuple of str
        Names of ``hips``, ``neck``, ``head``, ``jaw``; the first that a figure has is used.
    sides : dict of str to tuple of str
        Names of the joints of both sides, by the joint's name without its side, with ``{side}`` in each.
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
        """Return for each joint the `bone_key` of its possible names; the spine's bones are ``spine.0``, ``spine.1``
        and so on upwards.
        """
        found = {f"spine.{index}": names for index, names in enumerate(self.spine)} | self.middle
        for side, words in (("left", self.left), ("right", self.right)):
            for joint, names in self.sides.items():
                found[side + joint] = tuple(name.replace("{side}", word) for name in names for word in words)
        return {joint: tuple(dict.fromkeys(map(bone_key, names))) for joint, names in found.items()}


def morph_key(name: str) -> str:
    """Return a morph's name reduced for comparison: as `bone_key` does, without the name of a mesh or blend shape node
    before a dot, and without ExPlus's number (``A14_``).
    """
    return bone_key(re.sub(r"^A\d\d[_ ]", "", unicodedata.normalize("NFKC", name).rsplit(".", 1)[-1]))


Parts: TypeAlias = dict[str, Fraction01]
"""Weights of a figure's morphs that produce one shape."""


class FaceNames(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """Names of the morphs of a kind of face, and their sums that produce ARKit's shapes.

    Attributes
    ----------
    name : str
        Id, equal to the file name.
    title, source : str
        As in `BoneNames`.
    of : str
        Whether the names are those of morphs or of the file's expressions.
    morphs : dict of str to tuple
        Alternatives for each ARKit shape, best first: a name, or weights of several. An alternative applies if a figure
        has all its names. Names are compared by `morph_key`.
    """

    name: str
    title: str
    source: str
    morphs: dict[str, Annotated[tuple[str | Parts, ...], msgspec.Meta(min_length=1)]]
    of: Literal["morphs", "expressions"] = "morphs"

    def ways(self, shape: str) -> tuple[Parts, ...]:
        """Return the alternatives for an ARKit shape, best first, each as weights by `morph_key`."""
        ways = ({way: 1.0} if isinstance(way, str) else way for way in self.morphs.get(shape, ()))
        return tuple({morph_key(name): weight for name, weight in way.items()} for way in ways)
