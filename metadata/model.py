"""Data that an animator may edit: facial expressions, bodies, skeleton profiles, wind controllers.

Angles in the tables are degrees, since people edit them; every name states this. Rotations are about the axes of the
normalised T-pose: joint frames parallel to the world, the character faces +Z, its left is +X, arms along X with palms
down.
"""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

import msgspec

from metadata.face_model import EmbouchureKind as EmbouchureKind
from metadata.face_model import EmbouchureWeights as EmbouchureWeights
from metadata.face_model import FaceMotion as FaceMotion
from metadata.units import AmplitudeScale as AmplitudeScale
from metadata.units import Axis as Axis
from metadata.units import Delay as Delay
from metadata.units import Fraction01 as Fraction01
from metadata.units import NotNegative as NotNegative
from metadata.units import Positive as Positive
from metadata.units import Range as Range
from metadata.units import at_amplitude as at_amplitude

REQUIRED_JOINTS: tuple[str, ...] = (
    *("hips", "spine", "head"),
    *(
        side + part
        for side in ("left", "right")
        for part in ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot")
    ),
)
"""Joints that a body must have for playing, including those required by VRM 1.0."""
ARKIT_MORPHS: tuple[str, ...] = (
    "browDownLeft", "browDownRight", "browInnerUp", "browOuterUpLeft", "browOuterUpRight", "cheekPuff",
    "cheekSquintLeft", "cheekSquintRight", "eyeBlinkLeft", "eyeBlinkRight", "eyeLookDownLeft", "eyeLookDownRight",
    "eyeLookInLeft", "eyeLookInRight", "eyeLookOutLeft", "eyeLookOutRight", "eyeLookUpLeft", "eyeLookUpRight",
    "eyeSquintLeft", "eyeSquintRight", "eyeWideLeft", "eyeWideRight", "jawForward", "jawLeft", "jawOpen",
    "jawRight", "mouthClose", "mouthDimpleLeft", "mouthDimpleRight", "mouthFrownLeft", "mouthFrownRight",
    "mouthFunnel", "mouthLeft", "mouthLowerDownLeft", "mouthLowerDownRight", "mouthPressLeft", "mouthPressRight",
    "mouthPucker", "mouthRight", "mouthRollLower", "mouthRollUpper", "mouthShrugLower", "mouthShrugUpper",
    "mouthSmileLeft", "mouthSmileRight", "mouthStretchLeft", "mouthStretchRight", "mouthUpperUpLeft",
    "mouthUpperUpRight", "noseSneerLeft", "noseSneerRight", "tongueOut",
)  # fmt: skip
"""The 52 morph targets of Apple's ARKit (`ARFaceAnchor.BlendShapeLocation`)."""

BREATH_MORPHS: tuple[str, str] = ("chestExpand", "bellyExpand")
"""Morph targets of a trunk for breathing: expanded ribs and back, expanded belly."""


