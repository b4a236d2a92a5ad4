"""Types of the numbers in tables of acting, with their bounds."""

from __future__ import annotations

from typing import Annotated, TypeAlias

import msgspec

Fraction01: TypeAlias = Annotated[float, msgspec.Meta(ge=0.0, le=1.0)]
Positive: TypeAlias = Annotated[float, msgspec.Meta(gt=0.0)]
NotNegative: TypeAlias = Annotated[float, msgspec.Meta(ge=0.0)]
Range: TypeAlias = tuple[float, float]
"""Lowest and highest value in degrees."""
Axis: TypeAlias = tuple[float, float, float]
"""Unit vector in the T-pose about which a positive rotation is the motion that the field's name states."""
Delay: TypeAlias = Annotated[float, msgspec.Meta(ge=0.0, le=0.12)]
"""Delay in seconds, limited since longer delays make a body look disjointed."""
AmplitudeScale: TypeAlias = tuple[NotNegative, NotNegative, NotNegative]
"""Values at amplitude 0 (for a player who keeps still), 0.5 (natural) and 1 (exaggerated); linear between. Use
`at_amplitude`.
"""
Weights: TypeAlias = dict[str, Fraction01]
"""Weights of ARKit's morph targets by name."""


def at_amplitude(scale: AmplitudeScale, amplitude: float) -> float:
    """Return the value of a scale (values at amplitude 0, 0.5 and 1) at a player's amplitude 0..1, interpolated
    linearly.
    """
    residual, natural, exaggerated = scale
    if amplitude <= 0.5:
        return residual + (natural - residual) * max(amplitude, 0.0) * 2.0
    return natural + (exaggerated - natural) * (min(amplitude, 1.0) - 0.5) * 2.0
