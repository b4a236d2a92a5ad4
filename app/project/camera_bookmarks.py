"""Cameras stored with a piece by name, as bookmarks of the viewport."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Final, Literal, TypeAlias, get_args

import msgspec

from app.project import limits
from app.project.value_checks import Fault, text_faults, unique

View: TypeAlias = Literal["ensemble", "front", "side", "top", "hands", "mouth", "feet"]
"""Subject and direction of the camera; a close-up follows a player."""
VIEWS: Final[tuple[View, ...]] = get_args(View)
OF_INSTRUMENTS: Final[tuple[View, ...]] = ("hands", "mouth")
"""Views that need an instrument."""
MOST_CAMERAS: Final = 100

_Metres: TypeAlias = Annotated[float, msgspec.Meta(ge=limits.STAGE_M[0], le=limits.STAGE_M[1])]
_Radians: TypeAlias = Annotated[float, msgspec.Meta(ge=-7.0, le=7.0)]
_Point: TypeAlias = tuple[_Metres, _Metres, _Metres]


class CameraBookmark(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A stored camera: an orbit around a target; in a close-up the target moves with its performer.

    Attributes
    ----------
    name : str
        Unique in a piece, ignoring case.
    view : str
        One of `VIEWS`; close-ups follow their performer.
    player_id : str
        Id of the followed player or dancer; empty for none. If the performer no longer exists, the camera is fixed.
    target_m : (float, float, float)
        Point in the middle of the picture when the camera was stored.
    yaw_rad, pitch_rad : float
        Angle from the audience's direction towards +X, and angle above the horizontal.
    distance_m : float
        Distance from the target.
    fov_deg : float
        Vertical angle of view.
    shift_m : (float, float, float)
        Offset of a close-up's target from the followed point.
    """

    name: str
    view: View
    player_id: Annotated[str, msgspec.Meta(max_length=limits.MOST_ID)]
    target_m: _Point
    yaw_rad: _Radians
    pitch_rad: _Radians
    distance_m: Annotated[float, msgspec.Meta(gt=0.0, le=limits.STAGE_M[1])]
    fov_deg: Annotated[float, msgspec.Meta(ge=1.0, le=170.0)]
    shift_m: _Point = (0.0, 0.0, 0.0)


def camera_faults(cameras: Sequence[CameraBookmark]) -> Iterator[Fault]:
    """Yield key path and description of every error in a piece's camera bookmarks."""
    if len(cameras) > MOST_CAMERAS:
        yield "cameras", f"at most {MOST_CAMERAS}"
    yield from unique("cameras", (camera.name.casefold() for camera in cameras), "name")
    for index, camera in enumerate(cameras):
        if not camera.name:
            yield f"cameras[{index}].name", "must not be empty"
        yield from text_faults(f"cameras[{index}].name", camera.name)
