"""The 52 morph targets of a face in the person's language."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication

_WHOLE = frozenset({"jawLeft", "jawRight", "mouthLeft", "mouthRight"})
"""Their side is where they move, not where they are."""


def morph_name(morph: str) -> str:
    """What a morph target does, in words; its own name where there are none."""
    stem, side = morph, ""
    if morph not in _WHOLE:
        for ending, sign in (
            ("Left", QCoreApplication.translate("Morph", "L", "left side")),
            ("Right", QCoreApplication.translate("Morph", "R", "right side")),
        ):
            if morph.endswith(ending):
                stem, side = morph.removesuffix(ending), sign
    words = {
        "browDown": QCoreApplication.translate("Morph", "Brow down"),
        "browInnerUp": QCoreApplication.translate("Morph", "Inner brows up"),
        "browOuterUp": QCoreApplication.translate("Morph", "Outer brow up"),
        "cheekPuff": QCoreApplication.translate("Morph", "Cheeks puffed"),
        "cheekSquint": QCoreApplication.translate("Morph", "Cheek raised"),
        "eyeBlink": QCoreApplication.translate("Morph", "Eye closed"),
        "eyeLookDown": QCoreApplication.translate("Morph", "Looks down"),
        "eyeLookIn": QCoreApplication.translate("Morph", "Looks in"),
        "eyeLookOut": QCoreApplication.translate("Morph", "Looks out"),
        "eyeLookUp": QCoreApplication.translate("Morph", "Looks up"),
        "eyeSquint": QCoreApplication.translate("Morph", "Eye narrowed"),
        "eyeWide": QCoreApplication.translate("Morph", "Eye wide"),
        "jawForward": QCoreApplication.translate("Morph", "Jaw forward"),
        "jawLeft": QCoreApplication.translate("Morph", "Jaw to the left"),
        "jawOpen": QCoreApplication.translate("Morph", "Jaw open"),
        "jawRight": QCoreApplication.translate("Morph", "Jaw to the right"),
        "mouthClose": QCoreApplication.translate("Morph", "Lips closed"),
        "mouthDimple": QCoreApplication.translate("Morph", "Dimple"),
        "mouthFrown": QCoreApplication.translate("Morph", "Corner down"),
        "mouthFunnel": QCoreApplication.translate("Morph", "Funnel"),
        "mouthLeft": QCoreApplication.translate("Morph", "Mouth to the left"),
        "mouthLowerDown": QCoreApplication.translate("Morph", "Lower lip down"),
        "mouthPress": QCoreApplication.translate("Morph", "Lips pressed"),
        "mouthPucker": QCoreApplication.translate("Morph", "Pucker"),
        "mouthRight": QCoreApplication.translate("Morph", "Mouth to the right"),
        "mouthRollLower": QCoreApplication.translate("Morph", "Lower lip rolled in"),
        "mouthRollUpper": QCoreApplication.translate("Morph", "Upper lip rolled in"),
        "mouthShrugLower": QCoreApplication.translate("Morph", "Lower lip pushed up"),
        "mouthShrugUpper": QCoreApplication.translate("Morph", "Upper lip pushed up"),
        "mouthSmile": QCoreApplication.translate("Morph", "Smile"),
        "mouthStretch": QCoreApplication.translate("Morph", "Corner stretched"),
        "mouthUpperUp": QCoreApplication.translate("Morph", "Upper lip up"),
        "noseSneer": QCoreApplication.translate("Morph", "Nose wrinkled"),
        "tongueOut": QCoreApplication.translate("Morph", "Tongue out"),
    }
    name = words.get(stem, stem)
    return f"{name} {side}" if side else name
