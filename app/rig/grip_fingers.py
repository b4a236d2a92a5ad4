"""The fingers between the ends of their controls, solved with the wrist held, and the finished hold measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from app.rig import quaternion
from app.rig.grip_problem import COUPLING_RAD, Problem, contact_at, finger_dofs, nodes_at
from app.rig.grip_residuals import PENETRATION_M, STEP, WORKED_RAD, inside_proxy, pressed
from app.rig.hand import (
    FINGERS,
    ball_centres,
    flesh_radius,
    joint_rotations,
    skinned,
    turned,
    wrist_from_joint,
    wrist_from_mesh,
)
from app.rig.hold import ContactFit, FingerTable, interpolated
from app.rig.model import InstrumentModel
from instrument_maps.model import Contact, Control, InstrumentMap

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.intp]

EXACTER = 0.3
"""With the wrist held, touches are met this much more exactly than in the search."""
ROUNDS = 12

CARRIED_SHARE = 0.1
"""Skin with at least this weight on a finger's joints moves with it: webs too."""
FOLLOW_RAD = 0.15
"""How far angles wander from one sample to the next."""
SMOOTH_DEGREE = 3
SMOOTH_RAD = 0.04
"""How far a sample's angles wander from the smooth path over the control."""


@dataclass(frozen=True, eq=False)
class Scene:
    """A solved wrist on its instrument."""

    model: InstrumentModel
    instrument_map: InstrumentMap
    carrier: Control | None
    position_m: FloatArray
    basis: FloatArray

    def placed(self, points: FloatArray) -> FloatArray:
        """Take points (..., S, V, 3) of the wrist's frame to the instrument's, sample by sample."""
        return points @ self.basis.transpose(0, 2, 1) + self.position_m[:, None]

    def turned(self, vectors: FloatArray) -> FloatArray:
        """Likewise for directions."""
        return vectors @ self.basis.transpose(0, 2, 1)

    def only(self, which: IntArray) -> Scene:
        """The scene at some of its samples."""
        return replace(self, position_m=self.position_m[which], basis=self.basis[which])

    def mover(self, contact: Contact) -> Control | None:
        """The control that moves a contact against the wrist."""
        for control in self.instrument_map.controls:
            if control.node == contact.node and control is not self.carrier:
                return control
        return None


def solve_table(problem: Problem, scene: Scene, angles: FloatArray, values: FloatArray) -> FloatArray:
    """Solve the fingers at each value of their controls, the wrist held: angles (S, 16, 3), from (S, configs, 16, 3).

    A finger has more joints than a touch needs, so samples solved apart may fall into different bends and the finger
    would twitch. Each is followed from one end of the control to the other, from both ends, solved again about a smooth
    path, and the better of the two kept.
    """
    solved = angles[:, 0].copy()
    for number in range(5):
        if not any(touch.contact.part.split(".")[1] == FINGERS[number] for touch in problem.touches):
            continue
        moves = scene.carrier is not None or number in problem.worked
        finger = _Finger(problem, scene, number, values if moves else values[:1], solved)
        first, last = finger.taken(angles[0, 0]), finger.taken(angles[-1, -1 if number in problem.worked else 0])
        if moves:
            tries = [_followed(finger, first, range(len(values))), _followed(finger, last, range(len(values))[::-1])]
            found = min(tries, key=lambda one: one[1])[0]
        else:
            found, _ = finger.solve(first[None], first[None], WORKED_RAD, np.arange(1))
        solved[:, finger.joints, finger.kinds] = found
    return solved


def _followed(finger: _Finger, start: FloatArray, order: Sequence[int]) -> tuple[FloatArray, float]:
    """Angles (S, n) of a finger followed from one sample to the next, then smoothed, and what they cost."""
    found = np.zeros((len(order), len(start)))
    here = start
    for sample in order:
        here = finger.solve(here[None], here[None], FOLLOW_RAD, np.array([sample]))[0][0]
        found[sample] = here
    everywhere = np.arange(len(order))
    cost = np.zeros(len(order))
    powers = np.vander(finger.values, SMOOTH_DEGREE + 1)
    for _ in range(2):
        path = powers @ np.linalg.lstsq(powers, found, rcond=None)[0]
        found, cost = finger.solve(path, path, SMOOTH_RAD, everywhere)
    return found, float(cost.sum())


