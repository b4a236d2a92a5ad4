"""FBX, BVH and USD files."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "fbx.not_binary": (
        "{file} is not a binary FBX file; export it as binary FBX",
        "{file} はバイナリ形式の FBX ファイルではありません。バイナリ形式で書き出してください",
    ),
    "fbx.truncated": (
        "{file} ends within a record (byte {offset}); copy or export it again",
        "{file} がレコードの途中（バイト {offset}）で終わっています。コピーまたは書き出しをやり直してください",
    ),
    "fbx.bad_record": (
        "{file}: the record at byte {offset} is inconsistent with the data around it",
        "{file}: バイト {offset} のレコードが前後と整合しません",
    ),
    "fbx.bad_property": (
        "{file}: the property at byte {offset} has an unknown type or is too long for its record",
        "{file}: バイト {offset} のプロパティは型が不明か、レコードに対して長すぎます",
    ),
    "fbx.bad_array": ("{file}: the array at byte {offset} is damaged", "{file}: バイト {offset} の配列が壊れています"),
    "fbx.too_deep": (
        "{file}: the records at byte {offset} are nested too deeply",
        "{file}: バイト {offset} のレコードの入れ子が深すぎます",
    ),
    "fbx.missing": ("{file} has no {what}", "{file} に {what} がありません"),
    "fbx.unsupported": ("{file}: {what} is not supported", "{file}: {what} には対応していません"),
    "fbx.not_fbx": ("{file} is not an FBX file", "{file} は FBX ファイルではありません"),
    "fbx.foreign_damaged": (
        "{file} is damaged ({detail}); export it again",
        "{file} は壊れています（{detail}）。書き出し直してください",
    ),
    "fbx.too_large": (
        "{file} declares far more data than its size allows; export only the character",
        "{file} の内容がファイルのサイズに対して大きすぎます。キャラクターだけを書き出してください",
    ),
    "fbx.motion_too_large": (
        (
            "{file} declares far more data than its size allows; export only the skeleton and its animation, without "
            "meshes, textures and other takes"
        ),
        (
            "{file} の内容がファイルのサイズに対して大きすぎます。メッシュ、テクスチャ、ほかのテイクを含めず、"
            "スケルトンとそのアニメーションだけを書き出してください"
        ),
    ),
    "fbx.no_reader": (
        (
            "{file} cannot be read: FBX files of other programs require the Python package ufbx, which is missing here "
            "(Python 3.14 on Windows has none); use Python 3.11 to 3.13, or convert the file to GLB (a character) or "
            "BVH (motion)"
        ),
        (
            "{file} を読み込めません。ほかのプログラムの FBX ファイルには Python パッケージ ufbx が必要ですが、"
            "ここにはありません（Windows の Python 3.14 用はありません）。Python 3.11～3.13 を使うか、キャラクターは "
            "GLB、モーションは BVH に変換してください"
        ),
    ),
    "fbx.contradiction": ("{file} is inconsistent: {detail}", "{file} の内容が矛盾しています: {detail}"),
    "bvh.syntax": ("{file}, line {line}: unexpected {found}", "{file}、{line} 行目: {found} は無効です"),
    "bvh.truncated": (
        "{file} ends unexpectedly; copy or export it again",
        "{file} が途中で終わっています。コピーまたは書き出しをやり直してください",
    ),
    "bvh.row": (
        "{file}, line {line}: {found} {found:number|numbers} instead of {width} for a frame; export it again",
        "{file}、{line} 行目: 数値が {found} 個あります（1 フレームは {width} 個）。書き出し直してください",
    ),
    "bvh.no_frames": (
        "{file}, line {line}: 'Frames:' and 'Frame Time:' are missing after MOTION; export it again",
        "{file}、{line} 行目: MOTION の後に 'Frames:' と 'Frame Time:' がありません。書き出し直してください",
    ),
    "bvh.number": (
        "{file}, line {line}: a number of the motion is damaged or too large; export it again",
        "{file}、{line} 行目: モーションの数値が壊れているか、大きすぎます。書き出し直してください",
    ),
    "bvh.frame_time": (
        "{file}: 'Frame Time: {found}' is not the duration of a frame; enter it in seconds, such as 0.0333333 for 30 "
        "frames per second",
        (
            "{file}: 「Frame Time: {found}」はフレームの長さではありません。"
            "秒で指定してください（30 フレーム/秒なら 0.0333333）"
        ),
    ),
    "bvh.frames": (
        "{file}: 'Frames: {found}' is not a number of frames; enter how many rows of motion follow",
        "{file}: 「Frames: {found}」はフレーム数ではありません。続くモーションの行数を指定してください",
    ),
    "bvh.too_large": (
        "{file} declares far more data than its size allows; export only the motion",
        "{file} の内容がファイルのサイズに対して大きすぎます。モーションだけを書き出してください",
    ),
    "bvh.unsupported": (
        "{file}, line {line}: {what} is not supported",
        "{file}、{line} 行目: {what} には対応していません",
    ),
    "motion.incomplete": (
        "{file}: bones were not found for {joints}; only motion of a complete human body is supported",
        "{file}: {joints} のボーンが見つかりません。対応しているのは人体全身のモーションだけです",
    ),
    "motion.far": (
        "{file} is damaged: a joint is impossibly far away; export it again",
        "{file} は壊れています: 関節があり得ないほど遠くにあります。書き出し直してください",
    ),
    "motion.format": (
        "{file} is not a supported motion file; export the motion as BVH, FBX, GLB or VRMA",
        "{file} は対応していないモーションファイルです。モーションを BVH、FBX、GLB または VRMA で書き出してください",
    ),
    "motion.no_animation": (
        "{file} has no animation; export it with baked animation",
        "{file} にはアニメーションがありません。アニメーションをベイクして書き出してください",
    ),
    "motion.too_long": (
        (
            "{file}: {seconds:g} s of {nodes} {nodes:node|nodes} is too much motion for a file of this size; at most "
            "{most:g} s can be read; correct the times of its keys, or export it in shorter parts"
        ),
        (
            "{file}: {seconds:g} 秒（ノード {nodes} 個）のモーションは、ファイルのサイズに対して長すぎます。"
            "読み込めるのは {most:g} 秒までです。キーの時間を修正するか、短く分けて書き出してください"
        ),
    ),
    "motion.rate_impossible": (
        (
            "{file}: a frame of {frame_s:g} s is not possible; motion has from {slowest} to {fastest} frames/s; enter "
            "the true frame rate, or correct the frame time, which is in seconds"
        ),
        (
            "{file}: 1 フレーム {frame_s:g} 秒はあり得ません（{slowest}～{fastest} フレーム/秒が可能）。"
            "正しいフレームレートを指定するか、フレーム時間（秒単位）を修正してください"
        ),
    ),
    "usd.missing": (
        ("USD export requires the package usd-core, which is not installed; install it with: pip install usd-core"),
        (
            "USD の書き出しに必要なパッケージ usd-core がインストールされていません。"
            "次のコマンドでインストールしてください: pip install usd-core"
        ),
    ),
}
