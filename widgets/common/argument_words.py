"""Words that stand as arguments in messages, in the person's language."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication


def argument_word(value: str) -> str:
    """What a word of the program's own is called; anything else is as it is."""
    words = {
        "left": QCoreApplication.translate("Word", "left"),
        "right": QCoreApplication.translate("Word", "right"),
        "melody": QCoreApplication.translate("Word", "leads the melody"),
        "chosen": QCoreApplication.translate("Word", "chosen as leader"),
        "pin_fingering": QCoreApplication.translate("Word", "fingering"),
        "remove": QCoreApplication.translate("Word", "removal"),
        "set_breath": QCoreApplication.translate("Word", "breath"),
        "set_cue": QCoreApplication.translate("Word", "cue"),
        "set_embouchure": QCoreApplication.translate("Word", "embouchure"),
        "change_gesture": QCoreApplication.translate("Word", "gesture"),
        "add_gesture": QCoreApplication.translate("Word", "gesture"),
        "change_expression": QCoreApplication.translate("Word", "expression"),
        "add_expression": QCoreApplication.translate("Word", "expression"),
        "pose": QCoreApplication.translate("Word", "pose"),
        "vary": QCoreApplication.translate("Word", "variation"),
    }
    return words.get(value, value)


WORDED = ("kind", "leader_reason", "side")
"""Arguments of messages that are such words."""
