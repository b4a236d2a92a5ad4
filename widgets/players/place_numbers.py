"""A place on the stage as three numbers: metres to the right and towards the audience, and a turn in degrees."""

from __future__ import annotations

import math

import msgspec

from app.editor.session import Session
from app.editor.translated import tr
from app.project.casting import StagePosition
from widgets.common.number_slider import NumberSlider
from widgets.players.stage import FARTHEST_M


def place_sliders(session: Session, prefix: str) -> dict[str, NumberSlider]:
    """A control for each field of a place, by its name."""
    sliders = {
        "x_m": NumberSlider(session, -FARTHEST_M, FARTHEST_M, step=0.05, slides=False),
        "z_m": NumberSlider(session, -FARTHEST_M, FARTHEST_M, step=0.05, slides=False),
        "turn_rad": NumberSlider(session, -180.0, 180.0, decimals=0, step=5.0),
    }
    for name, slider in sliders.items():
        slider.setObjectName(f"{prefix}_{name}")
    return sliders


def name_places(sliders: dict[str, NumberSlider]) -> None:
    """Set their words in the language of the editor."""
    metres = tr("place.metres")
    words = {
        "x_m": (tr("place.x"), metres, tr("place.to_right_as_audience_sees")),
        "z_m": (tr("place.z"), metres, tr("place.towards_audience_from_middle")),
        "turn_rad": (tr("place.turn"), "°", tr("place.0_faces_audience_positive_turns")),
    }
    for name, (label, unit, tip) in words.items():
        sliders[name].set_texts(label, unit, tip)


def shown_number(place: StagePosition, name: str) -> float:
    """A field of a place as it is shown."""
    return round(math.degrees(place.turn_rad)) + 0.0 if name == "turn_rad" else float(getattr(place, name))


def with_number(place: StagePosition, name: str, shown: float) -> StagePosition:
    """The place with a field as it was shown."""
    return msgspec.structs.replace(place, **{name: math.radians(shown) if name == "turn_rad" else shown})
