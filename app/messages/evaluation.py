"""The evaluation: films of real players, clips, the page and its key."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "evaluation.not_a_key": (
        "{file} is not the key of an evaluation ({detail}); choose the key.json that 'suisou evaluate' wrote",
        "{file} は評価のキーファイルではありません（{detail}）。'suisou evaluate' が書き出した key.json を選んでく"
        "ださい",
    ),
    "evaluation.newer_key": (
        "{file} was written by a newer version of Suisou; update Suisou to read it",
        "{file} は新しいバージョンの Suisou で作成されています。読み込むには Suisou を更新してください",
    ),
}
