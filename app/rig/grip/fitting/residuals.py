"""Residuals of a hand's grip and their Jacobian.

All perturbed poses of a Jacobian are computed in one vectorised call; distances to the proxy are exact at the current
pose and linearised by the gradient.
"""

from __future__ import annotations

import numpy as np

from app.arrays import FloatArray
from app.rig import quaternion
from app.rig.grip.fitting.arm_problem import arm_residuals, elbow_place
from app.rig.grip.fitting.hand_model import (
    ball_centres,
    flesh_radius,
    joint_rotations,
    skinned,
    turned,
    wrist_from_joint,
    wrist_from_mesh,
)
from app.rig.grip.fitting.hand_problem import (
    COUPLING_RAD,
    METRES,
    Elsewhere,
    HandProblem,
    finger_dofs,
    joint_angles,
    worked_dofs,
    wrist_transform,
)
from app.rig.grip.instrument_proxy import Bodies, InstrumentNodes, gradient, inside

# Deviations that give a residual of one.
PENETRATION_M, FOREARM_M = 0.0005, 0.003
BALL_M = 0.001
GIVE_M, STIFFENING = 0.0019, 5.0
WORKED_RAD = 0.5
SEED_M, SEED_RAD = 0.03, 0.4
STEP = 1e-6
ELSEWHERE_M, ELSEWHERE_NORMAL, ELSEWHERE_RELAXED = 0.006, 0.7, 1.5
"""Scales of the terms for other stations: the wrist is near a position from which fingers reach these too; it is offset
for those that miss (`app.rig.grip.fitting.leaning_hand`).
"""


