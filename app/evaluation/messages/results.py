"""The results of an evaluation: what is wrong with viewers' files."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "results.not_text": (
        "{file} is not text in UTF-8; use the file that the page wrote, or save it from the spreadsheet as CSV UTF-8",
        "{file} は UTF-8 のテキストではありません。ページが書き出したファイルを使うか、表計算ソフトで「CSV UTF-8」"
        "として"
        "保存し直してください",
    ),
    "results.header": (
        "{file}, line 1: these are not the answers of a viewer: the first line must be {expected}; use the file "
        "that the "
        "page wrote",
        "{file} 1 行目: 参加者の回答ファイルではありません。1 行目は {expected} でなければなりません。ページが書き"
        "出した"
        "ファイルを使ってください",
    ),
    "results.row": (
        "{file}, line {line}: {found} fields instead of {expected}; the file is cut off or was edited: ask the "
        "viewer for "
        "the file that the page wrote",
        "{file} {line} 行目: 項目が {expected} 個ではなく {found} 個です。途中で切れているか編集されています。"
        "ページが書き出したファイルを参加者から受け取ってください",
    ),
    "results.value": (
        "{file}, line {line}: {column} is {found!r}, not one of: {expected}; ask the viewer for the file that the "
        "page "
        "wrote",
        "{file} {line} 行目: {column} の値 {found!r} は使えません（{expected}）。ページが書き出したファイルを視聴"
        "者から"
        "受け取ってください",
    ),
    "results.side": (
        "{file}, line {line}: answers about a pair need a side (left, right), others none; ask the viewer for the "
        "file "
        "that the page wrote",
        "{file} {line} 行目: 左右の指定（left、right）はペアの回答だけに必要です。ページが書き出したファイルを視聴"
        "者から"
        "受け取ってください",
    ),
    "results.cut_off": (
        "{file}, line {line}: the file is cut off: its last line does not end; ask the viewer to send it again",
        "{file} {line} 行目: 最終行に改行がなく、途中で切れています。参加者にもう一度送ってもらってください",
    ),
    "results.empty": (
        "{file} contains no answers; leave it out",
        "{file} には回答がありません。このファイルを除いてください",
    ),
    "results.viewers": (
        "{file}, line {line}: a second viewer or evaluation begins here; give one file for each viewer, as the "
        "page wrote "
        "it",
        "{file} {line} 行目: ここから別の参加者または別の評価の回答です。参加者ごとに 1 ファイル、ページが書き出した"
        "まま指定してください",
    ),
    "results.repeated": (
        "{file}, line {line}: this question was answered in line {first} already; ask the viewer for the file "
        "that the "
        "page wrote",
        "{file} {line} 行目: この質問は {first} 行目で回答済みです。ページが書き出したファイルを参加者から受け取って"
        "ください",
    ),
    "results.other_evaluation": (
        "{file} is about evaluation {found}, the key about {expected}; choose the key.json of that evaluation "
        "(--key), or "
        "leave the file out",
        "{file} は評価 {found} の回答ですが、キーは評価 {expected} のものです。その評価の key.json を --key で指定"
        "するか、"
        "このファイルを除いてください",
    ),
    "results.same_viewer": (
        "{file} and {other} are of the same viewer; leave one of them out",
        "{file} と {other} は同じ参加者の回答です。どちらかを除いてください",
    ),
    "results.unknown_clip": (
        "{file}, line {line}: the key has no clip {code}; choose the key.json that was written with the page (--key)",
        "{file} {line} 行目: クリップ {code} はキーにありません。ページと同時に書き出した key.json を --key で"
        "指定してください",
    ),
    "results.unasked": (
        "{file}, line {line}: the key does not ask about {aspect}; choose the key.json that was written with the "
        "page "
        "(--key)",
        "{file} {line} 行目: {aspect} はキーの質問にありません。ページと同時に書き出した key.json を --key で"
        "指定してください",
    ),
    "results.no_key": (
        "there is no {name} beside {file} or in the folder above; name it with --key",
        "{file} と同じフォルダーにも 1 つ上のフォルダーにも {name} がありません。--key で指定してください",
    ),
    "results.no_key_here": (
        "there is no {name} beside {file} or in the folder above; choose it with 'Choose Key...'",
        "{file} と同じフォルダーにも 1 つ上のフォルダーにも {name} がありません。「キーを選択...」で選んでください",
    ),
    "results.other_evaluation_here": (
        "{file} is about evaluation {found}, the key about {expected}; choose the key.json of that evaluation with "
        "'Choose Key...', or remove the file",
        "{file} は評価 {found} の回答ですが、キーは評価 {expected} のものです。その評価の key.json を"
        "「キーを選択...」で選ぶか、このファイルを取り除いてください",
    ),
    "results.unknown_clip_here": (
        "{file}, line {line}: the key has no clip {code}; choose the key.json that was written with the page with "
        "'Choose Key...'",
        "{file} {line} 行目: クリップ {code} はキーにありません。ページと同時に書き出した key.json を"
        "「キーを選択...」で選んでください",
    ),
    "results.unasked_here": (
        "{file}, line {line}: the key does not ask about {aspect}; choose the key.json that was written with the page "
        "with 'Choose Key...'",
        "{file} {line} 行目: {aspect} はキーの質問にありません。ページと同時に書き出した key.json を"
        "「キーを選択...」で選んでください",
    ),
    "results.not_measures": (
        "{file} does not contain measures of an evaluation ({detail}); make the evaluation again or remove the file",
        "{file} は評価の測定値ではありません（{detail}）。評価を作り直すか、このファイルを削除してください",
    ),
}
