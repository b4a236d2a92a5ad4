"""What kinds of events and expressions are called in the user's language."""

from __future__ import annotations

from typing import Final

from app.editor.translated import tr
from metadata.library import GESTURES, HABITS, STYLES
from widgets.common.instrument_name import language

_KINDS: Final = {
    "breath": "event.breath",
    "within": "event.breath",
    "preparation": "event.preparation",
    "cue": "event.cue",
    "expression": "event.expression",
    "sway": "event.sway",
    "weight_shift": "event.weight_shift",
    "bell_height": "event.bell_height",
    "lower_instrument": "event.instrument_lowered",
    "named": "event.gesture",
    "lean": "event.lean",
    "accent": "event.accent",
    "step": "event.step",
    "tap": "event.tap",
    "heel": "event.heel",
    "nod": "event.nod",
    "count": "event.count",
    "look_about": "event.look_about",
    "settle_grip": "event.settle_grip",
    "hold_still": "event.hold_still",
    "look_up": "event.look_up",
    "bow": "event.bow",
    "pose": "event.pose",
    "additive": "event.additive_curve",
    "vary": "event.performed_anew",
    "style": "event.style",
}
_EXPRESSIONS: Final = {
    "neutral": "expression_name.neutral",
    "strained": "expression_name.strained",
    "puffed": "expression_name.puffed",
    "brows_up": "expression_name.brows_up",
    "smile": "expression_name.smile",
    "bright": "expression_name.bright",
    "eyes_closed": "expression_name.eyes_closed",
    "fierce": "expression_name.fierce",
    "focused": "expression_name.focused",
    "mournful": "expression_name.mournful",
    "proud": "expression_name.proud",
    "surprised": "expression_name.surprised",
    "tender": "expression_name.tender",
}
_TARGETS: Final = {
    "bell": "pose_name.bell",
    "head": "pose_name.head",
    "left_elbow": "pose_name.left_elbow",
    "right_elbow": "pose_name.right_elbow",
    "torso": "pose_name.torso",
}


def kind_name(kind: str) -> str:
    """The name of a kind of event (`app.plan.by_hand.corrections.kind_of`)."""
    return tr(_KINDS[kind]) if kind in _KINDS else kind


def expression_name(name: str) -> str:
    """The name of a bundled expression; custom are called what they are called."""
    return tr(_EXPRESSIONS[name]) if name in _EXPRESSIONS else name


def gesture_name(name: str) -> str:
    """The name of a gesture that is written in a table; one that is not there, by its own name."""
    gesture = GESTURES.now().items.get(name)
    return name if gesture is None else gesture.title.in_language(language())


def style_name(name: str) -> str:
    """What a style is called in the user's language; one that is not there, by its name."""
    style = STYLES.now().items.get(name)
    return name if style is None else style.title.in_language(language())


def habit_name(name: str) -> str:
    """What a habit is called in the user's language; one that is not there, by its name."""
    habit = HABITS.now().items.get(name)
    return name if habit is None else habit.title.in_language(language())


def pose_name(target: str) -> str:
    """The name of what is held differently."""
    return tr(_TARGETS[target]) if target in _TARGETS else target
