"""Names of the channels of additive curves, in the user's language."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from typing import Final

from app.editor.translated import tr
from app.plan.by_hand.additive_curve import BODY_CHANNELS, CHANNELS, FACE
from metadata.model import ARKIT_MORPHS
from widgets.common.morph_names import morph_name
from widgets.common.numbers import number_text

_PARTS: Final = {
    part: f"channel.{part}"
    for part in ("bell", "head", "torso", "left_elbow", "right_elbow", "shoulders", "hips", "knees", "eyes")
}
_WAYS: Final = {way: f"channel.{way}" for way in ("up", "left", "roll", "ahead", "bend", "tilt")}
_FACE_GROUPS: Final = {
    "brow": "channel.brows",
    "cheek": "channel.cheeks",
    "eye": "channel.lids",
    "jaw": "channel.jaw",
    "mouth": "channel.mouth",
    "nose": "channel.nose",
    "tongue": "channel.tongue",
}


def part_name(part: str) -> str:
    """Return the translated name of a part of the body."""
    return tr(_PARTS[part])


def way_name(channel: str) -> str:
    """Return the direction or motion of a channel without its body part: up, to the left and so on."""
    if channel.startswith(FACE):
        return morph_name(channel.removeprefix(FACE))
    return tr(_WAYS[channel.partition(".")[2]])


def channel_name(channel: str) -> str:
    """Return the full name of a channel; if there is none, its name in files."""
    if channel not in CHANNELS:
        return channel
    if channel.startswith(FACE):
        return tr("channel.of").format(part=tr("channel.face"), way=way_name(channel))
    return tr("channel.of").format(part=part_name(channel.partition(".")[0]), way=way_name(channel))


def body_groups() -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the translated name of each body part with its animation channels."""
    for part, channels in groupby(BODY_CHANNELS, key=lambda channel: channel.partition(".")[0]):
        yield part_name(part), tuple(channels)


def face_groups() -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the translated name of each part of the face with its channels."""
    for stem, text_id in _FACE_GROUPS.items():
        yield tr(text_id), tuple(f"{FACE}{name}" for name in ARKIT_MORPHS if name.startswith(stem))


def value_text(channel: str, value: float) -> str:
    """Return a channel's value with its unit: ``12.5°``, ``2.1 cm``, ``0.35``."""
    unit = CHANNELS[channel].unit
    if unit == "deg":
        return f"{number_text(value, 1)}°"
    return f"{number_text(100.0 * value, 1)} cm" if unit == "m" else number_text(value, 2)
