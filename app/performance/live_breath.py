"""Lungs, lips and eyes of a live player: they follow breath, bite and bend, and inhale when the breath pauses."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from app.arrays import FloatArray
from app.motion.breath.air_in_trunk import EXHALE_S
from app.motion.curves.live_values import Reach, Spring
from app.motion.curves.seeded_chance import generator
from app.motion.faces.exertion import LIGHT, Exertion
from app.motion.faces.face_curves import FORM_S, HOLD_S, SHALLOWEST, Drivers
from app.motion.faces.gaze import (
    BLINK_DOWN_S,
    BLINK_SHUT_S,
    BLINK_UP_S,
    HEAD_TURN_S,
    MUSIC_M,
    MUSIC_PITCH_RAD,
    SACCADE_S,
    GazeFrames,
)
from app.motion.gestures.body_lag import Overlapped
from app.motion.gestures.layers import LayerSamples
from app.motion.perform import PerformanceCurves
from app.performance.live_hands import FRAMES
from app.performance.live_tongue import LiveTongue
from app.plan.breath.lungs import FULL_BREATH_S, air_rate, lungful_s
from app.plan.faces.live_expressions import faces_now, live_rules
from app.plan.lips.embouchure import strain_of, tension_of
from app.plan.lips.recorded_lips import pressed_by
from app.plan.music.piece import MEZZOFORTE
from metadata.library import bundled_rules
from metadata.rules import Rule

SILENT = 0.02
"""Value of a breath sensor up to which it counts as zero."""
FORMS_S = 0.06
"""Seconds in which the lips form; short, since the note has already begun."""
SHUTS_S = 0.06
"""Seconds in which a mouth that is open for a breath closes when a note begins."""
OPENS_S = 0.16
"""Seconds in which the mouth opens for a breath."""
EMPTY_PAUSE_S, FULL_PAUSE_S = 0.12, 0.45
"""Least seconds without breath after which the player inhales, with empty and with full lungs."""
LEAST_SPENT = 0.08
"""Least used share of the lungs for the player to inhale."""
RELAXES_S = 2.0
"""Seconds for which full lungs are held before the body lets go."""
TENSION_S, PRESSED_S, AIR_S, EFFORT_S, RAISES_S = 0.09, 0.05, 0.10, 0.50, 1.6
"""Settling times of the lips after notes, and after bite and bend, of the cheeks after the air, of the face after the
strain, and of the bell after the loudness."""
WORKS_S, STRAINS_S = 0.35, 3.0
"""Settling times in seconds of brows and cheeks after a note's effort, and after a lasting strain."""
USUAL_BITE_S = 8.0
"""Settling time in seconds of the mean bite, relative to which the bite is measured."""
OTHER_LID = 0.95
"""Closure of one eye relative to the other."""
BELL_RISES = 0.5
"""Share of the bell's range by which it rises from mezzoforte to the loudest, and sinks to the softest."""


@dataclass(frozen=True)
class BreathFrames:
    """Body and face of a live player at one moment, repeated for `FRAMES` frames; fields as in
    `app.motion.played_frames.PlayedFrames`.
    """

    levels: LayerSamples
    face: Drivers


