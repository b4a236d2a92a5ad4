"""What kinds of events and expressions are called in the user's language."""

from __future__ import annotations

from app.editor.translated import tr


def kind_name(kind: str) -> str:
    """The name of a kind of event: the first part of its id."""
    match kind:
        case "breath" | "within":
            return tr("event.breath")
        case "preparation":
            return tr("event.preparation")
        case "cue":
            return tr("event.cue")
        case "expression":
            return tr("event.expression")
        case "sway":
            return tr("event.sway")
        case "weight_shift":
            return tr("event.weight_shift")
        case "bell_height":
            return tr("event.bell_height")
        case "lower_instrument":
            return tr("event.instrument_lowered")
        case "pose":
            return tr("event.pose")
        case "vary":
            return tr("event.performed_anew")
    return kind


def expression_name(name: str) -> str:
    """The name of a bundled expression; custom are called what they are called."""
    match name:
        case "neutral":
            return tr("expression_name.neutral")
        case "strained":
            return tr("expression_name.strained")
        case "puffed":
            return tr("expression_name.puffed")
        case "brows_up":
            return tr("expression_name.brows_up")
        case "smile":
            return tr("expression_name.smile")
    return name


def pose_name(target: str) -> str:
    """The name of what is held differently."""
    match target:
        case "bell":
            return tr("pose_name.bell")
        case "head":
            return tr("pose_name.head")
        case "left_elbow":
            return tr("pose_name.left_elbow")
        case "right_elbow":
            return tr("pose_name.right_elbow")
        case "torso":
            return tr("pose_name.torso")
    return target
