"""Texts of timeline: id -> English and Japanese."""

from __future__ import annotations

from typing import Final

TEXTS: Final[dict[str, tuple[str, str]]] = {
    "acting_lane.acting": ("Acting", "演技"),
    "acting_lane.add_cue_here": ("Add cue here", "ここに合図を追加"),
    "acting_lane.add_expression_here": ("Add expression here", "ここに表情を追加"),
    "acting_lane.add_gesture_here": ("Add gesture here", "ここにジェスチャーを追加"),
    "acting_lane.anew": ("Regenerated", "再生成"),
    "acting_lane.another_expression": ("Change expression", "別の表情に変更"),
    "acting_lane.drag_to_move_up_and": (
        ("Drag to move, drag up or down for strength, an edge to resize, a corner for a fade. Double-click to add."),
        "ドラッグで移動、上下で強さ、端で長さ、角でフェードを変更します。ダブルクリックで追加します。",
    ),
    "acting_lane.beside": ("Beside playing", "演奏以外"),
    "acting_lane.given_by": ("Given by", "合図を出す人"),
    "acting_lane.brings_in": ("Brings in", "合図で入る人"),
    "acting_lane.who_enters": ("Who comes in there", "そこで入る奏者（自動）"),
    "acting_lane.style_here": ("Play in style here", "ここの演奏スタイル"),
    "acting_lane.style_of_all_here": ("Everyone in style here", "ここの全員の演奏スタイル"),
    "acting_lane.another_style": ("Change style", "別の演奏スタイルに変更"),
    "acting_lane.feet": ("Feet", "足"),
    "acting_lane.pose": ("Pose", "ポーズ"),
    "acting_lane.these_bars_are_performed_anew": (
        "These bars were regenerated. Press Backspace to restore the first performance.",
        "この小節は別パターンで再生成されています。Backspace で最初の演奏に戻します。",
    ),
    "additive_lane.add_key_here": ("Add Key Here", "ここにキーを追加"),
    "additive_lane.automatic": ("Automatic", "自動"),
    "additive_lane.bezier": ("Bezier", "ベジェ"),
    "additive_lane.channel": ("Channel", "チャンネル"),
    "additive_lane.constant": ("Constant", "一定"),
    "additive_lane.copy_keys": ("Copy Keys", "キーをコピー"),
    "additive_lane.delete_curve": ("Delete Curve", "カーブを削除"),
    "additive_lane.delete_keys": ("Delete Keys", "キーを削除"),
    "additive_lane.double_click_to_add": (
        "Double-click to add a key for {channel}.",
        "ダブルクリックで {channel} のキーを追加します。",
    ),
    "additive_lane.drag_to_blend": ("Drag to change the blend", "ドラッグでブレンドの長さを変更"),
    "additive_lane.enabled": ("Enabled", "有効"),
    "additive_lane.flat": ("Flat", "水平"),
    "additive_lane.interpolation": ("Interpolation", "補間"),
    "additive_lane.linear": ("Linear", "直線"),
    "additive_lane.not_here": (
        "This does not move in the player's posture.",
        "この奏者の姿勢では動きません。",
    ),
    "additive_lane.off": ("Disabled", "無効"),
    "additive_lane.paste_keys_here": ("Paste Keys Here", "ここにキーを貼り付け"),
    "additive_lane.rename": ("Rename...", "名前を変更..."),
    "additive_lane.tangents": ("Tangents", "接線"),
    "additive_lane.title": ("Additive Curves", "加算カーブ"),
    "additive_lane.value": ("Value...", "値..."),
    "additive_lane.weight": ("Weight...", "ウェイト..."),
    "additive_lane.weight_is": ("Weight {weight:.2f}", "ウェイト {weight:.2f}"),
    "additive_lane.what_to_do": (
        (
            "Keys added to the generated motion. Double-click to add a key, drag keys, tangents and blends, "
            "right-click for more. Hold Shift for fine steps, Alt to ignore the grid."
        ),
        (
            "生成された動きに加えるキーです。ダブルクリックでキーを追加、ドラッグでキー・接線・ブレンドを変更、"
            "右クリックでその他の操作。Shift で微調整、Alt でグリッドを無視します。"
        ),
    ),
    "alternates.back_to_generators_choice": ("Revert to generated fingering", "自動生成の運指に戻す"),
    "alternates.choice": ("Choice {rank}", "第 {rank} 候補"),
    "alternates.generated": ("Revert to Generated", "自動生成に戻す"),
    "breath_lane.add_breath_here": ("Add breath here", "ここにブレスを追加"),
    "breath_lane.breath": ("Breath", "ブレス"),
    "breath_lane.depth_s": ("depth {depth:.2f}, {seconds:.2f} s", "深さ {depth:.2f}、{seconds:.2f} 秒"),
    "breath_lane.drag_to_move_up_and": (
        "Drag to move, drag up or down for depth, an edge to resize. Double-click to add.",
        "ドラッグで移動、上下で深さ、端で長さを変更します。ダブルクリックで追加します。",
    ),
    "breath_lane.prepared": ("With preparation", "準備動作あり"),
    "curves_lane.aftertouch": ("Aftertouch", "アフタータッチ"),
    "curves_lane.air": ("Air", "息の量"),
    "curves_lane.bite": ("Bite", "バイト"),
    "curves_lane.breath_controller": ("Breath controller", "ブレス（CC2）"),
    "curves_lane.curve": ("Curve", "カーブ"),
    "curves_lane.curve_that_is_edited_or": ("Active curve", "編集・表示するカーブ"),
    "curves_lane.curves": ("Curves", "カーブ"),
    "curves_lane.drag_notes_value_up_or": (
        "Drag a note's value up or down. Hold Shift for fine steps, and Alt to change a controller at one place.",
        "音符の値を上下にドラッグします。Shift で微調整、Alt でコントローラーをその位置だけ変更できます。",
    ),
    "curves_lane.effort": ("Effort", "力の入り具合"),
    "curves_lane.expression": ("Expression", "エクスプレッション"),
    "curves_lane.lip_tension": ("Lip tension", "唇の緊張"),
    "curves_lane.pitch_bend": ("Pitch bend", "ピッチベンド"),
    "curves_lane.volume": ("Volume", "ボリューム"),
    "dance_lane.basic_motion_is_not_danced": (
        "Basic motion {number} disabled here",
        "ここでは基本動作 {number} を禁止",
    ),
    "dance_lane.basic_motion_s": ("Basic motion {number}, {seconds:.2f} s", "基本動作 {number}、{seconds:.2f} 秒"),
    "dance_lane.dance": ("Dance", "ダンス"),
    "dance_lane.from_s": ("From {source}, {start:.2f} s", "{source} の {start:.2f} 秒から"),
    "dance_lane.no_beat_of_music_is": ("No beats were found in the music.", "曲に拍が見つかりません。"),
    "dance_lane.no_dancers_yet_add_one": (
        "No dancers. Add one in the Players panel.",
        "ダンサーがいません。「奏者」パネルで追加してください。",
    ),
    "dance_lane.pinned_backspace_returns_it_to": (
        "Pinned. Press Backspace to revert to generated.",
        "固定済み。Backspace で自動生成に戻します。",
    ),
    "dance_lane.what_each_dancer_dances_click": (
        (
            "Dance of each dancer. Click a motion to select it, drag it to another beat, drag up or down for "
            "another motion, right-click for more. Press Backspace to revert to generated."
        ),
        (
            "各ダンサーのダンス。動作をクリックで選択、ドラッグで別の拍へ移動、上下のドラッグで別の動作に変更、"
            "右クリックでその他の操作、Backspace で自動生成に戻します。"
        ),
    ),
    "dance_menu.allow_basic_motion_again": ("Allow Basic Motion {number}", "基本動作 {number} の禁止を解除"),
    "dance_menu.basic_motion": ("Basic Motion {number}", "基本動作 {number}"),
    "dance_menu.do_not_dance_basic_motion": ("Disable Basic Motion {number} Here", "ここで基本動作 {number} を禁止"),
    "dance_menu.do_not_dance_basic_motion_in_this_piece": (
        "Disable Basic Motion {number} in This Piece",
        "この曲で基本動作 {number} を禁止",
    ),
    "dance_menu.other_basic_motion": ("Change Basic Motion", "基本動作を変更"),
    "dance_menu.other_segment_of_this_motion": ("Change Segment", "セグメントを変更"),
    "dance_menu.pin_basic_motion_here": ("Pin Basic Motion {number} Here", "ここで基本動作 {number} に固定"),
    "dance_menu.return_to_generator": ("Revert to Generated", "自動生成に戻す"),
    "dance_menu.return_whole_dance_to_generator": ("Revert Whole Dance to Generated", "ダンス全体を自動生成に戻す"),
    "dance_menu.s": ("{source}, {start:.2f} s", "{source}、{start:.2f} 秒"),
    "fingering_lane.click_note_to_see_its": (
        "Click a note for alternate fingerings; type a fingering to pin it",
        "音符をクリックすると替え指を表示します。運指を入力すると固定されます",
    ),
    "fingering_lane.fingering": ("Fingering", "運指"),
    "flags.bar": ("Bar {bar}", "小節 {bar}"),
    "lane.fold": ("Collapse", "折りたたむ"),
    "lane.unfold": ("Expand", "展開"),
    "mark_editor.metre_e_g_6_8": (
        "Time signature, e.g. 6/8. Enter to apply, Esc to cancel.",
        "拍子（例: 6/8）。Enter で確定、Esc で取り消し。",
    ),
    "mark_editor.tempo_in_quarters_per_minute": (
        "Tempo in quarter notes per minute. Enter to apply, Esc to cancel.",
        "テンポ（1 分あたりの四分音符の数）。Enter で確定、Esc で取り消し。",
    ),
    "piano_roll.click_to_select_all_its": (
        "{pitch}: click to select all notes of this pitch",
        "{pitch}: クリックでこの音高の音符をすべて選択",
    ),
    "piano_roll.entry_to": ("{giver} → {taker}: {place}", "{giver} → {taker}: {place}"),
    "piano_roll.entry_unchanged": (
        "Drag to another player's note",
        "別の奏者の音符までドラッグ",
    ),
    "piano_roll.no_notes_yet_take_pencil": (
        "No notes. Draw with the pencil, double-click, or paste.",
        "音符がありません。鉛筆で描くか、ダブルクリックまたは貼り付けで入力してください。",
    ),
    "piano_roll.no_players_yet_open_midi": (
        "No players. Open a MIDI file or add a player.",
        "奏者がいません。MIDI ファイルを開くか、奏者を追加してください。",
    ),
    "piano_roll.notes": ("Notes", "音符"),
    "piano_roll.notes_of_player_in_front": (
        "Notes of the active player; the others are shown behind",
        "アクティブな奏者の音符（ほかの奏者は背面に表示）",
    ),
    "piano_roll.pitch_place": ("{pitch} · {place}", "{pitch} · {place}"),
    "piano_roll.velocity": ("Velocity {velocity}", "ベロシティ {velocity}"),
    "piano_roll.velocity_2": (" · velocity {velocity}", " · ベロシティ {velocity}"),
    "problems_lane.problems": ("Problems", "問題"),
    "problems_lane.what_player_in_front_cannot": (
        "Problems of the active player; F8 goes to the next one",
        "アクティブな奏者の問題（F8 で次の問題へ移動）",
    ),
    "quantise_popover.beginnings": ("Starts", "開始位置"),
    "quantise_popover.ends": ("Ends", "終了位置"),
    "quantise_popover.grid": ("Grid", "グリッド"),
    "quantise_popover.quantise": ("Quantise", "クオンタイズ"),
    "quantise_popover.strength": ("Strength", "強さ"),
    "region_lane.deleted_by_hand": ("deleted manually", "手動で削除"),
    "region_lane.how_much": ("Amount", "量"),
    "ruler.add_metre_at_this_bar": ("Add Time Signature at This Bar", "この小節に拍子を追加"),
    "ruler.add_tempo_here": ("Add Tempo Here", "ここにテンポを追加"),
    "ruler.change_metre": ("Change Time Signature", "拍子を変更"),
    "ruler.change_tempo": ("Change Tempo", "テンポを変更"),
    "ruler.felt_beat": ("Beat Unit", "拍の単位"),
    "ruler.remove_metre": ("Remove Time Signature", "拍子を削除"),
    "ruler.remove_tempo": ("Remove Tempo", "テンポを削除"),
    "ruler.select_this_bar": ("Select Bar", "この小節を選択"),
    "take_heads.before": ("Pre-take", "テイク前"),
    "take_heads.double_click_takes_all_of": ("Double-click to comp the whole take", "ダブルクリックでテイク全体を採用"),
    "take_heads.name_of_take": ("Take name", "テイクの名前"),
    "take_heads.s_notes": ("{seconds:.1f} s, notes: {count}", "{seconds:.1f} 秒、音符 {count} 個"),
    "take_heads.takes": ("Takes", "テイク"),
    "take_heads.what_was_there_before_first": (
        "Part from before the first take. Double-click to restore it.",
        "最初のテイクより前のパート。ダブルクリックで元に戻します。",
    ),
    "takes_lane.blown_too_softly_to_be": ("blown too softly to sound", "息が弱く鳴らない音"),
    "takes_lane.drag_to_change_where_one": (
        "Drag to change the boundary between takes",
        "ドラッグでテイクの境界を変更",
    ),
    "takes_lane.finger_was_late_it_lies": (
        "late finger, between two legato notes",
        "指の遅れによる、レガートの 2 音の間の音",
    ),
    "takes_lane.is_left_out": ("{note} is excluded: {why}", "{note} は除外されます: {why}"),
    "takes_lane.no_player_is_in_front": ("No active player.", "アクティブな奏者がいません。"),
    "takes_lane.nothing_is_recorded_of_yet": (
        (
            "No takes of {player}. Connect a wind controller, start recording ({keys}) and play: each pass becomes "
            "a take. Then drag over the takes to comp the part."
        ),
        (
            "{player} のテイクはありません。ウインドコントローラーを接続し、録音を開始して（{keys}）演奏すると、1 "
            "回ごとにテイクになります。テイクの上をドラッグしてパートを組み立てます。"
        ),
    ),
    "takes_lane.record": ("Record", "録音"),
    "takes_lane.same_note_twice_key_sprang": ("repeated note from key bounce", "キーの跳ね返りによる二度打ち"),
    "takes_lane.short_and_soft_ghost_note": ("short, soft ghost note", "短く弱いゴーストノート"),
    "takes_lane.takes": ("Takes ({count})", "テイク（{count}）"),
    "takes_lane.takes_2": ("Takes", "テイク"),
    "takes_lane.what_was_recorded_of_player": (
        "Takes of the active player. Drag over a row to comp that range from the take.",
        "アクティブな奏者のテイク。行の上をドラッグすると、その範囲をそのテイクから採用します。",
    ),
    "timeline_panel.fold": ("Collapse", "折りたたむ"),
    "timeline_panel.fold_all": ("Collapse All", "すべて折りたたむ"),
    "timeline_panel.hide": ("Hide", "非表示"),
    "timeline_panel.lanes": ("Lanes", "レーン"),
    "timeline_panel.move_down": ("Move Down", "下へ移動"),
    "timeline_panel.move_up": ("Move Up", "上へ移動"),
    "timeline_panel.show_whole_piece_double_click": (
        "Zoom to whole piece (double-click the ruler)",
        "曲全体を表示（ルーラーをダブルクリック）",
    ),
    "timeline_panel.unfold": ("Expand", "展開"),
    "timeline_panel.unfold_all": ("Expand All", "すべて展開"),
    "timeline_panel.which_lanes_are_shown_and": ("Show and reorder lanes", "レーンの表示と並び順"),
    "timeline_panel.zoom_in_ctrl_wheel": ("Zoom in (Ctrl+wheel)", "拡大（Ctrl+ホイール）"),
    "timeline_panel.zoom_out_ctrl_wheel": ("Zoom out (Ctrl+wheel)", "縮小（Ctrl+ホイール）"),
    "tool_bar.all_players": ("All Players", "全奏者"),
    "tool_bar.draw_drag_out_new_note": ("Draw: drag to add a note", "描画: ドラッグで音符を追加"),
    "tool_bar.erase_drag_over_notes": ("Erase: drag over notes", "消去: 音符の上をドラッグ"),
    "tool_bar.how_other_players_notes_are": ("How to show the notes of other players", "ほかの奏者の音符の表示方法"),
    "tool_bar.only_this_player": ("Active Player Only", "アクティブな奏者のみ"),
    "tool_bar.others_as_ghosts": ("Ghost Notes", "ほかの奏者をゴースト表示"),
    "tool_bar.player_in_front": ("Active player", "アクティブな奏者"),
    "tool_bar.select_click_drag_frame_drag": (
        "Select: click, box-select, or drag notes and their ends",
        "選択: クリック、ボックス選択、音符や端のドラッグ",
    ),
    "tool_bar.selected_notes": ("Selected notes: {count}", "選択中の音符: {count}"),
    "tool_bar.split_click_where_note_shall": ("Split: click where to cut the note", "分割: 音符を切る位置をクリック"),
    "unit_button.bars": ("Bars", "小節"),
    "unit_button.frames": ("Frames", "フレーム"),
    "unit_button.seconds": ("Seconds", "秒"),
    "unit_button.what_ruler_counts": ("Ruler unit", "ルーラーの単位"),
    "waveform_lane.bar_doubtful": (
        "Bar {bar}: confidence {percent} %. Check it by ear.",
        "第 {bar} 小節: 信頼度 {percent} %。耳で確認してください。",
    ),
    "waveform_lane.bar_not_recorded": ("Bar {bar} is not in the recording.", "第 {bar} 小節は音源にありません。"),
    "waveform_lane.drag_to_move_it_against": (
        "Drag to move the audio against the score, hold Shift for fine steps. Double-click to type the offset. Drag a "
        "triangle at the lower edge to where its bar or beat sounds.",
        "ドラッグで音源を楽譜に対してずらします（Shift で微調整）。ダブルクリックでオフセットを入力します。"
        "下端の三角をドラッグすると、その小節や拍を音の鳴る位置に固定できます。",
    ),
    "waveform_lane.drag_to_where_it_sounds": (
        "Drag to where this beat sounds, hold Shift for fine steps. Double-click to pin it here.",
        "この拍が鳴る位置までドラッグします（Shift で微調整）。ダブルクリックでこの位置に固定します。",
    ),
    "waveform_lane.pin_here": ("Pin Beat Here", "拍をここに固定"),
    "waveform_lane.pinned_at": (
        "Pinned at {seconds} s of the audio. Double-click or press Delete to remove the pin.",
        "音源の {seconds} 秒に固定されています。ダブルクリックまたは Delete キーで固定を解除します。",
    ),
    "waveform_lane.remove_all_pins": ("Remove All Pins", "すべての固定を解除"),
    "waveform_lane.remove_pin": ("Remove Pin", "固定を解除"),
    "waveform_lane.drop_recording_here_until_then": (
        "Drop an audio file here. Without audio the synthesiser plays the score.",
        "ここに音源をドロップしてください。音源がない間は、シンセサイザーが楽譜を再生します。",
    ),
    "waveform_lane.offset_in_seconds": ("Offset in seconds", "オフセット（秒）"),
    "waveform_lane.offset_s": ("offset {offset} s", "オフセット {offset} 秒"),
    "waveform_lane.offset_s_estimated": (
        "offset {offset} s (estimated, {confidence:.2f})",
        "オフセット {offset} 秒（推定、信頼度 {confidence:.2f}）",
    ),
    "waveform_lane.offset_s_recording_is_not": (
        "offset {offset} s · loading audio…",
        "オフセット {offset} 秒 · 音源を読み込み中…",
    ),
    "waveform_lane.recording": ("Audio", "音源"),
    "waveform_lane.type_offset": ("Type Offset...", "オフセットを入力..."),
}
