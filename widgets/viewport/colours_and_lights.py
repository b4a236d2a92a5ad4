"""Colours and lights of the picture, from the design tokens."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from app.editor.design_tokens import Tokens
from app.formats.video import Picture

Color = tuple[float, float, float]


@dataclass(frozen=True)
class ViewportLook:
    """Colours of the 3D view, 0..1 in display values (backdrop, floor, lines), and its lights in linear units."""

    top: Color
    horizon: Color
    floor: Color
    lines: Color
    sky: Color
    ground: Color
    rim: Color
    key_light: Color
    fill_light: Color
    shadow: float
    key: Color
    wire: Color


@dataclass(frozen=True)
class Emphasis:
    """State of the picture beyond the poses: rings on the floor by row, the conductor's place, performers in the way,
    wireframe, props and video.
    """

    rings: Mapping[int, Color] = field(default_factory=dict)
    podium: tuple[float, float, Color] | None = None
    """Position (x, z) of the conductor in metres and colour of the rings that mark it; None without a conductor."""
    in_the_way: Mapping[int, float] = field(default_factory=dict)
    """Share of the pixels omitted, 0..1, by row of the performers in the way of those that the view is about."""
    wireframe: bool = False
    props: bool = True
    """True if straps and chairs are drawn."""
    video: Picture | None = None
    """Video picture drawn behind the players; None without a video."""
    video_opacity: float = 1.0
    """Opacity of the video's picture, 0..1."""
    is_final: bool = False
    """True if missing levels of detail are made before the picture is drawn, since no better one follows."""
    in_motion: bool = False
    """True if the next picture follows immediately: drawing without a graphics card may then be less exact."""


def direction(x: float, y: float, z: float) -> Color:
    """Return a direction as a vector of length 1."""
    length = float(np.linalg.norm((x, y, z)))
    return x / length, y / length, z / length


KEY = direction(-0.55, 1.0, 0.72)
"""Direction towards the key light: above the audience's left, as on a stage."""


def rgb(text: str) -> Color:
    """Convert a colour ``#rrggbb`` to red, green and blue 0..1."""
    return int(text[1:3], 16) / 255.0, int(text[3:5], 16) / 255.0, int(text[5:7], 16) / 255.0


def mixed(one: Color, other: Color, share: float) -> Color:
    """Return a mixture of two colours; at ``share`` 0 it is the first, at 1 the second."""
    return (
        one[0] + share * (other[0] - one[0]),
        one[1] + share * (other[1] - one[1]),
        one[2] + share * (other[2] - one[2]),
    )


def is_dark(tokens: Tokens) -> bool:
    """Return whether a theme's surface is dark."""
    return sum(rgb(tokens.surface)) < 1.5


@lru_cache(maxsize=4)
def look_of(tokens: Tokens) -> ViewportLook:
    """Return colours and lights of the 3D view for a theme."""
    surface, sunken, raised = rgb(tokens.surface), rgb(tokens.sunken), rgb(tokens.raised)
    text, accent = rgb(tokens.text), rgb(tokens.accent)
    if is_dark(tokens):
        return ViewportLook(
            top=mixed(sunken, (0.0, 0.0, 0.0), 0.1),
            horizon=mixed(surface, text, 0.07),
            floor=mixed(raised, text, 0.24),
            lines=mixed(raised, text, 0.5),
            sky=(0.30, 0.315, 0.345),
            ground=(0.11, 0.105, 0.10),
            rim=(2.0, 2.2, 2.6),
            key_light=(1.22, 1.16, 1.07),
            fill_light=(0.17, 0.19, 0.22),
            shadow=0.95,
            key=KEY,
            wire=mixed(accent, text, 0.3),
        )
    return ViewportLook(
        top=mixed(sunken, text, 0.24),
        horizon=mixed(sunken, text, 0.09),
        floor=mixed(sunken, text, 0.11),
        lines=mixed(sunken, text, 0.42),
        sky=(0.45, 0.46, 0.48),
        ground=(0.24, 0.235, 0.23),
        rim=(0.8, 0.85, 0.9),
        key_light=(1.12, 1.08, 1.02),
        fill_light=(0.18, 0.19, 0.2),
        shadow=0.8,
        key=KEY,
        wire=mixed(accent, text, 0.2),
    )
