"""The 52 morph targets of a face in the user's language."""

from __future__ import annotations

from app.editor.translated import tr

_WHOLE = frozenset({"jawLeft", "jawRight", "mouthLeft", "mouthRight"})
"""Morphs whose side is a direction of movement and not a place."""


def morph_name(morph: str) -> str:
    """Return the name of a morph target in words; an unknown name is returned unchanged."""
    stem, side = morph, ""
    if morph not in _WHOLE:
        for ending, sign in (("Left", tr("morph.left_side")), ("Right", tr("morph.right_side"))):
            if morph.endswith(ending):
                stem, side = morph.removesuffix(ending), sign
    words = {
        "browDown": tr("morph.brow_down"),
        "browInnerUp": tr("morph.inner_brows_up"),
        "browOuterUp": tr("morph.outer_brow_up"),
        "cheekPuff": tr("morph.cheeks_puffed"),
        "cheekSquint": tr("morph.cheek_raised"),
        "eyeBlink": tr("morph.eye_closed"),
        "eyeLookDown": tr("morph.looks_down"),
        "eyeLookIn": tr("morph.looks_in"),
        "eyeLookOut": tr("morph.looks_out"),
        "eyeLookUp": tr("morph.looks_up"),
        "eyeSquint": tr("morph.eye_narrowed"),
        "eyeWide": tr("morph.eye_wide"),
        "jawForward": tr("morph.jaw_forward"),
        "jawLeft": tr("morph.jaw_to_left"),
        "jawOpen": tr("morph.jaw_open"),
        "jawRight": tr("morph.jaw_to_right"),
        "mouthClose": tr("morph.lips_closed"),
        "mouthDimple": tr("morph.dimple"),
        "mouthFrown": tr("morph.corner_down"),
        "mouthFunnel": tr("morph.funnel"),
        "mouthLeft": tr("morph.mouth_to_left"),
        "mouthLowerDown": tr("morph.lower_lip_down"),
        "mouthPress": tr("morph.lips_pressed"),
        "mouthPucker": tr("morph.pucker"),
        "mouthRight": tr("morph.mouth_to_right"),
        "mouthRollLower": tr("morph.lower_lip_rolled_in"),
        "mouthRollUpper": tr("morph.upper_lip_rolled_in"),
        "mouthShrugLower": tr("morph.lower_lip_pushed_up"),
        "mouthShrugUpper": tr("morph.upper_lip_pushed_up"),
        "mouthSmile": tr("morph.smile"),
        "mouthStretch": tr("morph.corner_stretched"),
        "mouthUpperUp": tr("morph.upper_lip_up"),
        "noseSneer": tr("morph.nose_wrinkled"),
        "tongueOut": tr("morph.tongue_out"),
    }
    name = words.get(stem, stem)
    return f"{name} {side}" if side else name
