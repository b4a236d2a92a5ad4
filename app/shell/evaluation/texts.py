"""Texts of evaluations' actions and dialogs: id -> English and Japanese."""

from __future__ import annotations

from typing import Final

TEXTS: Final[dict[str, tuple[str, str]]] = {
    "action.file.evaluation": ("Evaluation...", "評価..."),
    "action.file.evaluation_results": ("Evaluation Results...", "評価の結果..."),
    "evaluation_dialog.by_hand": ("At a given time", "時刻を指定"),
    "evaluation_dialog.by_sound": ("Found by its sound", "音声から検出"),
    "evaluation_dialog.bars": ("Excerpts", "抜粋"),
    "evaluation_dialog.choose": ("Browse...", "参照..."),
    "evaluation_dialog.choose_folder": ("Folder...", "フォルダー..."),
    "evaluation_dialog.chosen_excerpts": ("Chosen where most is played", "演奏の多い箇所を自動で選択"),
    "evaluation_dialog.found": ("Found by its sound or its report", "音声またはレポートから検出"),
    "evaluation_dialog.keyframes_place": ("Position of the animation", "アニメーションの位置"),
    "evaluation_dialog.videos_or_motion": ("Videos and motion", "動画とモーション"),
    "evaluation_dialog.done": (
        (
            "Evaluation created: {clips} clips, {pairs} pairs.\nGive viewers this file alone: {page}\n"
            "Keep key.json: it says which variant each clip shows."
        ),
        (
            "評価を作成しました（映像 {clips} 本、ペア {pairs} 組）。\n"
            "参加者にはこのファイルだけを渡してください: {page}\n"
            "key.json は各映像のバリエーションを示すため、手元に保管してください。"
        ),
    ),
    "evaluation_dialog.excerpts": ("Number of excerpts", "抜粋の数"),
    "evaluation_dialog.film": ("Film of real players", "実際の奏者の動画"),
    "evaluation_dialog.folder": ("Folder", "フォルダー"),
    "evaluation_dialog.followed": (
        "Found by its sound; the piece follows its tempo",
        "音声から検出し、曲のテンポを合わせる",
    ),
    "evaluation_dialog.keyframes": ("Other animation", "他のアニメーション（動画・モーション）"),
    "evaluation_dialog.length": ("Length of an excerpt", "抜粋の長さ"),
    "evaluation_dialog.make": ("Create Evaluation", "評価を作成"),
    "evaluation_dialog.place": ("Position of the film", "動画の位置"),
    "evaluation_dialog.placed": (
        "The film begins at {offset_s:.2f} s of the piece (confidence {percent} %).",
        "動画は曲の {offset_s:.2f} 秒から始まります（信頼度 {percent} %）。",
    ),
    "evaluation_dialog.presentation": ("Presentation", "提示方法"),
    "evaluation_dialog.presentation_both": ("One at a time, then side by side", "1 本ずつ、その後に並べて"),
    "evaluation_dialog.presentation_pair": ("Side by side", "並べて"),
    "evaluation_dialog.presentation_single": ("One at a time", "1 本ずつ"),
    "evaluation_dialog.seconds": (" s", " 秒"),
    "evaluation_dialog.size": ("Size of a clip", "映像のサイズ"),
    "evaluation_dialog.title": ("Evaluation", "評価"),
    "evaluation_dialog.variant_film": ("Real players", "実際の奏者"),
    "evaluation_dialog.variant_generated": ("This performance", "この演奏"),
    "evaluation_dialog.variant_keyframes": ("Other animation", "他のアニメーション"),
    "evaluation_dialog.variant_shifted": ("Fingers 200 ms late (control)", "指を 200 ms 遅らせる（対照）"),
    "evaluation_dialog.variant_still": ("Amplitude 0", "動きの大きさ 0"),
    "evaluation_dialog.variants": ("Compare", "比較するもの"),
    "evaluation_dialog.videos": ("Videos", "動画"),
    "evaluation_dialog.view": ("View", "ビュー"),
    "results_dialog.add": ("Add Answers...", "回答を追加..."),
    "results_dialog.answers": ("Answers of viewers", "参加者の回答"),
    "results_dialog.beside": ("found beside the answers", "回答と同じ場所から検出"),
    "results_dialog.choose_key": ("Choose Key...", "キーを選択..."),
    "results_dialog.close": ("Close", "閉じる"),
    "results_dialog.conclusions": ("Conclusions", "結論"),
    "results_dialog.copy": ("Copy", "コピー"),
    "results_dialog.files": ("Answers, one file for each viewer", "回答（参加者ごとに 1 ファイル）"),
    "results_dialog.key": ("Key of the evaluation", "評価のキー"),
    "results_dialog.nothing_yet": (
        "Add the files that viewers saved at the end of the questionnaire (answers-....csv), or drop them here.",
        "質問票の最後に参加者が保存したファイル（answers-....csv）を追加するか、ここにドロップしてください。",
    ),
    "results_dialog.picture": ("Picture", "図"),
    "results_dialog.remove": ("Remove", "取り除く"),
    "results_dialog.save": ("Save All...", "すべて保存..."),
    "results_dialog.saved": ("{folder}: {names}", "{folder}: {names}"),
    "results_dialog.title": ("Evaluation Results", "評価の結果"),
}
