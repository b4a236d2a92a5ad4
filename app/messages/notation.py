"""Scores in MusicXML: why one cannot be read, and what was changed in it."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "musicxml.damaged_archive": (
        "{file} is a damaged compressed file; export the score again as MusicXML",
        "{file} は壊れた圧縮ファイルです。楽譜を MusicXML で書き出し直してください",
    ),
    "musicxml.no_score_in_archive": (
        "{file} is a compressed file without a score; export the score as MusicXML",
        "{file} は圧縮ファイルですが、楽譜が入っていません。楽譜を MusicXML で書き出してください",
    ),
    "musicxml.archive_too_large": (
        (
            "{file} unpacks to more than {most_mb} MB, which no score of its size does; export it again uncompressed "
            "(.musicxml)"
        ),
        (
            "{file} を展開すると {most_mb} MB を超えます。この大きさの楽譜ではあり得ません。非圧縮（.musicxml）で"
            "書き出し直してください"
        ),
    ),
    "musicxml.damaged": (
        "{file} is damaged at line {line}: {detail}; export it again as MusicXML",
        "{file} の {line} 行目が壊れています: {detail}。MusicXML で書き出し直してください",
    ),
    "musicxml.entities": (
        "{file} declares entities, which no notation program does, and was not read; export it again as MusicXML",
        "{file} はエンティティを宣言しているため、読み込みませんでした。MusicXML で書き出し直してください",
    ),
    "musicxml.too_deep": (
        "{file} nests more than {most} elements at line {line}; export it again as MusicXML",
        "{file} の {line} 行目で要素の入れ子が {most} を超えています。MusicXML で書き出し直してください",
    ),
    "musicxml.too_many_elements": (
        "{file} has more than {most} XML elements; export fewer parts or a part of the piece",
        "{file} の XML 要素が {most} を超えています。パートを減らすか、曲の一部を書き出してください",
    ),
    "musicxml.not_a_score": (
        "{file} is not a score: its root element is <{root}>; export the piece as MusicXML from the notation program",
        "{file} は楽譜ではありません: ルート要素が <{root}> です。楽譜作成ソフトから MusicXML で書き出してください",
    ),
    "musicxml.list_of_scores": (
        "{file} lists other scores and has no notes of its own (a MusicXML opus); open one of the scores that it lists",
        "{file} は他の楽譜の一覧（MusicXML の opus）で、音符を含みません。一覧にある楽譜を開いてください",
    ),
    "musicxml.bad_value": (
        (
            "{file}, part {part}, measure {measure}: <{element}> is {value!r}, which makes no sense; correct the "
            "measure in the notation program and export it again"
        ),
        (
            "{file}、パート {part}、{measure} 小節: <{element}> の値 {value!r} が不正です。"
            "楽譜作成ソフトでこの小節を修正し、書き出し直してください"
        ),
    ),
    "musicxml.too_many_parts": (
        "{file} has {parts} parts, but at most {most} can be read; export fewer parts",
        "{file} にパートが {parts} あります。読み込めるのは {most} までです。パートを減らして書き出してください",
    ),
    "musicxml.too_many_measures": (
        "{file} has more than {most} measures in all its parts; export fewer parts or a part of the piece",
        "{file} の小節が全パートの合計で {most} を超えています。パートを減らすか、曲の一部を書き出してください",
    ),
    "musicxml.too_many_notes": (
        "{file} has more than {most} notes with its repeats; export fewer parts or a part of the piece",
        "{file} の音符が繰り返しを含めて {most} を超えています。パートを減らすか、曲の一部を書き出してください",
    ),
    "musicxml.too_many_repeats": (
        "{file} plays more than {most} measures with its repeats; correct the repeats in the notation program",
        "{file} の小節が繰り返しを含めて {most} を超えています。楽譜作成ソフトで繰り返しを修正してください",
    ),
    "musicxml.too_long": (
        (
            "{file} ends after {hours:g} hours, {quarters} quarter notes and {bars} bars; the maximum is {most_hours} "
            "hours, {most_quarters} quarter notes and {most_bars} bars; correct the tempo or export a part of the piece"
        ),
        (
            "{file} は {hours:g} 時間後（四分音符 {quarters} 個、{bars} 小節）に終わります。上限は {most_hours} 時間、"
            "四分音符 {most_quarters} 個、{most_bars} 小節です。テンポを修正するか、曲の一部を書き出してください"
        ),
    ),
    "musicxml.no_notes": (
        "the score has {parts} {parts:part|parts} and no notes",
        "楽譜に音符がありません（{parts} パート）",
    ),
    "musicxml.slashes": (
        "{part}: measures {measures} have slashes, whose pitches mean nothing: they are not played",
        "{part}: {measures} 小節はスラッシュ表記で音高がないため、演奏しません",
    ),
    "musicxml.lost_jump": (
        "measure {measure} jumps to a segno or coda that the score does not have; it was played without the jump",
        "{measure} 小節のジャンプ先の記号（セーニョまたはコーダ）が楽譜にないため、ジャンプせずに演奏します",
    ),
}
