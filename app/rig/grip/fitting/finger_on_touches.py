"""Least-squares fit of one finger to its contacts, with the wrist and the other fingers fixed."""

from __future__ import annotations

from copy import copy

import numpy as np

from app.arrays import FloatArray, IndexArray
from app.rig.grip.finger_stations import Station
from app.rig.grip.fitting.fit_terms import GripScene
from app.rig.grip.fitting.hand_model import (
    ball_centres,
    flesh_radius,
    joint_rotations,
    skinned,
    turned,
    wrist_from_joint,
    wrist_from_mesh,
)
from app.rig.grip.fitting.hand_problem import COUPLING_RAD, HandProblem, finger_dofs
from app.rig.grip.fitting.residuals import PENETRATION_M, STEP, inside_proxy, pressure_cost
from app.rig.grip.fitting.touch_targets import TouchTarget, contact_at, nodes_at, touch_at

EXACTER = 0.3
"""Factor for the tolerance of touches after the wrist is fixed."""
ROUNDS = 12
CARRIED_SHARE = 0.1
"""Weight on a finger's joints above which skin moves with it, including webs."""
OPEN_M, OPEN_SPREAD_M = (0.007, 0.0045), (0.0005, 0.0001)
"""Distance in metres that a finger keeps from a hole to be left open, and its tolerance; the second pair is used if it
would come nearer than `LEAST_OPEN_M`.
"""
LEAST_OPEN_M = 0.0032
"""Distance in metres of a finger from a hole below which the hole would not sound open."""


