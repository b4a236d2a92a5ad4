"""A place on the stage as three numbers: metres to the right and towards the audience, and a rotation in degrees."""

from __future__ import annotations

import math

import msgspec

from app.editor.session import Session
from app.project.casting import StagePosition
from widgets.common.controls import Retranslated
from widgets.common.number_slider import NumberSlider
from widgets.players.stage import FARTHEST_M


def place_sliders(holder: Retranslated, session: Session, prefix: str) -> dict[str, NumberSlider]:
    """Return a slider for each field of a place, by the field's name; ``holder`` sets their texts."""
    sliders = {
        "x_m": NumberSlider(session, -FARTHEST_M, FARTHEST_M, step=0.05, slides=False),
        "z_m": NumberSlider(session, -FARTHEST_M, FARTHEST_M, step=0.05, slides=False),
        "turn_rad": NumberSlider(session, -180.0, 180.0, decimals=0, step=5.0),
    }
    for name, slider in sliders.items():
        slider.setObjectName(f"{prefix}_{name}")
    holder.texted(sliders["x_m"], words=("place.x", "place.metres", "place.right_tip"))
    holder.texted(sliders["z_m"], words=("place.z", "place.metres", "place.front_tip"))
    holder.texted(sliders["turn_rad"], words=("place.turn", "°", "place.turn_tip"))
    return sliders


def shown_number(place: StagePosition, name: str) -> float:
    """Return a field of a place in its displayed unit: metres or degrees."""
    return round(math.degrees(place.turn_rad)) + 0.0 if name == "turn_rad" else float(getattr(place, name))


def with_number(place: StagePosition, name: str, shown: float) -> StagePosition:
    """Return a position on stage with one field set to a displayed value; angles are displayed in degrees."""
    return msgspec.structs.replace(place, **{name: math.radians(shown) if name == "turn_rad" else shown})
