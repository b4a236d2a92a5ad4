"""Names and refusals of edits of notes."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "edit.add_note": ("Add Note", "音符を追加"),
    "edit.erase_notes": ("Erase {count} {count:Note|Notes}", "音符を消去（{count} 個）"),
    "edit.move_notes": ("Move {count} {count:Note|Notes}", "音符を移動（{count} 個）"),
    "edit.transpose_notes": ("Transpose {count} {count:Note|Notes}", "音符を移調（{count} 個）"),
    "edit.nudge_notes": ("Nudge {count} {count:Note|Notes}", "音符をずらす（{count} 個）"),
    "edit.resize_notes": ("Resize {count} {count:Note|Notes}", "音符の長さを変更（{count} 個）"),
    "edit.split_notes": ("Split {count} {count:Note|Notes}", "音符を分割（{count} 個）"),
    "edit.join_notes": ("Join {count} {count:Note|Notes}", "音符を結合（{count} 個）"),
    "edit.duplicate_notes": ("Duplicate {count} {count:Note|Notes}", "音符を複製（{count} 個）"),
    "edit.change_velocity": ("Change Velocity of {count} {count:Note|Notes}", "ベロシティを変更（{count} 個）"),
    "edit.quantise_notes": ("Quantise {count} {count:Note|Notes}", "音符をクオンタイズ（{count} 個）"),
    "edit.cut_notes": ("Cut {count} {count:Note|Notes}", "音符を切り取り（{count} 個）"),
    "edit.paste_notes": ("Paste {count} {count:Note|Notes}", "音符を貼り付け（{count} 個）"),
    "edit.set_tempo": ("Set Tempo", "テンポを設定"),
    "edit.move_tempo": ("Move Tempo", "テンポを移動"),
    "edit.move_metre": ("Move Time Signature", "拍子を移動"),
    "edit.remove_tempo": ("Remove Tempo", "テンポを削除"),
    "edit.set_felt_beat": ("Set Beat Unit", "拍の単位を変更"),
    "edit.set_metre": ("Set Time Signature", "拍子を設定"),
    "edit.remove_metre": ("Remove Time Signature", "拍子を削除"),
    "note.before_start": ("A note cannot start before the piece.", "曲の始まりより前に音符は置けません。"),
    "note.after_all_pieces": (
        "A note cannot end later than the maximum length of a piece.",
        "扱える曲の長さを超える位置に音符は置けません。",
    ),
    "note.pitch_outside": (
        "Pitch {pitch} is outside the MIDI range, {low} to {high}.",
        "音高 {pitch} は範囲外です。{low} から {high} までです。",
    ),
    "note.velocity_outside": (
        "Velocity {velocity} is outside the range {low} to {high}.",
        "ベロシティ {velocity} は範囲外です。{low} から {high} までです。",
    ),
    "note.too_short": ("A note must be at least one tick long.", "音符には 1 ティック以上の長さが必要です。"),
    "note.nothing_to_split": (
        "No selected note sounds across this position, so nothing was split.",
        "選択した音符の中に、この位置をまたぐ音符がないため、分割できません。",
    ),
    "note.nothing_to_join": (
        "Select two or more consecutive notes of the same pitch to join them.",
        "結合するには、連続する同じ音高の音符を 2 つ以上選んでください。",
    ),
    "note.nothing_to_paste": (
        "The clipboard contains no notes. Copy some notes first.",
        "クリップボードに音符がありません。先に音符をコピーしてください。",
    ),
    "note.nowhere_to_paste": (
        "There is no player to paste the notes to. Add a player first.",
        "貼り付け先の奏者がいません。先に奏者を追加してください。",
    ),
}
