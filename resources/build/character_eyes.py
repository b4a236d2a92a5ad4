"""Eyes of the base mesh brought to people's size, and lids that rest as open as people's.

The base mesh's eyeballs are 30 mm across, people's 24 (Bekerman 2014). A smaller ball takes their place, its front
where it was; lids and lashes go back onto it by one smooth map of the space about the eye, at rest and in every shape
of the face. Lids that hang over the iris are opened along their own way of closing; a blink still ends where it did.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from character_lids import lid_edges_m
from character_source import Source
from character_surface import triangulate

BALL_SHARE = 0.8
"""Radius of the new ball, as a share of the old one's."""
LID_OVER_PUPIL_M = 0.0042
"""Height in metres of the upper lid's edge above the centre of the pupil; nearly 2 mm of the iris are covered."""
CLOSED_SHARE = 0.88
"""Share of the source's motion that closes the eye, with a margin; all of it moves the lid over the lower one."""
NEAR_M = 0.04
"""Distance in metres from an eye beyond which vertices are unchanged."""


@dataclass(frozen=True)
class Eye:
    """One eye of the base mesh and the ball that takes its place, metres.

    Attributes
    ----------
    centre, axes : (3,) of the base mesh's ball, an ellipsoid.
    ball_centre : (3,) and ``radius``, of the new one.
    """

    centre: np.ndarray
    axes: np.ndarray
    ball_centre: np.ndarray
    radius: float

    def onto_ball(self, points: np.ndarray) -> np.ndarray:
        """Move points (N, 3) from around the old ball to the new one, with the same distance in front and the same
        sideways position.
        """
        place = points - self.centre
        above = (np.linalg.norm(place / self.axes, axis=1) - 1.0) * self.axes.mean()
        aside = np.hypot(place[:, 0], place[:, 1])
        reach = self.radius + above
        front = np.sqrt(np.maximum(reach**2 - aside**2, (0.35 * reach) ** 2))
        back = np.clip(self.ball_centre[2] + front - points[:, 2], -0.003, 0.001)
        # The corners of the lids stay: the front of the new ball is as far ahead there as they need it.
        share = _fall(above, 0.0035, 0.010) * _fall(-place[:, 2], -0.006, -0.001) * _fall(aside, 0.009, 0.013)
        return points + np.stack([np.zeros(len(points)), np.zeros(len(points)), share * back], axis=1)

    def held_off(self, points: np.ndarray, moved: np.ndarray) -> np.ndarray:
        """Move displaced points (`moved`) of lids to their former distance in front of the ball."""
        level = np.linalg.norm((points - self.centre) / self.axes, axis=1)
        place = (moved - self.centre) / self.axes
        front = self.axes[2] * np.sqrt(np.maximum(level**2 - place[:, 0] ** 2 - place[:, 1] ** 2, 0.05))
        share = _fall((level - 1.0) * self.axes.mean(), 0.004, 0.009) * _fall(-place[:, 2], -0.4, -0.1)
        depth = share * (self.centre[2] + front - moved[:, 2])
        return moved + np.stack([np.zeros(len(moved)), np.zeros(len(moved)), depth], axis=1)


def _fall(values: np.ndarray, low: float, high: float) -> np.ndarray:
    """Weight that is one up to `low` and none from `high` on."""
    share = np.clip((high - values) / (high - low), 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def with_measured_eyes(source: Source) -> Source:
    """Body with eyeballs of human size and naturally open lids."""
    for letter, side in (("l", "Left"), ("r", "Right")):
        source = _with_measured_eye(source, letter, "eyeBlink" + side)
    return source


def _with_measured_eye(source: Source, letter: str, blink: str) -> Source:
    ball = np.unique(source.groups[f"helper-{letter}-eye"].vertices)
    bone = source.bones.index(f"eye.{letter.upper()}")
    eye = _eye(source.vertices[ball], source.heads[bone])
    near = np.flatnonzero(np.linalg.norm(source.vertices - eye.centre, axis=1) < NEAR_M)
    near = np.setdiff1d(near, ball)
    points = source.vertices[near]
    closing = source.morph_deltas[source.morph_names.index(blink)][near]
    opened = _opened(source, eye, near, closing)
    rest = eye.onto_ball(opened)
    vertices, heads, tails = source.vertices.copy(), source.heads.copy(), source.tails.copy()
    vertices[near] = rest
    way = (source.vertices[ball] - eye.centre) / eye.axes
    vertices[ball] = eye.ball_centre + eye.radius * way / np.linalg.norm(way, axis=1, keepdims=True)
    tails[bone] += eye.ball_centre - heads[bone]
    heads[bone] = eye.ball_centre
    deltas = source.morph_deltas.copy()
    for row, name in enumerate(source.morph_names):
        moved = points + CLOSED_SHARE * closing if name == blink else opened + source.morph_deltas[row, near]
        deltas[row, near] = eye.onto_ball(moved) - rest
        deltas[row, ball] = 0.0
    return replace(source, vertices=vertices, heads=heads, tails=tails, morph_deltas=deltas)


def _eye(ball: np.ndarray, centre: np.ndarray) -> Eye:
    axes = np.array([np.ptp(ball[:, 0]) / 2, np.ptp(ball[:, 1]) / 2, ball[:, 2].max() - centre[2]])
    # Only the corners lie on the ball; the faces of a coarse ball are inside it.
    axes[:2] *= np.linalg.norm((ball - centre) / axes, axis=1).mean()
    radius = BALL_SHARE * float(axes[:2].mean())
    return Eye(centre, axes, centre + np.array([0.0, 0.0, axes[2] - radius]), radius)


def _opened(source: Source, eye: Eye, near: np.ndarray, closing: np.ndarray) -> np.ndarray:
    """Vertices `near` an eye with the upper lid raised to human height, against its closing motion."""
    quads = source.groups["body"].vertices
    quads = quads[np.isin(quads, near).all(axis=1)]
    triangles = triangulate(np.searchsorted(near, quads), source.vertices[near])
    points = source.vertices[near]
    low, high = 0.0, 0.5
    for _ in range(24):
        share = (low + high) / 2
        opened = eye.held_off(points, points - share * closing)
        if lid_edges_m(eye.onto_ball(opened), triangles, eye.ball_centre, eye.radius)[1] < LID_OVER_PUPIL_M:
            low = share
        else:
            high = share
    return opened
