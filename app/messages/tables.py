"""Instrument maps, metadata, models."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    # So that who has only a wording knows whose names to fill it with.
    "language.tag": ("en", "ja"),
    "fingering_words.open": ("open", "開放"),
    "fingering_words.half": ("{key} half open", "{key}（半開）"),
    "table.syntax": (
        "{file}, line {line}, column {column}: {detail}; correct it in a text editor",
        "{file}、{line} 行目 {column} 列目: {detail}。テキストエディターで修正してください",
    ),
    "table.invalid": ("{file}: {place}: {detail}", "{file}: {place}: {detail}"),
    "table.not_utf8": (
        "{file} is not UTF-8 text (byte {byte}); save it as UTF-8 in a text editor",
        (
            "{file} は UTF-8 のテキストではありません（バイト {byte}）。テキストエディターで UTF-8 "
            "として保存してください"
        ),
    ),
    "vocabulary.invalid": ("{file}: {detail}", "{file}: {detail}"),
    "gltf.not_gltf": (
        "{file} is not a glTF 2.0 file; export it as glTF 2.0",
        "{file} は glTF 2.0 ファイルではありません。glTF 2.0 で書き出してください",
    ),
    "gltf.damaged": (
        "{file} is damaged: invalid {what}; export it again",
        "{file} は壊れています: {what} が正しくありません。書き出し直してください",
    ),
    "gltf.external": (
        "{file} requires the separate file {uri}; export it as a single self-contained file",
        "{file} には別ファイル {uri} が必要です。すべてを含む単独のファイルとして書き出してください",
    ),
    "gltf.unsupported": (
        "{file} uses {what}, which is not supported; export it without",
        "{file} は未対応の {what} を使っています。使わずに書き出してください",
    ),
    "gltf.too_deep": (
        "{file} has nodes nested more than {most} levels deep; export only the character",
        "{file} のノードの階層が {most} 段を超えています。キャラクターだけを書き出してください",
    ),
    "gltf.too_large": (
        "{file} declares far more data than its size allows; export only the character",
        "{file} の内容がファイルのサイズに対して大きすぎます。キャラクターだけを書き出してください",
    ),
    "figure.unknown_format": (
        "{file} is not a VRM, glTF or FBX file; choose a character in one of these formats",
        "{file} は VRM、glTF、FBX のいずれでもありません。いずれかの形式のキャラクターを選んでください",
    ),
    "figure.too_large": (
        "{file} contains too much data for a character; export only the character",
        "{file} はキャラクターとしてはデータが大きすぎます。キャラクターだけを書き出してください",
    ),
    "figure.no_bones": (
        "{file} has no bones; choose a character with a skeleton",
        "{file} にはボーンがありません。スケルトンのあるキャラクターを選んでください",
    ),
    "figure.scaled": (
        (
            "the character in {file} would be {height_m} m tall, so its unit seems wrong; sizes were multiplied by "
            "{factor}"
        ),
        ("{file} のキャラクターの身長が {height_m} m になるため、単位の誤りとみなし、大きさを {factor} 倍にしました"),
    ),
    "figure.odd_height": (
        ("the character in {file} is {height_m} m tall; if this is not intended, export it again in the right unit"),
        ("{file} のキャラクターの身長は {height_m} m です。意図したものでなければ、正しい単位で書き出し直してください"),
    ),
    "character.incomplete": (
        "{file} cannot play because bones were not found for {joints}; assign these bones manually",
        "{file} は演奏できません。次の関節のボーンが見つかりません: {joints}。ボーンを手動で指定してください",
    ),
    "character.file_missing": (
        "{name}, referenced in {file}, was not found in the same folder",
        "{file} が参照する {name} が同じフォルダーに見つかりません",
    ),
    "character.odd_name": (
        "the name of {file} contains characters that cannot be displayed; rename the file",
        "{file} の名前に表示できない文字があります。名前を変更してください",
    ),
    "character.taken": (
        "{file} defines {id!r}, which is the name of a bundled character; use another name",
        "{file} は付属のキャラクター {id!r} と同じ名前です。別の名前にしてください",
    ),
    "character.cannot_play": (
        "{file} cannot play; see the missing items above",
        "{file} は演奏できません。足りないものは上に示しています",
    ),
    "characters.joint": (
        "{text!r} does not assign a bone to a joint; write e.g. leftHand=Wrist_L",
        "{text!r} は関節へのボーンの指定ではありません。leftHand=Wrist_L のように書いてください",
    ),
    "characters.morph": (
        "{text!r} does not assign morphs to a blendshape; write e.g. jawOpen=Mouth_A:0.8+Teeth_A:0.8",
        (
            "{text!r} はブレンドシェイプへのモーフの指定ではありません。jawOpen=Mouth_A:0.8+Teeth_A:0.8 "
            "のように書いてください"
        ),
    ),
    "instruments.invalid": ("{file} is invalid; problems: {count}", "{file} に問題が {count} 件あります"),
    "metadata.no_piece": (
        "--save, --load and --diff need a project: suisou metadata PIECE --save FILE",
        "--save、--load、--diff にはプロジェクトが必要です: suisou metadata PIECE --save FILE",
    ),
    "metadata.nothing_asked": (
        "say what to do with the piece: --save FILE, --load FILE or --diff FILE",
        "曲に対する操作を指定してください: --save FILE、--load FILE、--diff FILE",
    ),
    "metadata.no_kind": (
        "the folder {folder!r} says no kind of table; the file must be in a folder called one of: {known}",
        "フォルダー {folder!r} からは表の種類がわかりません。次のいずれかの名前のフォルダーに置いてください: {known}",
    ),
    "metadata.newer": (
        "{file} is of version {version}, and this version of Suisou reads up to {known}; update Suisou",
        "{file} はバージョン {version} です。この Suisou が読めるのは {known} までです。Suisou を更新してください",
    ),
    "metadata.no_player": (
        "no players are called {players}, so what is said of them was left out; players: {known}",
        "{players} という奏者がいないため、その内容を除外しました。奏者: {known}",
    ),
    "metadata.written": ("metadata written to {file}", "メタデータを {file} に保存しました"),
    "metadata.same": ("the piece has the metadata of {file}", "曲のメタデータは {file} と同じです"),
    "metadata.differ": (
        "{piece} and {file} differ in {count} {count:place|places}",
        "{piece} と {file} は {count} か所で異なります",
    ),
    "metadata.read_again": ("metadata reloaded: {maps}", "メタデータを再読み込みしました: {maps}"),
    "instruments.read_again": ("instruments reloaded: {maps}", "楽器を再読み込みしました: {maps}"),
    "map.unreadable": ("{file} cannot be read: {detail}", "{file} を読み込めません: {detail}"),
    "map.not_rewritten": (
        "{file}: the format of its fingering table does not allow changes here; edit it in a text editor",
        "{file}: 運指表がここでは変更できない書き方になっています。テキストエディターで変更してください",
    ),
    "fingering.unknown_sign": (
        "{text!r} is not valid on this instrument; valid symbols: {signs}",
        "{text!r} はこの楽器では使えません。使える記号: {signs}",
    ),
    "fingering.unknown_place": (
        "{text!r} is not a slide position; valid positions: {places}",
        "{text!r} はスライドポジションではありません。使えるもの: {places}",
    ),
    "fingering.twice": ("{text!r} already exists for this note", "{text!r} はこの音に既に登録されています"),
    "fingering.no_number": ("{text!r} is not a number of cents", "{text!r} はセントの数値ではありません"),
    "fingering.last": (
        "the only fingering of a note cannot be removed; add another one first",
        "音に残った唯一の運指は削除できません。先に別の運指を追加してください",
    ),
    "map.unknown": ("instrument map {id!r} was not found", "インストゥルメントマップ {id!r} が見つかりません"),
    "figure.no_joint": (
        "{file}: joint {joint!r} does not exist; choose one of: {joints}",
        "{file}: 関節 {joint!r} はありません。使えるもの: {joints}",
    ),
    "figure.no_bone": (
        "{file} has no bone {bone!r}, which is assigned to {joint}",
        "{file} には、{joint} に指定されたボーン {bone!r} がありません",
    ),
    "figure.no_shape": (
        "{file}: {shape!r} is not an ARKit blendshape",
        "{file}: {shape!r} は ARKit のブレンドシェイプにありません",
    ),
    "figure.no_morph": (
        "{file} has no morph {morph!r}, which is assigned to {shape}",
        "{file} には、{shape} に指定されたモーフ {morph!r} がありません",
    ),
    "metadata.missing": (
        "{kind} {name!r} was not found; choose one of: {known}",
        "{kind} に {name!r} はありません。使えるもの: {known}",
    ),
    "character.missing": (
        "character {id!r} was not found; choose one of: {known}",
        "キャラクター {id!r} が見つかりません。使えるもの: {known}",
    ),
    "character.added": (
        "{name} was added; select it for a player under Character",
        "{name} を追加しました。奏者の「キャラクター」で選べます",
    ),
    "character.landmarks_missing": (
        "character {id!r} lacks data required for playing: {missing}",
        "キャラクター {id!r} には演奏に必要なデータがありません: {missing}",
    ),
    "model.invalid": ("{file}: {detail}", "{file}: {detail}"),
}
