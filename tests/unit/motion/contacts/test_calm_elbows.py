"""Elbows of players who move a slide: not flung by the shoulder that begins to reach."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from app.arrays import FloatArray
from app.motion.contacts.ready_player import player_body
from app.motion.contacts.solve import padding_frames, solve
from app.motion.contacts.still_player import ContactCurves
from app.motion.curves.curve import minimum_jerk
from app.motion.model import Motion
from app.plan.parameters import PlayerParameters
from app.rig.skeleton import forward
from metadata.load import load_body
from tests.unit.motion import figure
from tests.unit.motion.events import press, slide

SKELETON = figure.character().skeleton
FPS = 60
MOVES_S = 0.3


def moved(slide_m: float, near: float, far: float) -> Motion:
    """A slide that goes out and comes back, each in `MOVES_S`, and rests before, between and after."""
    player = player_body(
        PlayerParameters(), figure.instrument_map(press(), slide()), figure.character(),
        figure.hold(SKELETON, slide_m), load_body(),
    )  # fmt: skip
    frames = 3 * FPS + 2 * padding_frames(Fraction(FPS))
    times_s = (np.arange(frames) - padding_frames(Fraction(FPS))) / FPS
    out = minimum_jerk(np.clip((times_s - 1.0) / MOVES_S, 0.0, 1.0))
    out -= minimum_jerk(np.clip((times_s - 2.0) / MOVES_S, 0.0, 1.0))
    curves = ContactCurves(player.still.for_frames(frames), {"slide": near + (far - near) * out}, {}, np.zeros(frames))
    return solve(player, curves, Fraction(FPS), 0.0)


def speeds_m_s(motion: Motion) -> tuple[FloatArray, FloatArray]:
    """Speeds of the right elbow and the right hand from frame to frame."""
    joints = [SKELETON.index(f"right{name}") for name in ("LowerArm", "Hand")]
    posed = forward(SKELETON, motion.rotations, motion.hips_m, joints)
    elbow, hand = (FPS * np.linalg.norm(np.diff(posed.of(joint)[0], axis=0), axis=1) for joint in joints)
    return elbow, hand


def turned_deg_s(motion: Motion, joint: str) -> FloatArray:
    """Speed of a joint's rotation from frame to frame."""
    rotations = motion.rotations[:, SKELETON.index(joint)].astype(np.float64)
    cosine = np.abs((rotations[1:] * rotations[:-1]).sum(axis=1)).clip(0.0, 1.0)
    return FPS * np.rad2deg(2.0 * np.arccos(cosine))


@pytest.mark.parametrize(("slide_m", "near", "far"), [(0.4, 0.4, 1.0), (0.6, 0.4, 0.8), (0.5, 0.4, 0.8)])
def test_elbows_are_not_flung_when_a_shoulder_begins_to_reach(slide_m: float, near: float, far: float) -> None:
    """Between places that the arm alone reaches and those for which the shoulder goes fully forward, the elbow that
    goes outwards with it does so early and slowly: it is hardly faster than the hand."""
    motion = moved(slide_m, near, far)
    elbow_m_s, hand_m_s = speeds_m_s(motion)
    assert 0.9 < hand_m_s.max() < 1.8
    assert (elbow_m_s - hand_m_s).max() < 1.0
    assert elbow_m_s.max() < 2.0
    assert turned_deg_s(motion, "rightUpperArm").max() < 800.0
    assert turned_deg_s(motion, "rightShoulder").max() < 260.0