class _Finger:
    """One finger on its touches at some values of the controls, the rest of the hand held."""

    def __init__(self, problem: Problem, scene: Scene, number: int, values: FloatArray, pose: FloatArray) -> None:
        hand = problem.hand
        dofs = [problem.dofs[i] for i in finger_dofs(problem, number)]
        touches = [t for t in problem.touches if t.contact.part.split(".")[1] == FINGERS[number]]
        self.problem, self.scene, self.number, self.values, self.pose = problem, scene, number, values, pose
        self.joints, self.kinds = np.array([dof.joint for dof in dofs]), np.array([dof.kind for dof in dofs])
        self.low, self.high = np.array([dof.low for dof in dofs]), np.array([dof.high for dof in dofs])
        self.touches = touches
        self.ends = [contact_at(scene.model, t.contact, scene.mover(t.contact), values) for t in touches]
        self.active = [_active(t.contact, values).astype(np.float64) for t in touches]
        self.points = np.stack([hand.landmarks[t.contact.part] for t in touches], axis=2)
        self.normals = np.stack([hand.landmark_normals[t.contact.part] for t in touches], axis=2)
        carried = hand.all_points[1 + 3 * number : 4 + 3 * number, 3].sum(axis=0) > CARRIED_SHARE
        self.skin = np.ascontiguousarray(hand.all_points[:, :, carried])
        self.balls = np.flatnonzero(hand.ball_finger == number)
        self.radius = np.concatenate([np.zeros(self.skin.shape[2]), flesh_radius(hand)[self.balls]])
        self.nodes = nodes_at(scene.model, scene.instrument_map, hand.side, scene.carrier, values)

    def taken(self, angles: FloatArray) -> FloatArray:
        """This finger's angles (..., n) out of those of a hand (..., 16, 3)."""
        return angles[..., self.joints, self.kinds]

    def solve(
        self, start: FloatArray, usual: FloatArray, usual_rad: float, which: IntArray
    ) -> tuple[FloatArray, FloatArray]:
        """Solve some samples about usual angles; both (S, n). Returns the angles and the cost (S,) of each.

        Damped Gauss-Newton (Levenberg-Marquardt, clipped to the limits), all samples at once: they are independent,
        so their normal equations are solved as a batch.
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
        # An angle at its limit that would be pushed further stays.
        free = ~(((x <= self.low) & (down > 0.0)) | ((x >= self.high) & (down < 0.0)))
        normal = np.einsum("smn,smk->snk", jacobian, jacobian) * free[:, :, None] * free[:, None, :]
        corner = np.arange(x.shape[1])
        normal[:, corner, corner] += damping[:, None] * np.einsum("sii->si", normal) + ~free + 1e-9
        stepped: FloatArray = x - np.linalg.solve(normal, (down * free)[..., None])[..., 0]
        return np.clip(stepped, self.low, self.high)

    def _cost(
        self, x: FloatArray, usual: FloatArray, usual_rad: float, which: IntArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        smooth, skin = self._residuals(x[None], usual, usual_rad, which)
        place, turn = self.nodes
        found = [
            inside_proxy(self.problem.proxies, place[s], turn[s], skin[0, k], self.radius) for k, s in enumerate(which)
        ]
        depth, slope = np.stack([depth for depth, _ in found]), np.stack([slope for _, slope in found])
        cost = np.square(smooth[0]).sum(axis=1) + np.square(pressed(depth)[0] / PENETRATION_M).sum(axis=1)
        return cost, depth, slope

    def _linear(
        self, x: FloatArray, usual: FloatArray, usual_rad: float, which: IntArray, depth: FloatArray, slope: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Jacobian (S, m, n) and residuals (S, m)."""
        count = x.shape[1]
        tried = np.repeat(x[None], count + 1, axis=0)
        step = np.where(x + STEP < self.high, STEP, -STEP).T
        tried[np.arange(1, count + 1), :, np.arange(count)] += step
        smooth, skin = self._residuals(tried, usual, usual_rad, which)
        slant = np.moveaxis((smooth[1:] - smooth[0]) / step[:, :, None], 0, 2)
        change = (skin[1:] - skin[0]) / step[:, :, None, None]
        push, rise = pressed(depth)
        skin_slope = -np.einsum("nsvi,svi->svn", change, slope) * rise[..., None] / PENETRATION_M
        return (
            np.concatenate([slant, skin_slope], axis=1),
            np.concatenate([smooth[0], push / PENETRATION_M], axis=1),
        )

    def _residuals(
        self, x: FloatArray, usual: FloatArray, usual_rad: float, which: IntArray
    ) -> tuple[FloatArray, FloatArray]:
        """Residuals (B, S, m) without the proxy's, and skin (B, S, V, 3), for angles (B, S, n)."""
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
            (place, normal), active = self.ends[k], self.active[k][which, None]
            parts.append((at[:, :, k] - place[which]) / (touch.spread_m * EXACTER) * active)
            parts.append((facing[:, :, k] + normal[which]) / touch.spread_normal * active)
        return np.concatenate(parts, axis=2), scene.placed(flesh.reshape(shape))


