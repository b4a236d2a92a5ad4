"""Choreographies: learning them from motion and music, dancing them, and their files."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "generate.no_source": (
        "the choreography has no source {source}; use --prefer with one of {sources}",
        "振り付けにソース {source} はありません。--prefer には次のいずれかを指定してください: {sources}",
    ),
    "choreography.damaged": (
        (
            "{file} is not a choreography file or is damaged ({place}: {detail}); copy it again from an intact "
            "source, or learn it again with 'suisou choreography learn'"
        ),
        (
            "{file} は振り付けのファイルではないか、壊れています（{place}: {detail}）。"
            "壊れていない元のファイルをコピーし直すか、'suisou choreography learn' で学習し直してください"
        ),
    ),
    "choreography.newer": (
        (
            "{file} was saved by a newer version of Suisou (file version {version}; this version reads up to "
            "{known}); use the newer version"
        ),
        (
            "{file} は新しいバージョンの Suisou で保存されています（ファイルのバージョン {version}、対応は {known} "
            "まで）。新しいバージョンを使ってください"
        ),
    ),
    "cuts.line": (
        "{file}, line {line}: {text!r} is not a time; write one time in seconds per line",
        "{file}、{line} 行目: {text!r} は時刻ではありません。1 行に 1 つ、秒で時刻を書いてください",
    ),
    "cuts.order": (
        "{file}, line {line}: a motion needs a start time and a later end time; put the times in order",
        "{file}、{line} 行目: 動きには開始時刻と、それより後の終了時刻が必要です。時刻を順に並べてください",
    ),
    "cuts.wrong": (
        (
            "{motion} cannot be cut into a motion from frame {start} to {end} with its accent at {accent}: put the "
            "cuts in order, with accents between them, within the {frames} frames of the motion"
        ),
        (
            "{motion} は、フレーム {start} から {end}、アクセント {accent} の動きに区切れません。区切りを順に並べ、"
            "アクセントをその間に置き、モーションの {frames} フレームに収めてください"
        ),
    ),
    "dance.no_percussion": (
        "the piece has no percussion; dancers follow its melody, bass and accents",
        "曲に打楽器がないため、ダンサーは旋律、低音、アクセントに合わせます",
    ),
    "dance.state_not_held": (
        (
            "the pinned basic motion {number} cannot be used here: the choreography does not contain it, or "
            "another correction is too close; unpin it or pin another one"
        ),
        (
            "固定された基本動作 {number} をここでは使えません。振り付けに含まれていないか、"
            "別の手動修正が近すぎます。固定を解除するか、別の基本動作を固定してください"
        ),
    ),
    "dance.segment_not_held": (
        (
            "the selected segment {number} cannot be used here: the choreography does not contain it, or another "
            "correction is too close; unpin it or select another one"
        ),
        (
            "選択されたセグメント {number} をここでは使えません。振り付けに含まれていないか、"
            "別の手動修正が近すぎます。固定を解除するか、別のセグメントを選んでください"
        ),
    ),
    "dance.state_not_avoided": (
        (
            "the disabled basic motion {number} is used here because nothing else fits; disable fewer basic "
            "motions, or a shorter span"
        ),
        (
            "禁止された基本動作 {number} が、ほかに合う動作がないため、ここで使われています。"
            "禁止する基本動作を減らすか、区間を短くしてください"
        ),
    ),
    "dance.seam_shows": (
        "the change from basic motion {before} to {after} is visible; pin another motion here, or move this one",
        (
            "基本動作 {before} から {after} への切り替わりが目立ちます。ここに別の動作を固定するか、"
            "この動作を移動してください"
        ),
    ),
    "dance.foot_slides": (
        "the {side} foot slides while it is on the floor; pin another motion here, or move this one",
        "{side}足が接地中に床の上を滑ります。ここに別の動作を固定するか、この動作を移動してください",
    ),
    "learn.no_motion": (
        (
            "no motion to learn from was found in {motions}: the body does not move, or the clips are too short; "
            "add other motion files"
        ),
        (
            "{motions} には学習できる動きがありません。体が静止しているか、クリップが短すぎます。"
            "別のモーションファイルを追加してください"
        ),
    ),
    "learn.states": (
        "{states} basic motions cannot be learned from {segments} motions; use a smaller number",
        "{segments} 個の動きから {states} 個の基本動作は学習できません。数を小さくしてください",
    ),
    "learn.no_overlap": (
        ("no percussion of {music} sounds during {motion}; correct the offset of this pair, or set it to automatic"),
        "{motion} の動きの間に {music} の打楽器が鳴りません。この組のオフセットを修正するか、自動にしてください",
    ),
    "learn.done": (
        (
            "{file}: {states} basic {states:motion|motions} from {segments} {segments:segment|segments}, "
            "{length_s:.1f} s ({frames} {frames:frame|frames})"
        ),
        "{file}: 基本動作 {states} 個、セグメント {segments} 個、{length_s:.1f} 秒（{frames} フレーム）",
    ),
    "learn.no_percussion": (
        (
            "{file} has no percussion to learn from (a drum kit on channel 10, or as GS, XG or GM2 set it); pair the "
            "motion with a file that has a drum part"
        ),
        (
            "{file} には学習に使う打楽器（チャンネル 10、または GS・XG・GM2 のリズムパート）がありません。"
            "ドラムパートのあるファイルと組み合わせてください"
        ),
    ),
    "motion.apart": (
        "arms deviate by up to {apart_mm} mm from the file because its collar bones move",
        "鎖骨が動くため、腕の位置がファイルから最大 {apart_mm} mm ずれます",
    ),
    "motion.doubtful": ("guessed joints: {joints}", "推測した関節: {joints}"),
    "motion.flips": ("{n} {n:flip|flips} of the capture corrected", "キャプチャの反転を {n} か所修正しました"),
    "motion.lead_in": (
        "{n} {n:frame|frames} of rest pose at the start skipped",
        "先頭のレストポーズ {n} フレームを除外しました",
    ),
    "motion.no_unit": (
        "unknown unit; the body was scaled to a height of 1.7 m",
        "単位が不明のため、身長を 1.7 m にしました",
    ),
    "dance.too_long": (
        "the piece lasts {minutes} minutes; dances can be generated for pieces of up to {most} minutes",
        "曲の長さが {minutes} 分あります。ダンスを生成できるのは {most} 分までの曲です",
    ),
    "motion.milliseconds": (
        "{rate} frames/s (the frame time {said:g} was read as milliseconds)",
        "{rate} フレーム/秒（フレーム時間 {said:g} はミリ秒とみなしました）",
    ),
    "motion.rate_as_time": (
        "{rate} frames/s (the frame time {said:g} was read as a frame rate)",
        "{rate} フレーム/秒（フレーム時間 {said:g} はフレームレートとみなしました）",
    ),
    "motion.rows": (
        "{found} {found:frame|frames} (the file states {frames})",
        "{found} フレーム（ファイルの値は {frames}）",
    ),
    "motion.row_cut": (
        "{found} {found:frame|frames} of {frames}; the last row is incomplete, so the file may have been cut off",
        "{frames} フレーム中 {found} フレーム。最後の行が不完全です（ファイルが途中で切れている可能性があります）",
    ),
    "motion.figures": (
        "several figures; only {name} was read (also in the file: {others})",
        "複数の人物のうち {name} だけを読み込みました（ほかに {others}）",
    ),
    "motion.place_unit": (
        "the positions of the hips were read as {unit}, the bones as {bones}",
        "腰の位置の単位を {unit}、ボーンの単位を {bones} とみなしました",
    ),
    "motion.rate": ("{rate} frames/s (the file states {said})", "{rate} フレーム/秒（ファイルの値は {said}）"),
}
