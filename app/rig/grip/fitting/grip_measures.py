"""Measurement of a finished grip: accuracy of every contact, and depth of skin inside the instrument."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from app.arrays import FloatArray
from app.rig import quaternion
from app.rig.grip.fitting.fit_terms import GripScene
from app.rig.grip.fitting.hand_model import (
    ball_centres,
    flesh_radius,
    skinned,
    turned,
    wrist_from_joint,
    wrist_from_mesh,
)
from app.rig.grip.fitting.hand_problem import HandProblem, home_controls
from app.rig.grip.fitting.residuals import inside_proxy
from app.rig.grip.fitting.touch_targets import contact_at, counts, nodes_at
from app.rig.grip.grip_pose import ContactFit, FingerTable, StationTable
from app.rig.quaternion import interpolated


def judge(
    problem: HandProblem,
    scene: GripScene,
    fingers: tuple[FingerTable, ...],
    values: FloatArray,
    leant: Mapping[tuple[int, int], tuple[GripScene, Mapping[int, StationTable]]],
) -> tuple[tuple[ContactFit, ...], float]:
    """Return the errors of all contacts, and the greatest depth of skin inside the instrument in metres.

    Measured on all skin of the hand, at the solved values of the controls and halfway between them: first with all
    fingers at home, then with each finger at each of its other stations.

    ``leant`` has wrist and fingers for stations with a wrist offset, by (finger, station).
    """
    instrument = scene.instrument_map
    fine = np.linspace(0.0, 1.0, 2 * len(values) - 1) if len(values) > 1 else values
    home = {number: table.stations[0] for number, table in enumerate(fingers)}
    own = [i for i, contact in enumerate(instrument.contacts) if any(t.contact is contact for t in problem.touches)]
    posed = _posed(home, dict.fromkeys(home, fine), len(fine))
    moved = home_controls(problem.stations)
    contacts, depth = _judged(problem, _finer(scene, values, fine), posed, moved, own, fine)
    few = np.linspace(0.0, 1.0, 5)
    for number, places in enumerate(problem.stations):
        for index, station in enumerate(places[1:], 1):
            there, others = leant.get((number, index), (scene, home))
            tables = {**home, **others, number: fingers[number].stations[index]}
            posed = _posed(tables, {number: few}, len(few))
            own = [i for i in station.contacts if i not in places[0].contacts]
            more, deep = _judged(problem, there.over(few), posed, frozenset(station.controls), own, few)
            contacts, depth = contacts + more, max(depth, deep)
    return tuple(contacts), depth


def _finer(scene: GripScene, values: FloatArray, fine: FloatArray) -> GripScene:
    """Return the scene at the control values ``fine``, interpolated between its samples at ``values``."""
    if len(values) == 1:
        return scene
    between = np.interp(fine, values, np.arange(len(values), dtype=np.float64))
    low = np.minimum(between.astype(np.intp), len(values) - 2)
    high, share = low + 1, (between - low)[:, None]
    if len(scene.position_m) == 1:
        return scene.over(fine)
    turn = quaternion.to_matrix(interpolated(values, quaternion.from_matrix(scene.basis)[:, None], fine)[:, 0])
    position_m = scene.position_m[low] * (1.0 - share) + scene.position_m[high] * share
    return replace(scene, position_m=position_m, basis=turn)


def _posed(tables: Mapping[int, StationTable], values: Mapping[int, FloatArray], count: int) -> FloatArray:
    """Return the rotations (S, 16, 4) of a hand's 16 joints in S samples: fingers in ``values`` with their controls at
    these values, the others at rest.
    """
    rotations = np.tile(quaternion.IDENTITY, (count, 16, 1))
    for number, table in tables.items():
        at = values.get(number, np.zeros(count))
        rotations[:, 1 + 3 * number : 4 + 3 * number] = interpolated(table.values, table.rotations, at)
    return rotations


def _judged(
    problem: HandProblem,
    scene: GripScene,
    rotations: FloatArray,
    moved: frozenset[str],
    own: Sequence[int],
    values: FloatArray,
) -> tuple[list[ContactFit], float]:
    """Return the accuracy of the contacts with the indices ``own``, and the greatest depth in metres of the hand's skin
    in the instrument, while the ``moved`` controls take all ``values``.
    """
    hand, instrument = problem.hand, scene.instrument_map
    transforms = wrist_from_joint(hand, rotations)
    matrices = wrist_from_mesh(hand, transforms)
    contacts = []
    for index in own:
        contact = instrument.contacts[index]
        points, normals = hand.landmarks[contact.part], hand.landmark_normals[contact.part]
        touching = scene.placed(skinned(matrices, points[:, :, None]))[:, 0]
        facing = scene.turned(turned(matrices, normals[:, :, None]))[:, 0]
        at, normal = contact_at(scene.model, instrument, contact, moved, scene.carrier, values)
        off = np.linalg.norm(touching - at, axis=1)
        angle = np.arccos(np.clip(-np.einsum("si,si->s", facing, normal), -1.0, 1.0))
        there = counts(contact, values)
        control = instrument.control(contact.control) if contact.control in moved else None
        hovers = control is not None and control.hover_m > 0.0
        if hovers or (control is not None and control.half_value is not None):
            there &= values == 1.0
        contacts.append(
            ContactFit(
                contact.part, contact.node, contact.control, contact.grip == "firm",
                float(off[there].max(initial=0.0)), float(angle[there].max(initial=0.0)),
                contact.together, float(off[0]) if hovers else 0.0,
            )
        )  # fmt: skip
    place, turn = nodes_at(scene.model, instrument, moved, scene.carrier, values)
    flesh = np.concatenate([skinned(matrices, hand.all_points), ball_centres(hand, transforms)], axis=1)
    skin = scene.placed(flesh)
    radius = np.concatenate([np.zeros(hand.all_points.shape[2]), flesh_radius(hand)[: len(hand.balls)]])
    depth = max(
        float(inside_proxy(problem.proxies, place[s], turn[s], skin[s], radius)[0].max()) for s in range(len(values))
    )
    return contacts, depth
