"""Cues, gestures and faces: why they are there."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
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
    "mute.straight": ("with a straight mute", "ストレートミュートを装着"),
    "mute.cup": ("with a cup mute", "カップミュートを装着"),
    "mute.harmon": ("with a Harmon mute", "ハーマンミュートを装着"),
    "mute.plunger": ("with a plunger mute", "プランジャーミュートを使用"),
    "mute.bucket": ("with a bucket mute", "バケットミュートを装着"),
    "mute.hat": ("with a hat mute", "ハットミュートを使用"),
    "mute.practice": ("with a practice mute", "プラクティスミュートを装着"),
    "mute.solotone": ("with a solotone mute", "ソロトーンミュートを装着"),
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
    "tongue.by_hand": ("{mark} by hand", "手動で記入した{mark}"),
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
}
