"""MIDI files, parts and who plays them."""

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
    # Parts and who plays them
    "score.no_map": (
        "no instrument map for {instrument} is available; add a map and a model for it",
        "{instrument} のインストゥルメントマップがありません。マップとモデルを追加してください",
    ),
    "score.left_out": ("excluded on import", "読み込み時に除外"),
    "score.percussion": ("{instrument} is percussion", "{instrument} は打楽器です"),
    "score.sound_effect": ("it is a sound effect, which no player plays", "効果音です。奏者は演奏しません"),
    "score.not_wind": ("{instrument} is not a wind instrument", "{instrument} は管楽器ではありません"),
    "score.outside_ranges": (
        (
            "the instrument cannot be determined from name or program, and no instrument map covers its range "
            "({lowest} to {highest})"
        ),
        (
            "名前やプログラム番号から楽器を判定できず、"
            "音域（{lowest}～{highest}）に合うインストゥルメントマップもありません"
        ),
    ),
    "score.substituted": (
        "{part}: no instrument map for {instrument} is available; {map} is used instead",
        "{part}: {instrument} のインストゥルメントマップがないため、{map} で代用します",
    ),
    "score.instrument_from_title": (
        "{part}: the instrument cannot be determined from name or program; {map} was chosen from the title",
        "{part}: 名前やプログラム番号から楽器を判定できないため、曲名から {map} を選びました",
    ),
    "score.chosen_by_ensemble": (
        (
            "{part}: the instrument cannot be determined from name or program; {map} was chosen because the staves "
            "match a known ensemble"
        ),
        "{part}: 名前やプログラム番号から楽器を判定できないため、よくある編成と一致する {map} を選びました",
    ),
    "score.program_gives_way": (
        (
            "{part}: the program number selects {instrument}, but {outside} of {total} notes are outside its range, "
            "the first at {place} ({pitch}); {map} is used because the range fits"
        ),
        (
            "{part}: プログラム番号の楽器は {instrument} ですが、{total} 音のうち {outside} 音が音域外のため（最初は "
            "{place} の {pitch}）、音域の合う {map} を使います"
        ),
    ),
    "score.chosen_by_range": (
        "{part}: the instrument cannot be determined from name or program; {map} was chosen by range",
        "{part}: 名前やプログラム番号から楽器を判定できないため、音域の合う {map} を選びました",
    ),
    "score.chosen_by_range_partly": (
        (
            "{part}: the instrument cannot be determined from name or program; {map} was chosen, but {outside} of "
            "{total} notes are outside its range, the first at {place} ({pitch})"
        ),
        (
            "{part}: 名前やプログラム番号から楽器を判定できないため、{map} を選びましたが、{total} 音のうち "
            "{outside} 音が音域外です（最初は {place} の {pitch}）"
        ),
    ),
    "score.looks_written": (
        (
            "{part}: {outside} of {total} notes are outside the range of {map}, the first at "
            "{place} ({pitch}), but all fit as written pitches; import this part as written pitch"
        ),
        (
            "{part}: {total} 音のうち {outside} 音が {map} の音域外ですが（最初は {place} の {pitch}）、"
            "記譜音と見なすとすべて収まります。このパートを「記譜音」として読み込んでください"
        ),
    ),
    "score.read_as_written": (
        (
            "{part}: {outside} of {total} notes are outside the range of {map} as sounding pitches, the first at "
            "{place} ({pitch}), but all fit as written pitches; this part is imported as written pitch"
        ),
        (
            "{part}: 実音と見なすと {total} 音のうち {outside} 音が {map} の音域外ですが（最初は {place} の {pitch}）、"
            "記譜音と見なすとすべて収まるため、「記譜音」として読み込みます"
        ),
    ),
    "score.take_cleaned": (
        (
            "{part}: cleaned as a take of a wind controller: {count} {count:note|notes} left out ({slips} slipped, "
            "{doubles} struck twice in one breath, {silent} without breath), at {places}; "
            "turn off Clean Take at import (--keep-takes) to keep {count:it|them}"
        ),
        (
            "{part}: ウインドコントローラーのテイクとしてクリーンアップし、{count} 音を除きました（運指のずれ {slips}、"
            "1 つの息での二度打ち {doubles}、息のない音 {silent}）。位置: {places}。残すには、"
            "読み込みで「テイクをクリーンアップ」をオフ（--keep-takes）にしてください"
        ),
    ),
    "score.solos": (
        "{part}: {count} {count:note is|notes are} marked for one player, the first at {place} ({pitch}); others rest",
        "{part}: {count} 音は奏者 1 人の指定があるため（最初は {place} の {pitch}）、ほかの奏者は休みます",
    ),
    "score.written": (
        "{part}: imported as written pitch for {map}",
        "{part}: {map} の記譜音として読み込みます",
    ),
    "score.too_many_players": (
        "the piece already has the maximum of {most} players",
        "奏者が既に上限の {most} 人に達しています",
    ),
    "score.too_many_for_hours": (
        (
            "at most {most} {most:player plays|players play} a piece of {hours:g} hours; in the source program, "
            "split the piece"
        ),
        "{hours:g} 時間の曲を演奏できる奏者は {most} 人までです。元のプログラムで曲を分割してください",
    ),
    "score.unknown_instrument": (
        "the instrument cannot be determined because the name is not understood ({lowest} to {highest}); select one",
        "トラック名から楽器を判定できません（{lowest}～{highest}）。楽器を選んでください",
    ),
    "score.unisons": (
        (
            "{part}: {count} {count:note is|notes are} doubled in unison, the first at {place} ({pitch}); one player "
            "plays {count:it|each} once"
        ),
        "{part}: {count} 音がユニゾンで重複しているため、1 人の奏者が 1 回ずつ演奏します（最初は {place} の {pitch}）",
    ),
    "score.regions": (
        (
            "{part}: {count} {count:track|tracks} of this name, channel and program, one after the other, have one "
            "player; if they are several players, split them in the import dialog"
        ),
        (
            "{part}: 名前・チャンネル・プログラムが同じ {count} トラックが順に続くため、1 人の奏者にまとめました。"
            "別々の奏者の場合は、読み込みのダイアログで分けてください"
        ),
    ),
    "score.spread": (
        (
            "{part}: one line goes through {count} {count:track|tracks}, as controllers with a channel for each note "
            "write it, and has one player; if they are several players, split them in the import dialog"
        ),
        (
            "{part}: 音ごとにチャンネルを変える楽器のように、1 つの旋律が {count} トラックに分かれているため、"
            "1 人の奏者にまとめました。別々の奏者の場合は、読み込みのダイアログで分けてください"
        ),
    ),
    "score.notes_left_out": (
        (
            "{part}: split among the maximum of {most} players; {count} further overlapping {count:note was|notes "
            "were} excluded, the first at {place} ({pitch})"
        ),
        ("{part}: 上限の {most} 人で分担し、それ以上に重なる {count} 音を除外しました（最初は {place} の {pitch}）"),
    ),
    "score.doubling": (
        ("{part}: the player changes to {instrument} for {count} {count:note|notes}, the first at {place} ({pitch})"),
        ("{part}: 奏者が {count} 音を {instrument} に持ち替えて演奏します。最初は {place}（{pitch}）"),
    ),
    "score.stray_notes": (
        (
            "{count} overlapping {count:note was|notes were} excluded, the first at {place} ({pitch}); "
            "too few and too short for another player"
        ),
        (
            "ほかの音と重なる {count} 音を除外しました（最初は {place} の {pitch}）。"
            "別の奏者に分けるには少なく短いためです"
        ),
    ),
    "score.slurred": (
        (
            "{count} {count:note overlaps the next one and was|notes overlap the next ones and were} shortened as "
            "slurred, the first in {part} at {place} ({pitch})"
        ),
        (
            "{count} 音が次の音に重なるため、スラーとして次の音の始まりまで縮めました（最初は {part} の "
            "{place} の {pitch}）"
        ),
    ),
    "score.key_switches": (
        (
            "{count} {count:note|notes} far outside the range of the instrument {count:was|were} treated as key "
            "{count:switch|switches}, the first at {place} ({pitch})"
        ),
        "楽器の音域から遠い {count} 音をキースイッチと見なしました（最初は {place} の {pitch}）",
    ),
    "score.voices": (
        (
            "{part}: split among {voices} players because {count} {count:note keeps|notes keep} overlapping others,"
            " the first at {place} ({pitch})"
        ),
        ("{part}: {count} 音がほかの音と重なり続けるため、{voices} 人で分担します（最初は {place} の {pitch}）"),
    ),
}
