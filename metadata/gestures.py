"""Gestures as written by an animator: keyframed angles of body parts, added to the other motion.

Hands, lips and feet keep their places, since contacts are solved later. Only while the instrument is lowered, a hand
may leave it, and the instrument may rise to the lips.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Annotated, Literal, TypeAlias

import msgspec

from metadata.model import AmplitudeScale, Fraction01
from metadata.tables import Title, check_name, check_title, decoded, invalid

Target: TypeAlias = Literal["bell", "head", "left_elbow", "right_elbow", "torso"]
Turn: TypeAlias = Literal["up", "left", "roll"]
Start: TypeAlias = Literal["anytime", "resting", "lowered"]
Angle: TypeAlias = Annotated[float, msgspec.Meta(ge=-45.0, le=45.0)]
Slope: TypeAlias = Annotated[float, msgspec.Meta(ge=-720.0, le=720.0)]

HandPlace: TypeAlias = Literal["grip", "page", "key"]
HandShape: TypeAlias = Literal["held", "open", "pinch", "point"]
Which: TypeAlias = Literal["free", "left", "right"]
Offset: TypeAlias = Annotated[float, msgspec.Meta(ge=-0.5, le=0.5)]

MOST_TRACKS = 15
"""Greatest number of tracks: one for every angle of every target."""
MOST_KEYS = 64


class AngleKey(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A key of an angle: time, value and slope.

    Attributes
    ----------
    at : float
        Share of the gesture's length.
    deg : float
        The angle in degrees.
    slope : float or None
        Tangent in degrees per length of the gesture; None for automatic: horizontal at an extreme, else towards the
        neighbours.
    """

    at: Fraction01
    deg: Angle
    slope: Slope | None = None