class FingerOnTouches:
    """Least-squares problem of one finger at a station, for S values of its controls, with the rest of the
    hand fixed.
    """

    def __init__(
        self,
        problem: HandProblem,
        scene: GripScene,
        number: int,
        station: Station,
        values: FloatArray,
        pose: FloatArray,
        exacter: float = EXACTER,
    ) -> None:
        hand = problem.hand
        self.exacter = exacter
        dofs = [problem.dofs[i] for i in finger_dofs(problem, number)]
        self.problem, self.scene, self.number, self.values, self.pose = problem, scene, number, values, pose
        self.joints, self.kinds = np.array([dof.joint for dof in dofs]), np.array([dof.kind for dof in dofs])
        self.low, self.high = np.array([dof.low for dof in dofs]), np.array([dof.high for dof in dofs])
        self.touches = touches_at(scene, station, values)
        self.points = np.stack([hand.landmarks[t.contact.part] for t in self.touches], axis=2)
        self.normals = np.stack([hand.landmark_normals[t.contact.part] for t in self.touches], axis=2)
        self.kept_open = _kept_open(problem, scene, number, station)
        self.open_m, self.open_spread_m = OPEN_M[0], OPEN_SPREAD_M[0]
        carried = hand.all_points[1 + 3 * number : 4 + 3 * number, 3].sum(axis=0) > CARRIED_SHARE
        self.skin = np.ascontiguousarray(hand.all_points[:, :, carried])
        self.balls = np.flatnonzero(hand.ball_finger == number)
        self.radius = np.concatenate([np.zeros(self.skin.shape[2]), flesh_radius(hand)[self.balls]])
        moved = frozenset(station.controls)
        self.nodes = nodes_at(scene.model, scene.instrument_map, moved, scene.carrier, values)

    def taken(self, angles: FloatArray) -> FloatArray:
        """Return this finger's angles (..., n) from those of a hand (..., 16, 3)."""
        return angles[..., self.joints, self.kinds]

    def opening(self) -> FingerOnTouches:
        """Return the same problem with more weight on leaving holes open."""
        result = copy(self)
        result.open_m, result.open_spread_m = OPEN_M[1], OPEN_SPREAD_M[1]
        return result

    def shuts(self, x: FloatArray) -> bool:
        """Return whether a finger with angles ``x`` (S, n) closes or nearly closes a hole that must stay open."""
        pose = self.pose.copy()
        pose[:, self.joints, self.kinds] = x
        matrices = wrist_from_mesh(
            self.problem.hand, wrist_from_joint(self.problem.hand, joint_rotations(self.problem.hand, pose))
        )
        for part, hole in self.kept_open:
            at = self.scene.placed(skinned(matrices, self.problem.hand.landmarks[part][:, :, None]))[:, 0]
            if np.linalg.norm(at - hole, axis=1).min() < LEAST_OPEN_M:
                return True
        return False

    def solve(
        self, start: FloatArray, usual: FloatArray, usual_rad: float, which: IndexArray
    ) -> tuple[FloatArray, FloatArray]:
        """Solve the samples with the indices ``which``, and return the angles (S, n) and the cost (S,) of each.

        Angles begin at ``start`` and are kept near ``usual`` (S, n) with a tolerance of ``usual_rad``. Damped
        Gauss-Newton (Levenberg-Marquardt, clipped to the limits) for all samples at once, since they are independent.
        """
        x = np.clip(start, self.low, self.high)
        damping = np.full(len(which), 1e-3)
        cost, depth, slope = self._cost(x, usual, usual_rad, which)
        for _ in range(ROUNDS):
            jacobian, value = self._linear(x, usual, usual_rad, which, depth, slope)
            new = self._step(x, jacobian, value, damping)
            new_cost, new_depth, new_slope = self._cost(new, usual, usual_rad, which)
            better = new_cost < cost
            settled = np.all(np.where(better, cost - new_cost, 0.0) < 1e-6 * cost)
            x = np.where(better[:, None], new, x)
            depth = np.where(better[:, None], new_depth, depth)
            slope = np.where(better[:, None, None], new_slope, slope)
            cost = np.where(better, new_cost, cost)
            damping = np.where(better, damping * 0.3, damping * 5.0)
            if settled and better.any():
                break
        return x, cost

    def _step(self, x: FloatArray, jacobian: FloatArray, value: FloatArray, damping: FloatArray) -> FloatArray:
        down = np.einsum("smn,sm->sn", jacobian, value)
        # An angle at its limit that would be pushed further is fixed.
        free = ~(((x <= self.low) & (down > 0.0)) | ((x >= self.high) & (down < 0.0)))
        normal = np.einsum("smn,smk->snk", jacobian, jacobian) * free[:, :, None] * free[:, None, :]
        corner = np.arange(x.shape[1])
        normal[:, corner, corner] += damping[:, None] * np.einsum("sii->si", normal) + ~free + 1e-9
        stepped: FloatArray = x - np.linalg.solve(normal, (down * free)[..., None])[..., 0]
        return np.clip(stepped, self.low, self.high)

    def _cost(
        self, x: FloatArray, usual: FloatArray, usual_rad: float, which: IndexArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        smooth, skin = self._residuals(x[None], usual, usual_rad, which)
        place, turn = self.nodes
        found = [
            inside_proxy(self.problem.proxies, place[s], turn[s], skin[0, k], self.radius) for k, s in enumerate(which)
        ]
        depth, slope = np.stack([depth for depth, _ in found]), np.stack([slope for _, slope in found])
        cost = np.square(smooth[0]).sum(axis=1) + np.square(pressure_cost(depth)[0] / PENETRATION_M).sum(axis=1)
        return cost, depth, slope

    def _linear(
        self,
        x: FloatArray,
        usual: FloatArray,
        usual_rad: float,
        which: IndexArray,
        depth: FloatArray,
        slope: FloatArray,
    ) -> tuple[FloatArray, FloatArray]:
        """Return the Jacobian (S, m, n) and the m residuals (S, m) at the angles ``x``, by finite differences.

        The residuals of skin inside the instrument come from its ``depth`` and ``slope``.
        """
        count = x.shape[1]
        tried = np.repeat(x[None], count + 1, axis=0)
        step = np.where(x + STEP < self.high, STEP, -STEP).T
        tried[np.arange(1, count + 1), :, np.arange(count)] += step
        smooth, skin = self._residuals(tried, usual, usual_rad, which)
        slant = np.moveaxis((smooth[1:] - smooth[0]) / step[:, :, None], 0, 2)
        change = (skin[1:] - skin[0]) / step[:, :, None, None]
        push, rise = pressure_cost(depth)
        skin_slope = -np.einsum("nsvi,svi->svn", change, slope) * rise[..., None] / PENETRATION_M
        return (np.concatenate([slant, skin_slope], axis=1), np.concatenate([smooth[0], push / PENETRATION_M], axis=1))

    def _residuals(
        self, x: FloatArray, usual: FloatArray, usual_rad: float, which: IndexArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the residuals (B, S, m) without those of skin inside the instrument, and the skin (B, S, V, 3), for B
        sets of angles (B, S, n).
        """
        hand = self.problem.hand
        pose = np.repeat(self.pose[None, which], len(x), axis=0)
        pose[:, :, self.joints, self.kinds] = x
        transforms = wrist_from_joint(hand, joint_rotations(hand, pose.reshape(-1, 16, 3)))
        matrices = wrist_from_mesh(hand, transforms)
        scene, shape = self.scene.only(which), (len(x), len(which), -1, 3)
        flesh = np.concatenate([skinned(matrices, self.skin), ball_centres(hand, transforms)[:, self.balls]], axis=1)
        at = scene.placed(skinned(matrices, self.points).reshape(shape))
        facing = scene.turned(turned(matrices, self.normals).reshape(shape))
        parts = [(x - usual) / usual_rad]
        if self.number:
            parts.append(((x[..., 3] - 0.67 * x[..., 2]) / COUPLING_RAD)[..., None])
        for k, touch in enumerate(self.touches):
            active = touch.active[which, None].astype(np.float64)
            off = (at[:, :, k] - touch.positions[which]) / touch.spread_m[which, None]
            parts.append(off / self.exacter * active)
            turn = (facing[:, :, k] + touch.normals[which]) / touch.spread_normal[which, None]
            parts.append(turn * active)
        for part, hole in self.kept_open:
            near = scene.placed(skinned(matrices, hand.landmarks[part][:, :, None]).reshape(shape))[:, :, 0] - hole
            gap = np.sqrt(np.einsum("nsi,nsi->ns", near, near))
            parts.append((np.maximum(self.open_m - gap, 0.0) / self.open_spread_m)[..., None])
        return np.concatenate(parts, axis=2), scene.placed(flesh.reshape(shape))


def _kept_open(problem: HandProblem, scene: GripScene, number: int, station: Station) -> list[tuple[str, FloatArray]]:
    """Return the holes that a finger must leave open at a station because it closes them at another one: name of the
    part of the finger, and position (3,) of the hole.
    """
    instrument, found = scene.instrument_map, []
    for place in problem.stations[number]:
        for contact in (instrument.contacts[index] for index in place.contacts):
            hole = None if contact.control in (None, *station.controls) else instrument.control(contact.control or "")
            if hole is not None and hole.kind == "hole":
                at, _ = contact_at(scene.model, instrument, contact, frozenset(), None, np.zeros(1))
                found.append((contact.part, at[0]))
    return found


def touches_at(scene: GripScene, station: Station, values: FloatArray) -> list[TouchTarget]:
    """Return the contacts that a finger must touch at a station, for values of its controls."""
    instrument, moved = scene.instrument_map, frozenset(station.controls)
    return [
        touch_at(scene.model, instrument, instrument.contacts[index], moved, scene.carrier, values)
        for index in station.contacts
    ]
