"""Texts of actions, lane, section and dialogs of dancers and choreographies: id -> English and Japanese."""

from __future__ import annotations

from typing import Final

TEXTS: Final[dict[str, tuple[str, str]]] = {
    "action.dancers.add": ("Add Dancer", "ダンサーを追加"),
    "action.dancers.choreography": ("Show Choreography...", "振り付けを表示..."),
    "action.dancers.duplicate": ("Duplicate Dancer", "ダンサーを複製"),
    "action.dancers.learn": ("Learn Choreography...", "振り付けを学習..."),
    "action.dancers.remove": ("Remove Dancer", "ダンサーを削除"),
    "action.dancers.rename": ("Rename Dancer", "ダンサーの名前を変更"),
    "choreography_dialog.arrow_for_each_transition_that": (
        (
            "Arrows show the learned transitions; wider arrows are more likely. Point at a basic motion to "
            "highlight its transitions."
        ),
        "学習した遷移を矢印で示します。太いほど確率が高くなります。基本動作を指すと、その遷移が強調されます。",
    ),
    "choreography_dialog.basic_motion": ("Basic motion {number}", "基本動作 {number}"),
    "choreography_dialog.basic_motion_is_danced_again": (
        "Basic motion {number} repeats with a probability of {share} %.",
        "基本動作 {number} が繰り返される確率は {share} % です。",
    ),
    "choreography_dialog.basic_motion_is_followed_by": (
        "Basic motion {number} is followed by {next} with a probability of {share} %.",
        "基本動作 {number} の次に {next} が続く確率は {share} % です。",
    ),
    "choreography_dialog.basic_motions": ("Basic Motions", "基本動作"),
    "choreography_dialog.basic_motions_segments_min_sources": (
        ("{name} · Basic motions: {motions} · Segments: {segments}, {minutes}:{seconds:02d} min · Sources: {sources}"),
        ("{name} · 基本動作: {motions} · セグメント: {segments}、{minutes} 分 {seconds:02d} 秒 · ソース: {sources}"),
    ),
    "choreography_dialog.choreography": ("Choreography", "振り付け"),
    "choreography_dialog.choreography_of": ("Choreography of {dancer}", "{dancer} の振り付け"),
    "choreography_dialog.close": ("Close", "閉じる"),
    "choreography_dialog.credits": ("Credits", "クレジット"),
    "choreography_dialog.danced_to": ("percussion: {sounds}", "打楽器: {sounds}"),
    "choreography_dialog.dances_of_basic_motions_in": (
        "{dancer} uses {used} of {count} basic motions in this piece.",
        "{dancer} はこの曲で {count} 個の基本動作のうち {used} 個を使います。",
    ),
    "choreography_dialog.followed_by": ("next: {motions}", "次の動作: {motions}"),
    "choreography_dialog.from": ("sources: {sources}", "ソース: {sources}"),
    "choreography_dialog.graph": ("Graph", "グラフ"),
    "choreography_dialog.most_typical_segment_of_each": (
        "The most typical segment of each basic motion: start, accent and end.",
        "各基本動作の最も代表的なセグメントの始まり、アクセント、終わりです。",
    ),
    "choreography_dialog.no_credits_are_given_for": (
        "No credits are available for these sources.",
        "これらのソースにはクレジットがありません。",
    ),
    "choreography_dialog.no_dancer_is_selected": ("No dancer is selected.", "ダンサーが選択されていません。"),
    "choreography_dialog.of_strokes_during_basic_motion": (
        "{sound}: {share} % of the percussion hits during basic motion {number}",
        "{sound}: 基本動作 {number} の間の打音の {share} %",
    ),
    "choreography_dialog.percussion": ("Percussion", "打楽器"),
    "choreography_dialog.reading": ("Loading…", "読み込み中…"),
    "choreography_dialog.text": ("{count}×", "{count} 回"),
    "choreography_dialog.transitions": ("Transitions", "遷移"),
    "choreography_dialog.what_follows_what_in_percent": (
        (
            "Transition probabilities in percent. Rows are the current basic motion, columns the next one. "
            "Coloured basic motions are used in this piece, with the number of uses."
        ),
        (
            "遷移の確率（%）です。行が現在の基本動作、列が次の基本動作です。"
            "色付きの基本動作はこの曲で使われるもので、数字はその回数です。"
        ),
    ),
    "choreography_dialog.what_is_struck_during_each": (
        (
            "Percussion during each basic motion, in percent of its hits. This piece has no percussion; sounds "
            "with a dot stand for its melody, bass and accents."
        ),
        (
            "各基本動作の間に鳴る打楽器（打音に占める割合、%）です。この曲には打楽器がないため、"
            "点の付いた音は旋律、低音、アクセントの代わりです。"
        ),
    ),
    "choreography_dialog.what_is_struck_during_each_basic_motion_in": (
        "Percussion during each basic motion, in percent of its hits. Sounds with a dot occur in this piece.",
        "各基本動作の間に鳴る打楽器（打音に占める割合、%）です。点の付いた音はこの曲で使われています。",
    ),
    "choreography_dialog.with": ("{motion} with {music}", "{motion} と {music}"),
    "cut_panel.angular_acceleration_rad_s_over": (
        (
            "Angular acceleration (rad/s²) over motion time (s). Blue: cuts; orange: accents; green: percussion of "
            "the music. Drag a line to move it, double-click to add a cut, press Delete to remove it. Ctrl+wheel "
            "zooms; drag in the time axis to scrub."
        ),
        (
            "モーションの時刻（秒）に対する角加速度（rad/s²）。青: 区切り、オレンジ: アクセント、緑: 音楽の打楽器。"
            "線をドラッグで移動、ダブルクリックで区切りを追加、Delete で削除、Ctrl+ホイールで拡大縮小、"
            "時間軸のドラッグで再生位置を移動します。"
        ),
    ),
    "cut_panel.cuts_of_motion": ("Motion cuts", "モーションの区切り"),
    "cut_panel.cuts_stop_at_minima_accents": (
        "Snap cuts to minima and accents to maxima; hold Alt to suspend",
        "区切りは極小に、アクセントは極大にスナップ（Alt で一時解除）",
    ),
    "cut_panel.redo_ctrl_shift_z": ("Redo (Ctrl+Shift+Z)", "やり直す（Ctrl+Shift+Z）"),
    "cut_panel.reset_to_automatic": ("Reset to Automatic", "自動に戻す"),
    "cut_panel.s_rad_s": ("{time} s, {acceleration} rad/s²", "{time} 秒、{acceleration} rad/s²"),
    "cut_panel.segments_found": ("Segments: {n} (detected)", "セグメント: {n}（検出）"),
    "cut_panel.segments_set_by_hand": ("Segments: {n} (manual)", "セグメント: {n}（手動）"),
    "cut_panel.snap": ("Snap", "スナップ"),
    "cut_panel.undo_ctrl_z": ("Undo (Ctrl+Z)", "元に戻す（Ctrl+Z）"),
    "cut_panel.whole_motion_f": ("Show whole motion (F)", "モーション全体を表示（F）"),
    "hit_chart.how_late_every_hit_came": ("Delay of each hit", "各クリックに対する吹き始めの遅れ"),
    "hit_chart.ms": ("{count} ms", "{count} ms"),
    "learn_dialog.add": ("Add...", "追加..."),
    "learn_dialog.add_dancer_with_it": ("Add Dancer with This Choreography", "この振り付けでダンサーを追加"),
    "learn_dialog.add_motion_and_music": ("Add Motion and Music", "モーションと音楽を追加"),
    "learn_dialog.add_motion_files_and_midi": (
        "Add motion files and their MIDI files or scores, or drop them here.",
        "モーションファイルと、対応する MIDI ファイルか楽譜を追加するか、ここにドロップしてください。",
    ),
    "learn_dialog.automatic": ("Automatic", "自動"),
    "learn_dialog.choose": ("Browse...", "参照..."),
    "learn_dialog.choose_where_to_save_choreography": (
        "Select where to save the choreography.",
        "振り付けの保存先を選んでください。",
    ),
    "learn_dialog.choreographies": ("Choreographies", "振り付け"),
    "learn_dialog.confidence": ("Confidence", "信頼度"),
    "learn_dialog.learn": ("Learn", "学習"),
    "learn_dialog.learn_choreography": ("Learn Choreography", "振り付けを学習"),
    "learn_dialog.motion": ("Motion", "モーション"),
    "learn_dialog.motion_and_midi_files": ("Motion and music files", "モーションと楽曲のファイル"),
    "learn_dialog.music": ("Music", "音楽"),
    "learn_dialog.neither_motion_nor_midi": (
        "Not a motion, MIDI or score file: {files}",
        "モーション、MIDI、楽譜のいずれでもないファイル: {files}",
    ),
    "learn_dialog.number_of_basic_motions_automatic": (
        "Number of basic motions. Automatic: as many as needed for motions of the same kind to look alike.",
        "基本動作の数。自動では、同じ種類の動きが似て見えるのに必要な数になります。",
    ),
    "learn_dialog.of_classification_same_pairs_and": (
        "Seed of the classification. The same pairs and seed give the same choreography.",
        "分類のシード。同じ組と同じシードからは同じ振り付けができます。",
    ),
    "learn_dialog.offset_s": ("Offset (s)", "オフセット（秒）"),
    "learn_dialog.pair": ("Pair {n}: {error}", "組 {n}: {error}"),
    "learn_dialog.pair_choose_its_motion": (
        "Pair {n}: select a motion file.",
        "組 {n}: モーションファイルを選んでください。",
    ),
    "learn_dialog.pair_choose_its_music": (
        "Pair {n}: select a MIDI file or score.",
        "組 {n}: MIDI ファイルか楽譜を選んでください。",
    ),
    "learn_dialog.pair_offset_outside": (
        "Pair {n}: no percussion sounds during the motion with this offset. Set one from {least} to {most} s.",
        "組 {n}: このオフセットではモーションの間に打楽器が鳴りません。{least}～{most} 秒にしてください。",
    ),
    "learn_dialog.pairs_of_motion_and_music": ("Motion and music pairs", "モーションと音楽の組"),
    "learn_dialog.reading_files": ("Reading files…", "ファイルを読み込み中…"),
    "learn_dialog.remove": ("Remove", "削除"),
    "learn_dialog.save_choreography": ("Save Choreography", "振り付けを保存"),
    "learn_dialog.save_to": ("Save to", "保存先"),
    "learn_dialog.seconds": ("Seconds", "秒"),
    "learn_dialog.seed": ("Seed", "シード"),
    "learn_dialog.segments": ("Segments", "セグメント"),
    "learn_dialog.states": ("Basic motions", "基本動作"),
    "learn_dialog.this_file_is_there_and": (
        "The file already exists and will be replaced.",
        "ファイルは既に存在し、上書きされます。",
    ),
    "learn_dialog.use_for": ("Use for {dancer}", "{dancer} に使用"),
    "motion_model.basic_motion": ("Basic motion {number}", "基本動作 {number}"),
    "motion_model.danced": ("used {count}×", "{count} 回"),
    "motion_model.not_danced": ("not used", "使用なし"),
    "motion_model.segments_s_on_average": (
        "Segments: {count}, {seconds:.2f} s on average",
        "セグメント: {count}、平均 {seconds:.2f} 秒",
    ),
    "motion_model.sources_of": ("Sources: {count} of {all}", "ソース: {all} 個中 {count} 個"),
    "pair_form.as_in_file": ("From file", "ファイルの値"),
    "pair_form.automatic": ("Automatic", "自動"),
    "pair_form.bvh_fbx_or_glb": ("BVH, FBX or GLB", "BVH、FBX、GLB"),
    "pair_form.choose": ("Browse...", "参照..."),
    "pair_form.credits": ("Credits", "クレジット"),
    "pair_form.frame_rate": ("Frame rate", "フレームレート"),
    "pair_form.frames_s": (" frames/s", " フレーム/秒"),
    "pair_form.midi_files": ("MIDI files and scores", "MIDI ファイルと楽譜"),
    "pair_form.midi_with_percussion": ("Music with percussion", "打楽器を含む楽曲"),
    "pair_form.motion": ("Motion", "モーション"),
    "pair_form.motion_files": ("Motion files", "モーションファイル"),
    "pair_form.music": ("Music", "音楽"),
    "pair_form.no_credits_say_where_motion": (
        "No credits. Enter the source and licence of the motion.",
        "クレジットがありません。モーションの出典と利用条件を入力してください。",
    ),
    "pair_form.offset": ("Offset", "オフセット"),
    "pair_form.offset_found_with_confidence": (
        "Offset detected (confidence {confidence}).",
        "オフセットを検出しました（信頼度 {confidence}）。",
    ),
    "pair_form.offset_found_with_confidence_another": (
        (
            "Offset detected (confidence {confidence}), but another one fits nearly as well. If the music starts "
            "elsewhere, type the offset."
        ),
        (
            "オフセットを検出しました（信頼度 {confidence}）。ほぼ同程度に合う別の位置もあります。"
            "音楽の開始位置が違う場合は入力してください。"
        ),
    ),
    "pair_form.offset_outside": (
        "With this offset no percussion sounds during the motion: set one from {least} to {most} s, or Automatic.",
        ("このオフセットではモーションの間に打楽器が鳴りません。{least}～{most} 秒の値か「自動」にしてください。"),
    ),
    "pair_form.pair_is_motion_and_midi": (
        "A pair is a motion and the MIDI file or score of its music.",
        "組は、モーションと、その音楽の MIDI ファイルか楽譜からなります。",
    ),
    "pair_form.reading_files": ("Reading files…", "ファイルを読み込み中…"),
    "pair_form.seconds": (" s", " 秒"),
    "pair_form.text_files": ("Text files", "テキストファイル"),
    "pair_form.time_of_motion_at_which": ("Motion time at which the music starts", "音楽が始まる、モーション内の時刻"),
    "pair_form.to_check": ("Check: {notes}", "要確認: {notes}"),
    "pair_player.drag_to_scrub": (
        "Drag to move through the motion and hear its music",
        "ドラッグすると、音楽を聞きながらモーション内を移動します",
    ),
    "pair_player.no_audio_device": ("no audio device", "音声デバイスなし"),
    "pair_player.play_space": (
        "Play the motion with its music (Space)",
        "モーションを音楽と一緒に再生（Space）",
    ),
    "pair_player.preparing_sound": ("preparing sound, {percent} %", "音を準備中 {percent} %"),
    "pair_player.time": ("{seconds} / {end} s", "{seconds} / {end} 秒"),
    "pair_form.true_frame_rate_of_motion": (
        "Correct frame rate of the motion, if the file states a wrong one",
        "ファイルの値が誤っている場合の、正しいフレームレート",
    ),
    "pair_form.txt_file_beside_motion": (".txt file next to the motion", "モーションと同じフォルダーの .txt"),
    "action.lanes.dance": ("Dance Lane", "ダンスレーン"),
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
    "dancers_section.add_dancer": ("Add dancer", "ダンサーを追加"),
    "dancers_section.another_dance_to_same_music": (
        "Create another dance to the same music",
        "同じ曲で別のダンスを生成",
    ),
    "dancers_section.character": ("Character", "キャラクター"),
    "dancers_section.choreographies": ("Choreographies", "振り付け"),
    "dancers_section.choreography": ("Choreography", "振り付け"),
    "dancers_section.dancer": ("Dancer", "ダンサー"),
    "dancers_section.dancers": ("Dancers", "ダンサー"),
    "dancers_section.duplicate_another_one_dances_same": (
        "Duplicate: adds a dancer with the same dance",
        "複製: 同じダンスを踊るダンサーを追加",
    ),
    "dancers_section.from_file": ("From File...", "ファイルから..."),
    "dancers_section.learn": ("Learn...", "学習..."),
    "dancers_section.left_and_right_exchanged": ("Swap left and right", "左右を入れ替え"),
    "dancers_section.mirrored": ("Mirrored", "左右反転"),
    "dancers_section.none": ("None", "なし"),
    "dancers_section.remove_selected_dancer": ("Remove selected dancer", "選択したダンサーを削除"),
    "dancers_section.show_what_choreography_has_learned": ("Show choreography", "振り付けを表示"),
}