class LiveBreath:
    """Breath and lips of one live player.

    Parameters
    ----------
    curves : PerformanceCurves
        Curves of the player, with definitions of ``neutral`` and of expressions used by rules.
    rules : tuple of Rule, optional
        Rules; the bundled ones by default.
    """

    def __init__(self, curves: PerformanceCurves, rules: tuple[Rule, ...] | None = None) -> None:
        rules, expressions = bundled_rules() if rules is None else rules, curves.expressions
        self._instrument, self._parameters = curves.instrument_map, curves.parameters
        self._lung_s = lungful_s(curves.parameters, curves.instrument_map.air)
        self._breath: float | None = None
        self._bite = self._bend = 0.0
        self._pitch: float | None = None
        self._struck = MEZZOFORTE
        self._sounding = False
        self._onset_s = self._now_s = -math.inf
        self._paused_s = -math.inf
        """Since when nothing is blown; inf while something is."""
        self._spent = 0.0
        """Share of the lungs' air that is used up."""
        self._inhaled_s = math.inf
        """Time at which the breath that is being drawn in is complete; inf if there is none."""
        self._rested = True
        self._at_lips, self._mouth, self._full = (Reach.at_rest(0.0) for _ in range(3))
        self._tongue = LiveTongue(curves)
        self._tension = Spring(float(tension_of(np.array([float(self._middle)]), self._instrument)[0]), TENSION_S)
        self._air, self._effort = Spring(0.0, AIR_S), Spring(0.0, EFFORT_S)
        self._bell = Spring(0.0, RAISES_S)
        self._load = curves.body.face.load
        self._working, self._strain = Spring(0.0, WORKS_S), Spring(0.0, STRAINS_S)
        self._pressed, self._usual_bite = Spring(0.0, PRESSED_S), Spring(0.0, USUAL_BITE_S)
        self._rules = live_rules(rules, expressions)
        self._shown = {
            name: Spring(0.0, expressions[name].fade_in_s)
            for name in dict.fromkeys(rule.do.expression for rule in self._rules)
        }
        self._neutral = "neutral" in expressions

    @property
    def _middle(self) -> float:
        limits = self._instrument.range
        return 0.5 * (limits.easy_low + limits.easy_high)

    @property
    def loudness(self) -> float:
        """Current loudness, 0..1, by the breath, or by the note's velocity if no breath is sent."""
        return self._struck if self._breath is None else self._breath

    def play(self, now_s: float, pitch: int, velocity: int, attacked: bool) -> None:
        """Begin a note; ``attacked`` is False if it is slurred to the note before."""
        self.advance(now_s)
        self._pitch, self._struck = float(pitch), velocity / 127.0
        self._onset_s, self._sounding = now_s, True
        if attacked:
            self._tongue.strike(now_s, self._struck)
        self._turn(now_s)

    def rest(self, now_s: float) -> None:
        """End the current note, so that silence begins."""
        self.advance(now_s)
        self._sounding = False
        self._turn(now_s)

    def blow(self, now_s: float, breath: float) -> None:
        """Set the breath of the live wind controller, 0..1, at a time."""
        self.advance(now_s)
        self._breath = breath
        self._turn(now_s)

    def bite(self, bite: float) -> None:
        """Set the strength of the bite on the reed from a live wind controller, 0..1."""
        self._bite = bite

    def bend(self, bend: float) -> None:
        """Set the pitch bend of the live wind controller, -1..1."""
        self._bend = bend

    @property
    def _blown(self) -> bool:
        return self._sounding or (self._breath is not None and self._breath > SILENT)

    def _turn(self, now_s: float) -> None:
        """Start or stop blowing, as the current breath and note require."""
        if self._blown and self._paused_s < math.inf:
            self._begin(now_s)
        elif not self._blown and self._paused_s == math.inf:
            self._paused_s, self._rested = now_s, False

    def _begin(self, now_s: float) -> None:
        self._paused_s = math.inf
        self._at_lips = self._at_lips.toward(now_s, 1.0, FORMS_S)
        if self._mouth.target or not self._mouth.ended(now_s):
            self._mouth = self._mouth.toward(now_s, 0.0, SHUTS_S)
        if not math.isinf(self._inhaled_s):
            # A breath that was cut short brings air in proportion to its duration.
            left = max(self._inhaled_s - now_s, 0.0) / FULL_BREATH_S
            self._spent *= min(left, 1.0)
            self._inhaled_s = math.inf
        self._full = self._full.toward(now_s, 0.0, EXHALE_S)

    def advance(self, now_s: float) -> None:
        """Update the state of breath and lungs to a time, in seconds."""
        elapsed_s = max(now_s - self._now_s, 0.0)
        if math.isinf(elapsed_s):
            elapsed_s = 0.0
        self._now_s = max(now_s, self._now_s)
        if self._blown:
            rate = float(air_rate(np.array([self.loudness]), self._instrument.air)[0])
            self._spent = min(self._spent + elapsed_s * rate / self._lung_s, 1.0)
        elif math.isfinite(self._paused_s):
            self._pause(now_s)
        self._follow(now_s, elapsed_s)

    def _pause(self, now_s: float) -> None:
        """Update the state of a pause between notes: inhale, hold the breath, then release it."""
        waits_s = FULL_PAUSE_S + (EMPTY_PAUSE_S - FULL_PAUSE_S) * self._spent
        paused_s = now_s - self._paused_s
        if now_s >= self._inhaled_s:
            self._mouth = self._mouth.toward(self._inhaled_s, 0.0, OPENS_S)
            self._spent, self._inhaled_s = 0.0, math.inf
        elif math.isinf(self._inhaled_s) and self._spent > LEAST_SPENT and paused_s >= waits_s:
            depth = min(1.0, 0.4 + 0.6 * self._spent)
            self._mouth = self._mouth.toward(now_s, SHALLOWEST + (1.0 - SHALLOWEST) * depth, OPENS_S)
            self._full = self._full.toward(now_s, 0.5 + 0.5 * depth, FULL_BREATH_S)
            self._inhaled_s = now_s + FULL_BREATH_S
        if not self._rested and paused_s >= HOLD_S + RELAXES_S and math.isinf(self._inhaled_s):
            self._rested = True
            self._at_lips = self._at_lips.toward(now_s, 0.0, 2.0 * FORM_S)
            self._full = self._full.toward(now_s, 0.0, EXHALE_S)

    def _follow(self, now_s: float, elapsed_s: float) -> None:
        """Move lips, cheeks and face towards the values for the current playing."""
        loud = np.array([self.loudness if self._blown else 0.0])
        pitch = np.array([self._middle if self._pitch is None else self._pitch])
        held_s = np.array([now_s - self._onset_s if self._sounding else 0.0])
        tension, effort = strain_of(tension_of(pitch, self._instrument), loud, held_s)
        tight = float(tension[0]) * self._parameters.embouchure_tension
        self._tension.follow(min(max(tight, 0.0), 1.0), elapsed_s)
        if self._blown:
            usual = self._usual_bite.follow(self._bite, elapsed_s)
            pressed = float(pressed_by(np.array([self._bite - usual]), np.array([self._bend]))[0])
        else:
            pressed = 0.0
        self._pressed.follow(pressed, elapsed_s)
        if not self._blown:
            effort = np.zeros(1)
        self._air.follow(float(loud[0]), elapsed_s)
        self._effort.follow(float(effort[0]), elapsed_s)
        asked = self._load.tension * tight + self._load.air * float(loud[0]) + self._load.effort * float(effort[0])
        load = min(max(asked - self._load.easy, 0.0), 1.0) if self._blown else 0.0
        self._working.follow(load, elapsed_s)
        self._strain.follow(max(load - LIGHT, 0.0) / (1.0 - LIGHT), elapsed_s)
        height = float(np.clip((loud[0] - MEZZOFORTE) / (1.0 - MEZZOFORTE), -1.0, 1.0)) if self._blown else 0.0
        self._bell.follow(BELL_RISES * height, elapsed_s)
        strengths = faces_now(self._rules, pitch, loud, effort, self._instrument)
        for name, spring in self._shown.items():
            spring.follow(strengths[name], elapsed_s)

    def at(self, now_s: float) -> BreathFrames:
        """Return body and face of the live player at a time in seconds."""
        self.advance(now_s)
        nothing, still = np.zeros(FRAMES), Overlapped.nothing(FRAMES)

        def pair(value: float) -> FloatArray:
            return np.full(FRAMES, min(max(value, 0.0), 1.0))

        expressions: dict[str, FloatArray] = {name: pair(spring.value) for name, spring in self._shown.items()}
        if self._neutral:
            expressions["neutral"] = np.ones(FRAMES)
        tip, back, push = (np.full(FRAMES, value) for value in self._tongue.at(now_s))
        face = Drivers(
            at_lips=pair(self._at_lips.at(now_s)),
            tension=pair(self._tension.value + self._pressed.value),
            effort=pair(self._effort.value),
            air=pair(self._air.value),
            tongue=tip,
            tongue_back=back,
            push=push,
            mouth_open=pair(self._mouth.at(now_s)),
            firm=nothing,
            eased=nothing,
            vibrato=nothing,
            exertion=Exertion(
                working=pair(self._working.value),
                strain=pair(self._strain.value),
                contour=nothing,
                swell=nothing,
                emptying=pair(self._spent * self._spent),
                phrase=nothing,
                tired=nothing,
            ),
            expressions=dict(sorted(expressions.items())),
        )
        levels = LayerSamples(
            full=np.full(FRAMES, max(self._full.at(now_s), 0.0)),
            leaning=nothing,
            air=pair(self._full.at(now_s)),
            dip=nothing,
            lift=nothing,
            sway=still,
            lean=still,
            accent=still,
            weight=still,
            giving=nothing,
            height=np.full(FRAMES, self._bell.value),
            lowered=nothing,
            feet={},
            held={},
        )
        return BreathFrames(levels, face)


