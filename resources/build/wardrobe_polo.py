"""A polo shirt: short sleeves with ribbed ends, turned-down collar, short row of buttons, worn over the trousers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from character_cloth import Cloth, cut, hang, hull_profile, join, smoothed, smoothstep
from character_garments import collar, front_of, move_out
from wardrobe_fitted import LAP_M, drawn_to, over_lap, weights_with
from wardrobe_pieces import MAIN, Wearer
from wardrobe_sewn import Sewn, gold, over, plain
from wardrobe_shirt import STRIP_M, closed, laid, neck_of, neck_under, untucked, without_neck
from wardrobe_tunic import buttons, ribbon

SLEEVE = 0.36
"""Length of the sleeve as a share of the arm from shoulder to wrist."""
HEM_M, HANGS_M = 0.075, 0.012
"""Depth of the hem under the hip joints, and distance of the cloth from the drape of the trunk."""
BEHIND_M = 0.016
"""Length by which the collar hides the edge of the shirt's back behind."""
RIB_M, RIB_LIFT_M = 0.022, 0.0022
BUTTONS_M = (-0.018, -0.062, -0.106)


def _hung(wearer: Wearer, cloth: Cloth) -> Cloth:
    """The shirt falling straight from the chest."""
    tailoring = wearer.tailoring
    drape = smoothed(hang(tailoring.trunk, 0.35), 2.0, 1.5)
    low = 1.0 - smoothstep(cloth.points[:, 1], tailoring.belt_m - 0.02, tailoring.armpit_m - 0.04)
    low *= np.abs(cloth.points[:, 0]) < 0.9 * tailoring.shoulder[0] + 0.05
    return replace(cloth, points=drawn_to(cloth.points, drape, np.full(len(low), HANGS_M), low))


def _loose_sleeves(wearer: Wearer, cloth: Cloth, end_m: float) -> Cloth:
    """Sleeves that stand off the arm towards their ends."""
    tailoring, points = wearer.tailoring, cloth.points.copy()
    levels = np.arange(tailoring.shoulder[0], end_m + 0.03, 0.01)
    centres = np.tile(tailoring.shoulder[[1, 2]], (len(levels), 1))
    for sign in (1.0, -1.0):
        arm = tailoring.suit.points[(tailoring.arm > 0.9) & (tailoring.suit.points[:, 0] * sign > 0)] * [sign, 1.0, 1.0]
        sleeve = smoothed(hull_profile(arm[:, 0], arm[:, [1, 2]], levels, centres, 0.016), 4.0, 1.5)
        own = points[:, 0] * sign > levels[0]
        moved = points[own] * [sign, 1.0, 1.0]
        along = smoothstep(moved[:, 0], levels[0] + 0.02, end_m)
        angle, _, _ = sleeve.polar(moved[:, 0], moved[:, [1, 2]])
        target = sleeve.radius_at(moved[:, 0], angle) + 0.006 + 0.007 * along
        points[own] = move_out(moved, sleeve, (0, 1, 2), target, along) * [sign, 1.0, 1.0]
    return replace(cloth, points=points)


def _ribs(wearer: Wearer, cloth: Cloth, end_m: float) -> Sewn:
    """Ribbed ends of the sleeves."""
    own = cut(cloth, np.abs(cloth.points[:, 0]) - (end_m - RIB_M))
    points = own.points.copy()
    off = points[:, 1:] - wearer.tailoring.shoulder[1:]
    points[:, 1:] += RIB_LIFT_M * off / np.maximum(np.linalg.norm(off, axis=1, keepdims=True), 1e-6)
    return plain(replace(own, points=points))


def polo_shirt(wearer: Wearer, legs: Cloth) -> tuple[Sewn, list[Sewn], float]:
    """The shirt over trousers, its trimmings, and the distance of its sleeves' ends from the middle of the body."""
    tailoring = wearer.tailoring
    end_m = float(tailoring.shoulder[0] + SLEEVE * (tailoring.wrist_m - tailoring.shoulder[0]))
    cloth = untucked(wearer, MAIN)
    cloth = cut(
        cloth, cloth.points[:, 1] - (float(wearer.fit.positions_t[wearer.fit.index("leftUpperLeg")][1]) - HEM_M)
    )
    cloth = cut(cloth, end_m - np.abs(cloth.points[:, 0]))
    cloth = closed(wearer, _hung(wearer, without_neck(wearer, cloth)))
    cloth = _loose_sleeves(wearer, cloth, end_m)
    sewn = laid(wearer, cloth)
    own = over(wearer, sewn.cloth, legs, tailoring.belt_m + 0.05, 0.010)
    lap = over_lap(wearer, own, legs)
    own = replace(own, weights=weights_with(wearer, own, lap, tailoring.belt_m + LAP_M))
    sewn = replace(sewn, cloth=own)
    whole, under = neck_under(wearer, own)
    front = front_of(join(own, whole.cloth))
    turned = collar(tailoring, own, front, neck_of(wearer), BEHIND_M)
    top = float(tailoring.collar_point[1]) - 0.075
    path = np.stack([np.full(24, 0.0), np.linspace(top, top - 0.15, 24)], axis=1)
    strip = ribbon(own, path, 0.014, STRIP_M)
    row = buttons(own, np.array([(0.0, top + down) for down in BUTTONS_M]), 0.0055)
    trim = [replace(plain(turned), folded=True), plain(strip), under, _ribs(wearer, own, end_m), gold(row.cloth)]
    return sewn, trim, end_m
