"""Pose of a live player: the character fingers, breathes and moves its lips as the user plays.

`PlayAlong` receives controller data and returns the pose at any later moment. Motion for a note starts at its onset,
since nothing is known in advance. Body layers, face and contacts are those of `app.motion` for a single frame. Only the
current state is stored, so memory is constant.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np

from app.arrays import SingleArray
from app.motion.by_hand.additive_curves import Additive
from app.motion.by_hand.pose_corrections import PoseCorrectionTable
from app.motion.contacts.help_for_far_hands import Help
from app.motion.contacts.solve import body_with_help, needs, poses, with_elbows_out
from app.motion.contacts.still_player import ContactCurves
from app.motion.doubling import Doubling
from app.motion.perform import PerformanceCurves
from app.motion.played_frames import PlayedFrames
from app.performance.chunks import Pose
from app.performance.live_breath import LiveBreath, LiveLook
from app.performance.live_hands import FRAMES, LiveHands
from app.performance.live_help import LiveHelp
from app.plan.events_by_hand import AdditiveEvent, PoseEvent
from app.score.bend_range import BendRanges
from app.score.sounding import SILENCING, SoundingNotes, begins
from app.score.take import ControllerMapping, curve_values, decoded, is_wired
from instrument_maps.model import Fingering
from metadata.rules import Rule

LEGATO_S = 0.012
"""Gap in seconds up to which a note is legato and not tongued, since controllers send end and onset together."""
ONE_FRAME = Fraction(1)
"""Frame rate of a single pose, which needs none."""


class PlayAlong:
    """Pose of a single player who is played live with a controller.

    Times are seconds of any monotonic clock (``time.perf_counter_ns() / 1e9``); a time before the previous one counts
    as the previous one. Values are clipped to their ranges.

    Parameters
    ----------
    curves : PerformanceCurves
        Player, instrument and posture (`app.performance.motion.performance_curves`); its notes are not used.
    rules : tuple of Rule, optional
        Rules for facial expressions; the bundled ones by default.
    """

    def __init__(self, curves: PerformanceCurves, rules: tuple[Rule, ...] | None = None) -> None:
        self._whole = self._curves = curves
        self._hands = LiveHands(curves)
        self._breath = LiveBreath(curves, rules)
        self._look = LiveLook(curves)
        self._help = LiveHelp()
        self._poses, self._at_s = curves.layers.held, -math.inf
        self._additive = curves.additive
        self._held: dict[int, int] = {}
        """Pitches that are held with their velocities, in the order they began."""
        self._received: SoundingNotes[None] = SoundingNotes()
        self._ranges = BendRanges()
        self._ended_s = -math.inf
        self._now_s = -math.inf

    @property
    def player_id(self) -> str:
        """Return the id of the player."""
        return self._curves.player_id

    @property
    def lying(self) -> dict[str, tuple[SingleArray, SingleArray]]:
        """Return the positions (3,) and rotations (4,) at which the musician's other instruments lie, by player id."""
        if not isinstance(self._whole, Doubling):
            return {}
        others = (
            (one.player_id, one.player.put_aside) for one in self._whole.played if one.player_id != self.player_id
        )
        return {
            player_id: (place.rest.position_m[0].astype(np.float32), place.rest.rotation[0].astype(np.float32))
            for player_id, place in others
            if place is not None
        }

    @property
    def fingering(self) -> Fingering | None:
        """Last fingering; None before any note and after its release."""
        return self._hands.fingering

    def note_on(self, time_s: float, pitch: int, velocity: int = 80) -> None:
        """Begin a note played live at ``time_s``; of several held notes the last one sounds. ``pitch`` and ``velocity``
        as in MIDI."""
        now_s, velocity = self._time(time_s), min(max(velocity, 1), 127)
        attacked = not self._held and now_s - self._ended_s > LEGATO_S
        self._held.pop(pitch, None)
        self._held[pitch] = velocity
        self._sound(now_s, pitch, velocity, attacked)

    def note_off(self, time_s: float, pitch: int) -> None:
        """End a note; if another note is still held, it sounds again."""
        now_s = self._time(time_s)
        if pitch not in self._held:
            return
        sounded = next(reversed(self._held)) == pitch
        del self._held[pitch]
        if not self._held:
            self._ended_s = now_s
            self._hands.rest(now_s)
            self._breath.rest(now_s)
        elif sounded:
            before = next(reversed(self._held))
            self._sound(now_s, before, self._held[before], attacked=False)

    def all_off(self, time_s: float) -> None:
        """End all notes, after a disconnected controller or "all notes off"."""
        now_s = self._time(time_s)
        self._held.clear()
        self._received.end_all()
        self._ended_s = now_s
        self._hands.rest(now_s)
        self._breath.rest(now_s)
        self._breath.blow(now_s, 0.0)

    def breath(self, time_s: float, value: float) -> None:
        """Set the strength of the breath from a live wind controller, 0..1, from ``time_s`` on."""
        self._breath.blow(self._time(time_s), min(max(value, 0.0), 1.0))

    def bite(self, time_s: float, value: float) -> None:
        """Set the strength of the bite on the reed from a live wind controller, 0..1, from ``time_s`` on."""
        self._time(time_s)
        self._breath.bite(min(max(value, 0.0), 1.0))

    def bend(self, time_s: float, value: float) -> None:
        """Set the pitch bend of the live wind controller in whole tones from ``time_s`` on."""
        self._time(time_s)
        self._breath.bend(value)

    def receive(self, time_s: float, raw: str, mapping: ControllerMapping) -> bool:
        """Receive a MIDI message in hexadecimal, as in takes; other messages than notes, breath and lips are ignored.
        Returns whether a note began or ended.

        Parameters
        ----------
        mapping : ControllerMapping
            Controllers that carry breath and bite.
        """
        message = decoded(raw)
        if message is None or not is_wired(message, mapping):
            return False
        data = bytes.fromhex(raw)
        ended = self._received.receive(data, None)
        if begins(data):
            self.note_on(time_s, message.note, message.velocity)
        elif message.type == "control_change" and message.control in SILENCING and not self._received.notes:
            self.all_off(time_s)
        else:
            # If two channels play the same pitch, it ends with the second note-off.
            held = {pitch for _, pitch in self._received.notes}
            for (_, pitch), _ in ended:
                if pitch not in held:
                    self.note_off(time_s, pitch)
        for kind, value in curve_values(message, mapping, self._ranges):
            if kind == "breath":
                self.breath(time_s, value)
            elif kind == "bite":
                self.bite(time_s, value)
            elif kind == "pitch_bend":
                self.bend(time_s, value)
        return message.type in ("note_on", "note_off")

    def hold(self, poses: Sequence[PoseEvent], additive: Sequence[AdditiveEvent] = ()) -> None:
        """Apply the project's pose corrections and additive curves from now on."""
        self._poses, self._additive = PoseCorrectionTable.of(poses), Additive.of(additive)

    def pose(self, time_s: float, at_s: float | None = None) -> Pose:
        """Pose of the player at a time.

        Parameters
        ----------
        at_s : float, optional
            Time in the piece for the animator's poses and curves; by default that of the previous call.
        """
        now_s = self._time(time_s)
        self._at_s = self._at_s if at_s is None else at_s
        curves, given = self._solved(now_s)
        player, now = self._curves.player, curves[:1]
        now = replace(now, body=body_with_help(player, now.body, given))
        now = replace(now, body=self._help.off_trunk(now_s, with_elbows_out(player, now)))
        motion = poses(player, now, ONE_FRAME, now_s)
        return Pose.of(motion, 0)

    def _sound(self, now_s: float, pitch: int, velocity: int, attacked: bool) -> None:
        self._hands.play(now_s, pitch, self._breath.loudness)
        self._breath.play(now_s, pitch, velocity, attacked)
        if self._hands.carries:
            # Set before the hand moves: a moving hand cannot be slowed down without overshooting.
            self._solved(now_s)
            self._hands.carry(now_s, self._help.carries_s)

    def _solved(self, now_s: float) -> tuple[ContactCurves, Help]:
        """Return the inputs of the contact solvers, with the current help for far hands: now (first frame), and at
        later moments on the hands' way to their goals (further frames).
        """
        hands, breathing, look = self._hands.at(now_s), self._breath.at(now_s), self._look.at(now_s)
        times_s = np.full(FRAMES, now_s)
        here_s = np.full(FRAMES, self._at_s)
        levels = replace(breathing.levels, held=self._poses.sample(here_s))
        added = self._additive.sample(here_s)
        curves = self._curves.curves(
            PlayedFrames(times_s, levels, look, breathing.face, hands.controls, hands.placed, hands.raised, added=added)
        )
        return curves, self._help.at(now_s, hands.arrived_s, needs(self._curves.player, curves))

    def _time(self, time_s: float) -> float:
        self._now_s = max(time_s, self._now_s)
        return self._now_s
