"""The fingers between the ends of their controls, solved with the wrist held, and the finished hold measured."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from app.rig import quaternion
from app.rig.grip_problem import COUPLING_RAD, Problem, Touch, contact_at, finger_dofs, nodes_at
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

CARRIED_SHARE = 0.1
"""Skin with at least this weight on a finger's joints moves with it: webs too."""
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

    def mover(self, contact: Contact) -> Control | None:
        """The control that moves a contact against the wrist."""
        for control in self.instrument_map.controls:
            if control.node == contact.node and control is not self.carrier:
                return control
        return None


def solve_table(problem: Problem, scene: Scene, angles: FloatArray, values: FloatArray) -> FloatArray:
    """Solve the fingers at each value of their controls, the wrist held: angles (S, 16, 3), from (S, configs, 16, 3).

    One damped Gauss-Newton iteration (Levenberg-Marquardt, clipped to the limits) for all values at once: the
    samples are independent, their normal equations are solved as a batch.
    """
    first, last = angles[:, 0], angles[:, -1]
    usual = first + (last - first) * values[:, None, None]
    solved = usual.copy()
    place, turn = nodes_at(scene.model, scene.instrument_map, problem.hand.side, scene.carrier, values)
    for number in range(5):
        mine = [t for t in problem.touches if t.contact.part.split(".")[1] == FINGERS[number]]
        if not mine:
            continue
        _solve_finger(problem, scene, solved, usual, WORKED_RAD, values, number, mine, place, turn)
        # Samples that fell into different bends of one finger would make it twitch: solve again about a smooth path.
        for _ in range(2 if len(values) > SMOOTH_DEGREE + 1 else 0):
            flat = solved.reshape(len(values), -1)
            powers = np.vander(values, SMOOTH_DEGREE + 1)
            usual = (powers @ np.linalg.lstsq(powers, flat, rcond=None)[0]).reshape(solved.shape)
            solved[:, 1 + 3 * number : 4 + 3 * number] = usual[:, 1 + 3 * number : 4 + 3 * number]
            _solve_finger(problem, scene, solved, usual, SMOOTH_RAD, values, number, mine, place, turn)
    return solved


