"""The evaluation: films of real players, clips, the page and its key."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "evaluate.not_a_key": (
        "{file} is not the key of an evaluation ({detail}); choose the key.json that 'suisou evaluate' wrote",
        (
            "{file} は評価のキーファイルではありません（{detail}）。"
            "'suisou evaluate' が書き出した key.json を選んでください"
        ),
    ),
    "evaluate.newer_key": (
        "{file} was written by a newer version of Suisou; update Suisou to read it",
        "{file} は新しいバージョンの Suisou で作成されています。読み込むには Suisou を更新してください",
    ),
    "evaluate.there_already": (
        "{file} already has an evaluation, and its viewers' answers belong to its key; choose another folder",
        "{file} にはすでに評価があり、参加者の回答はそのキーと対応しています。別のフォルダーを選んでください",
    ),
    "evaluate.needs_file": (
        "the variant '{variant}' needs a file: choose one with {option}",
        "バリエーション '{variant}' にはファイルが必要です。{option} で指定してください",
    ),
    "evaluate.keyframes_format": (
        "{file} is neither a video nor a file of motion (BVH, FBX, GLB); choose one of these",
        "{file} は動画でもモーションファイル（BVH、FBX、GLB）でもありません。いずれかを選んでください",
    ),
    "evaluate.keyframes_skeleton": (
        (
            "the skeleton of {file} is not that of the players; retarget the motion to a file that 'suisou export' "
            "wrote (--skeleton suisou), or give a video"
        ),
        (
            "{file} の骨格は奏者の骨格と異なります。'suisou export'（--skeleton suisou）で書き出したファイルに"
            "リターゲットするか、動画を指定してください"
        ),
    ),
    "evaluate.keyframes_bones": (
        "{file} has no motion of these bones: {bones}; export all bones of the skeleton",
        "{file} に次のボーンのモーションがありません：{bones}。骨格のすべてのボーンを書き出してください",
    ),
    "evaluate.keyframes_body": (
        (
            "the bone {bone} of {file} has not the length that it has in the character '{character}'; give the player "
            "the character that the file was made with"
        ),
        (
            "{file} のボーン {bone} の長さがキャラクター '{character}' と異なります。"
            "ファイルの作成に使ったキャラクターを奏者に割り当ててください"
        ),
    ),
    "evaluate.keyframes_player": (
        "{file} is not named after a player, so it is not known whose motion it is; its name is to be one of: {players}",
        "{file} の名前が奏者名と一致しないため、どの奏者のモーションか分かりません。次のいずれかの名前にしてください：{players}",
    ),
    "evaluate.keyframes_lacking": (
        (
            "{file} has no motion of {player}: add {name}, give the folder that has the files of all players, or show "
            "only players that there is motion of"
        ),
        (
            "{file} に {player} のモーションがありません。{name} を追加するか、全奏者のファイルがあるフォルダーを"
            "指定するか、モーションのある奏者だけを表示してください"
        ),
    ),
    "evaluate.keyframes_report": (
        "{file} does not say when the motion beside it begins ({detail}); give its place by hand, or remove the report",
        "{file} からモーションの開始時刻を読み取れません（{detail}）。位置を指定するか、このファイルを削除してください",
    ),
    "evaluate.too_few": (
        "an evaluation compares at least two variants; choose more of them",
        "評価では 2 つ以上のバリエーションを比較します。バリエーションを追加してください",
    ),
    "evaluate.no_excerpt": (
        "nothing is played where an excerpt could be; choose the bars by hand, or another offset of the video",
        "抜粋できる範囲に演奏がありません。小節を手動で選ぶか、動画のオフセットを変更してください",
    ),
    "evaluate.silent_video": (
        (
            "{file} has no sound to find its place in the piece by; give its place by hand (on the command line: "
            "--film-offset, --keyframes-offset)"
        ),
        (
            "{file} には音声がないため、曲の中の位置を検出できません。"
            "位置を指定してください（コマンドラインでは --film-offset、--keyframes-offset）"
        ),
    ),
    "evaluate.other_piece": (
        (
            "the sound of {file} does not fit this piece at a steady tempo (confidence {percent} %); choose a video of "
            "this piece, follow its tempo (--follow-film), or give its place by hand (--film-offset, "
            "--keyframes-offset)"
        ),
        (
            "{file} の音声は一定のテンポではこの曲に一致しません（信頼度 {percent} %）。この曲の動画を選ぶか、"
            "テンポを動画に合わせるか（--follow-film）、位置を指定してください（--film-offset、--keyframes-offset）"
        ),
    ),
    "evaluate.not_followed": (
        (
            "the piece was not recognised in {file} (confidence {percent} %): choose a film of this piece, of all of "
            "it, in this key, or give its place by hand (--film-offset)"
        ),
        (
            "{file} の音声からこの曲を認識できませんでした（信頼度 {percent} %）。"
            "この曲全体を同じ調で演奏した動画を選ぶか、位置を指定してください（--film-offset）"
        ),
    ),
    "evaluate.other_tempo": (
        (
            "{file} keeps another tempo than the piece ({percent} %), so that sound and picture would drift apart; "
            "follow its tempo (on the command line: --follow-film)"
        ),
        (
            "{file} のテンポは曲と異なる（{percent} %）ため、音と映像がずれていきます。"
            "テンポを動画に合わせてください（コマンドラインでは --follow-film）"
        ),
    ),
    "evaluate.not_covered": (
        (
            "{file} does not show {from_s:.1f} s to {until_s:.1f} s of the piece, but {first_s:.1f} s to {last_s:.1f} "
            "s; choose other bars or a longer video"
        ),
        (
            "{file} に含まれるのは曲の {first_s:.1f} 秒から {last_s:.1f} 秒までで、"
            "{from_s:.1f} 秒から {until_s:.1f} 秒までは含まれません。別の小節か、より長い動画を選んでください"
        ),
    ),
    "evaluate.one_choice": (
        "{option} and {other} exclude each other: the excerpts are bars, or are chosen",
        "{option} と {other} は同時に指定できません。抜粋は小節で指定するか、自動で選択します",
    ),
    "evaluate.ended": (
        "the evaluation could not be made ({detail}); try again, or run 'suisou evaluate'",
        "評価を作成できませんでした（{detail}）。もう一度試すか、'suisou evaluate' を実行してください",
    ),
    "evaluate.step_video": ("listening to {file}", "{file} の音声を解析中"),
    "evaluate.step_holds": ("how the instruments are held", "楽器の持ち方を計算中"),
    "evaluate.step_sound": ("sound", "音声を作成中"),
    "evaluate.step_clips": (
        "clips, variant {number} of {count}",
        "映像を作成中（バリエーション {number} / {count}）",
    ),
    "evaluate.step_pairs": ("clips side by side", "並べた映像を作成中"),
    "evaluate.step_page": ("the page", "ページを作成中"),
    "evaluate.step_measures": ("measures of the motion", "動きを測定中"),
}
