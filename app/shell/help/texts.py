"""Texts of the help window, the help buttons and the first steps: id -> English and Japanese."""

from __future__ import annotations

from typing import Final

TEXTS: Final[dict[str, tuple[str, str]]] = {
    "first_steps.back": ("Back", "戻る"),
    "first_steps.close": ("Close First Steps", "ファーストステップを閉じる"),
    "first_steps.done.amplitude": (
        "Done. The motion of the selected players was generated again.",
        "できました。選択した奏者の動きが作り直されました。",
    ),
    "first_steps.done.breath": (
        "Done. Its preparation moved along, and Ctrl+Z takes it back.",
        "できました。準備動作も一緒に動きます。Ctrl+Z で元に戻せます。",
    ),
    "first_steps.done.export": (
        "Done. You know the way from the notes to the file. The guides (F1) tell the rest.",
        "できました。これで音符からファイルまでの流れは終わりです。続きはガイド（F1）にあります。",
    ),
    "first_steps.done.fingering": (
        "Done. The fingering is pinned: it stays when everything else is regenerated.",
        "できました。この運指は固定され、ほかを再生成しても残ります。",
    ),
    "first_steps.done.play": ("Done. {keys} pauses.", "できました。{keys} で一時停止します。"),
    "first_steps.finish": ("Finish", "完了"),
    "first_steps.next": ("Next", "次へ"),
    "first_steps.skip": ("Skip", "スキップ"),
    "first_steps.step": ("First Steps: {number} of {count}", "ファーストステップ: {number} / {count}"),
    "first_steps.text.amplitude": (
        "Drag Amplitude, the size of all motion of the selected players. Play again ({keys}) to compare.",
        "「動きの大きさ」をドラッグします。選択した奏者のすべての動きが変わります。もう一度再生（{keys}）して比べてください。",
    ),
    "first_steps.text.breath": (
        "Each hill in the Breath lane is a breath. Drag one to the left or right.",
        "ブレスレーンの山が一つひとつのブレスです。山を左右にドラッグしてください。",
    ),
    "first_steps.text.export": (
        "Open Export > Export Players... ({keys}). Players and instruments are written as FBX, BVH, GLB or USD, or "
        "straight into an Unreal project.",
        "「書き出し > 奏者を書き出す...」（{keys}）を開きます。奏者と楽器を FBX・BVH・GLB・USD、"
        "または Unreal プロジェクトに書き出せます。",
    ),
    "first_steps.text.fingering": (
        "Click a note in the Fingering lane and choose another chip, or select a note and press {keys}.",
        "運指レーンの音符をクリックして別の候補を選ぶか、音符を選択して {keys} キーを押します。",
    ),
    "first_steps.text.play": (
        "Press {keys} or this button. Fingers, breaths and motion were generated from the notes.",
        "{keys} キーかこのボタンを押します。指使い、ブレス、動きは音符から生成されています。",
    ),
    "first_steps.title.amplitude": ("Change the amplitude", "動きの大きさを変える"),
    "first_steps.title.breath": ("Move a breath", "ブレスを動かす"),
    "first_steps.title.export": ("Export", "書き出す"),
    "first_steps.title.fingering": ("Correct a fingering", "運指を直す"),
    "first_steps.title.play": ("Play the piece", "再生する"),
    "first_steps.waiting": ("Try it, or skip it.", "試してみてください。スキップもできます。"),
    "help_window.back": ("Back (Alt+Left)", "戻る (Alt+←)"),
    "help_window.contents": ("Contents", "目次"),
    "help_window.forward": ("Forward (Alt+Right)", "進む (Alt+→)"),
    "help_window.larger": ("Larger text (Ctrl++)", "文字を大きく (Ctrl++)"),
    "help_window.leads_outside": ("Not one of the guides: {path}", "ガイド以外のファイルです: {path}"),
    "help_window.no_hits": ("No matches in the guides.", "ガイド内に一致する箇所がありません。"),
    "help_window.not_opened": ("This kind of link is not opened: {link}", "この種類のリンクは開きません: {link}"),
    "help_window.not_translated": (
        "This guide is only available in English.",
        "このガイドの日本語版はまだありません。英語版を表示しています。",
    ),
    "help_window.search": ("Search guides", "ガイドを検索"),
    "help_window.smaller": ("Smaller text (Ctrl+-)", "文字を小さく (Ctrl+-)"),
    "help_window.title": ("{guide} - Suisou Guides", "{guide} - Suisou ガイド"),
}
