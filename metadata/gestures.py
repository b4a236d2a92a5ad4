"""Gestures as an animator writes them: keyed angles of parts of the body, added to whatever the body does there.

Hands, lips and feet keep their places: contacts are solved after.
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

MOST_TRACKS = 15
"""Every angle of every target."""
MOST_KEYS = 64


class Key(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An angle at a time.

    Attributes
    ----------
    at : float
        Share of the gesture's length.
    deg : float
    slope : float or None
        Tangent, degrees for the whole length of the gesture; None: level at a turn, else towards the neighbours.
    """

    at: Fraction01
    deg: Angle
    slope: Slope | None = None


class Track(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The keys of one angle; it begins and ends at 0.

    Attributes
    ----------
    target : str
        What is turned.
    turn : str
        ``"up"``: bell and face up, trunk back, elbow out; ``"left"``: turned to the player's left; ``"roll"``: leaning
        to the left. Elbows have only ``"up"``.
    """

    target: Target
    turn: Turn
    keys: tuple[Key, ...]


class Gesture(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A gesture.

    Attributes
    ----------
    length_s : float
        As it is usually done.
    may_start : str
        Where rules may place it: anywhere, while nothing is played, or while the instrument is lowered.
    amplitude : tuple of float
        Its size at amplitude 0, 0.5 and 1, linear between.
    """

    name: str
    title: Title
    length_s: Annotated[float, msgspec.Meta(ge=0.3, le=30.0)]
    tracks: tuple[Track, ...]
    may_start: Start = "anytime"
    amplitude: AmplitudeScale = (0.3, 1.0, 1.5)
    description: Title = Title("")


def read_gesture(path: Path) -> Gesture:
    """Read and check a gesture. Raises FileError, MapError."""
    gesture = decoded(path, Gesture)
    check_name(path, gesture.name)
    check_title(path, gesture.title)
    if not gesture.amplitude[0] <= gesture.amplitude[1] <= gesture.amplitude[2] <= 3.0:
        raise invalid(path, "amplitude", "must not fall, and be at most 3")
    if not 1 <= len(gesture.tracks) <= MOST_TRACKS:
        raise invalid(path, "tracks", f"must be 1 to {MOST_TRACKS}")
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


def _check_keys(path: Path, place: str, keys: tuple[Key, ...]) -> None:
    if not 3 <= len(keys) <= MOST_KEYS:
        raise invalid(path, place, f"must be 3 to {MOST_KEYS}")
    for index, (key, following) in enumerate(pairwise(keys), 1):
        if following.at - key.at < 0.01:
            raise invalid(path, f"{place}[{index}].at", "must be at least 0.01 after the key before")
    for index, at in ((0, 0.0), (len(keys) - 1, 1.0)):
        key = keys[index]
        if key.at != at:
            raise invalid(path, f"{place}[{index}].at", f"must be {at:g}: a gesture begins at 0 and ends at 1")
        if key.deg != 0.0 or key.slope:
            raise invalid(path, f"{place}[{index}].deg", "must be 0 and level: the body goes on from where it is")


# As in `metadata.load`: types are worked out under the import's lock.
msgspec.json.Decoder(Gesture)