def _active(contact: Contact, values: FloatArray) -> npt.NDArray[np.bool_]:
    """At which values of its control a contact counts."""
    if contact.when == "pressed":
        return values > 0.0
    return values == 0.0 if contact.when == "released" else values >= 0.0


def finger_table(problem: Problem, scene: Scene, rotations: FloatArray, values: FloatArray, number: int) -> FingerTable:
    name = f"{problem.hand.side}.{FINGERS[number]}"
    places = slice(1 + 3 * number, 4 + 3 * number)
    control = next((c.name for c in scene.instrument_map.controls if c.finger == name), None)
    if control is None and scene.carrier is not None:
        control = scene.carrier.name
    rows = rotations[:, places] if control is not None else rotations[:1, places]
    return FingerTable(name, control, values if control is not None else np.zeros(1), problem.hand.joints[places], rows)


def judge(
    problem: Problem, scene: Scene, fingers: tuple[FingerTable, ...], values: FloatArray
) -> tuple[tuple[ContactFit, ...], float]:
    """Measure the hold over all its samples and half way between them, on the whole skin of the hand."""
    hand = problem.hand
    fine = np.linspace(0.0, 1.0, 2 * len(values) - 1) if len(values) > 1 else values
    rotations = np.tile(quaternion.IDENTITY, (len(fine), 16, 1))
    for number, table in enumerate(fingers):
        rotations[:, 1 + 3 * number : 4 + 3 * number] = interpolated(table.values, table.rotations, fine)
    between = np.interp(fine, values, np.arange(len(values), dtype=np.float64))
    low = np.minimum(between.astype(np.intp), max(len(values) - 2, 0))
    high, share = np.minimum(low + 1, len(values) - 1), (between - low)[:, None]
    turn = quaternion.to_matrix(interpolated(values, quaternion.from_matrix(scene.basis)[:, None], fine)[:, 0])
    scene = replace(
        scene, position_m=scene.position_m[low] * (1.0 - share) + scene.position_m[high] * share, basis=turn
    )
    transforms = wrist_from_joint(hand, rotations)
    matrices = wrist_from_mesh(hand, transforms)
    touching = scene.placed(skinned(matrices, problem.touch_points))
    facing = scene.turned(turned(matrices, problem.touch_normals))
    contacts = []
    for number, touch in enumerate(problem.touches):
        at, normal = contact_at(scene.model, touch.contact, scene.mover(touch.contact), fine)
        off = np.linalg.norm(touching[:, number] - at, axis=1)
        angle = np.arccos(np.clip(-np.einsum("si,si->s", facing[:, number], normal), -1.0, 1.0))
        counts = _active(touch.contact, fine)
        contact = touch.contact
        contacts.append(
            ContactFit(
                contact.part, contact.node, contact.control, contact.grip == "firm",
                float(off[counts].max(initial=0.0)), float(angle[counts].max(initial=0.0)),
            )
        )  # fmt: skip
    place, turn = nodes_at(scene.model, scene.instrument_map, hand.side, scene.carrier, fine)
    flesh = np.concatenate([skinned(matrices, hand.all_points), ball_centres(hand, transforms)], axis=1)
    skin = scene.placed(flesh)
    radius = np.concatenate([np.zeros(hand.all_points.shape[2]), flesh_radius(hand)[: len(hand.balls)]])
    depth = max(
        float(inside_proxy(problem.proxies, place[s], turn[s], skin[s], radius)[0].max()) for s in range(len(fine))
    )
    return tuple(contacts), depth
