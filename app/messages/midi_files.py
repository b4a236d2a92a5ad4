"""MIDI files that are read and written."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    # MIDI files that cannot be read
    "midi.empty": ("{file} is empty; choose another file", "{file} は空です。別のファイルを選んでください"),
    "midi.not_midi": (
        "{file} is not a MIDI file: byte {byte} contains {found} instead of the header MThd",
        "{file} は MIDI ファイルではありません: ヘッダー MThd があるべきバイト {byte} が {found} です",
    ),
    "midi.header_truncated": (
        "{file} ends within its header, at byte {byte}; copy or export it again",
        "{file} がヘッダーの途中（バイト {byte}）で終わっています。コピーまたは書き出しをやり直してください",
    ),
    "midi.bad_division": (
        "{file}: the time division at byte {byte} is 0, so note times cannot be determined; export it again",
        "{file}: バイト {byte} の分解能が 0 のため、音符の時間を決定できません。書き出し直してください",
    ),
    "midi.no_tracks": (
        "{file} has no tracks: byte {byte} contains {found} instead of a track header MTrk",
        "{file} にトラックがありません: トラック MTrk があるべきバイト {byte} が {found} です",
    ),
    "midi.unknown_encoding": (
        "{file}: unknown text encoding {encoding!r}",
        "{file}: 文字コード {encoding!r} は不明です",
    ),
    "midi.track_unreadable": (
        "{file}: track {track}, starting at byte {byte}, cannot be read: {detail}",
        "{file}: バイト {byte} から始まるトラック {track} を読み込めません: {detail}",
    ),
    "midi.too_many_parts": (
        (
            "{file}: {parts} parts (channels of tracks) contain notes, but at most {most} can be read; in the "
            "source program, delete parts that no wind player plays"
        ),
        (
            "{file}: 音符のあるパート（トラックごとのチャンネル）が {parts} あります。読み込めるのは {most} "
            "までです。元のプログラムで、管楽器が演奏しないパートを削除してください"
        ),
    ),
    "midi.too_long": (
        (
            "{file}: the last note of track {track} ends after {hours:g} hours, {quarters} quarter notes and "
            "{bars} bars; the maximum is {most_hours} hours, {most_quarters} quarter notes and {most_bars} bars; "
            "in the source program, delete notes far behind the music, or correct the tempo"
        ),
        (
            "{file}: トラック {track} の最後の音符が {hours:g} 時間後（四分音符 {quarters} 個、{bars} "
            "小節）に終わります。上限は {most_hours} 時間、四分音符 {most_quarters} 個、{most_bars} 小節です。"
            "元のプログラムで、曲から遠く離れた音符を削除するか、テンポを修正してください"
        ),
    ),
    # MIDI files that can be read in part, or in an own way
    "midi.header_length": (
        ("the header length is stated as {length} bytes, which is wrong (byte {byte}); its first 6 bytes were used"),
        "ヘッダーの長さ {length} バイトは誤りです（バイト {byte}）。先頭の 6 バイトを使いました",
    ),
    "midi.unknown_format": (
        "unknown file format {format}; the tracks were treated as simultaneous",
        "不明なフォーマット {format} です。トラックは同時に鳴るものとして読み込みました",
    ),
    "midi.format_0_tracks": (
        "the file is format 0 (one track) but has {tracks} tracks; they were treated as simultaneous",
        (
            "フォーマット 0（1 トラック）のファイルですが、トラックが {tracks} あります。"
            "同時に鳴るものとして読み込みました"
        ),
    ),
    "midi.track_length": (
        "the length of track {track} (byte {byte}) is wrong; the track was read to its actual end",
        "トラック {track} の長さ（バイト {byte}）が誤っています。実際の終わりまで読み込みました",
    ),
    "midi.track_cut_off": (
        (
            "the file ends within track {track}, after {found} of its {length} bytes (its length is at byte {byte}); "
            "what is there was read"
        ),
        (
            "ファイルがトラック {track} の途中で終わっています（{length} バイト中 {found} バイト、"
            "長さはバイト {byte}）。そこまでを読み込みました"
        ),
    ),
    "midi.tracks_missing": (
        "the header states {expected} tracks, but the file has {found}",
        "ヘッダーには {expected} トラックとありますが、実際は {found} です",
    ),
    "midi.bytes_left_out": (
        (
            "{count} {count:byte|bytes} after the last track, from byte {byte}, {count:is|are} not MIDI data and "
            "{count:was|were} skipped"
        ),
        "最後のトラックの後、バイト {byte} からの {count} バイトは MIDI データではないため、無視しました",
    ),
    "midi.track_truncated": (
        "track {track} ends within an event at byte {byte}; the events before it were read",
        "トラック {track} はバイト {byte} のイベントの途中で切れています。その前までを読み込みました",
    ),
    "midi.bytes_not_understood": (
        (
            "{count} {count:byte|bytes} of track {track} {count:is not a MIDI event and was|are not MIDI events "
            "and were} skipped, the first at byte {byte}"
        ),
        "トラック {track} の {count} バイトは MIDI イベントではないため、無視しました（最初はバイト {byte}）",
    ),
    "midi.smpte_rate": (
        "the file counts time in frames of 1/{rate} s, which is not an SMPTE rate; the value was used as it is",
        "時間の単位 1/{rate} 秒は SMPTE にない値です。そのまま使いました",
    ),
    "midi.patterns": (
        "the file has {patterns} independent patterns (format 2); they were placed one after another",
        "独立した {patterns} 個のパターン（フォーマット 2）です。順に並べました",
    ),
    "midi.early_end": (
        "an end-of-track event of track {track} comes before {count} {count:note|notes}; {count:it was|they were} read",
        "トラック {track} の途中にトラックの終わりがありますが、その後の {count} 音も読み込みました",
    ),
    "midi.hanging_notes": (
        (
            "{count} {count:note|notes} of track {track} {count:has no note-off; it ends|have no note-off; they "
            "end} at the next note of the channel, or after four quarter notes at most"
        ),
        (
            "トラック {track} の {count} 音にノートオフがないため、同じチャンネルの次の音符まで（最長で四分音符 4 "
            "個分）としました"
        ),
    ),
    "midi.stuck_notes": (
        (
            "{count} {count:note|notes} of track {track} {count:sounds|sound} for hours after the rest of the piece "
            "and {count:was|were} cut at its end, the first at {place} ({pitch}, {hours:g} hours long)"
        ),
        (
            "トラック {track} の {count} 音が曲の終わりの後も何時間も続くため、曲の終わりで切りました"
            "（最初は {place} の {pitch}、長さ {hours:g} 時間）"
        ),
    ),
    "midi.zero_length_notes": (
        (
            "{count} {count:note|notes} of track {track} {count:has no length and was|have no length and were} set "
            "to one tick"
        ),
        "トラック {track} の {count} 音には長さがないため、1 ティックとしました",
    ),
    "midi.beyond_all_music": (
        (
            "{count} {count:event|events} of track {track} {count:is|are} beyond the last possible tick and "
            "{count:was|were} skipped"
        ),
        "トラック {track} の {count} 個のイベントは最大のティックを超えているため、無視しました",
    ),
    "midi.impossible_metre": (
        (
            "track {track} has {count} invalid time {count:signature|signatures}, the first at tick {tick}; "
            "{count:it was|they were} skipped"
        ),
        "トラック {track} に不正な拍子が {count} 個あるため（最初はティック {tick}）、無視しました",
    ),
    "midi.metre_assumed": (
        "no time signature in the file: {numerator}/{denominator} assumed from the notes",
        "ファイルに拍子がないため、音符から {numerator}/{denominator} と推定しました",
    ),
    "midi.impossible_tempo": (
        (
            "track {track} has {count} invalid {count:tempo|tempos}, the first at tick {tick}; {count:it was|they "
            "were} skipped"
        ),
        "トラック {track} に不正なテンポが {count} 個あるため（最初はティック {tick}）、無視しました",
    ),
    "midi.no_notes": (
        "the file has {tracks} {tracks:track|tracks} and no notes",
        "ファイルに音符がありません（{tracks} トラック）",
    ),
    "midi.track_without_notes": (
        "track {track} ({name}) has no notes and {count} other {count:event|events}",
        "トラック {track}（{name}）には音符がなく、ほかのイベントが {count} 個あります",
    ),
    "midi.unnamed_track_without_notes": (
        "track {track} has no notes and {count} other {count:event|events}",
        "トラック {track} には音符がなく、ほかのイベントが {count} 個あります",
    ),
    # MIDI files that were written, and what they cannot hold
    "midi.written": ("{file} saved: {count} {count:track|tracks}", "{file} を保存しました（{count} トラック）"),
    "midi.written_but": (
        "{file} saved with {count} {count:warning|warnings}: {first}",
        "{file} を保存しましたが、警告が {count} 件あります: {first}",
    ),
    "midi.tempo_unwritable": (
        (
            "{place}: MIDI files support tempos of {low:g} to {high:g} quarter notes per minute, not {bpm:g}; "
            "change the tempo and export again"
        ),
        (
            "{place}: MIDI ファイルのテンポは毎分 {low:g} から {high:g} 四分音符までで、{bpm:g} "
            "は保存できません。テンポを変更してからもう一度書き出してください"
        ),
    ),
    "midi.nested_notes": (
        (
            "{part}: {count} overlapping same-pitch {count:note|notes} cannot be represented in a MIDI file: the "
            "ends are swapped"
        ),
        "{part}: 同じ高さで重なる {count} 音は MIDI ファイルで表せないため、終わりが入れ替わります",
    ),
    "midi.name_says_other": (
        "{part}: the name indicates {said}, so it will be imported as that instead of {played}; rename the part",
        (
            "{part}: 名前が {said} を示すため、読み込むと {played} ではなくそちらとして扱われます。"
            "パートの名前を変更してください"
        ),
    ),
    "midi.shared_again": (
        "{part}: notes overlap, so an import splits them among several players",
        "{part}: 同時に鳴る音があるため、読み込むと複数の奏者に分けられます",
    ),
    "midi.onto_source": (
        (
            "{file} is the source of this piece and contains {count} more {count:part|parts} that {count:is|are} "
            "not played here; save to another file"
        ),
        (
            "{file} はこの曲の読み込み元で、ここで演奏されないパートがほかに {count} 個あります。"
            "別のファイルに保存してください"
        ),
    ),
    "midi.onto_itself": (
        "{file} is the source file and cannot be replaced; save to another file",
        "{file} は読み込み元なので上書きできません。別のファイルに保存してください",
    ),
}
