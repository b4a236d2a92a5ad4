"""Additive curves are visible, limited, end in time, and break no contact."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from app.motion.by_hand.additive_curves import Additive
from app.motion.model import Motion
from app.plan.by_hand.additive_curve import CHANNELS, AdditiveCurve, CurveKey
from app.plan.by_hand.additive_events import segments
from app.plan.events_by_hand import AdditiveEvent
from app.plan.model import PlayerPlan
from app.rig import quaternion
from app.rig.grip.grip_pose import hand_targets
from tests.support.plan import PlainClock
from tests.unit.motion.test_perform import BODY, CHARACTER, FPS, HOLD, made, piece, times, world

pytestmark = pytest.mark.slow

CLOCK = PlainClock(((0, 120.0),))
LIMITS = {
    "bell.up": (-12.0, 12.0),
    "bell.left": (-12.0, 12.0),
    "bell.roll": (-6.0, 6.0),
    "head.up": (-20.0, 12.0),
    "head.left": (-20.0, 16.0),
    "head.roll": (-18.0, 15.0),
    "torso.up": (-30.0, 20.0),
    "torso.left": (-20.0, 20.0),
    "torso.roll": (-10.0, 18.0),
    "left_elbow.up": (-25.0, 45.0),
    "right_elbow.up": (-25.0, 45.0),
    "shoulders.up": (-5.0, 12.0),
    "hips.left": (-0.09, 0.09),
    "hips.ahead": (-0.06, 0.06),
    "hips.up": (-0.1, 0.015),
    "hips.tilt": (-6.0, 8.0),
    "hips.roll": (-6.0, 6.0),
    "knees.bend": (-6.0, 45.0),
    "eyes.up": (-30.0, 25.0),
    "eyes.left": (-35.0, 35.0),
    "face.browInnerUp": (-1.0, 1.0),
    "face.jawOpen": (-1.0, 1.0),
    "face.mouthSmileLeft": (-1.0, 1.0),
}
KEYS = ((2880, 1.0), (3840, 0.3), (4800, 1.0))
"""Keys from 3 s to 5 s as shares of the channel's limit."""
SPAN_S = (2.5, 5.5)
CASES = [(channel, side) for channel in LIMITS for side in (0, 1)]


def event(channel: str, share: float, name: str = "x", size: float = 1.0) -> AdditiveEvent:
    """Curve to a share of the channel's limit, upwards or (negative) downwards, scaled by ``size``."""
    low, high = LIMITS[channel]
    most = size * (high if share > 0.0 else -low)
    keys = tuple(CurveKey(tick, part * share * most) for tick, part in KEYS)
    shape = segments(AdditiveCurve(name, channel, keys, 480, 480), CLOCK)
    return AdditiveEvent(
        f"additive:{name}", channel, keys[0].tick, keys[-1].tick, shape[0].start_s, shape[-1].end_s, shape, low, high
    )


def keyed(*events: AdditiveEvent) -> PlayerPlan:
    return msgspec.structs.replace(piece(), additive=events)


def at(motion: Motion, time_s: float) -> int:
    return int(np.argmin(np.abs(times(motion) - time_s)))


@pytest.mark.parametrize(("channel", "side"), CASES)
def test_contacts_hold(channel: str, side: int) -> None:
    motion = made(keyed(event(channel, (-1.0, 1.0)[side], size=1.5)))
    instrument = motion.instrument_position_m.astype(np.float64), motion.instrument_rotation.astype(np.float64)
    for hand in HOLD.hands:
        target_m, turned = hand_targets(hand, *instrument, motion.controls)
        ((position_m, rotation),) = world(motion, f"{hand.side}Hand")
        assert np.linalg.norm(position_m - target_m, axis=1).max() < 0.5e-3
        turn = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(turned), rotation))
        assert np.linalg.norm(turn, axis=1).max() < 1e-3
    ((head_m, head),) = world(motion, "head")
    playing = (times(motion) >= 0.0) & (times(motion) < 10.0)
    contact_m = head_m + quaternion.rotate(head, HOLD.lips.contact_m(motion.morphs, motion.frames))
    assert np.linalg.norm(contact_m - motion.instrument_position_m, axis=1)[playing].max() < 0.5e-3
    for position_m, _ in world(motion, "leftFoot", "rightFoot"):
        assert np.ptp(position_m, axis=0).max() < 1e-3


@pytest.mark.parametrize("channel", LIMITS)
def test_nothing_is_different_before_and_after(channel: str) -> None:
    # Upwards hips go only where they have sunk.
    plain, other = made(), made(keyed(event(channel, -1.0 if channel == "hips.up" else 1.0)))
    t = times(plain)
    # Help for far hands looks a little ahead and back, and elbows beside reaching shoulders move slowly.
    outside = (t < SPAN_S[0] - 0.6) | (t > SPAN_S[1] + 0.6)
    inside = (t > SPAN_S[0]) & (t < SPAN_S[1])
    same = [np.array_equal(plain.rotations[part], other.rotations[part]) for part in (outside, inside)]
    morphs = [
        all(np.array_equal(values[part], other.morphs[name][part]) for name, values in plain.morphs.items())
        and all(name in plain.morphs or not other.morphs[name][part].any() for name in other.morphs)
        for part in (outside, inside)
    ]
    assert same[0]
    assert morphs[0]
    seen = not (same[1] and morphs[1]) or not np.array_equal(plain.hips_m[inside], other.hips_m[inside])
    lips = channel.startswith(("face.jaw", "face.mouth"))
    # Here the lips are at the mouthpiece all the time, and morphs of the embouchure are not changed.
    assert seen != lips


