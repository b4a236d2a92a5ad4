"""Plans: what is generated and why, and what is wrong with it."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    # Problems as lines of a report
    "note.place": ("{pitch} ({place})", "{pitch} ({place})"),
    "problem.at": ("{problem} (at {place})", "{problem}（{place}）"),
    "problem.repeated": (
        "{problem}; the same kind occurs {count} more {count:time|times}: {places}",
        "{problem}。同じ種類がほかに {count} 件: {places}",
    ),
    "problem.ignored": ("{count} {count:problem|problems} ignored", "無視した問題 {count} 件"),
    "doubling.rest_short": (
        ("the rest of {rest_s:g} s is too short to change from {before} to {after}; about {needed_s:g} s are needed"),
        "{before} から {after} への持ち替えには {rest_s:g} 秒の休みでは短すぎます。約 {needed_s:g} 秒必要です",
    ),
    "doubling.overlap": (
        (
            "{before} still sounds {seconds:g} s into {after}, and one player plays both; notes during the change "
            "are not played"
        ),
        (
            "{after} の始まりから {seconds:g} 秒間まだ {before} が鳴っていますが、奏者は一人です。"
            "持ち替えの間の音は演奏されません"
        ),
    ),
    # The plan: fingerings
    "fingering.first_choice": ("{label}: usual fingering", "{label}: 標準の運指"),
    "fingering.trill": (
        "{label} instead of {first}: less motion in a trill with {time_ms} ms per note",
        "{first} の代わりに {label}: 1 音 {time_ms} ms のトリルで動きが少なくなります",
    ),
    "fingering.speed": (
        "{label} instead of {first}: less motion where a note lasts {time_ms} ms",
        "{first} の代わりに {label}: 1 音が {time_ms} ms のところで動きが少なくなります",
    ),
    "fingering.by_hand": ("{label}: set manually", "{label}: 手動で指定"),
    "fingering.written": ("{label}: in the score", "{label}: 楽譜の指定"),
    "fingering.not_in_map": (
        "the fingering {label!r} in the score is not in the instrument map for note {note}, which is fingered as usual",
        "楽譜の運指 {label!r} は、音符 {note} に対してインストゥルメントマップにないため、通常の運指で演奏します",
    ),
    "fingering.out_of_range": (
        ("note {note} is outside this instrument's range ({low} to {high}); the fingering of {played_pitch} is shown"),
        "音符 {note} はこの楽器の音域（{low}～{high}）の外です。{played_pitch} の運指を表示します",
    ),
    "fingering.starts_early": (
        (
            "the change to {label} takes {needed_ms} ms, but only {available_ms} ms are available before note "
            "{note}, so it starts earlier"
        ),
        (
            "{label} への移動には {needed_ms} ms かかりますが、音符 {note} の前には {available_ms} ms "
            "しかないため、早めに動き始めます"
        ),
    ),
    # The plan: notes that cannot sound together
    "note.struck_together": (
        (
            "note {note} starts together with the higher note {other} and is excluded, as only one note can sound "
            "at a time"
        ),
        "音符 {note} は、より高い音符 {other} と同時です。一度に鳴る音は 1 つのため、除外します",
    ),
    "note.overlaps": (
        "note {note} overlaps {other} by {overlap_ms} ms and is shortened",
        "音符 {note} は {other} と {overlap_ms} ms 重なるため、短くします",
    ),
    "contact.out_of_reach": (
        (
            "{label} is out of reach for this player: {control} stops {gap_mm} mm short; choose another fingering, "
            "or a character with longer arms"
        ),
        (
            "{label} にはこの奏者の手が届かず、{control}が {gap_mm} mm 手前で止まります。別の運指か、"
            "腕の長いキャラクターを選んでください"
        ),
    ),
    # The plan: breaths
    "breath.first": (
        "first breath, in the {beats:g} {beats:beat|beats} before the entry",
        "最初のブレス。入りの前の {beats:g} 拍で吸います",
    ),
    "breath.rest_whole": (
        (
            "rest of {rest_beats:g} {rest_beats:beat|beats} ({rest_s:g} s), breathed in because {why}; shorter than "
            "{last_beat_beats:g} {last_beat_beats:beat|beats}: the breath takes the whole rest"
        ),
        (
            "{rest_beats:g} 拍（{rest_s:g} 秒）の休符。{why}ためブレスします。{last_beat_beats:g} 拍未満なので"
            "休符全体で吸います"
        ),
    ),
    "breath.blown": (
        "from the recorded breath: {gap_s:g} s without blowing",
        "録音したブレスから: {gap_s:g} 秒間息が止まっています",
    ),
    "breath.blown_preparation": (
        "from the recorded breath: {gap_s:g} s without blowing; breath preparation",
        "録音したブレスから: {gap_s:g} 秒間息が止まっています。ブレスの準備動作です",
    ),
    "breath.blown_short": (
        "from the recorded breath: {gap_s:g} s without blowing, used because air runs out",
        "録音したブレスから: {gap_s:g} 秒間息が止まっています。息が足りないためここで吸います",
    ),
    "breath.last_beat": (
        (
            "rest of {rest_beats:g} {rest_beats:beat|beats} ({rest_s:g} s), breathed in because {why}; from "
            "{last_beat_beats:g} to less than {prepare_beats:g} {prepare_beats:beat|beats}: the breath takes the last "
            "beat"
        ),
        (
            "{rest_beats:g} 拍（{rest_s:g} 秒）の休符。{why}ためブレスします。{last_beat_beats:g} 拍以上 "
            "{prepare_beats:g} 拍未満なので最後の拍で吸います"
        ),
    ),
    "breath.prepared": (
        (
            "rest of {rest_beats:g} {rest_beats:beat|beats} ({rest_s:g} s), breathed in because {why}; at least "
            "{prepare_beats:g} {prepare_beats:beat|beats}: preparation, then breath on the last beat"
        ),
        (
            "{rest_beats:g} 拍（{rest_s:g} 秒）の休符。{why}ためブレスします。{prepare_beats:g} 拍以上なので"
            "準備動作をしてから最後の拍で吸います"
        ),
    ),
    "breath.why_long": (
        "rests of {always_s:g} s and more are always used",
        "{always_s:g} 秒以上の休符では必ず吸う",
    ),
    "breath.why_every": ("every rest is used", "すべての休符で吸う設定の"),
    "breath.why_played": (
        "{played_s:g} s were played since the last breath in a rest (at least {enough_s:g} s)",
        "前に休符で吸ってから {played_s:g} 秒吹いている（{enough_s:g} 秒以上）",
    ),
    "breath.why_air": (
        "{spent:g} % of the air is used (at least {share:g} %)",
        "息を {spent:g} % 使っている（{share:g} % 以上）",
    ),
    "breath.why_short": (
        "the air does not last until a better place",
        "次のよい場所まで息が続かない",
    ),
    "breath.why_written": ("there is a breath mark in the score", "楽譜にブレス記号がある"),
    "breath.why_by_hand": ("there is a breath mark by hand", "手動で記入したブレス記号がある"),
    "breath.why_not_recorded": (
        "no breath was recorded for this note",
        "この音のブレスは録音されていない",
    ),
    "breath.preparation": (
        "rest of {rest_beats:g} {rest_beats:beat|beats} (at least {prepare_beats:g}): breath preparation",
        "{rest_beats:g} 拍の休符（{prepare_beats:g} 以上）: ブレスの準備動作",
    ),
    "breath.catch": (
        (
            "catch breath after note {after_note}: {phrase_s:g} s without a breath in a rest need {air_s:g} s of air, "
            "but {lung_s:g} s are available; the note is shortened by {from_note_ms:g} ms"
        ),
        (
            "音符 {after_note} の後の息継ぎ: 休符でブレスできない {phrase_s:g} 秒に {air_s:g} 秒分の息が必要ですが、"
            "{lung_s:g} 秒分しかありません。その音を {from_note_ms:g} ms 短くします"
        ),
    ),
    "breath.catch_slurred": (
        (
            "catch breath after note {after_note}, which breaks a written slur: {phrase_s:g} s without a breath "
            "in a rest need {air_s:g} s of air, but {lung_s:g} s are available; the note is shortened by "
            "{from_note_ms:g} ms"
        ),
        (
            "音符 {after_note} の後の息継ぎ（スラーの途中）: 休符でブレスできない {phrase_s:g} 秒に {air_s:g} "
            "秒分の息が必要ですが、{lung_s:g} 秒分しかありません。その音を {from_note_ms:g} ms 短くします"
        ),
    ),
    "breath.catch_rest_slurred": (
        (
            "catch breath in the rest under a slur, after note {after_note}: {phrase_s:g} s without a breath in a rest "
            "need {air_s:g} s of air, but {lung_s:g} s are available"
        ),
        (
            "スラー内の休符（音符 {after_note} の後）での息継ぎ: 休符でブレスできない {phrase_s:g} 秒に {air_s:g} "
            "秒分の息が必要ですが、{lung_s:g} 秒分しかありません"
        ),
    ),
    "breath.written": (
        "breath mark in the score after note {after_note}, which is shortened by {from_note_ms:g} ms",
        "楽譜のブレス記号。前の音符 {after_note} を {from_note_ms:g} ms 短くします",
    ),
    "breath.by_hand": (
        "breath mark by hand after note {after_note}, which is shortened by {from_note_ms:g} ms",
        "手動で記入したブレス記号。前の音符 {after_note} を {from_note_ms:g} ms 短くします",
    ),
    "breath.phrase_end": (
        "short breath at the end of a phrase, after note {after_note}, which is shortened by {from_note_ms:g} ms",
        "フレーズの終わりの短いブレス。前の音符 {after_note} を {from_note_ms:g} ms 短くします",
    ),
    "breath.after_hold": (
        "catch breath in the release after note {after_note}, which all hold; they start again together",
        "全員が延ばす音符 {after_note} の後、次の入りの前の息継ぎ",
    ),
    "breath.catch_dropped": (
        (
            "catch breath in place of note {after_note}, which is excluded: {phrase_s:g} s without a breath in a rest "
            "need {air_s:g} s of air, but {lung_s:g} s are available, and no note is long enough to shorten"
        ),
        (
            "音符 {after_note} を除外した息継ぎ: 休符でブレスできない {phrase_s:g} 秒に {air_s:g} "
            "秒分の息が必要ですが、{lung_s:g} 秒分しかありません。短くできる長さの音もありません"
        ),
    ),
    "breath.catch_dropped_two": (
        (
            "catch breath in place of notes {first_note} and {after_note}, which are excluded: {phrase_s:g} s without "
            "a breath in a rest need {air_s:g} s of air, but {lung_s:g} s are available, and no note is long enough "
            "to shorten"
        ),
        (
            "音符 {first_note} と {after_note} を除外した息継ぎ: 休符でブレスできない {phrase_s:g} 秒に {air_s:g} "
            "秒分の息が必要ですが、{lung_s:g} 秒分しかありません。短くできる長さの音もありません"
        ),
    ),
    "breath.catch_dropped_slurred": (
        (
            "catch breath in place of note {after_note}, which is excluded: it {why}; {phrase_s:g} s without a breath "
            "in a rest need {air_s:g} s of air, but {lung_s:g} s are available, and there is no other place"
        ),
        (
            "音符 {after_note} を除外した息継ぎ（{why}）: 休符でブレスできない {phrase_s:g} 秒に {air_s:g} "
            "秒分の息が必要ですが、{lung_s:g} 秒分しかありません。ほかに吸える場所もありません"
        ),
    ),
    "breath.catch_dropped_two_slurred": (
        (
            "catch breath in place of notes {first_note} and {after_note}, which are excluded: it {why}; "
            "{phrase_s:g} s without a breath in a rest need {air_s:g} s of air, but {lung_s:g} s are available, and "
            "there is no other place"
        ),
        (
            "音符 {first_note} と {after_note} を除外した息継ぎ（{why}）: 休符でブレスできない {phrase_s:g} 秒に "
            "{air_s:g} 秒分の息が必要ですが、{lung_s:g} 秒分しかありません。ほかに吸える場所もありません"
        ),
    ),
    "breath.slur_broken": ("breaks a written slur", "スラーの途中"),
    "breath.slur_begins_late": ("takes the beginning of a written slur", "スラーの始めの音を省略"),
    "breath.slur_ends_early": ("takes the end of a written slur", "スラーの終わりの音を省略"),
    "breath.staggered": (
        (
            "staggered breath within a note that others of the line sustain: {air_s:g} s of air are needed, "
            "{lung_s:g} s are available"
        ),
        (
            "同じ声部のほかの奏者がのばしている音の途中のブレス: {air_s:g} 秒分の息が必要ですが、{lung_s:g} "
            "秒分しかありません"
        ),
    ),
    "breath.too_long": (
        (
            "from note {note}, {phrase_s:g} s must be played in one breath: {air_s:g} s of air are needed, "
            "{lung_s:g} s are available; add a breath"
        ),
        (
            "音符 {note} から {phrase_s:g} 秒を一息で吹く必要があります。{air_s:g} 秒分の息が必要ですが、"
            "{lung_s:g} 秒分しかありません。ブレスを追加してください"
        ),
    ),
    "breath.breaks_slur": (
        "the air does not last for the slur over note {note}: this breath breaks it; move the breath or add one before",
        "音符 {note} のスラーの終わりまで息が続かず、途中でブレスします。ブレスを移動するか、前に追加してください",
    ),
    "breath.mark_too_short": (
        (
            "note {note} is so short that the breath mark after it leaves {lasts_ms:g} ms, but a breath takes at least "
            "{least_ms:g} ms: move the mark, or start the breath earlier by hand"
        ),
        (
            "音符 {note} が短く、後のブレス記号に {lasts_ms:g} ms しかありません"
            "（ブレスには {least_ms:g} ms 以上必要）。記号を移動するか、ブレスの開始を手動で早めてください"
        ),
    ),
    "breath.inside_note": (
        "this manually placed breath is inside the sounding note {note}; move or remove it",
        "手動で置いたこのブレスは、鳴っている音符 {note} の途中にあります。移動するか削除してください",
    ),
    # Corrections
    "correction.by_hand": ("set manually", "手動で指定"),
    "correction.orphaned": (
        "correction ({kind}) for {anchor}: no matching note; it is kept but inactive; re-attach or revert it",
        ("{anchor} への手動修正（{kind}）: 対応する音符がなく、無効です。残してあるので、付け直すか元に戻してください"),
    ),
    "correction.unknown_expression": (
        "expression {name!r} was not found; choose one of: {known}",
        "表情 {name!r} が見つかりません。使えるもの: {known}",
    ),
    "correction.empty_span": (
        "correction ({kind}) for {anchor} ends before it starts; it is kept but inactive",
        "{anchor} への手動修正（{kind}）は、始まる前に終わるため無効です。残してあります",
    ),
    "pose.beyond_reach": (
        (
            "the {target} is set to {asked_deg:g} degrees ({angle}), but the limit of the body or instrument hold "
            "is {most_deg:g} degrees"
        ),
        "{target}の指定は {asked_deg:g} 度（{angle}）ですが、体や楽器の構えの限度は {most_deg:g} 度です",
    ),
    "additive.beyond_reach": (
        "curve for {moved}: {asked:g}{unit}, but the limit of the body or instrument hold is {most:g}{unit}",
        "{moved} のカーブは {asked:g}{unit} ですが、体や楽器の構えの限度は {most:g}{unit} です",
    ),
    "additive.not_here": (
        "curve for {moved}: this does not move in the player's posture; the curve is kept but inactive",
        "{moved} は、この奏者の姿勢では動かないため、カーブは無効です。残してあります",
    ),
    "additive.too_fast": (
        "curve for {moved}: changes faster than a body moves; put its keys further apart",
        "{moved} のカーブは、体の動きより速く変化します。キーの間隔を広げてください",
    ),
    "correction.no_such_fingering": (
        "{label} is not a fingering of note {note} on this instrument; the generated fingering is used",
        "{label} はこの楽器での音符 {note} の運指ではないため、自動生成の運指を使います",
    ),
}
