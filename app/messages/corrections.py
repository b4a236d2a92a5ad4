"""Kinds of corrections by their tags (`app.plan.by_hand.corrections.kind`), within a sentence."""

from __future__ import annotations

from typing import Final

PREFIX: Final = "correction."
WORDINGS: Final[dict[str, tuple[str, str]]] = {
    f"{PREFIX}{tag}": wording
    for tag, wording in {
        "pin_fingering": ("fingering", "運指"),
        "remove": ("removal", "削除"),
        "set_breath": ("breath", "ブレス"),
        "set_cue": ("cue", "合図"),
        "set_embouchure": ("embouchure", "アンブシュア"),
        "change_gesture": ("gesture", "ジェスチャー"),
        "add_gesture": ("gesture", "ジェスチャー"),
        "change_expression": ("expression", "表情"),
        "add_expression": ("expression", "表情"),
        "pose": ("pose", "ポーズ"),
        "additive": ("body curve", "体のカーブ"),
        "vary": ("regenerated", "再生成"),
        "play_style": ("style", "演奏スタイル"),
        "set_mark": ("mark", "記号"),
        "remove_mark": ("removed mark", "記号の削除"),
    }.items()
}