@pytest.mark.parametrize(("channel", "side"), CASES)
def test_it_moves_smoothly(channel: str, side: int) -> None:
    plain, other = made(), made(keyed(event(channel, (-1.0, 1.0)[side])))
    for name in ("head", "leftUpperArm", "rightUpperArm", "chest", "leftUpperLeg"):
        joint = CHARACTER.skeleton.index(name)
        limit = BODY.limits[name.replace("left", "").replace("right", "").replace("Upper", "upper", 1)]
        jumps = [np.abs(_accelerations(motion, joint)).max() for motion in (plain, other)]
        assert jumps[1] < max(1.5 * jumps[0], limit.acceleration_rad_s2)


def _accelerations(motion: Motion, joint: int) -> np.ndarray:
    local = motion.rotations[:, joint].astype(np.float64)
    steps = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(local[:-1]), local[1:]))
    return np.linalg.norm(np.diff(steps, axis=0), axis=1) * float(FPS) ** 2


def test_hips_go_where_the_curve_says() -> None:
    plain, frame = made(), None
    for channel, axis, sign in (("hips.left", 0, 1.0), ("hips.ahead", 2, 1.0), ("hips.up", 1, -1.0)):
        low, high = LIMITS[channel]
        other = made(keyed(event(channel, 0.5 * sign)))
        frame = at(plain, 3.0)
        moved_m = (other.hips_m - plain.hips_m)[frame, axis]
        assert moved_m == pytest.approx(0.5 * (high if sign > 0 else low), abs=0.003)


def test_knees_bend_and_the_hips_sink() -> None:
    plain, other = made(), made(keyed(event("knees.bend", 0.6)))
    frame = at(plain, 3.0)
    assert (plain.hips_m - other.hips_m)[frame, 1] > 0.01
    assert np.abs(plain.hips_m - other.hips_m)[frame, [0, 2]].max() < 1e-6


def test_brows_take_their_weight_and_curves_add_up() -> None:
    half = made(keyed(event("face.browInnerUp", 0.4)))
    twice = made(keyed(event("face.browInnerUp", 0.4), event("face.browInnerUp", 0.4, "y")))
    frame = at(half, 3.0)
    before = made().morphs.get("browInnerUp", np.zeros(half.frames))[frame]
    assert half.morphs["browInnerUp"][frame] - before == pytest.approx(0.4, abs=1e-6)
    assert twice.morphs["browInnerUp"][frame] - before == pytest.approx(0.8, abs=1e-6)


def test_lips_move_where_they_do_not_hold_the_mouthpiece() -> None:
    curve = AdditiveCurve("x", "face.mouthSmileLeft", (CurveKey(round(12.5 * 960), 0.6),), 480, 480)
    shape = segments(curve, CLOCK)
    resting = AdditiveEvent("additive:x", curve.channel, 0, 0, shape[0].start_s, shape[-1].end_s, shape, -1.0, 1.0)
    motion = made(keyed(resting))
    assert motion.morphs["mouthSmileLeft"][at(motion, 12.5)] > 0.5


def test_only_the_stretch_of_a_moved_key_is_made_anew() -> None:
    keys = [CurveKey(960 * number, float(number % 3)) for number in range(1, 12)]

    def made_of(keys: list[CurveKey]) -> Additive:
        shape = segments(AdditiveCurve("x", "head.up", tuple(keys), 480, 480), CLOCK)
        return Additive.of(
            [AdditiveEvent("additive:x", "head.up", 0, 0, shape[0].start_s, shape[-1].end_s, shape, -20.0, 20.0)]
        )

    before, after = made_of(keys), made_of([*keys[:5], msgspec.structs.replace(keys[5], value=9.0), *keys[6:]])
    changed = after.changed_s(before)
    # The key at 6 s, and the automatic handles of both neighbours.
    assert changed[:, 0].min() >= 4.0
    assert changed[:, 1].max() <= 8.0
    times_s = np.linspace(0.0, 13.0, 2000)
    same = before.sample(times_s)["head.up"].values == after.sample(times_s)["head.up"].values
    outside = ~np.any([(times_s >= low) & (times_s <= high) for low, high in changed], axis=0)
    assert same[outside].all()
    assert not same.all()
    assert len(before.changed_s(before)) == 0


def test_a_span_alone_has_the_values_of_the_whole() -> None:
    table = Additive.of([event("head.up", 1.0), event("head.up", -0.5, "y")])
    times_s = np.linspace(0.0, 8.0, 1001)
    whole = table.sample(times_s)["head.up"].values
    for start in range(0, 1000, 97):
        part = slice(start, start + 61)
        assert np.array_equal(table.sample(times_s[part])["head.up"].values, whole[part])


def test_every_kind_of_channel_is_tried() -> None:
    body = {channel for channel in CHANNELS if not channel.startswith("face.")}
    assert body <= LIMITS.keys()
