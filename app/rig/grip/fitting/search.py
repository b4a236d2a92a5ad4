"""Solution of a hand's grip: many starts with soft contacts, a few continued with harder ones, one final solution."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from app.arrays import FloatArray
from app.errors import Progress
from app.rig.grip.fitting.fit_terms import no_progress
from app.rig.grip.fitting.hand_problem import HandProblem, home_controls, start_at
from app.rig.grip.fitting.residuals import Residuals
from app.rig.grip.fitting.touch_targets import nodes_at, travel
from app.rig.model import InstrumentModel
from instrument_maps.model import Control, InstrumentMap

KNOTS = (0.25, 0.0, 0.5, 0.75, 1.0)
"""Values of the control that moves a hand at which its grip is solved: the first from the seed, the others each from
the solved neighbour, since the grip rotates in the fingers as the arm stretches.
"""
HELPED_FROM = 0.4
"""Value of that control from which the trunk may be turned towards the hand."""
TILTS = (
    (0.0, 0.0, 0.0),
    (0.3, 0.0, 0.0),
    (-0.3, 0.0, 0.0),
    (0.0, 0.3, 0.0),
    (0.0, -0.3, 0.0),
    (0.0, 0.0, 0.3),
    (0.0, 0.0, -0.3),
    (0.25, 0.25, 0.0),
    (-0.25, -0.25, 0.0),
    (0.0, 0.25, 0.25),
    (0.0, -0.25, -0.25),
)
"""Tried rotations of the seed (rotation vectors in the instrument's frame)."""


def starts(problem: HandProblem, progress: Progress = no_progress) -> list[FloatArray]:
    """Return first solutions (rows of parameters) of a hand on its instrument, best first.

    Starts are the suggested hand and rotations of it, solved with soft contacts; the best few are solved again with
    harder ones.
    """
    loose = []
    for number, tilt in enumerate(TILTS):
        progress(0.8 * number / len(TILTS))
        loose.append(solve(Residuals(problem, 6.0), start_at(problem, np.array(tilt)), 8))
    loose.sort(key=lambda found: float(found.cost))
    middle = []
    for number, found in enumerate(loose[:3]):
        progress(0.8 + 0.2 * number / 3.0)
        middle.append(solve(Residuals(problem, 2.0), found.x, 10))
    return [found.x for found in sorted(middle, key=lambda found: float(found.cost))]


def refined_solution(problem: HandProblem, start: FloatArray) -> FloatArray:
    """Return the parameters of the final solution from a start: first with contacts at full stiffness, then also with
    skin.
    """
    hard = solve(Residuals(problem, 1.0), start, 25)
    return np.asarray(solve(Residuals(problem, 1.0, stiff=True), hard.x, 12).x)


def search_knots(
    problem: HandProblem,
    model: InstrumentModel,
    instrument_map: InstrumentMap,
    carrier: Control,
    progress: Progress = no_progress,
) -> tuple[FloatArray, FloatArray]:
    """Solve the grip of a hand that a control moves: return K ascending values (K,) of the control, and the n
    parameters at each (K, n).
    """
    found: dict[float, FloatArray] = {}
    for value in KNOTS:
        place, turn = nodes_at(model, instrument_map, home_controls(problem.stations), carrier, np.array([value]))
        here = replace(
            problem,
            node_place=place,
            node_turn=turn,
            reference_shift_m=value * travel(carrier),
            helped=value >= HELPED_FROM,
            anchor=found[min(found, key=lambda other: abs(other - value))] if found else None,
        )
        if here.anchor is None:
            found[value] = refined_solution(here, starts(here, lambda share: progress(0.5 * share))[0])
        else:
            progress(0.6 + 0.4 * len(found) / len(KNOTS))
            found[value] = np.asarray(solve(Residuals(here, 1.0, stiff=True), here.anchor, 20).x)
    knots = np.array(sorted(found))
    return knots, np.stack([found[value] for value in knots])


def solve(residuals: Residuals, start: FloatArray, rounds: int) -> Any:
    """Minimise the residuals by least squares within the problem's bounds, in at most ``rounds`` steps; returns SciPy's
    result."""
    problem = residuals.problem
    from scipy.optimize import least_squares  # slow to import; holds are rarely fitted

    return least_squares(
        residuals,
        np.clip(start, problem.low + 1e-9, problem.high - 1e-9),
        jac=residuals.jacobian,
        bounds=(problem.low, problem.high),
        max_nfev=rounds,
        xtol=1e-7,
        ftol=1e-6,
        gtol=1e-8,
    )
