"""Texts for the user, in the editor's language."""

from __future__ import annotations

TEXTS = {
    "title": ("Suisou", "Suisou"),
    "import": ("Import Performance", "演奏をインポート"),
    "import_tip": (
        "Makes skeletal meshes, animations, the sound and a level sequence of what Suisou exported into this project",
        "Suisou がこのプロジェクトに書き出した演奏から、スケルタルメッシュ、アニメーション、"
        "音声、レベルシーケンスを作ります",
    ),
    "update": ("Update Performance", "演奏を更新"),
    "update_tip": (
        "Brings what was imported up to date with what Suisou has exported since; your own assets and tracks stay",
        "インポートした演奏を、Suisou がその後書き出した内容に更新します。自分で加えたアセットやトラックは変わりません",
    ),
    "nothing_exported": (
        "There is no performance in {folder}.\n\nExport one from Suisou into this project first.",
        "{folder} に演奏がありません。\n\nまず Suisou からこのプロジェクトへ書き出してください。",
    ),
    "nothing_new": (
        "Every performance that is there has been imported already: {names}.\n\nTo bring it up to date choose Update "
        "Performance.",
        "演奏はすべてインポート済みです: {names}\n\n更新するには「演奏を更新」を選んでください。",
    ),
    "nothing_imported": (
        "No performance has been imported yet. Choose Import Performance first.",
        "インポートした演奏がまだありません。先に「演奏をインポート」を選んでください。",
    ),
    "ask_import": ('Import "{name}"?', "「{name}」をインポートしますか？"),
    "ask_update": ('Update "{name}"?', "「{name}」を更新しますか？"),
    "old_engine": (
        "This is Unreal Engine {version}, which lacks {names}. Unreal Engine 5.2 or newer is needed.",
        "Unreal Engine {version} には {names} がありません。Unreal Engine 5.2 以降が必要です。",
    ),
    "plugin_off": (
        'The plug-in "{name}" is off. Turn it on under Edit > Plugins, start the editor again, then repeat this.',
        "プラグイン「{name}」が無効です。「編集 > プラグイン」で有効にし、"
        "エディターを再起動してからやり直してください。",
    ),
    "others_go_on": (
        "The following cannot be imported; everything else can.",
        "以下はインポートできません。ほかの演奏はインポートできます。",
    ),
    "larger_textures": (
        'Textures that stay as large as "{piece}" has them, which shares them: {count}.',
        "「{piece}」と共有しているテクスチャー {count} 枚は、その演奏の大きいサイズのままです。",
    ),
    "left_out": (
        "Excluded from the export; what was imported before stays as it was: {name}. {reason}",
        "書き出しから除外されています。以前にインポートしたものはそのまま残ります: {name}。{reason}",
    ),
    "unreadable": (
        "{file} cannot be read: {detail}\n\nExport again from Suisou.",
        "{file} を読み込めません: {detail}\n\nSuisou からもう一度書き出してください。",
    ),
    "newer": (
        "{file} was written by a newer Suisou. Close the editor, remove the folder Plugins/Suisou, export again from "
        "Suisou, and start the editor.",
        "{file} は新しい Suisou で書き出されています。"
        "エディターを閉じて Plugins/Suisou フォルダーを削除し、Suisou からもう一度"
        "書き出してから、エディターを起動してください。",
    ),
    "missing_file": (
        "{file} is not there.\n\nExport again from Suisou.",
        "{file} がありません。\n\nSuisou からもう一度書き出してください。",
    ),
    "changed_file": (
        "{file} is not what Suisou exported: it was changed, or an export was broken off.\n\nExport again from Suisou.",
        "{file} は Suisou が書き出した内容と違います。変更されたか、書き出しが中断されています。"
        "\n\nSuisou からもう一度書き出してください。",
    ),
    "not_ours": (
        "{asset} is there already and was not made by Suisou. Rename it or move it, then repeat this.",
        "{asset} は既にあり、Suisou が作ったものではありません。名前を変えるか移動してから、やり直してください。",
    ),
    "read_only": (
        "The level sequence {asset} is locked. Unlock it in Sequencer, then repeat this.",
        "レベルシーケンス {asset} はロックされています。シーケンサーでロックを解除してから、やり直してください。",
    ),
    "not_imported": (
        "Unreal did not make {asset} of {file}. The Output Log says why.",
        "Unreal は {file} から {asset} を作れませんでした。理由は出力ログを見てください。",
    ),
    "not_changed": (
        "Unreal did not let {asset} be renamed, replaced or removed. Close its editors, check that it is checked out "
        "and writable, then repeat this.",
        "{asset} の名前の変更、置き換え、または削除ができませんでした。"
        "アセットのエディターを閉じ、チェックアウトされていて書き込めることを"
        "確かめてから、やり直してください。",
    ),
    "not_saved": (
        "Not everything in {folder} could be saved. Check that the files are writable, then choose File > Save All.",
        "{folder} の一部を保存できませんでした。"
        "ファイルに書き込めることを確かめてから「ファイル > すべて保存」を選んでください。",
    ),
    "no_actor": (
        "No actor could be made of {asset}. Open a level that can be edited, then repeat this.",
        "{asset} からアクターを作れませんでした。編集できるレベルを開いてから、やり直してください。",
    ),
    "cancelled": (
        "Cancelled. What was finished stays; Update Performance does the rest.",
        "中止しました。済んだものは残ります。残りは「演奏を更新」で続けられます。",
    ),
    "fault": (
        "Something went wrong that Suisou did not expect: {detail}\n\nThe Output Log has the details.",
        "Suisou の予期しない問題が起きました: {detail}\n\n詳細は出力ログにあります。",
    ),
    "done_import": (
        '"{name}" is imported: {count} assets in {folder}.',
        "「{name}」をインポートしました: {folder} にアセット {count} 個",
    ),
    "done_update": (
        '"{name}" is up to date: {count} assets in {folder}.',
        "「{name}」を更新しました: {folder} にアセット {count} 個",
    ),
    "removed": ("Removed, because it is not needed any more: {asset}", "もう使われないため削除しました: {asset}"),
    "kept": (
        "Not needed any more, but {user} uses it: {asset}",
        "もう不要ですが、{user} が使っているため残しました: {asset}",
    ),
    "new_skeleton": (
        "Made anew, because its bones are others now: {asset}",
        "ボーンが変わったため作り直しました: {asset}",
    ),
    "moved": ("Left where you put it: {name}", "移動された位置のまま残しました: {name}"),
    "unplaced": (
        "Not moved to its new place, because its transform section has no channels that Suisou knows: {name}",
        "トランスフォームのセクションに Suisou の知っているチャンネルがないため、新しい位置に移せませんでした: {name}",
    ),
    "other_length": (
        "{asset} has {keys} keys, not {frames} as the file: compare it with the sound",
        "{asset} のキーの数は {keys} で、ファイルの {frames} と違います。音声と合っているか確かめてください",
    ),
    "step_check": ("Checking the files", "ファイルを確認しています"),
    "step_mesh": ("Mesh of {name}", "{name} のメッシュ"),
    "step_texture": ("Texture {name}", "テクスチャー {name}"),
    "step_material": ("Material {name}", "マテリアル {name}"),
    "step_animation": ("Animation of {name}", "{name} のアニメーション"),
    "step_sound": ("Sound", "音声"),
    "step_sequence": ("Level sequence", "レベルシーケンス"),
    "step_save": ("Saving", "保存しています"),
    "bar": ("Bar {number}", "第 {number} 小節"),
    "marker": ("Bar {number}: {names}", "第 {number} 小節: {names}"),
    "sound_track": ("Sound", "音声"),
}
"""English and Japanese, by name; filled with what is particular."""
