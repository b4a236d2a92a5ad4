"""What kinds of events and expressions are called in the person's language."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication


def kind_name(kind: str) -> str:
    """The name of a kind of event: the first part of its id."""
    match kind:
        case "breath" | "within":
            return QCoreApplication.translate("Event", "Breath")
        case "preparation":
            return QCoreApplication.translate("Event", "Preparation")
        case "cue":
            return QCoreApplication.translate("Event", "Cue")
        case "expression":
            return QCoreApplication.translate("Event", "Expression")
        case "sway":
            return QCoreApplication.translate("Event", "Sway")
        case "weight_shift":
            return QCoreApplication.translate("Event", "Weight shift")
        case "bell_height":
            return QCoreApplication.translate("Event", "Bell height")
        case "lower_instrument":
            return QCoreApplication.translate("Event", "Instrument lowered")
        case "pose":
            return QCoreApplication.translate("Event", "Pose")
        case "vary":
            return QCoreApplication.translate("Event", "Performed anew")
    return kind


def expression_name(name: str) -> str:
    """The name of a bundled expression; one's own are called what they are called."""
    match name:
        case "neutral":
            return QCoreApplication.translate("Expression", "Neutral")
        case "strained":
            return QCoreApplication.translate("Expression", "Strained")
        case "puffed":
            return QCoreApplication.translate("Expression", "Puffed")
        case "brows_up":
            return QCoreApplication.translate("Expression", "Brows up")
        case "smile":
            return QCoreApplication.translate("Expression", "Smile")
    return name


def pose_name(target: str) -> str:
    """The name of what is held differently."""
    match target:
        case "bell":
            return QCoreApplication.translate("Pose", "Bell")
        case "head":
            return QCoreApplication.translate("Pose", "Head")
        case "left_elbow":
            return QCoreApplication.translate("Pose", "Left elbow")
        case "right_elbow":
            return QCoreApplication.translate("Pose", "Right elbow")
        case "torso":
            return QCoreApplication.translate("Pose", "Torso")
    return target