class Expression(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A facial expression as ARKit weights; events of the plan blend it in by their strength.

    Attributes
    ----------
    while_playing : bool
        Whether it may be shown while the lips are at the mouthpiece; its lips are then not affected.
    fade_in_s, fade_out_s : float
        Usual fades, seconds.
    """

    name: str
    description: str
    weights: dict[str, Fraction01]
    while_playing: bool
    fade_in_s: Positive
    fade_out_s: Positive


class JointLimits(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Human range of one joint, and the largest angular acceleration in human motion.

    The joint's rotation is ``swing * twist``: twist about the profile's `JointAxes.twist`; the swing, as a rotation
    vector, has the components ``flexion`` and ``sideways`` on the axes of the same names. Both sides share an entry
    (``upperArm`` is `leftUpperArm` and `rightUpperArm`), because a right joint's axes are mirrored.
    """

    flexion_deg: Range
    sideways_deg: Range
    twist_deg: Range
    acceleration_rad_s2: Positive
    source: str


class Posture(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """Posture of a trained player standing or seated, before any motion.

    Attributes
    ----------
    feet_apart_hip_widths : float
        Distance between the ankles over the distance between the hip joints.
    foot_forward_m : float
        Distance of the left foot in front of the right in metres.
    toes_out_deg, knee_bend_deg, hip_flexion_deg : float
        Angle of the toes outwards, bend of the knees, and forward angle of the thigh from the vertical (seated about
        85).
    spine_deg : dict of str to float
        Flexion (forward positive) of each joint of spine and neck; the sum over the spine is the trunk's lean.
    spine_left_deg, spine_turn_deg : dict of str to float
        Lean to the left and turn to the left of the same joints; see `Body.turned_to`.
    shoulder_lift_deg, elbow_off_ribs_deg : float
        Lift of the shoulders, and sideways angle between the hanging upper arm and the trunk.
    head_down_deg : float
        Greatest angle by which the head follows the instrument downwards.
    seat_height_shank : float
        Height of the seat relative to the length of the shank; 0 without a seat.
    """

    feet_apart_hip_widths: Positive
    foot_forward_m: float
    toes_out_deg: float
    knee_bend_deg: NotNegative
    hip_flexion_deg: float
    spine_deg: dict[str, float]
    shoulder_lift_deg: float
    elbow_off_ribs_deg: NotNegative
    head_down_deg: float
    seat_height_shank: NotNegative
    spine_left_deg: dict[str, float] = {}
    spine_turn_deg: dict[str, float] = {}


class Sway(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Sizes of the trunk's sideways lean with the music, and of the bend of knees and hips on an accent, by
    amplitude.
    """

    side_deg: AmplitudeScale
    forward_deg: AmplitudeScale
    turn_deg: AmplitudeScale
    bob_m: AmplitudeScale
    knee_deg: AmplitudeScale
    head_deg: AmplitudeScale
    residual_hz: Positive


class PhraseMotion(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Motion of trunk, head and pelvis by phrase and accent.

    Attributes
    ----------
    lean_deg, head_deg : AmplitudeScale
        Forward lean of the trunk, and forward tilt of the head in the world, at a phrase's climax.
    accent_deg, accent_head_deg : AmplitudeScale
        The same angles on an accent.
    ahead_m : AmplitudeScale
        Backward motion of the hips as the trunk leans forward.
    pelvis_deg : AmplitudeScale
        Forward tilt of the pelvis with the trunk.
    seated_share, seated_pelvis : float
        Factors of the motion of trunk and pelvis of a seated player relative to a standing one.
    """

    lean_deg: AmplitudeScale
    head_deg: AmplitudeScale
    accent_deg: AmplitudeScale
    accent_head_deg: AmplitudeScale
    ahead_m: AmplitudeScale
    pelvis_deg: AmplitudeScale
    seated_share: Positive
    seated_pelvis: Positive


class Overlap(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Delays in seconds between parts of the body: of the chest behind the hips, and of head and elbows behind the
    chest.
    """

    chest_s: Delay
    head_s: Delay
    elbows_s: Delay


class Footwork(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Size and duration of steps and toe taps.

    Attributes
    ----------
    step_m, lift_m : AmplitudeScale
        Forward distance of a step, and its height.
    step_s : float
        Duration in seconds.
    heel_deg, toes_deg : AmplitudeScale
        Angles by which heels and toes rise.
    unload_m : AmplitudeScale
        Displacement of the hips over the other foot for a step.
    """

    step_m: AmplitudeScale
    lift_m: AmplitudeScale
    step_s: Positive
    heel_deg: AmplitudeScale
    toes_deg: AmplitudeScale
    unload_m: AmplitudeScale


class WeightShift(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Sizes of a shift of weight from one foot to the other: sideways and forward motion of the hips, and bend of the
    knees.
    """

    side_m: AmplitudeScale
    roll_deg: AmplitudeScale
    ahead_m: AmplitudeScale
    knee_deg: AmplitudeScale
    transition_s: Positive


class BellMotion(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Sizes of the bell's motion as it rises and falls with the melody."""

    up_deg: AmplitudeScale
    down_deg: AmplitudeScale
    lowered_trunk_deg: float
    lower_s: Positive
    raise_s: Positive


class CueMotion(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Sizes of the motion of a player who gives a cue: head and instrument rise on the preparatory beat and drop onto
    the entry, and the knees bend.
    """

    knee_deg: AmplitudeScale
    bell_dip_deg: AmplitudeScale
    bell_lift_deg: AmplitudeScale
    trunk_deg: AmplitudeScale
    head_deg: AmplitudeScale


class ConcertMotion(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Motion outside of playing (bowing, looking up, counting, settling), scaled by the plan's gestures.

    Attributes
    ----------
    bow_trunk_deg, bow_head_deg : AmplitudeScale
        Forward angles while standing; multiplied by ``bow_seated_share`` while seated.
    bow_hips_deg, bow_back_m : AmplitudeScale
        Forward tilt and backward displacement of the pelvis while standing.
    look_up_deg : AmplitudeScale
        Upward angle of the head for looking at the audience.
    look_trunk_share : float
        Share of the head's turn added by the trunk while the instrument is lowered.
    count_head_deg : AmplitudeScale
        Nod of the head on each counted beat.
    settle_share : float
        Share of the way up by which the instrument is lifted as the hands settle.
    settle_shoulders_deg, settle_elbows_deg : AmplitudeScale
        Lift of the shoulders and outward turn of the elbows as the hands settle.
    """

    bow_trunk_deg: AmplitudeScale
    bow_hips_deg: AmplitudeScale
    bow_back_m: AmplitudeScale
    bow_head_deg: AmplitudeScale
    bow_seated_share: NotNegative
    look_up_deg: AmplitudeScale
    look_trunk_share: NotNegative
    count_head_deg: AmplitudeScale
    settle_share: NotNegative
    settle_shoulders_deg: AmplitudeScale
    settle_elbows_deg: AmplitudeScale


class BreathMotion(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Body motion in an inhalation of depth 1; a shallower one scales it. Players become more upright and the arms
    neutral (Frontiers in Psychology 2024, 1394035). The mouth is described by the embouchure's
    `EmbouchureWeights.inhale`. ``shown`` is the visible share by amplitude; ``chest_share`` and ``belly_share`` are
    weights of the shapes `BREATH_MORPHS`, for characters that have them. ``push_forward_deg`` and ``push_share`` are
    the forward motion of the chest and the contraction of the belly in a marcato attack.
    """

    shown: AmplitudeScale
    torso_back_deg: NotNegative
    shoulder_lift_deg: NotNegative
    head_back_deg: float
    elbow_out_deg: float
    preparation_forward_deg: NotNegative
    chest_share: Fraction01
    belly_share: Fraction01
    push_forward_deg: NotNegative = 0.0
    push_share: Fraction01 = 0.0


TRUNK_JOINTS = ("spine", "chest", "upperChest")
NECK_JOINTS = ("neck", "head")
HEAD_FOLLOWS = 0.4
"""Share of the instrument's pitch angle that the head follows, up to the posture's limit."""
TURNED_SHARE = 0.85
"""Greatest share of the joints' range used for turning to an instrument, so that some remains for motion."""


class Body(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Posture and motion of a kind of body, on the joints of ``skeleton``; ``checked_with`` is the id of the reference
    instrument for checking a character of this body.
    """

    name: str
    description: str
    skeleton: str
    checked_with: str
    limits: dict[str, JointLimits]
    postures: dict[Literal["standing", "seated"], Posture]
    sway: Sway
    phrase: PhraseMotion
    overlap: Overlap
    footwork: Footwork
    weight_shift: WeightShift
    bell: BellMotion
    cue: CueMotion
    concert: ConcertMotion
    breath: BreathMotion
    embouchure: dict[EmbouchureKind, EmbouchureWeights]
    face: FaceMotion

    def turned_to(
        self,
        posture: Literal["standing", "seated"],
        *,
        pitch_down_deg: float = 0.0,
        head_left_deg: float = 0.0,
        head_lean_left_deg: float = 0.0,
        trunk_left_deg: float = 0.0,
    ) -> Posture:
        """Return a posture with head and trunk turned to an instrument, within the limits of posture and joints.

        Parameters
        ----------
        posture : str
            Posture to turn.
        pitch_down_deg : float
            Downward angle of the instrument, which the head follows in part.
        head_left_deg, head_lean_left_deg, trunk_left_deg : float
            Angles as in an instrument map's carriage, divided among the joints in proportion to their ranges.
        """
        still = self.postures[posture]
        spine_deg = dict(still.spine_deg)
        down_deg = min(still.head_down_deg, HEAD_FOLLOWS * max(pitch_down_deg, 0.0))
        spine_deg["head"] = spine_deg.get("head", 0.0) + down_deg
        return msgspec.structs.replace(
            still,
            spine_deg=spine_deg,
            spine_left_deg=self._shared(head_lean_left_deg, NECK_JOINTS, "sideways_deg"),
            spine_turn_deg=self._shared(head_left_deg, NECK_JOINTS, "twist_deg")
            | self._shared(trunk_left_deg, TRUNK_JOINTS, "twist_deg"),
        )

    def _shared(self, angle_deg: float, joints: tuple[str, ...], field: str) -> dict[str, float]:
        """Distribute an angle over joints in proportion to their ranges in that direction, by joint; empty without
        joints.
        """
        if angle_deg == 0.0:
            return {}
        side = 1 if angle_deg > 0.0 else 0
        rooms = {joint: abs(float(getattr(self.limits[joint], field)[side])) for joint in joints}
        room = sum(rooms.values())
        given = min(max(angle_deg, -TURNED_SHARE * room), TURNED_SHARE * room)
        return {joint: given * own / room for joint, own in rooms.items()}


BreathSource: TypeAlias = Literal["cc2", "cc7", "cc11", "channel_pressure"]
"""Carriers of a player's breath: MIDI's breath controller, volume, expression, channel pressure (aftertouch)."""
BiteSource: TypeAlias = Annotated[
    str, msgspec.Meta(pattern=r"^(none|pitch_bend|channel_pressure|cc([0-9]|[1-9][0-9]|1[01][0-9]))$")
]
"""Messages for the bite on a mouthpiece: none, pitch bend, channel pressure or a controller by its number."""


class ControllerName(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Name of a MIDI controller in English and Japanese."""

    en: str
    ja: str


class Controller(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An electronic wind instrument, with the MIDI messages that it sends in its factory settings.

    Attributes
    ----------
    name : str
        Id, equal to the file name.
    ports : tuple of str
        Regular expressions, one of which matches the name of its MIDI port, ignoring case; empty for the default
        controller.
    breath : tuple of BreathSource
        Possible messages for breath, the most trusted first.
    channel : int
        Channel, 1..16; 0 for any.
    bend_range_semitones : float
        Range of a full pitch bend in semitones.
    source : str
        Source of this information.
    """

    name: str
    title: ControllerName
    ports: tuple[str, ...]
    breath: Annotated[tuple[BreathSource, ...], msgspec.Meta(min_length=1)]
    channel: Annotated[int, msgspec.Meta(ge=0, le=16)]
    bite: BiteSource
    bend_range_semitones: Annotated[float, msgspec.Meta(gt=0.0, le=96.0)]
    source: str