class AngleTrack(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Keys of one angle, which begins and ends at 0.

    Attributes
    ----------
    target : str
        Rotated part.
    turn : str
        ``"up"``: bell and face up, trunk back, elbow out; ``"left"``: turned to the player's left; ``"roll"``: leaning
        to the left. Elbows have only ``"up"``.
    """

    target: Target
    turn: Turn
    keys: tuple[AngleKey, ...]


class HandKey(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Place of a hand at a time.

    Attributes
    ----------
    at : float
        Share of the gesture's length.
    place : str
        ``"grip"``: on the instrument; ``"page"``: the fingertips in the middle of the music; ``"key"``: the forefinger
        on the instrument's water key.
    m : tuple of float
        Offset to the left, up and forward in metres of an adult.
    shape : str
        Shape of the fingers. ``"held"``: as on the instrument; ``"open"``; ``"pinch"``: with thumb and forefinger;
        ``"point"``.
    """

    at: Fraction01
    place: HandPlace = "grip"
    m: tuple[Offset, Offset, Offset] = (0.0, 0.0, 0.0)
    shape: HandShape = "held"


class HandTrack(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The path of a hand that leaves the instrument; it begins and ends at its grip.

    Attributes
    ----------
    which : str
        ``"free"``: the hand that can leave the instrument according to its map.
    """

    keys: tuple[HandKey, ...]
    which: Which = "free"


class ShareKey(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Key of a curve whose value is a share: time as a share of the gesture's length, and value, both 0..1."""

    at: Fraction01
    share: Fraction01


class GazeTrack(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Gaze during a gesture: start and end as shares of the gesture's length, and direction in degrees from straight
    ahead.
    """

    start: Fraction01
    end: Fraction01
    up_deg: Annotated[float, msgspec.Meta(ge=-60.0, le=30.0)] = 0.0
    left_deg: Annotated[float, msgspec.Meta(ge=-60.0, le=60.0)] = 0.0


class Gesture(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A gesture that rules or the animator place: keyframed angles, hand, gaze, and conditions for its use.

    Attributes
    ----------
    length_s : float
        Usual duration in seconds.
    may_start : str
        Possible times for rules: always, while nothing is played, or while the instrument is lowered.
    amplitude : tuple of float
        Size at amplitude 0, 0.5 and 1, linear between. A hand moves completely, or not at all if the size is 0.
    hand : HandTrack or None
        Path of a hand that leaves the instrument.
    raised : tuple of ShareKey
        Rise of the lowered instrument as a share of its way to the lips; empty if it stays.
    gaze : GazeTrack or None
        Gaze; None if it is not affected.
    lets_out_water : bool
        Whether rules use it only for an instrument whose map refers to it.
    """

    name: str
    title: Title
    length_s: Annotated[float, msgspec.Meta(ge=0.3, le=30.0)]
    tracks: tuple[AngleTrack, ...] = ()
    may_start: Start = "anytime"
    amplitude: AmplitudeScale = (0.3, 1.0, 1.5)
    description: Title = Title("")
    hand: HandTrack | None = None
    raised: tuple[ShareKey, ...] = ()
    gaze: GazeTrack | None = None
    lets_out_water: bool = False

    @property
    def needs_lowered(self) -> bool:
        """True if the gesture can be made only while the instrument is completely lowered."""
        return self.hand is not None or bool(self.raised)


def read_gesture(path: Path) -> Gesture:
    """Read and check a gesture. Raises FileError, MapError."""
    gesture = decoded(path, Gesture)
    check_name(path, gesture.name)
    check_title(path, gesture.title)
    if not gesture.amplitude[0] <= gesture.amplitude[1] <= gesture.amplitude[2] <= 3.0:
        raise invalid(path, "amplitude", "must not fall, and be at most 3")
    least = 0 if gesture.needs_lowered else 1
    if not least <= len(gesture.tracks) <= MOST_TRACKS:
        raise invalid(path, "tracks", f"must be {least} to {MOST_TRACKS}")
    if gesture.needs_lowered and gesture.may_start != "lowered":
        raise invalid(path, "may_start", 'must be "lowered" where a hand leaves the instrument, or it comes up')
    _check_hand(path, gesture)
    seen: set[tuple[str, str]] = set()
    for index, track in enumerate(gesture.tracks):
        place = f"tracks[{index}]"
        if track.target.endswith("_elbow") and track.turn != "up":
            raise invalid(path, f"{place}.turn", 'an elbow has only "up"')
        if (track.target, track.turn) in seen:
            raise invalid(path, place, f"{track.target} {track.turn} appears twice")
        seen.add((track.target, track.turn))
        _check_keys(path, f"{place}.keys", track.keys)
    return gesture


def _check_keys(path: Path, place: str, keys: tuple[AngleKey, ...]) -> None:
    if not 3 <= len(keys) <= MOST_KEYS:
        raise invalid(path, place, f"must be 3 to {MOST_KEYS}")
    _check_times(path, place, [key.at for key in keys])
    for index in (0, len(keys) - 1):
        if keys[index].deg != 0.0 or keys[index].slope:
            raise invalid(path, f"{place}[{index}].deg", "must be 0 and level: the body goes on from where it is")


def _check_hand(path: Path, gesture: Gesture) -> None:
    if gesture.hand is not None:
        keys = gesture.hand.keys
        if not 3 <= len(keys) <= MOST_KEYS:
            raise invalid(path, "hand.keys", f"must be 3 to {MOST_KEYS}")
        _check_times(path, "hand.keys", [key.at for key in keys])
        for index in (0, len(keys) - 1):
            if keys[index] != HandKey(keys[index].at):
                raise invalid(path, f"hand.keys[{index}]", "must be on the grip: the hand goes back to where it was")
    if gesture.raised:
        if not 3 <= len(gesture.raised) <= MOST_KEYS:
            raise invalid(path, "raised", f"must be 3 to {MOST_KEYS}")
        _check_times(path, "raised", [key.at for key in gesture.raised])
        for index in (0, len(gesture.raised) - 1):
            if gesture.raised[index].share != 0.0:
                raise invalid(path, f"raised[{index}].share", "must be 0: the instrument is lowered before and after")
    if gesture.gaze is not None and gesture.gaze.end <= gesture.gaze.start:
        raise invalid(path, "gaze.end", "must be after the start")


def _check_times(path: Path, place: str, at: list[float]) -> None:
    for index, (before, after) in enumerate(pairwise(at), 1):
        if after - before < 0.01:
            raise invalid(path, f"{place}[{index}].at", "must be at least 0.01 after the key before")
    for index, end in ((0, 0.0), (len(at) - 1, 1.0)):
        if at[index] != end:
            raise invalid(path, f"{place}[{index}].at", f"must be {end:g}: a gesture begins at 0 and ends at 1")


# Created while the import lock is held, as in `metadata.load`.
msgspec.json.Decoder(Gesture)
