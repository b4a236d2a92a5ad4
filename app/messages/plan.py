"""Fingerings, breaths, cues, gestures, faces, corrections: reasons and problems."""

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
    # The body: what it lacks
    "character.instrument_size": (
        "the instrument is scaled to {percent} % so that hands and arms can reach it",
        "手と腕が届くように、楽器の大きさを {percent} % にします",
    ),
    "character.no_fingers": (
        (
            "the fingers of the {side} hand do not bend: the whole hand rests on the instrument, and keys and "
            "valves move without fingers"
        ),
        "{side}手の指は曲がりません。手全体を楽器に添え、キーやピストンは指なしで動きます",
    ),
    "character.no_hand": (
        "the {side} hand has no mesh and hangs down while the other hand plays",
        "{side}手にはメッシュがありません。下ろしたまま、もう一方の手で演奏します",
    ),
    "character.no_lips": (
        "the head has no mesh to find the mouth on; the instrument is held at the assumed lip position",
        "頭に口を検出できるメッシュがありません。想定される唇の位置に楽器を構えます",
    ),
    "character.lips_still": (
        "no morph opens the mouth: breaths are not visible and the lips stay closed",
        "口を開くモーフがありません。ブレスは口に表れず、唇は閉じたままです",
    ),
    "character.hold_failed": (
        ("{character} cannot hold {instrument} ({detail}); correct the instrument map, or choose another character"),
        (
            "{character} は {instrument} を持てません（{detail}）。インストゥルメントマップを修正するか、"
            "別のキャラクターを選んでください"
        ),
    ),
    "character.hold_waiting": (
        "the instrument hold is still being calculated; the player appears when it is finished",
        "楽器の持ち方を計算中です。終わり次第、奏者が表示されます",
    ),
    "character.touches_missed": (
        (
            "{count} {count:contact does|contacts do} not reach this instrument; the {touch} misses by {gap_mm} "
            "mm: the hands and the instrument do not match in size or shape"
        ),
        (
            "{count} か所の接触点がこの楽器に届きません（{touch}が {gap_mm} mm 外れます）。"
            "手と楽器の大きさや形が合っていません"
        ),
    ),
    # The motion: contacts
    "contact.hand_off": (
        (
            "the {side} hand is {gap_mm} mm off its position on the instrument; reduce the pose correction or "
            "gesture here, or choose a character of another size"
        ),
        (
            "{side}手が楽器上の位置から {gap_mm} mm 離れています。ここのポーズ修正やジェスチャーを弱めるか、"
            "体格の違うキャラクターを選んでください"
        ),
    ),
    "contact.stops_short": (
        (
            "{control} stops {gap_mm} mm short of its position because the {side} hand cannot reach further; "
            "reduce the pose correction or gesture here, or choose a character with longer arms"
        ),
        (
            "{side}手がこれ以上届かず、{control}が本来の位置の {gap_mm} mm 手前で止まります。"
            "ここのポーズ修正やジェスチャーを弱めるか、腕の長いキャラクターを選んでください"
        ),
    ),
    "contact.finger_off": (
        (
            "the {touch} misses {control} by {gap_mm} mm; reduce the pose correction here, or choose a character "
            "of another size"
        ),
        (
            "{touch}が{control}から {gap_mm} mm 外れています。ここのポーズ修正を弱めるか、"
            "体格の違うキャラクターを選んでください"
        ),
    ),
    "contact.grip_off": (
        (
            "the {touch} is {gap_mm} mm off the instrument; reduce the pose correction here, or choose a character "
            "of another size"
        ),
        (
            "{touch}が楽器から {gap_mm} mm 離れています。ここのポーズ修正を弱めるか、"
            "体格の違うキャラクターを選んでください"
        ),
    ),
    "contact.lips_off": (
        (
            "the lips are {gap_mm} mm off the mouthpiece while a note sounds; move or remove the gesture that "
            "lowers the instrument here"
        ),
        (
            "音が鳴っている間に唇がマウスピースから {gap_mm} mm 離れています。"
            "ここで楽器を下ろすジェスチャーを移動するか削除してください"
        ),
    ),
    "contact.foot_off": (
        "the {side} foot slides {gap_mm} mm on the floor; reduce sway, weight shift or the pose correction",
        "{side}足が床の位置から {gap_mm} mm ずれています。揺れ・重心移動・ポーズ修正のいずれかを弱めてください",
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
    "breath.inside_note": (
        "this manually placed breath is inside the sounding note {note}; move or remove it",
        "手動で置いたこのブレスは、鳴っている音符 {note} の途中にあります。移動するか削除してください",
    ),
    # The plan: cues, gestures, faces
    "cue.start": (
        "cue to start the piece ({leader_reason}); preparatory beat {beat_s:g} s",
        "曲を始める合図（{leader_reason}）。予備拍は {beat_s:g} 秒です",
    ),
    "cue.after_pause": (
        ("cue for all players after a general pause of {rest_s:g} s ({leader_reason}); preparatory beat {beat_s:g} s"),
        "{rest_s:g} 秒のゲネラルパウゼの後に全員を入れる合図（{leader_reason}）。予備拍は {beat_s:g} 秒です",
    ),
    "cue.after_fermata": (
        "cue to continue after a fermata ({leader_reason}); preparatory beat {beat_s:g} s",
        "フェルマータの後を続ける合図（{leader_reason}）。予備拍は {beat_s:g} 秒です",
    ),
    "cue.tempo": (
        "cue for the new tempo of {bpm:g} beats per minute ({leader_reason}); preparatory beat {beat_s:g} s",
        "毎分 {bpm:g} 拍の新しいテンポを示す合図（{leader_reason}）。予備拍は {beat_s:g} 秒です",
    ),
    "cue.section": (
        (
            "cue for {count} {count:player|players} after {rest_s:g} s of rest, while others play ({leader_reason})"
            "; preparatory beat {beat_s:g} s"
        ),
        (
            "ほかの奏者の演奏中、{rest_s:g} 秒休んだ奏者 {count} 人を入れる合図（{leader_reason}）。予備拍は "
            "{beat_s:g} 秒です"
        ),
    ),
    "cue.joins": (
        "entry cue after {rest_s:g} s of rest, while others play; preparatory beat {beat_s:g} s",
        "ほかの奏者の演奏中、{rest_s:g} 秒休んだ後に入る合図。予備拍は {beat_s:g} 秒です",
    ),
    "cue.after_rest": (
        "cue for all players after {rest_s:g} s of common rest ({leader_reason}); preparatory beat {beat_s:g} s",
        "{rest_s:g} 秒の全休の後に全員を入れる合図（{leader_reason}）。予備拍は {beat_s:g} 秒です",
    ),
    "gesture.sway": ("half a swing in {beats:g} beats of {beat_s:g} s", "{beat_s:g} 秒の拍 {beats:g} つで半往復の揺れ"),
    "gesture.still": ("the body keeps still", "体は動かしません"),
    "gesture.lean": (
        "lean towards the climax of a phrase of {length_s:g} s",
        "{length_s:g} 秒のフレーズの頂点へ向かう前後の傾き",
    ),
    "gesture.lean_back": ("back at the end of the phrase", "フレーズの終わりに元の姿勢へ"),
    "gesture.accent": ("a strong note", "強拍や長い音などの強い音"),
    "gesture.accent_loud": ("a note louder than those around it", "前後より大きい音"),
    "gesture.step": (
        "a small step with the {side} foot between phrases, and back after a later one",
        "フレーズの間に{side}足で小さく踏み出し、後のフレーズの終わりに戻します",
    ),
    "gesture.tap": ("the {side} foot taps with the beat", "{side}足のつま先で拍を取ります"),
    "gesture.heel": (
        "the weight is on the other foot: the {side} heel comes up",
        "体重が反対の足に乗り、{side}足のかかとが上がります",
    ),
    "gesture.weight_shift": ("weight shift to the {side} foot", "{side}足への重心移動"),
    "gesture.bell_height": (
        "the melody is around {pitch}; the mean of the part is {mean_pitch}",
        "旋律は {pitch} のあたり。パートの平均は {mean_pitch}",
    ),
    "gesture.bell_accent": (
        "accent, {more:g} louder than the notes around it",
        "アクセント: 前後の音より {more:g} 大きい音",
    ),
    "rule.applied": ("rule {rule}", "ルール {rule}"),
    "rule.unknown_expression": (
        "the rule {rule} shows the expression {name!r}, which does not exist; choose one of: {known}",
        "ルール {rule} の表情 {name!r} がありません。使えるもの: {known}",
    ),
    "rule.unknown_gesture": (
        "the rule {rule} makes the gesture {name!r}, which does not exist; choose one of: {known}",
        "ルール {rule} のジェスチャー {name!r} がありません。使えるもの: {known}",
    ),
    "rule.unknown_style": (
        "the rule {rule} is for the style {name!r}, which does not exist; choose of: {known}",
        "ルール {rule} の演奏スタイル {name!r} がありません。使えるもの: {known}",
    ),
    "rule.unknown_habit": (
        "the rule {rule} is for the habit {name!r}, which does not exist; choose of: {known}",
        "ルール {rule} の癖 {name!r} がありません。使えるもの: {known}",
    ),
    "gesture.unknown": (
        "the gesture {name!r} does not exist and does nothing; choose one of: {known}",
        "ジェスチャー {name!r} がないため、何も行いません。使えるもの: {known}",
    ),
    "gesture.not_here": (
        "the gesture {name!r} is meant for where its table says may_start = {start!r}; move it there",
        "ジェスチャー {name!r} は、表の may_start = {start!r} の場所で行うものです。移動してください",
    ),
    "stage.conductor": ("Conductor", "指揮者"),
    "gesture.hand_holds": (
        "the gesture {name!r} would take a hand that this instrument needs; no hand leaves it",
        "ジェスチャー {name!r} の手は、この楽器を持つのに必要です。手は楽器を離れません",
    ),
    "gesture.no_water_key": (
        "the gesture {name!r} presses a water key, and the instrument has none; no hand leaves it",
        "ジェスチャー {name!r} は水抜きのキーを押しますが、この楽器にはありません。手は楽器を離れません",
    ),
    "gesture.hand_busy": (
        "the gesture {name!r} begins before the hand is back from another; move it",
        "ジェスチャー {name!r} は、手がほかの動作から戻る前に始まります。移動してください",
    ),
    "gesture.lower_instrument": (
        "{rest_s:g} s of rest: the instrument is lowered and raised again before the entry",
        "{rest_s:g} 秒の休み: 楽器を下ろし、入りの前に構え直します",
    ),
    "gesture.come_up": (
        "{rest_s:g} s before the first note: the instrument comes up from rest",
        "最初の音の {rest_s:g} 秒前: 楽器を下ろした状態から構えます",
    ),
    "gesture.nod": (
        "nods with the cue to this entry, {after_ms:g} ms after it",
        "この入りの合図より {after_ms:g} ミリ秒後に、一緒にうなずきます",
    ),
    "gesture.count": (
        "{rest_s:g} s of rest: the last {beats:g} beats are counted",
        "{rest_s:g} 秒の休み: 最後の {beats:g} 拍を数えます",
    ),
    "gesture.look_about": ("{rest_s:g} s of rest: time to look about", "{rest_s:g} 秒の休み: 周りを見ます"),
    "gesture.settle_grip": (
        "{rest_s:g} s of rest: the hands settle on the instrument",
        "{rest_s:g} 秒の休み: 楽器を持ち直します",
    ),
    "gesture.hold_still": (
        "the end of the last note: nothing moves until the instrument comes down",
        "最後の音の終わり: 楽器を下ろすまで動きません",
    ),
    "gesture.look_up": (
        "{after_s:g} s after the last note of all: up to the audience",
        "全員の最後の音から {after_s:g} 秒後に客席を見ます",
    ),
    "gesture.bow": (
        "{after_s:g} s after the last note of all: the bow",
        "全員の最後の音から {after_s:g} 秒後にお辞儀をします",
    ),
    "gesture.lower_at_end": (
        "the instrument is lowered {after_s:g} s after the last note",
        "最後の音から {after_s:g} 秒後に楽器を下ろします",
    ),
    "gesture.lower_at_start": (
        "{rest_s:g} s before the entry: the instrument is still lowered",
        "入りまで {rest_s:g} 秒あるため、楽器はまだ下ろしています",
    ),
    "embouchure.register": (
        "{pitch} in a range of {low} to {high}, loudness {loudness:g}",
        "音域 {low}～{high} の中の {pitch}、音量 {loudness:g}",
    ),
    "embouchure.controller": (
        "{pitch} in a range of {low} to {high}; from the recorded breath: average loudness {loudness:g}",
        "音域 {low}～{high} の中の {pitch}、録音したブレスから: 平均音量 {loudness:g}",
    ),
    "fingering.stopped": (
        "stopped by the hand: fingered {label}, as the note a semitone lower",
        "ゲシュトップ: 半音低い音の運指 {label}",
    ),
    "mute.mute": ("with a mute in the bell", "ミュートを装着"),
    "mute.no_hand": (
        "stopped, which is played with a mute on this instrument",
        "ゲシュトップの指示（この楽器ではミュートを使用）",
    ),
    "mute.stopped_right": ("stopped: the right hand closes the bell", "ゲシュトップ: 右手でベルを閉じる"),
    "mute.stopped_left": ("stopped: the left hand closes the bell", "ゲシュトップ: 左手でベルを閉じる"),
    "tongue.attack": ("tongued", "タンギング"),
    "tongue.staccato": (
        "staccato: short for the time to the next note",
        "スタッカート: 次の音までの長さに対して短い音",
    ),
    "tongue.accent": ("accent: louder than the notes around it", "アクセント: 前後の音より強い音"),
    "tongue.marcato": (
        "marcato: louder than the notes around it and shorter than its full length",
        "マルカート: 前後の音より強く、音価より短い音",
    ),
    "tongue.tenuto": (
        "tenuto: held for its full length, tongued softly",
        "テヌート: 音価いっぱいに保ち、柔らかく舌を突く音",
    ),
    "tongue.written_staccato": ("staccato in the score", "楽譜のスタッカート"),
    "tongue.written_staccatissimo": ("staccatissimo in the score", "楽譜のスタッカーティッシモ"),
    "tongue.written_tenuto": ("tenuto in the score", "楽譜のテヌート"),
    "tongue.written_accent": ("accent in the score", "楽譜のアクセント"),
    "tongue.written_marcato": ("marcato in the score", "楽譜のマルカート"),
    "tongue.written_double_tongue": ("double tonguing in the score", "楽譜のダブルタンギング"),
    "tongue.written_triple_tongue": ("triple tonguing in the score", "楽譜のトリプルタンギング"),
    "tongue.written_flutter_tongue": ("flutter tonguing in the score", "楽譜のフラッタータンギング"),
    "tongue.slide": (
        "tongued softly, so that the slide's way is not heard",
        "スライドの移動音を隠す柔らかいタンギング",
    ),
    "tongue.double": (
        "double tonguing: {rate:g} notes per second, more than {limit:g} by single strokes",
        "ダブルタンギング: 毎秒 {rate:g} 音（シングルの限界 {limit:g} 音を超過）",
    ),
    "tongue.triple": (
        "triple tonguing: triplets at {rate:g} notes per second, more than {limit:g} by single strokes",
        "トリプルタンギング: 三連符、毎秒 {rate:g} 音（シングルの限界 {limit:g} 音を超過）",
    ),
    "expression.default": ("neutral face", "力を抜いた顔"),
    "expression.effort": (
        "effort {effort:g} (threshold {threshold:g}): high, loud or long",
        "力の入り具合 {effort:g}（{threshold:g} 以上）: 高い・強い・長い音",
    ),
    "expression.low_loud": (
        "{pitch} is below {easy_low} and loud ({loudness:g})",
        "{pitch} は {easy_low} より低く、強い音です（{loudness:g}）",
    ),
    "expression.gives_entry": ("gives a cue", "合図を出す"),
    "expression.takes_entry": ("enters after {rest_s:g} s of rest", "{rest_s:g} 秒の休みの後に入る"),
    "expression.end": (
        "after the last note: a bright ending (major, {bpm:g} beats per minute, not soft)",
        "最後の音の後: 明るい終わり（長調、毎分 {bpm:g} 拍、弱くない）",
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