class Residuals:
    """Residuals and their Jacobian. Distances to the instrument at the last pose are cached, since both need them."""

    def __init__(self, problem: HandProblem, soft: float, stiff: bool = False) -> None:
        self.problem = problem
        self.soft = soft
        self.stiff = stiff
        hand = problem.hand
        self.skin = hand.all_points if stiff else hand.skin_points
        counts = [self.skin.shape[2], len(hand.balls), len(hand.forearm_balls)]
        self.radius = np.concatenate([np.zeros(counts[0]), flesh_radius(hand)])
        self.spread = soft * np.repeat([PENETRATION_M, PENETRATION_M, FOREARM_M], counts)

    def __call__(self, x: FloatArray) -> FloatArray:
        smooth, skin = self._parts(x[None])
        depth, _ = self._depth(skin[0])
        others = [self._elsewhere(one, x[None])[0] for one in self.problem.elsewhere]
        return np.concatenate([smooth[0], (self._counted(depth)[0] / self.spread).ravel(), *others])

    def jacobian(self, x: FloatArray) -> FloatArray:
        count = len(x) if not self.problem.elsewhere else self.problem.elsewhere[0].angles.start
        tried = np.repeat(x[None], count + 1, axis=0)
        step = np.where(x + STEP < self.problem.high, STEP, -STEP)
        tried[np.arange(1, count + 1), np.arange(count)] += step[:count]
        smooth, skin = self._parts(tried)
        depth, slope = self._depth(skin[0])
        change = (skin[1:] - skin[0]) / step[:count, None, None, None]
        moved = -np.einsum("xcvi,cvi->xcv", change, slope) * self._counted(depth)[1] / self.spread
        home = np.concatenate([(smooth[1:] - smooth[0]) / step[:count, None], moved.reshape(count, -1)], axis=1).T
        if not self.problem.elsewhere:
            return home
        blocks = [self._elsewhere_jacobian(one, x, step) for one in self.problem.elsewhere]
        return np.concatenate([np.pad(home, ((0, 0), (0, len(x) - count))), *blocks])

    def _elsewhere_jacobian(self, one: Elsewhere, x: FloatArray, step: FloatArray) -> FloatArray:
        """Return the rows of the Jacobian for one finger at another station than home. They depend only on the wrist
        (first six columns) and that finger's angles.
        """
        columns = np.r_[0:6, one.angles]
        tried = np.repeat(x[None], len(columns) + 1, axis=0)
        tried[np.arange(1, len(tried)), columns] += step[columns]
        found = self._elsewhere(one, tried)
        result = np.zeros((found.shape[1], len(x)))
        result[:, columns] = ((found[1:] - found[0]) / step[columns, None]).T
        return result

    def _elsewhere(self, one: Elsewhere, x: FloatArray) -> FloatArray:
        """Return the m residuals (B, m) of a finger at another station for B candidates."""
        problem, hand = self.problem, self.problem.hand
        place, turn = wrist_transform(problem, x)
        angles = np.zeros((len(x), 16, 3))
        dofs = [problem.dofs[i] for i in finger_dofs(problem, one.number)]
        now = x[:, one.angles]
        angles[:, [dof.joint for dof in dofs], [dof.kind for dof in dofs]] = now
        matrices = wrist_from_mesh(hand, wrist_from_joint(hand, joint_rotations(hand, angles)))
        basis = quaternion.to_matrix(turn)
        at = np.einsum("bij,bvj->bvi", basis, skinned(matrices, one.points)) + place[:, None]
        facing = np.einsum("bij,bvj->bvi", basis, turned(matrices, one.normals))
        relaxed = np.array([(dof.relaxed, dof.spread * ELSEWHERE_RELAXED) for dof in dofs]).T
        parts = [(now - relaxed[0]) / relaxed[1]]
        if one.number:
            parts.append(((now[:, 3] - 0.67 * now[:, 2]) / COUPLING_RAD)[:, None])
        for number, touch in enumerate(one.touches):
            parts.append((at[:, number] - touch.positions[0]) / (ELSEWHERE_M * self.soft))
            parts.append((facing[:, number] + touch.normals[0]) / ELSEWHERE_NORMAL)
        return np.concatenate(parts, axis=1)

    def _counted(self, depth: FloatArray) -> tuple[FloatArray, FloatArray]:
        return pressure_cost(depth) if self.stiff else (depth, (depth > 0.0).astype(np.float64))

    def _depth(self, skin: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the depth (configs, V) of V skin vertices below the surface of the instrument's bodies, and the
        gradient of the distance."""
        depth, slope = np.zeros(skin.shape[:2]), np.zeros(skin.shape)
        for config in range(len(skin)):
            depth[config], slope[config] = inside_proxy(
                self.problem.proxies,
                self.problem.node_place[config],
                self.problem.node_turn[config],
                skin[config],
                self.radius,
            )
        return depth, slope

    def _parts(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return for B candidates the m residuals (B, m) without those of skin inside the instrument, and the skin and
        balls (B, configs, V, 3) in the instrument's frame.
        """
        problem, hand = self.problem, self.problem.hand
        place, turn = wrist_transform(problem, x)
        angles = joint_angles(problem, x)
        count = len(x)
        transforms = wrist_from_joint(hand, joint_rotations(hand, angles.reshape(-1, 16, 3)))
        matrices = wrist_from_mesh(hand, transforms)
        basis = quaternion.to_matrix(turn)

        def placed(points: FloatArray) -> FloatArray:
            local = points.reshape(count, problem.configs, -1, 3)
            moved: FloatArray = np.einsum("bij,bcvj->bcvi", basis, local) + place[:, None, None]
            return moved

        skin = placed(skinned(matrices, self.skin))
        touching = placed(skinned(matrices, problem.touch_points))
        facing = np.einsum(
            "bij,bcvj->bcvi", basis, turned(matrices, problem.touch_normals).reshape(count, problem.configs, -1, 3)
        )
        parts = []
        for number, touch in enumerate(problem.touches):
            for config in range(problem.configs):
                if touch.active[config]:
                    off = touching[:, config, number] - touch.positions[config]
                    parts.append(off / (touch.spread_m[config] * self.soft))
                    parts.append((facing[:, config, number] + touch.normals[config]) / touch.spread_normal[config])
        balls = ball_centres(hand, transforms)
        skin = np.concatenate([skin, placed(balls), self._forearm(x, place)], axis=2)
        pairs = balls[:, hand.ball_pairs[:, 0]] - balls[:, hand.ball_pairs[:, 1]]
        gap = np.sqrt(np.einsum("bki,bki->bk", pairs, pairs))
        parts.append((np.maximum(hand.ball_gaps_m - gap, 0.0) / (BALL_M * self.soft)).reshape(count, -1))
        parts.append(self._natural(angles))
        parts.append(arm_residuals(problem, x[:, 6], place, turn))
        parts.append(self._anchored(x))
        return np.concatenate(parts, axis=1), skin

    def _forearm(self, x: FloatArray, place: FloatArray) -> FloatArray:
        """Return the centres of the forearm's C balls (B, configs, C, 3) in the instrument's frame for the parameters
        ``x`` of B candidates, whose wrists are at ``place`` (B, 3).
        """
        wrist = place + self.problem.reference_shift_m
        behind = elbow_place(self.problem, wrist, x[:, 6], self.problem.shoulder_m) - wrist
        behind /= np.linalg.norm(behind, axis=1)[:, None]
        balls = place[:, None] + behind[:, None] * self.problem.hand.forearm_balls[:, :1]
        return np.repeat(balls[:, None], self.problem.configs, axis=1)

    def _natural(self, angles: FloatArray) -> FloatArray:
        problem = self.problem
        parts = []
        for config in range(problem.configs):
            order = range(len(problem.dofs)) if config == 0 else worked_dofs(problem)
            for i in order:
                dof = problem.dofs[i]
                now = angles[:, config, dof.joint, dof.kind]
                parts.append((now - dof.relaxed) / dof.spread)
                if config:
                    parts.append((now - angles[:, 0, dof.joint, dof.kind]) / WORKED_RAD)
            for number in range(1, 5) if config == 0 else [n for n in problem.worked if n]:
                # The last two joints of a finger bend together (about 2 to 3).
                middle, last = angles[:, config, 2 + 3 * number, 0], angles[:, config, 3 + 3 * number, 0]
                parts.append((last - 0.67 * middle) / COUPLING_RAD)
        return np.stack(parts, axis=1)

    def _anchored(self, x: FloatArray) -> FloatArray:
        """Return the residuals (B, m) that keep a hand near its seed, or, for a hand moved by a control, near the
        solution at the neighbouring value.
        """
        if self.problem.anchor is None:
            off: FloatArray = x[:, :6] / np.repeat([SEED_M / METRES, SEED_RAD], 3)
        else:
            place, turn, finger = self.problem.anchor_spread
            off = (x - self.problem.anchor) / ([place] * 3 + [turn] * 3 + [0.01] + [finger] * (x.shape[1] - 7))
        return off


def pressure_cost(depth: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the cost of a depth of skin in the instrument, and its derivative: flesh yields a little, then resists."""
    deep = depth > GIVE_M
    return depth + (STIFFENING - 1.0) * np.maximum(depth - GIVE_M, 0.0), np.where(deep, STIFFENING, depth > 0.0)


def inside_proxy(
    proxies: Bodies, node_place: FloatArray, node_turn: FloatArray, skin: FloatArray, radius: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the depth (V,) of V balls at (V, 3) below the surface of the instrument's bodies, 0 outside, and the
    gradient (V, 3) of the distance."""
    nodes = InstrumentNodes(node_place, node_turn)
    depth, owner = inside(proxies, nodes, skin, radius)
    hit = np.flatnonzero(owner >= 0)
    slope = np.zeros(skin.shape)
    if len(hit):
        slope[hit] = gradient(proxies, nodes, skin[hit], owner[hit])
    return depth, slope
