"""Messages about edits of takes."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "edit.comp": ("Comp Bars from {take}", "{take} から小節を採用"),
    "edit.comp_whole": ("Comp Whole {take}", "{take} 全体を採用"),
    "edit.comp_before": ("Restore Pre-take Part", "テイク前のパートに戻す"),
    "edit.rename_take": ("Rename Take to {take}", "テイクの名前を {take} に変更"),
    "edit.colour_take": ("Change Colour of {take}", "{take} の色を変更"),
    "edit.remove_take": ("Delete {take}", "{take} を削除"),
    "edit.move_take": ("Move {take}", "{take} を移動"),
    "edit.clean_take": ("Clean Up {take}", "{take} をクリーンアップ"),
    "edit.follow_beats": ("Fit Tempo to {take}", "テンポを {take} に合わせる"),
    "work.find_beats": ("detecting beats of {take}…", "{take} の拍を検出中…"),
    "take.beats_found": (
        "The tempo now follows {take}: {count} {count:beat|beats}, {bpm:.0f} per minute.",
        "テンポを {take} に合わせました: {count} 拍、毎分 {bpm:.0f} 拍。",
    ),
    "take.changed": (
        "{take} was changed while its beats were being detected, so nothing was done. Try again.",
        "拍の検出中に {take} が変更されたため、何も行いませんでした。もう一度試してください。",
    ),
    "take.none": ("Take {take} no longer exists.", "テイク {take} は既に存在しません。"),
    "take.too_many": (
        "A project can have at most {most} takes. Delete some takes first.",
        "1 つのプロジェクトに置けるテイクは {most} 個までです。先にいくつか削除してください。",
    ),
    "take.invalid": (
        "The recording cannot be used because its journal is damaged ({place}: {detail}).",
        "ジャーナルファイルが壊れているため、録音を使用できません（{place}: {detail}）。",
    ),
    "take.not_free": (
        "{part} already contains notes, so the tempo cannot follow one take. Quantise the take instead.",
        (
            "{part} には既に音符があるため、テンポを 1 つのテイクに合わせられません。"
            "代わりにテイクをクオンタイズしてください。"
        ),
    ),
    "take.too_few_notes": (
        "The take has {count} {count:note|notes}; at least {least} are required to detect beats.",
        "このテイクの音符は {count} 個です。拍の検出には {least} 個以上必要です。",
    ),
    "take.no_beats": ("No beats were detected in this take.", "このテイクからは拍を検出できませんでした。"),
}
