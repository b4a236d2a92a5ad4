"""Clothes as geometry of their own, from the base mesh's helper suit."""

from __future__ import annotations

import numpy as np
from character_body import surface_of
from character_skeleton import SkeletonFit
from character_source import Source
from character_surface import Surface, compact


def garments(source: Source, fit: SkeletonFit) -> tuple[Surface, ...]:
    suit = surface_of(source, fit, "suit", ("helper-tights",), "suit", morphs=False)
    height = float(source.vertices[source.groups["body"].vertices, 1].max())
    triangles = suit.triangles["suit"]
    y = suit.positions[triangles][:, :, 1].mean(axis=1) / height
    parts = {"shirt": y > 0.60, "trousers": (y <= 0.60) & (y > 0.055), "shoes": y <= 0.055}
    return tuple(
        compact(Surface(**(suit.__dict__ | {"name": name, "triangles": {name: triangles[keep]}})))
        for name, keep in parts.items()
    )


def soles(shoes: Surface, fit: SkeletonFit) -> dict[str, dict[str, object]]:
    """Vertices of each shoe that stand on the floor in the T-pose."""
    t_pose = fit.to_t_pose(shoes.positions, shoes.weights)
    low = t_pose[:, 1] < t_pose[:, 1].min() + 0.008
    sides = {"left": low & (t_pose[:, 0] > 0), "right": low & (t_pose[:, 0] < 0)}
    return {side: {"mesh": shoes.name, "vertices": [int(i) for i in np.flatnonzero(flags)]} for side, flags in sides.items()}