class LiveLook:
    """Gaze of a live player: the eyes stay on the music, with occasional blinks that avoid entries."""

    def __init__(self, curves: PerformanceCurves) -> None:
        self._random = generator(curves.player_id, curves.parameters.seed, "look")
        self._yaw, self._head_yaw, self._head_pitch = (Reach.at_rest(0.0) for _ in range(3))
        self._pitch = Reach.at_rest(MUSIC_PITCH_RAD)
        self._lids = Reach.at_rest(0.0)
        self._moves_s = self._blinks_s = self._opens_s = math.inf

    def at(self, now_s: float) -> GazeFrames:
        """Gaze and lids at a time, repeated for `FRAMES` frames."""
        random = self._random
        if math.isinf(self._moves_s):
            self._moves_s, self._blinks_s = now_s + random.uniform(0.4, 1.5), now_s + random.uniform(0.5, 2.5)
        if now_s >= self._moves_s:
            yaw, pitch = float(random.normal(0.0, 0.035)), MUSIC_PITCH_RAD + float(random.normal(0.0, 0.03))
            self._yaw, self._pitch = (
                self._yaw.toward(now_s, yaw, SACCADE_S),
                self._pitch.toward(now_s, pitch, SACCADE_S),
            )
            self._head_yaw = self._head_yaw.toward(now_s, 0.3 * yaw, HEAD_TURN_S)
            self._head_pitch = self._head_pitch.toward(now_s, 0.075 * (pitch - MUSIC_PITCH_RAD), HEAD_TURN_S)
            self._moves_s = now_s + random.uniform(0.9, 3.0)
        if now_s >= self._opens_s:
            self._lids = self._lids.toward(now_s, 0.0, BLINK_UP_S)
            self._opens_s = math.inf
        if now_s >= self._blinks_s:
            self._lids = self._lids.toward(now_s, 1.0, BLINK_DOWN_S)
            self._opens_s = now_s + BLINK_DOWN_S + BLINK_SHUT_S
            self._blinks_s = now_s + min(max(float(random.lognormal(np.log(4.2), 0.5)), 0.7), 12.0)
        lids = min(max(self._lids.at(now_s), 0.0), 1.0)
        return GazeFrames(
            yaw_rad=np.full(FRAMES, self._yaw.at(now_s)),
            pitch_rad=np.full(FRAMES, self._pitch.at(now_s)),
            near_per_m=np.full(FRAMES, 1.0 / MUSIC_M),
            own=np.ones(FRAMES),
            head_yaw_rad=np.full(FRAMES, self._head_yaw.at(now_s)),
            head_pitch_rad=np.full(FRAMES, self._head_pitch.at(now_s)),
            left_lid=np.full(FRAMES, lids),
            right_lid=np.full(FRAMES, OTHER_LID * lids),
        )