def _solve_finger(
    problem: Problem,
    scene: Scene,
    solved: FloatArray,
    usual: FloatArray,
    usual_rad: float,
    values: FloatArray,
    number: int,
    touches: list[Touch],
    node_place: FloatArray,
    node_turn: FloatArray,
) -> None:
    hand = problem.hand
    dofs = [problem.dofs[i] for i in finger_dofs(problem, number)]
    joints, kinds = np.array([dof.joint for dof in dofs]), np.array([dof.kind for dof in dofs])
    low, high = np.array([dof.low for dof in dofs]), np.array([dof.high for dof in dofs])
    ends = [contact_at(scene.model, t.contact, scene.mover(t.contact), values) for t in touches]
    active = [
        np.where(
            (t.contact.when == "pressed") & (values == 0.0) | (t.contact.when == "released") & (values > 0.0), 0.0, 1.0
        )
        for t in touches
    ]
    points = np.stack([hand.landmarks[t.contact.part] for t in touches], axis=2)
    normals = np.stack([hand.landmark_normals[t.contact.part] for t in touches], axis=2)
    carried = hand.all_points[1 + 3 * number : 4 + 3 * number, 3].sum(axis=0) > CARRIED_SHARE
    skin_points = np.ascontiguousarray(hand.all_points[:, :, carried])
    own = np.flatnonzero(hand.ball_finger == number)
    radius = np.concatenate([np.zeros(skin_points.shape[2]), flesh_radius(hand)[own]])
    samples, count = len(values), len(dofs)

    def residuals(x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Residuals (B, S, m) without the proxy's, and skin (B, S, V, 3), for angles (B, S, n)."""
        pose = np.repeat(solved[None], len(x), axis=0)
        pose[:, :, joints, kinds] = x
        transforms = wrist_from_joint(hand, joint_rotations(hand, pose.reshape(-1, 16, 3)))
        matrices = wrist_from_mesh(hand, transforms)
        shape = (len(x), samples, -1, 3)
        flesh = np.concatenate([skinned(matrices, skin_points), ball_centres(hand, transforms)[:, own]], axis=1)
        skin = scene.placed(flesh.reshape(shape))
        at = scene.placed(skinned(matrices, points).reshape(shape))
        facing = scene.turned(turned(matrices, normals).reshape(shape))
        parts = [(x - usual[:, joints, kinds]) / usual_rad]
        if number:
            parts.append(((x[..., 3] - 0.67 * x[..., 2]) / COUPLING_RAD)[..., None])
        for k, touch in enumerate(touches):
            parts.append((at[:, :, k] - ends[k][0]) / (touch.spread_m * 0.3) * active[k][:, None])
            parts.append((facing[:, :, k] + ends[k][1]) / touch.spread_normal * active[k][:, None])
        return np.concatenate(parts, axis=2), skin

    def depths(skin: FloatArray) -> tuple[FloatArray, FloatArray]:
        found = [inside_proxy(problem.proxies, node_place[s], node_turn[s], skin[s], radius) for s in range(samples)]
        return np.stack([depth for depth, _ in found]), np.stack([slope for _, slope in found])

    x = np.clip(solved[:, joints, kinds], low, high)
    damping = np.full(samples, 1e-3)
    smooth, skin = residuals(x[None])
    depth, slope = depths(skin[0])
    cost = (smooth[0] ** 2).sum(axis=1) + ((pressed(depth)[0] / PENETRATION_M) ** 2).sum(axis=1)
    for _ in range(12):
        tried = np.repeat(x[None], count + 1, axis=0)
        step = np.where(x + STEP < high, STEP, -STEP)
        for i in range(count):
            tried[i + 1, :, i] += step[:, i]
        smooth, skin = residuals(tried)
        slant = np.moveaxis((smooth[1:] - smooth[0]) / step.T[:, :, None], 0, 2)
        change = (skin[1:] - skin[0]) / step.T[:, :, None, None]
        push, rise = pressed(depth)
        skin_slope = -np.einsum("nsvi,svi->svn", change, slope) * rise[..., None] / PENETRATION_M
        jacobian = np.concatenate([slant, skin_slope], axis=1)
        value = np.concatenate([smooth[0], push / PENETRATION_M], axis=1)
        down = np.einsum("smn,sm->sn", jacobian, value)
        # An angle at its limit that would be pushed further stays.
        free = ~(((x <= low) & (down > 0.0)) | ((x >= high) & (down < 0.0)))
        normal = np.einsum("smn,smk->snk", jacobian, jacobian) * free[:, :, None] * free[:, None, :]
        diagonal = np.einsum("sii->si", normal)
        normal[:, np.arange(count), np.arange(count)] += damping[:, None] * diagonal + ~free + 1e-9
        new = np.clip(x - np.linalg.solve(normal, (down * free)[..., None])[..., 0], low, high)
        smooth, skin = residuals(new[None])
        new_depth, new_slope = depths(skin[0])
        new_cost = (smooth[0] ** 2).sum(axis=1) + ((pressed(new_depth)[0] / PENETRATION_M) ** 2).sum(axis=1)
        better = new_cost < cost
        x = np.where(better[:, None], new, x)
        depth = np.where(better[:, None], new_depth, depth)
        slope = np.where(better[:, None, None], new_slope, slope)
        settled = np.all(np.abs(np.where(better, cost - new_cost, 0.0)) < 1e-6 * cost)
        cost = np.where(better, new_cost, cost)
        damping = np.where(better, damping * 0.3, damping * 5.0)
        if settled and better.any():
            break
    solved[:, joints, kinds] = x


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
        counts = (
            fine > 0.0
            if touch.contact.when == "pressed"
            else fine == 0.0
            if touch.contact.when == "released"
            else fine >= 0.0
        )
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
