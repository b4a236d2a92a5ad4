"""What kinds of events and expressions are called in the person's language."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication


def kind_name(kind: str) -> str:
    """The name of a kind of event: the first part of its id."""
    names = {
        "breath": QCoreApplication.translate("Event", "Breath"),
        "preparation": QCoreApplication.translate("Event", "Preparation"),
        "cue": QCoreApplication.translate("Event", "Cue"),
        "expression": QCoreApplication.translate("Event", "Expression"),
        "sway": QCoreApplication.translate("Event", "Sway"),
        "weight_shift": QCoreApplication.translate("Event", "Weight shift"),
        "bell_height": QCoreApplication.translate("Event", "Bell height"),
        "lower_instrument": QCoreApplication.translate("Event", "Instrument lowered"),
        "pose": QCoreApplication.translate("Event", "Pose"),
        "vary": QCoreApplication.translate("Event", "Performed anew"),
    }
    return names.get(kind, kind)


def expression_name(name: str) -> str:
    """The name of a bundled expression; one's own are called what they are called."""
    names = {
        "neutral": QCoreApplication.translate("Expression", "Neutral"),
        "strained": QCoreApplication.translate("Expression", "Strained"),
        "puffed": QCoreApplication.translate("Expression", "Puffed"),
        "brows_up": QCoreApplication.translate("Expression", "Brows up"),
        "smile": QCoreApplication.translate("Expression", "Smile"),
    }
    return names.get(name, name)


def pose_name(target: str) -> str:
    """The name of what is held differently."""
    names = {
        "bell": QCoreApplication.translate("Pose", "Bell"),
        "head": QCoreApplication.translate("Pose", "Head"),
        "left_elbow": QCoreApplication.translate("Pose", "Left elbow"),
        "right_elbow": QCoreApplication.translate("Pose", "Right elbow"),
        "torso": QCoreApplication.translate("Pose", "Torso"),
    }
    return names.get(target, target)
