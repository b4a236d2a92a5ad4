"""Texts of the page for viewers, which has both languages in it."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "evaluate.page_title": ("Judging a musical performance", "演奏映像の評価"),
    "evaluate.page_language": ("Language", "言語"),
    "evaluate.page_no_script": (
        "This page needs JavaScript. Please allow it in the browser's settings.",
        "このページには JavaScript が必要です。ブラウザーの設定で許可してください。",
    ),
    "evaluate.page_welcome": ("Welcome", "はじめに"),
    "evaluate.page_about": (
        (
            "You will see {count} short clips of musicians and answer questions about each. There are no right or "
            "wrong answers: please answer as you see and hear it."
        ),
        (
            "演奏者の短い映像を {count} 本見て、それぞれについての質問に答えていただきます。"
            "正解や不正解はありません。見えたまま、聞こえたままにお答えください。"
        ),
    ),
    "evaluate.page_piece": ("Piece: {piece}", "曲: {piece}"),
    "evaluate.page_time": ("It takes about {minutes} minutes.", "所要時間は約 {minutes} 分です。"),
    "evaluate.page_headphones": (
        "Please use headphones in a quiet place, and do not change the volume once you have begun.",
        "静かな場所でヘッドホンを使用し、開始後は音量を変えないでください。",
    ),
    "evaluate.page_keeps": (
        (
            "Your answers are kept in this browser only. Nothing is sent anywhere. If you close or reload the page, "
            "you can go on where you were."
        ),
        (
            "回答はこのブラウザーの中だけに保存され、どこにも送信されません。"
            "ページを閉じたり再読み込みしたりしても、続きから再開できます。"
        ),
    ),
    "evaluate.page_keeps_nothing": (
        (
            "This browser does not let the page keep your answers: please do not close or reload it before you have "
            "saved them."
        ),
        "このブラウザーでは回答を一時保存できません。回答を保存するまで、ページを閉じたり再読み込みしたりしないでください。",
    ),
    "evaluate.page_file": (
        "At the end you save your answers as a file and send it to whoever gave you this page. It has no name in it.",
        "最後に回答をファイルに保存し、このページを渡した人に送ってください。ファイルに氏名は含まれません。",
    ),
    "evaluate.page_keys": (
        "Keyboard: Enter or Space plays a clip, 1 to 5 answer, 0 is “cannot judge”, Tab moves on.",
        "キーボード: Enter または Space で再生、1～5 で回答、0 で「判断できない」、Tab で次に移動します。",
    ),
    "evaluate.page_consent": (
        "I have read this and take part of my own free will. I can stop at any time.",
        "上記を読み、自分の意思で参加します。いつでも中止できることを理解しました。",
    ),
    "evaluate.page_number": (
        "Your number, if you were given one",
        "参加者番号（指定されている場合）",
    ),
    "evaluate.page_number_wrong": (
        "Please enter a whole number from 1, or leave the field empty.",
        "1 以上の整数を入力するか、空欄のままにしてください。",
    ),
    "evaluate.page_begin": ("Begin", "開始"),
    "evaluate.page_practice": ("Practice", "練習"),
    "evaluate.page_practice_about": (
        "Try it out: play the clip to its end, then answer. These answers do not count.",
        "操作の練習です。映像を最後まで再生してから回答してください。この回答は集計されません。",
    ),
    "evaluate.page_progress": ("Clip {number} of {count}", "映像 {number} / {count}"),
    "evaluate.page_play": ("Play", "再生"),
    "evaluate.page_again": ("Play again", "もう一度再生"),
    "evaluate.page_playing": ("Playing…", "再生中…"),
    "evaluate.page_first_watch": (
        "Please watch the clip to its end. The questions follow.",
        "映像を最後まで見てください。その後に質問が表示されます。",
    ),
    "evaluate.page_watch_pair": (
        "Please watch A and B to their end. The questions follow.",
        "A と B を最後まで見てください。その後に質問が表示されます。",
    ),
    "evaluate.page_cannot_play": (
        (
            "This clip cannot be played here. Please open the page in a current Chrome, Edge, Safari or Firefox; your "
            "answers so far are kept in this browser."
        ),
        (
            "この映像を再生できません。最新の Chrome、Edge、Safari、Firefox でページを開いてください。"
            "これまでの回答はこのブラウザーに保存されています。"
        ),
    ),
    "evaluate.page_next": ("Next", "次へ"),
    "evaluate.page_missing": (
        "Please answer every question; {count} remaining.",
        "すべての質問に答えてください（残り {count} 問）。",
    ),
    "evaluate.page_cannot_judge": ("Cannot judge", "判断できない"),
    "evaluate.page_fingers_arms": ("Fingers and arms", "指と腕"),
    "evaluate.page_body": ("Body", "体"),
    "evaluate.page_mouth": ("Mouth", "口元"),
    "evaluate.page_ensemble": ("Ensemble", "アンサンブル"),
    "evaluate.page_fingers_arms_naturalness": (
        "How natural are the movements of fingers and arms?",
        "指と腕の動きはどのくらい自然ですか？",
    ),
    "evaluate.page_fingers_arms_synchrony": (
        "How well do the movements of fingers and arms match the sound?",
        "指と腕の動きはどのくらい音と合っていますか？",
    ),
    "evaluate.page_body_naturalness": (
        "How natural are the movements of the body?",
        "体の動きはどのくらい自然ですか？",
    ),
    "evaluate.page_body_synchrony": (
        "How well do the movements of the body match the sound?",
        "体の動きはどのくらい音と合っていますか？",
    ),
    "evaluate.page_mouth_naturalness": (
        "How natural are the movements of mouth and face?",
        "口元と顔の動きはどのくらい自然ですか？",
    ),
    "evaluate.page_mouth_synchrony": (
        "How well do the movements of mouth and face match the sound?",
        "口元と顔の動きはどのくらい音と合っていますか？",
    ),
    "evaluate.page_ensemble_naturalness": (
        "How natural is the way the musicians play together?",
        "演奏者どうしの合わせ方はどのくらい自然ですか？",
    ),
    "evaluate.page_ensemble_synchrony": (
        "How well do the musicians move together with the sound?",
        "演奏者どうしの動きはどのくらい音と合っていますか？",
    ),
    "evaluate.page_naturalness_low": ("very unnatural", "とても不自然"),
    "evaluate.page_naturalness_high": ("very natural", "とても自然"),
    "evaluate.page_synchrony_low": ("not at all", "まったく合っていない"),
    "evaluate.page_synchrony_high": ("exactly", "ぴったり合っている"),
    "evaluate.page_thanks": ("Thank you!", "ありがとうございました"),
    "evaluate.page_save_about": (
        "Please save your answers now, and send the file {file} to whoever gave you this page.",
        "回答を保存し、ファイル {file} をこのページを渡した人に送ってください。",
    ),
    "evaluate.page_save": ("Save answers", "回答を保存"),
    "evaluate.page_saved": (
        "The file was handed to the browser; it is usually in the Downloads folder. You can save it again.",
        "ファイルをブラウザーに渡しました。通常は「ダウンロード」フォルダーにあります。もう一度保存することもできます。",
    ),
    "evaluate.page_another": ("Another viewer", "別の参加者"),
    "evaluate.page_another_sure": (
        "The answers in this browser will be removed. Have you saved them?",
        "このブラウザーに保存された回答を削除します。ファイルに保存しましたか？",
    ),
}
