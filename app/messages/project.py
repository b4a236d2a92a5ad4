"""Projects: files, recovery, re-import."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    # Files
    "project.damaged": (
        (
            "{file} is not a project file or is damaged: {detail}; look for the previously saved version next to "
            "it, with .bak at the end of its name"
        ),
        (
            "{file} はプロジェクトファイルではないか、壊れています: {detail}。同じフォルダーに、"
            "前回保存したもの（名前の末尾が .bak）がないか確認してください"
        ),
    ),
    "project.invalid": (
        (
            "{file} cannot be opened: {place}: {detail}; correct it in a text editor, or open the previously saved "
            "version, which has .bak at the end of its name"
        ),
        (
            "{file} を開けません: {place}: {detail}。テキストエディターで修正するか、"
            "前回保存したもの（名前の末尾が .bak）を開いてください"
        ),
    ),
    "project.newer": (
        (
            "{file} was saved by a newer version of Suisou (file version {version}; this version reads up to "
            "{known}); use the newer version"
        ),
        (
            "{file} は新しいバージョンの Suisou で保存されています（ファイルのバージョンは {version}、対応は "
            "{known} まで）。新しいバージョンを使ってください"
        ),
    ),
    "project.cannot_save": (
        ("{file} was not saved because it could not be opened again: {place}: {detail}; undo the last edit, then save"),
        (
            "{file} は保存していません。保存すると開けなくなります: {place}: {detail}。"
            "直前の編集を元に戻してから保存してください"
        ),
    ),
    "project.not_storable": (
        "not done, because the project could not be saved with it: {place}: {detail}",
        "実行していません。プロジェクトを保存できなくなります: {place}: {detail}",
    ),
    "project.read_only": (
        "{file} is write-protected; save it under another name or allow writing",
        "{file} は書き込み禁止です。別の名前で保存するか、書き込みを許可してください",
    ),
    "project.open_elsewhere": (
        ("{file} is also open in another window; saving in both overwrites each other's changes; close one of them"),
        "{file} は別のウィンドウでも開かれています。両方で保存すると互いに上書きされます。一方を閉じてください",
    ),
    "project.takes": (
        (
            "--clean-takes and --keep-takes set how the tracks of a MIDI file are read, but {file} is a project; clean "
            "its takes in the editor"
        ),
        (
            "--clean-takes と --keep-takes は MIDI ファイルの読み方の指定ですが、{file} はプロジェクトです。"
            "テイクのクリーンアップはエディターで行ってください"
        ),
    ),
    "project.written": (
        (
            "--written and --sounding set how the pitches of a MIDI file or score are read, but {file} is a project; "
            "transpose its notes in the editor"
        ),
        (
            "--written と --sounding は MIDI ファイルや楽譜の音高の読み方の指定ですが、{file} はプロジェクトです。"
            "音符の移調はエディターで行ってください"
        ),
    ),
    "project.assign": (
        (
            "--assign sets the instruments of the parts of a MIDI file or score, but {file} is a project; use --set "
            "'PLAYER.instrument=ID'"
        ),
        (
            "--assign は MIDI ファイルや楽譜のパートに楽器を割り当てますが、{file} はプロジェクトです。--set "
            "'PLAYER.instrument=ID' を使ってください"
        ),
    ),
    "assign.malformed": (
        "--assign: {assignment!r} is not in the form PART=INSTRUMENT; `suisou instruments` lists the instruments",
        (
            "--assign: {assignment!r} は「PART=INSTRUMENT」（パート=楽器）の形ではありません。楽器は "
            "`suisou instruments` で一覧できます"
        ),
    ),
    "assign.instrument_unknown": (
        "instrument {instrument!r} was not found; available: {possible}",
        "楽器 {instrument!r} が見つかりません。使える楽器: {possible}",
    ),
    "assign.others": (
        (
            "{file}: no part is for a wind instrument ({parts}); to have winds play them, for example: {command} "
            "(`suisou instruments` lists the instruments)"
        ),
        (
            "{file}: 管楽器のパートがありません（{parts}）。管楽器で演奏するには、たとえば: {command}"
            "（楽器は `suisou instruments` で一覧できます）"
        ),
    ),
    "assign.parts": (
        (
            "{file}: nothing says which instruments play {parts}; assign them, for example: {command} "
            "(`suisou instruments` lists the instruments)"
        ),
        (
            "{file}: {parts} の楽器が分かりません。たとえば次のように割り当ててください: {command}"
            "（楽器は `suisou instruments` で一覧できます）"
        ),
    ),
    "argument.with_nul": (
        "{argument!r} holds a NUL character, which no file name or option can have; leave it out",
        "{argument!r} にはファイル名やオプションに使えない NUL 文字が含まれています。取り除いてください",
    ),
    "project.encoding": (
        "--encoding sets how the texts of a MIDI file are read, but {file} is a project; leave it out",
        "--encoding は MIDI ファイルの文字の読み方の指定ですが、{file} はプロジェクトです。指定は不要です",
    ),
    "autosave.elsewhere": (
        (
            "{file} cannot be autosaved in its folder ({reason}); it is autosaved in {folder} instead and can be "
            "recovered from there after a crash; free some space, allow writing, or save the project in another "
            "folder"
        ),
        (
            "{file} は、そのフォルダーに自動保存できません（{reason}）。代わりに {folder} に自動保存し、"
            "異常終了後はそこから復元できます。空き容量を増やすか、書き込みを許可するか、"
            "プロジェクトを別のフォルダーに保存してください"
        ),
    ),
    "autosave.refused": (
        (
            "unsaved changes are at risk: {file} cannot be autosaved in its folder ({reason}) or in {folder} "
            "({folder_reason}); save the project in another folder now"
        ),
        (
            "未保存の変更が失われる恐れがあります。{file} は、そのフォルダー（{reason}）にも "
            "{folder}（{folder_reason}）にも自動保存できません。"
            "すぐにプロジェクトを別のフォルダーに保存してください"
        ),
    ),
    "autosave.nowhere": (
        ("unsaved changes are at risk: autosave to {folder} failed ({reason}); save the project in another folder now"),
        (
            "未保存の変更が失われる恐れがあります。{folder} に自動保存できません（{reason}）。"
            "すぐにプロジェクトを別のフォルダーに保存してください"
        ),
    ),
    "autosave.without": (
        (
            "autosaved without {count} {count:value|values} that cannot be saved: {place}: {detail}; undo the last "
            "edit or remove the value"
        ),
        (
            "保存できない値（{count} 個）を除いて自動保存しました: {place}: {detail}。"
            "直前の編集を元に戻すか、値を外してください"
        ),
    ),
    "presence.refused": (
        (
            "{file} cannot be written ({reason}): new projects are not autosaved until they are saved, and unsaved "
            "changes can be recovered only by opening their file; allow writing or free some space"
        ),
        (
            "{file} に書き込めません（{reason}）。新規プロジェクトは保存するまで自動保存されず、"
            "未保存の変更はそのファイルを開いたときにだけ復元できます。書き込みを許可するか、"
            "空き容量を増やしてください"
        ),
    ),
    "project.instrument_missing": (
        "the instrument {id!r} of {player} is not installed; choose another one or install it",
        "{player} の楽器 {id!r} がインストールされていません。別の楽器を選ぶか、追加してください",
    ),
    "project.character_missing": (
        "the character {id!r} of {player} is not installed; choose another one or install it",
        ("{player} のキャラクター {id!r} がインストールされていません。別のキャラクターを選ぶか、追加してください"),
    ),
    "project.style_missing": (
        "the style {name!r} of {player} is not installed and changes nothing; choose one of: {known}",
        "{player} のスタイル {name!r} がインストールされていないため、何も変わりません。使えるもの: {known}",
    ),
    "project.habit_missing": (
        "the habit {name!r} of {player} is not installed and changes nothing; choose among: {known}",
        "{player} の癖 {name!r} がインストールされていないため、何も変わりません。使えるもの: {known}",
    ),
    "project.no_dances": (
        "{dancer} cannot dance: this installation of Suisou does not make dances",
        "{dancer} は踊れません。この Suisou にはダンスの生成機能が含まれていません",
    ),
    "project.choreography_missing": (
        (
            "the choreography {name!r} of {dancer} is not included in this version of Suisou; choose a "
            "choreography file or one of: {known}"
        ),
        (
            "{dancer} の振り付け {name!r} は、このバージョンの Suisou に付属していません。振り付けのファイルか、"
            "次のいずれかを選んでください: {known}"
        ),
    ),
    "project.choreography_file_missing": (
        "the choreography {file} of {dancer} was not found; put the file back or choose another choreography",
        "{dancer} の振り付け {file} が見つかりません。ファイルを元の場所に戻すか、別の振り付けを選んでください",
    ),
    "project.choreography_elsewhere": (
        (
            "the choreography {file} of {dancer} is on another computer ({host}) and was not looked for; agree in the "
            "question that the editor asks, or copy the file next to the project and choose it there"
        ),
        (
            "{dancer} の振り付け {file} は別のコンピューター（{host}）にあるため、探していません。"
            "エディターの確認で許可するか、プロジェクトの隣にコピーして選び直してください"
        ),
    ),
    "project.unknown_remark": (
        "warning from another version of Suisou ({remark})",
        "別のバージョンの Suisou による警告（{remark}）",
    ),
    # Edits of the piece
    "tempo.outside": (
        "the tempo must be between {low:g} and {high:g} quarter notes per minute",
        "テンポは毎分 {low:g} から {high:g} 四分音符までです",
    ),
    "tempo.first_stays": (
        "the initial tempo and time signature can be changed, but not moved or removed",
        "曲頭のテンポと拍子は変更できますが、移動や削除はできません",
    ),
    "tempo.none_here": ("no tempo change starts at tick {tick}", "ティック {tick} から始まるテンポはありません"),
    "tempo.place_outside": ("tick {tick} is outside the piece", "ティック {tick} は曲の範囲外です"),
    "metre.none_here": ("no time signature starts at tick {tick}", "ティック {tick} から始まる拍子はありません"),
    "metre.impossible": (
        ("{numerator}/{denominator} is not a valid time signature; the lower number must be 1, 2, 4, 8, 16, 32 or 64"),
        "{numerator}/{denominator} は拍子として使えません。分母は 1、2、4、8、16、32、64 のいずれかです",
    ),
    "metre.pickup_too_long": (
        "a pickup must be shorter than a whole bar: at most {most} ticks",
        "弱起は 1 小節より短く、最長 {most} ティックです",
    ),
    "metre.inside_pickup": (
        "a time signature cannot start within the pickup; change the pickup first",
        "弱起の途中から拍子は始められません。先に弱起を変更してください",
    ),
    "piece.value_outside": ("{what} must be between {low:g} and {high:g}", "{what} は {low:g} から {high:g} までです"),
    "piece.no_recording": (
        "there is no audio to offset; import an audio file first",
        "オフセットを設定する音源がありません。先に音源を読み込んでください",
    ),
    "piece.no_video": (
        "there is no reference video; import one first",
        "参照ビデオがありません。先に読み込んでください",
    ),
    "pins.before_the_piece": (
        "only beats of the piece can be pinned to the audio",
        "音源に固定できるのは曲の中の拍だけです",
    ),
    "pins.no_room": (
        "there is no room between the pinned beats beside it; move those first",
        "隣の固定された拍との間に余地がありません。先にそちらを動かしてください",
    ),
    "pins.none_here": ("no beat is pinned there", "そこに固定された拍はありません"),
    "piece.path_unusable": (
        "the path {path} cannot be stored in a project; rename or move the file",
        "パス {path} はプロジェクトに保存できません。ファイルの名前を変えるか、移動してください",
    ),
    "expression.invalid": (
        "the expression {name!r} cannot be saved: {place}: {detail}",
        "表情 {name!r} を保存できません: {place}: {detail}",
    ),
    "expression.no_name": (
        "an expression name must have at least one visible character",
        "表情の名前には、表示できる文字が 1 つ以上必要です",
    ),
    "expression.name_taken": (
        "an expression named {name!r} already exists; choose another name",
        "表情 {name!r} は既に存在します。別の名前にしてください",
    ),
    "expression.none_of_name": (
        "expression {name!r} was not found in this project",
        "このプロジェクトに、表情 {name!r} が見つかりません",
    ),
    # Presets
    # Re-import
    "reimport.done": (
        "File updated; notes matched: {kept}, corrections without a matching note: {lost}",
        "ファイルを更新しました。引き継いだ音符: {kept}、対応する音符のない手動修正: {lost}",
    ),
    "reimport.no_note": (
        "corrections of this kind ({kind}) are not attached to notes",
        "この種類の手動修正（{kind}）は音符に付くものではありません",
    ),
    "reimport.not_played": (
        "the player does not play note {note}; select one of this player's notes",
        "この奏者は音符 {note} を演奏しません。この奏者の音符を選んでください",
    ),
    "preset.no_name": (
        "a preset name must have at least one visible character",
        "プリセットの名前には、表示できる文字が 1 つ以上必要です",
    ),
    "preset.none_of_name": ("preset {name!r} was not found", "プリセット {name!r} が見つかりません"),
}
