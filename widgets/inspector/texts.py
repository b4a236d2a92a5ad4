"""Texts of inspector: id -> English and Japanese."""

from __future__ import annotations

from typing import Final

TEXTS: Final[dict[str, tuple[str, str]]] = {
    "by_hand_line.added_by_hand": ("added manually", "手動で追加"),
    "by_hand_line.back_to_generators": ("Revert to generated", "自動生成に戻す"),
    "by_hand_line.generated_yours": (
        "generated {generated} · edited {yours}",
        "自動生成 {generated} → 手動修正 {yours}",
    ),
    "by_hand_line.yours": ("edited {yours}", "手動修正 {yours}"),
    "correction_list.added_by_hand": ("added manually: {yours}", "手動で追加: {yours}"),
    "correction_list.added_by_hand_2": ("added manually", "手動で追加"),
    "correction_list.back_to_generators_everything_of": (
        "Revert all corrections of the selected players to generated",
        "選択した奏者の手動修正をすべて自動生成に戻す",
    ),
    "correction_list.back_to_generators_selected_lines": (
        "Revert the selected corrections to generated",
        "選択した手動修正を自動生成に戻す",
    ),
    "correction_list.generated": ("generated {before} ({reason})", "自動生成 {before}（{reason}）"),
    "correction_list.let_selected_line_be_about": (
        "Attach the selected correction to the selected note",
        "選択した手動修正を、選択した音符に付け直す",
    ),
    "correction_list.lost_its_place_it_does": (
        "No matching note; inactive. Select a note and re-attach the correction, or revert it.",
        "対応する音符がなく、無効です。音符を選んで付け直すか、元に戻してください。",
    ),
    "correction_list.nothing_was_changed_by_hand": (
        (
            "The selected players have no manual corrections. Pinned fingerings, moved breaths and other edits are "
            "listed here and are kept when you regenerate."
        ),
        (
            "選択した奏者に手動修正はありません。運指の固定やブレスの移動などの修正がここに表示され、"
            "再生成しても残ります。"
        ),
    ),
    "correction_list.re_attach_to_selected_note": ("Re-attach to Selected Note", "選択した音符に付け直す"),
    "correction_list.revert": ("Revert", "元に戻す"),
    "correction_list.revert_all": ("Revert All", "すべて元に戻す"),
    "correction_list.curve_off": ("{detail} (disabled)", "{detail}（無効）"),
    "correction_list.curve_up_to": ("up to {end}, keys: {count}", "{end} まで、キー {count} 個"),
    "correction_list.with_other_chances_up_to": ("regenerated up to {end}", "{end} まで再生成"),
    "correction_list.mark_instead": ("edited {yours} · in the score {before}", "手動修正 {yours} · 楽譜では {before}"),
    "correction_list.mark_of_score_removed": ("in the score, not played", "楽譜にあるが、演奏しない"),
    "correction_list.yours": ("edited {now} · {generated}", "手動修正 {now} · {generated}"),
    "event_section.amount": ("Amount", "量"),
    "event_section.bar_beat_ticks": ("Bar.beat.ticks", "小節.拍.ティック"),
    "event_section.beats": ("beats", "拍"),
    "event_section.depth": ("Depth", "深さ"),
    "event_section.end": ("End", "終了"),
    "event_section.end_in_seconds_of_performance": ("End in performance time (s)", "演奏時間での終了（秒）"),
    "event_section.entry": ("Entry", "入り"),
    "event_section.face_that_is_shown": ("Expression to show", "表示する表情"),
    "event_section.fade_in": ("Fade in", "フェードイン"),
    "event_section.fade_out": ("Fade out", "フェードアウト"),
    "event_section.generator": ("Generated: {reason}", "自動生成: {reason}"),
    "event_section.how_long_before_entry_cues": ("Time from the cue's beat to the entry", "合図の拍から入りまでの時間"),
    "event_section.how_long_it_takes_to": ("Fade-in time", "フェードインの時間"),
    "event_section.how_long_it_takes_to_go": ("Fade-out time", "フェードアウトの時間"),
    "event_section.leaning_to_players_left": ("Lean to the player's left", "奏者の左へ傾ける"),
    "event_section.left": ("Left", "左"),
    "event_section.preparatory_beat": ("Preparatory beat", "予備拍"),
    "event_section.preparatory_beat_lasts_s": ("preparatory beat: {seconds} s", "予備拍: {seconds} 秒"),
    "event_section.raised_leaning_back_or_elbow": (
        "Raise, lean back, or move the elbow outwards",
        "上げる・反る・ひじを外へ出す",
    ),
    "event_section.roll": ("Roll", "ロール"),
    "event_section.s_long": ("duration {seconds} s", "長さ {seconds} 秒"),
    "event_section.seconds": ("s", "秒"),
    "event_section.start": ("Start", "開始"),
    "event_section.start_in_seconds_of_performance": ("Start in performance time (s)", "演奏時間での開始（秒）"),
    "event_section.strength": ("Strength", "強さ"),
    "event_section.text": ("{count} × {what}", "{what} × {count}"),
    "event_section.turned_to_players_left": ("Turn to the player's left", "奏者の左へ回す"),
    "event_section.up": ("Up", "上"),
    "event_section.why": ("Reason: {reason}", "理由: {reason}"),
    "expression_maker.brows": ("Brows", "眉"),
    "expression_maker.cheeks_nose_tongue": ("Cheeks, nose, tongue", "頬・鼻・舌"),
    "expression_maker.comes_from_your_folder_use": (
        "Expression from your folder. Add it to this project to edit it.",
        "自分のフォルダーの表情です。編集するには、このプロジェクトに追加してください。",
    ),
    "expression_maker.comes_with_program_duplicate_it": (
        "Bundled expression. Duplicate it to edit a copy.",
        "付属の表情です。編集するには複製してください。",
    ),
    "expression_maker.delete_it_from_your_folder": ("Delete from the user folder", "ユーザーフォルダーから削除"),
    "expression_maker.expressions": ("Expression editor", "表情の編集"),
    "expression_maker.eyes": ("Eyes", "目"),
    "expression_maker.fade_in": ("Fade in", "フェードイン"),
    "expression_maker.fade_out": ("Fade out", "フェードアウト"),
    "expression_maker.jaw": ("Jaw", "顎"),
    "expression_maker.keep_it_for_other_projects": ("Save for other projects", "ほかのプロジェクト用に保存"),
    "expression_maker.kept": ("{name} (saved)", "{name}（保存済み）"),
    "expression_maker.make_one_of_your_own": ("Duplicate as a new expression", "複製して新しい表情を作成"),
    "expression_maker.may_show_while_playing": ("Show while playing", "演奏中も表示"),
    "expression_maker.mouth": ("Mouth", "口"),
    "expression_maker.move_both_sides_of_face": ("Move both sides of the face together", "顔の左右を連動"),
    "expression_maker.name": ("Name", "名前"),
    "expression_maker.remove_it_from_project": ("Remove from project", "プロジェクトから削除"),
    "expression_maker.seconds": ("s", "秒"),
    "expression_maker.show_it_on_player_in": ("Preview on active player", "アクティブな奏者でプレビュー"),
    "expression_maker.what_moves_lips_must_not": (
        ("Expressions that move the lips cannot be shown while playing, because the embouchure controls the lips."),
        "演奏中の唇はアンブシュアが制御するため、唇を動かす表情は演奏中に表示できません。",
    ),
    "history_list.as_opened": ("Opened", "開いた時点"),
    "inspector.air": ("air", "息の量"),
    "inspector.effort": ("effort", "力の入り具合"),
    "inspector.entry_beat_s": ("entry {place}, beat {seconds} s", "入り {place}、予備拍 {seconds} 秒"),
    "inspector.expression": ("Expression: {name}", "表情: {name}"),
    "inspector.fingering": ("Fingering {name}", "運指 {name}"),
    "inspector.additive_curve": ("Curve: {name}", "カーブ: {name}"),
    "inspector.style": ("Style: {name}", "演奏スタイル: {name}"),
    "inspector.pose": ("Pose: {name}", "ポーズ: {name}"),
    "inspector.mark_until": ("to {end}", "{end} まで"),
    "inspector.removed": ("{name} removed", "{name}を削除"),
    "inspector.tension": ("tension", "唇の緊張"),
    "inspector_panel.by_hand": ("Corrections ({count})", "手動修正（{count}）"),
    "inspector_panel.by_hand_2": ("Corrections", "手動修正"),
    "inspector_panel.click_note_in_timeline_to": (
        (
            "Click a note in the timeline to view and change its fingering, or click a breath, cue, gesture or "
            "expression to see the reason for it."
        ),
        (
            "タイムラインの音符をクリックすると、運指を確認・変更できます。ブレス、合図、ジェスチャー、"
            "表情をクリックすると、その理由を確認できます。"
        ),
    ),
    "inspector_panel.history": ("History", "履歴"),
    "inspector_panel.problems": ("Problems ({count})", "問題（{count}）"),
    "inspector_panel.problems_2": ("Problems", "問題"),
    "inspector_panel.these_bars_are_performed_anew": (
        (
            "These bars were regenerated. Select bars and press Ctrl+G to regenerate again; press Backspace to "
            "restore the first performance."
        ),
        (
            "この小節は別パターンで再生成されています。小節を選択して Ctrl+G で再生成し、Backspace "
            "で最初の演奏に戻します。"
        ),
    ),
    "note_marks.add_mark": ("Add Mark", "記号を追加"),
    "note_marks.origin.hand": ("Written by hand; click to change", "手動で記入。クリックで変更"),
    "note_marks.origin.score": ("In the score; click to change", "楽譜にある記号。クリックで変更"),
    "note_marks.marks": ("Marks", "記号"),
    "note_marks.none": ("none", "なし"),
    "note_marks.slurred_to": ("slurred to the note before", "前の音からスラーで続く"),
    "note_marks.tongue": ("Tongue: {reason}", "タンギング: {reason}"),
    "note_section.air": ("Air", "息の量"),
    "note_section.bar": ("Bar", "小節"),
    "note_section.bar_beat_ticks_several_notes": (
        "Bar.beat.ticks. Multiple notes move together.",
        "小節.拍.ティック。複数の音符は一緒に動きます。",
    ),
    "note_section.beats": ("beats", "拍"),
    "note_section.cents_when_simply_blown": ("{cents} cents without correction", "補正なしで {cents} セント"),
    "note_section.choice_no": ("choice {rank}", "第 {rank} 候補"),
    "note_section.effort": ("Effort", "力の入り具合"),
    "note_section.embouchure": ("Embouchure", "アンブシュア"),
    "note_section.fingering": ("Fingering", "運指"),
    "note_section.fingering_diagram": ("Fingering diagram", "運指図"),
    "note_section.first_choice": ("usual fingering", "標準の運指"),
    "note_section.generator": ("Generated: {reason}", "自動生成: {reason}"),
    "note_section.how_hard_note_is_struck": ("MIDI velocity, 1 to 127", "MIDI ベロシティ、1～127"),
    "note_section.how_much_air_flows": ("Air flow", "息の量"),
    "note_section.how_much_face_works_height": (
        "Facial effort, from pitch, loudness and length",
        "顔の力の入り具合（音高・音量・長さから）",
    ),
    "note_section.in_beats_of_metre": ("In beats of the time signature", "拍子の拍を単位とします"),
    "note_section.length": ("Length", "長さ"),
    "note_section.lips_0_relaxed_for_low": (
        "Lips: 0 relaxed for the low register, 1 fully tensed",
        "唇: 0 で低音域の緩んだ状態、1 で最大の緊張",
    ),
    "note_section.name_or_midi_number_several": (
        "Name or MIDI number. Multiple notes move together.",
        "音名または MIDI 番号。複数の音符は一緒に動きます。",
    ),
    "note_section.note": ("Note", "音符"),
    "note_section.notes": ("{count} notes", "音符: {count} 個"),
    "note_section.pitch": ("Pitch", "音高"),
    "note_section.tension": ("Lip tension", "唇の緊張"),
    "note_section.velocity": ("Velocity", "ベロシティ"),
    "note_section.what_generator_chose": ("generated choice", "自動生成の選択"),
    "note_section.why": ("Reason: {reason}", "理由: {reason}"),
    "problem_list.all_kinds": ("All kinds", "すべての種類"),
    "problem_list.all_players": ("All players", "全奏者"),
    "problem_list.and_more_choose_players_or": (
        "And {count} more. Filter by player or kind above.",
        "ほかに {count} 件あります。上で奏者か種類を絞り込んでください。",
    ),
    "problem_list.breaths": ("Breaths", "ブレス"),
    "problem_list.contacts": ("Contacts", "接触"),
    "problem_list.corrections": ("Corrections", "手動修正"),
    "problem_list.dances": ("Dances", "ダンス"),
    "problem_list.count_again": ("Stop Ignoring", "無視を解除"),
    "problem_list.fix_all_players": ("{fix} (All Players)", "{fix}（全奏者）"),
    "problem_list.fix_by_octaves": (
        "Move {count} {count:Note|Notes} into Range by Octaves",
        "{count} 音を音域内へオクターブ移動",
    ),
    "problem_list.fix_erase": ("Delete {count} Lower {count:Note|Notes}", "下の音符を削除（{count} 個）"),
    "problem_list.fix_from_written": ("Import Part as Written Pitch", "パートを記譜音として読み込む"),
    "problem_list.fix_revert": (
        "Revert {count} Inactive {count:Correction|Corrections}",
        "無効な手動修正を元に戻す（{count} 件）",
    ),
    "problem_list.fix_shorten": (
        "Shorten {count} Overlapping {count:Note|Notes}",
        "重なる音符を短くする（{count} 個）",
    ),
    "problem_list.fix_needs_a_row": (
        "Select a row of the list to fix its problems",
        "一覧の行を 1 つ選ぶと、その問題を解決できます",
    ),
    "problem_list.fix_waits": (
        "Available as soon as the performance is up to date",
        "演奏の更新が終わると使えます",
    ),
    "problem_list.has_no_fix": (
        "No automatic fix for this kind of problem. Correct it in the timeline, or ignore it.",
        "この種類の問題は自動では解決できません。タイムラインで修正するか、無視してください。",
    ),
    "problem_list.fix": ("Fix", "解決"),
    "problem_list.go_to": ("Go to Problem", "問題の場所へ移動"),
    "problem_list.ignore": ("Ignore", "無視"),
    "problem_list.ignore_selected": (
        "Ignore the problems of the selected row; the project keeps this",
        "選択した行の問題を無視します（プロジェクトに保存されます）",
    ),
    "problem_list.mend_selected": (
        "Fix every problem of the selected row at once",
        "選択した行の問題をまとめて解決します",
    ),
    "problem_list.show_ignored": ("Ignored ({count})", "無視中（{count}）"),
    "problem_list.show_what_is_ignored": ("Show ignored problems as well", "無視した問題も表示"),
    "problem_list.fingerings": ("Fingerings", "運指"),
    "problem_list.instruments_and_characters": ("Instruments and characters", "楽器とキャラクター"),
    "problem_list.no_problems_everything_can_be": ("No problems found.", "問題は見つかりませんでした。"),
    "problem_list.none_of_these_choose_other": (
        "No problems match the filter. Select other players or kinds above.",
        "該当する問題はありません。上で別の奏者や種類を選んでください。",
    ),
    "problem_list.notes": ("Notes", "音符"),
    "problem_list.problems_of_which_kind": ("Filter by kind", "種類で絞り込み"),
    "problem_list.selected_players": ("Selected players", "選択した奏者"),
    "problem_list.whose_problems": ("Filter by player", "奏者で絞り込み"),
    "take_section.and_softer_than": ("Ghost notes softer than", "ゴーストノートの強さの上限"),
    "take_section.as_usual": ("Reset to Default", "標準に戻す"),
    "take_section.between_what_is_left": (", ", "、"),
    "take_section.clean_this_take_as_every": (
        "Reset the cleaning settings of this take to their defaults",
        "このテイクのクリーニング設定を標準に戻す",
    ),
    "take_section.cleaning": ("Cleaning", "クリーニング"),
    "take_section.colour_of_take": ("Take colour", "テイクの色"),
    "take_section.doubled_notes_within": ("Merge repeated notes within", "二度打ちとみなす間隔"),
    "take_section.draw_to_score": ("Align to score", "楽譜に合わせる"),
    "take_section.find_beats": ("Detect Beats", "拍を検出"),
    "take_section.for_take_without_click_piece": (
        (
            "For a take recorded without a click: sets the tempo of the piece from the take. No other part may "
            "contain notes."
        ),
        (
            "クリックなしで録音したテイク用です。テイクのテンポを曲のテンポにします。"
            "ほかのパートに音符がないときだけ使えます。"
        ),
    ),
    "take_section.ghost_notes": ("ghost notes: {count}", "ゴーストノート: {count}"),
    "take_section.ghost_notes_shorter_than": ("Ghost notes shorter than", "ゴーストノートの長さの上限"),
    "take_section.grid_of_quantising": ("Quantise grid", "クオンタイズのグリッド"),
    "take_section.how_far_notes_are_drawn": ("Strength of quantising to the grid", "グリッドに寄せる強さ"),
    "take_section.how_far_notes_are_drawn_to_those_of": (
        "Strength of aligning to the matching notes (pitch and time) of the pre-take part",
        "テイク前のパートの対応する音符（音高と時間）に寄せる強さ",
    ),
    "take_section.late_fingers": ("late fingers: {count}", "指の遅れ: {count}"),
    "take_section.legato_overlap_at_most": ("Maximum legato overlap", "レガートの重なりの上限"),
    "take_section.milliseconds": ("ms", "ms"),
    "take_section.name_of_take": ("Take name", "テイクの名前"),
    "take_section.note_that_sounds_longer_into": (
        "Longer overlaps into the next note are trimmed",
        "これより長い次の音との重なりは切り詰めます",
    ),
    "take_section.notes_left_out": ("Notes: {count}. Excluded: {faults}.", "音符: {count} 個。除外: {faults}。"),
    "take_section.notes_nothing_is_left_out": ("Notes: {count}. None excluded.", "音符: {count} 個。除外なし。"),
    "take_section.quantise": ("Quantise", "クオンタイズ"),
    "take_section.quarters": ("{count} quarter notes", "四分音符 {count} 個分"),
    "take_section.s_events": ("{seconds:.1f} s, {count:,} events", "{seconds:.1f} 秒、イベント {count:,} 個"),
    "take_section.same_note_struck_again_within": (
        "A note repeated within this time is merged into one. 0: never.",
        "この時間内に繰り返された同じ音は 1 つにまとめます。0: まとめません。",
    ),
    "take_section.soft_breath_stays_below_this": (
        "A note is soft if its breath, or its velocity without breath data, stays below this value.",
        "ブレス（データがなければベロシティ）がこの値に届かない音を弱い音とします。",
    ),
    "take_section.soft_notes_shorter_than_this": (
        "Excludes soft notes shorter than this, and short notes between two legato notes. 0: none.",
        "これより短い弱い音と、レガートの 2 音に挟まれた短い音を除外します。0: 除外しません。",
    ),
    "take_section.struck_twice": ("double-triggered: {count}", "二度打ち: {count}"),
    "take_section.take": ("Take", "テイク"),
    "take_section.inaudible": ("inaudible: {count}", "聞こえない音: {count}"),
}
