"""The face at rest: a base mesh's looks stern, so part of a smile's corners and of raised inner brows is built in.

The middle of the lips, which meets mouthpieces, stays where it is, and shapes move the face on from there.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
from character_cloth import smoothstep
from character_source import Source

AT_EASE: Final = {"mouthSmileLeft": 0.21, "mouthSmileRight": 0.21, "browInnerUp": 0.38} | {
    f"browOuterUp{side}": -0.14 for side in ("Left", "Right")
}
"""Weights of the shapes at rest: corners of the mouth 2.9 mm higher, inner ends of the brows 0.9 mm higher and outer
ones 0.3 to 0.6 mm lower.
"""
MIDDLE_M: Final = (0.014, 0.025)
"""Distances from the face's middle up to which the mouth stays and from which it moves wholly."""
BROWS: Final = "brow"
"""Shapes that move the middle of the face as well start with this."""


def at_ease(source: Source) -> Source:
    """A body whose face rests with a slightly pleasant look."""
    vertices = source.vertices.copy()
    aside = smoothstep(np.abs(vertices[:, :1]), *MIDDLE_M)
    for name, weight in AT_EASE.items():
        share = weight if name.startswith(BROWS) else weight * aside
        vertices += share * source.morph_deltas[source.morph_names.index(name)]
    return replace(source, vertices=vertices)
