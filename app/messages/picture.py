"""Pictures of the players: why there is none."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "picture.no_gl": (
        ("the players cannot be displayed because OpenGL 2 is not available ({reason}); update the graphics driver"),
        ("OpenGL 2 を使用できないため、奏者を表示できません（{reason}）。グラフィックドライバーを更新してください"),
    ),
    "picture.loading": (
        "the players are still loading; try again in a moment",
        "奏者を読み込み中です。少し待ってからもう一度試してください",
    ),
}
