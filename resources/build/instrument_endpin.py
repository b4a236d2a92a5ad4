"""The pin some instruments stand on the floor with: a tube at the instrument, in which a rod slides under a screw.

Pushed in, the rod's upper end lies in the tube or in the bow above it; a tall player draws it out (table ``[endpin]``
of the map).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from resources.build.instrument_keys import Keywork
from resources.build.instrument_mesh import Array, solid, turned, unit

NODE = "endpin"


@dataclass(frozen=True)
class Pin:
    """Sizes along the pin, from where it is let into the instrument downwards.

    Attributes
    ----------
    tube : tuple of float
        Where the tube begins and ends.
    tip : float
        Where the rod's tip is when it is pushed in.
    most_m : float
        How far it can be drawn out.
    kept_m : float
        How much of the rod the tube keeps then.
    tip_profile : tuple of (float, float)
        Distances behind the tip, and radii there; the last is the tip's.
    """

    tube: tuple[float, float]
    tip: float
    most_m: float
    tip_profile: tuple[tuple[float, float], ...]
    kept_m: float = 0.010
    radius: float = 0.0048
    tube_radius: float = 0.0072
    tip_material: str = "nickel_silver"

    @property
    def upper(self) -> float:
        """Return the place along the pin of the rod's upper end while the rod is pushed in, m."""
        return self.tube[1] - self.kept_m - self.most_m


def stand(work: Keywork, start: Array, axis: Array, pin: Pin, screw: Array) -> None:
    """Add tube and rod to an instrument; ``screw`` is the side of the screw."""
    axis, r = unit(axis), pin.tube_radius
    first, last = pin.tube
    tube = [
        (first, 0.8 * r), (first + 0.003, r), (last - 0.014, r), (last - 0.012, r + 0.0016), (last - 0.001, r + 0.0016),
        (last, r + 0.0006),
    ]  # fmt: skip
    work.model.add("silver", solid(start, axis, tube, sides=20))
    side = unit(screw - axis * (screw @ axis))
    shaft = [(0, 0.0022), (0.006, 0.0022), (0.006, 0.0060), (0.010, 0.0064), (0.012, 0.0056)]
    work.model.add("silver", solid(start + (last - 0.0065) * axis + r * side, side, shaft, sides=12, proxy=False))
    tip = start + pin.tip * axis
    work.model.node(NODE, tip)
    behind = pin.tip_profile[0][0]
    rod = [(pin.upper - pin.tip, pin.radius), (-behind, pin.radius)]
    work.model.add("nickel_silver", solid(tip, axis, rod, sides=14), node=NODE)
    end = [(-behind, 0.0), *((-along, radius) for along, radius in pin.tip_profile), (0.0, 0.0)]
    work.model.add(pin.tip_material, turned(tip, axis, end, sides=16), node=NODE)
    work.endpin = {"node": NODE, "axis": axis, "tip_m": np.asarray(tip), "most_m": pin.most_m}
