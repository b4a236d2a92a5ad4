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
    "evaluate.keyframes_skeleton": (
        (
            "the skeleton of {file} is not that of the players; retarget the motion to a file that Suisou exported on "
            "its own skeleton, or choose a video"
        ),
        (
            "{file} の骨格は奏者の骨格と異なります。Suisou が自身の骨格で書き出したファイルにリターゲットするか、"
            "動画を選んでください"
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
        (
            "{file} is not named after a player, so it is not known whose motion it is; its name is to be one of: "
            "{players}"
        ),
        (
            "{file} の名前が奏者名と一致しないため、どの奏者のモーションか分かりません。"
            "次のいずれかの名前にしてください：{players}"
        ),
    ),
    "evaluate.keyframes_lacking": (
        (
            "{file} has no motion of {player}: add {name}, give the folder that has the files of all players, or name "
            "players that there is motion of (--player)"
        ),
        (
            "{file} に {player} のモーションがありません。{name} を追加するか、全奏者のファイルがあるフォルダーを"
            "指定するか、モーションのある奏者を指定してください（--player）"
        ),
    ),
    "evaluate.keyframes_lacking_here": (
        (
            "{file} has no motion of {player}: add {name}, choose the folder that has the files of all players, or "
            "select a player that there is motion of and choose another view than 'Ensemble'"
        ),
        (
            "{file} に {player} のモーションがありません。{name} を追加するか、全奏者のファイルがあるフォルダーを"
            "選ぶか、モーションのある奏者を選択して「全体」以外のビューを選んでください"
        ),
    ),
    "evaluate.keyframes_report": (
        (
            "{file} does not say when the motion beside it begins ({detail}); give its place by hand "
            "(--keyframes-offset)"
        ),
        ("{file} からモーションの開始時刻を読み取れません（{detail}）。位置を指定してください（--keyframes-offset）"),
    ),
    "evaluate.keyframes_report_here": (
        (
            "{file} does not say when the motion beside it begins ({detail}); choose 'At a given time' as the position "
            "of the animation"
        ),
        (
            "{file} からモーションの開始時刻を読み取れません（{detail}）。"
            "アニメーションの位置に「時刻を指定」を選んでください"
        ),
    ),
    "evaluate.too_few": (
        "an evaluation compares at least two variants; choose more of them",
        "評価では 2 つ以上のバリエーションを比較します。バリエーションを追加してください",
    ),
    "evaluate.no_excerpt": (
        (
            "nothing is played where an excerpt could be; name the bars (--from-bar, --to-bar), or give another place "
            "of the video (--film-offset, --keyframes-offset)"
        ),
        (
            "抜粋できる範囲に演奏がありません。小節（--from-bar、--to-bar）か、"
            "動画の位置（--film-offset、--keyframes-offset）を指定してください"
        ),
    ),
    "evaluate.no_excerpt_here": (
        "nothing is played where an excerpt could be; choose bars under 'Excerpts', or another position of the video",
        "抜粋できる範囲に演奏がありません。「抜粋」で小節を選ぶか、動画の位置を変更してください",
    ),
    "evaluate.silent_video": (
        (
            "{file} has no sound to find its place in the piece by; give its place by hand (--film-offset, "
            "--keyframes-offset)"
        ),
        (
            "{file} には音声がないため、曲の中の位置を検出できません。"
            "位置を指定してください（--film-offset、--keyframes-offset）"
        ),
    ),
    "evaluate.silent_video_here": (
        (
            "{file} has no sound to find its place in the piece by; choose 'At a given time' as its position and enter "
            "the time"
        ),
        (
            "{file} には音声がないため、曲の中の位置を検出できません。"
            "その位置に「時刻を指定」を選んで時刻を入力してください"
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
    "evaluate.other_piece_here": (
        (
            "the sound of {file} does not fit this piece at a steady tempo (confidence {percent} %); choose a video of "
            "this piece, or as its position 'At a given time', or for the film 'Found by its sound; the piece follows "
            "its tempo'"
        ),
        (
            "{file} の音声は一定のテンポではこの曲に一致しません（信頼度 {percent} %）。この曲の動画を選ぶか、"
            "その位置に「時刻を指定」、実際の奏者の動画では「音声から検出し、曲のテンポを合わせる」を選んでください"
        ),
    ),
    "evaluate.not_followed": (
        (
            "the piece was not recognised in {file} (confidence {percent} %): choose a film of this piece in this key, "
            "or give its place by hand (--film-offset)"
        ),
        (
            "{file} の音声からこの曲を認識できませんでした（信頼度 {percent} %）。"
            "この曲を同じ調で演奏した動画を選ぶか、位置を指定してください（--film-offset）"
        ),
    ),
    "evaluate.not_followed_here": (
        (
            "the piece was not recognised in {file} (confidence {percent} %): choose a film of this piece in this key, "
            "or 'At a given time' as its position"
        ),
        (
            "{file} の音声からこの曲を認識できませんでした（信頼度 {percent} %）。"
            "この曲を同じ調で演奏した動画を選ぶか、位置に「時刻を指定」を選んでください"
        ),
    ),
    "evaluate.other_tempo": (
        (
            "{file} keeps another tempo than the piece ({percent} %), so that sound and picture would drift apart; "
            "follow its tempo (--follow-film)"
        ),
        (
            "{file} のテンポは曲と異なる（{percent} %）ため、音と映像がずれていきます。"
            "テンポを動画に合わせてください（--follow-film）"
        ),
    ),
    "evaluate.other_tempo_here": (
        (
            "{file} keeps another tempo than the piece ({percent} %), so that sound and picture would drift apart; "
            "choose 'Found by its sound; the piece follows its tempo' as the position of the film, or another video"
        ),
        (
            "{file} のテンポは曲と異なる（{percent} %）ため、音と映像がずれていきます。"
            "実際の奏者の動画の位置に「音声から検出し、曲のテンポを合わせる」を選ぶか、別の動画を選んでください"
        ),
    ),
    "evaluate.not_covered": (
        (
            "{file} does not show {from_s:.1f} s to {until_s:.1f} s of the piece, but {first_s:.1f} s to {last_s:.1f} "
            "s; name other bars (--from-bar, --to-bar), give another place (--film-offset, --keyframes-offset) or a "
            "longer file"
        ),
        (
            "{file} に含まれるのは曲の {first_s:.1f} 秒から {last_s:.1f} 秒までで、"
            "{from_s:.1f} 秒から {until_s:.1f} 秒までは含まれません。別の小節（--from-bar、--to-bar）、"
            "別の位置（--film-offset、--keyframes-offset）、またはより長いファイルを指定してください"
        ),
    ),
    "evaluate.not_covered_here": (
        (
            "{file} does not show {from_s:.1f} s to {until_s:.1f} s of the piece, but {first_s:.1f} s to {last_s:.1f} "
            "s; choose other bars under 'Excerpts', another position or a longer file"
        ),
        (
            "{file} に含まれるのは曲の {first_s:.1f} 秒から {last_s:.1f} 秒までで、"
            "{from_s:.1f} 秒から {until_s:.1f} 秒までは含まれません。"
            "「抜粋」で別の小節を選ぶか、別の位置またはより長いファイルを選んでください"
        ),
    ),
    "evaluate.one_choice": (
        "{option} and {other} exclude each other: the excerpts are bars, or are chosen",
        "{option} と {other} は同時に指定できません。抜粋は小節で指定するか、自動で選択します",
    ),
    "evaluate.ended": (
        "the evaluation could not be made ({detail}); try again with fewer or smaller clips",
        "評価を作成できませんでした（{detail}）。映像の数やサイズを減らして、もう一度試してください",
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
