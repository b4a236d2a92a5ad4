"""Pictures and films of the players."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "camera.no_name": ("a camera needs a name", "カメラには名前が必要です"),
    "camera.name_taken": ("another camera is called {name}", "別のカメラが「{name}」という名前を使用しています"),
    "camera.kept": ("camera “{name}” was saved", "カメラ「{name}」を保存しました"),
    "camera.unknown": (
        "there is no camera {name!r} in this piece; known: {known}",
        "この曲にカメラ {name!r} はありません。あるカメラ: {known}",
    ),
    "camera.name": ("{name}", "{name}"),
    "picture.no_gl": (
        ("the players cannot be displayed because OpenGL 2 is not available ({reason}); update the graphics driver"),
        ("OpenGL 2 を使用できないため、奏者を表示できません（{reason}）。グラフィックドライバーを更新してください"),
    ),
    "picture.loading": (
        "the players are still loading; try again in a moment",
        "奏者を読み込み中です。少し待ってからもう一度試してください",
    ),
    "picture.other_frames": (
        "{file} has frames of another film, which would be mixed with these; choose another folder or remove them",
        "{file} には別の動画のフレームがあり、混ざってしまいます。別のフォルダーを選ぶか、削除してください",
    ),
    "picture.film_no_gl": (
        (
            "the players cannot be drawn because OpenGL 2 is not available ({reason}); update the graphics driver, or "
            "on Linux install xvfb and Mesa and run 'xvfb-run -a suisou film ...'"
        ),
        (
            "OpenGL 2 を使用できないため、奏者を描画できません（{reason}）。グラフィックドライバーを更新するか、"
            "Linux では xvfb と Mesa をインストールして 'xvfb-run -a suisou film ...' を実行してください"
        ),
    ),
    "picture.no_players": (
        "{file}: there are no players to draw; 'suisou inspect' shows why each part is not played",
        "{file}: 描画する奏者がいません。演奏されない理由は 'suisou inspect' で確認できます",
    ),
    "picture.sheet_ending": (
        "--sheet {file}: the name of a contact sheet must end in .png",
        "--sheet {file}: コンタクトシートのファイル名は .png で終わる必要があります",
    ),
    "picture.film_ending": (
        "--to {file}: the name of a film must end in .mp4, and the folder for PNG files has no such ending",
        "--to {file}: 動画のファイル名は .mp4 で終わる必要があります。PNG ファイルのフォルダーには拡張子を付けません",
    ),
    "picture.film_option": (
        "{option} is only possible with {needs}",
        "{option} は {needs} を指定したときだけ使用できます",
    ),
    "picture.odd_size": (
        "--size {width}x{height}: an MP4 file needs an even width and height",
        "--size {width}x{height}: MP4 ファイルの幅と高さは偶数にしてください",
    ),
    "picture.sheet_too_large": (
        (
            "a contact sheet with {count} {count:frame|frames} has {width}x{height} pixels "
            "(the maximum is {most}x{most}); choose fewer bars, a longer --every, another --columns or a smaller --size"
        ),
        (
            "{count} フレームのコンタクトシートは {width}x{height} ピクセルになります（上限 {most}x{most}）。"
            "小節を絞るか、--every、--columns、--size を変更してください"
        ),
    ),
    "picture.dancer_view": (
        "{dancer} plays no instrument: --view {view} is possible for players only",
        "{dancer} は楽器を演奏しません。--view {view} は奏者だけに使用できます",
    ),
    "picture.time": ("{time} s · frame {frame}", "{time} 秒 · フレーム {frame}"),
}
