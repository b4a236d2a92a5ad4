"""Parts, and who plays them."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
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
            "{count} {count:note that overlaps others is|notes that overlap others are} left out, the first at {place} "
            "({pitch}): too few and too short for a player of their own. All other notes of the part are played. To "
            "keep {count:it|them}, set Overlapping notes to Split among players in the import dialog"
        ),
        (
            "ほかの音と重なる {count} 音を除きました（最初は {place} の {pitch}）。奏者を増やすには少なく短いためで、"
            "パートのほかの音はすべて演奏されます。残すには、読み込みのダイアログで「重なる音」を"
            "「複数の奏者で分担」にしてください"
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
            "{count:switch|switches}, the first at {place} ({pitch}). All other notes of the part are played"
        ),
        (
            "楽器の音域から遠い {count} 音をキースイッチと見なしました（最初は {place} の {pitch}）。"
            "パートのほかの音はすべて演奏されます"
        ),
    ),
    "score.voices": (
        (
            "{part}: split among {voices} players because {count} {count:note keeps|notes keep} overlapping others,"
            " the first at {place} ({pitch})"
        ),
        ("{part}: {count} 音がほかの音と重なり続けるため、{voices} 人で分担します（最初は {place} の {pitch}）"),
    ),
}
