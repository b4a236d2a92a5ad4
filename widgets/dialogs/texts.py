"""Texts of dialogs: id -> English and Japanese."""

from __future__ import annotations

from typing import Final

TEXTS: Final[dict[str, tuple[str, str]]] = {
    "character_dialog.automatic": ("Automatic", "自動"),
    "character_dialog.body": ("Body", "ボディ"),
    "character_dialog.bone": ("Bone", "ボーン"),
    "character_dialog.bone_of_file": ("Bone in file", "ファイルのボーン"),
    "character_dialog.bones_morphs": (
        "{file}\nBones: {bones}, morphs: {morphs}",
        "{file}\nボーン {bones}、モーフ {morphs}",
    ),
    "character_dialog.cancel": ("Cancel", "キャンセル"),
    "character_dialog.character": ("Character: {file}", "キャラクター: {file}"),
    "character_dialog.everything_will_be_played": ("All features are supported.", "すべての機能に対応しています。"),
    "character_dialog.face": ("Face", "顔"),
    "character_dialog.file_has_no_such_bone": (
        "{joint}: bone not found in the file",
        "{joint}: ファイルに該当するボーンがありません",
    ),
    "character_dialog.found": ("found", "検出"),
    "character_dialog.give_it_to": ("Assign to {players}", "{players} に割り当てる"),
    "character_dialog.guess": ("guessed", "推測"),
    "character_dialog.guess_please_look": (
        "{joint}: {bone}, guessed; please check",
        "{joint}: {bone}（推測。確認してください）",
    ),
    "character_dialog.joint": ("Joint", "関節"),
    "character_dialog.joints_of_body": ("Body joints", "体の関節"),
    "character_dialog.keep_character": ("Save Character", "キャラクターを保存"),
    "character_dialog.name": ("Name", "名前"),
    "character_dialog.no_bone": ("No Bone", "ボーンなし"),
    "character_dialog.no_picture_yet": ("No preview", "プレビューなし"),
    "character_dialog.none": ("none", "なし"),
    "character_dialog.redo": ("Redo", "やり直す"),
    "character_dialog.reset_all": ("Reset All", "すべてリセット"),
    "character_dialog.search_bones": ("Search bones", "ボーンを検索"),
    "character_dialog.text": ("{joint}: {bone}", "{joint}: {bone}"),
    "character_dialog.undo": ("Undo", "元に戻す"),
    "character_words.cheeks_do_not_fill_it": (
        "Cheek puffing is not available: no matching morph was found.",
        "頬をふくらませる動きは使えません（該当するモーフがありません）。",
    ),
    "character_words.eyes_do_not_look_around": (
        "Eye direction is not available: no matching bones or morphs were found.",
        "視線は動きません（目のボーンもモーフもありません）。",
    ),
    "character_words.it_cannot_play_yet_choose": (
        "This character cannot play yet. Select bones for: {joints}",
        "このままでは演奏できません。次の関節のボーンを選んでください: {joints}",
    ),
    "character_words.it_does_not_blink_it": (
        "Blinking is not available: no matching morph was found.",
        "まばたきはしません（該当するモーフがありません）。",
    ),
    "character_words.it_has_no_finger_bones": (
        "No finger bones were found. The hands hold the instrument, but the fingers do not move.",
        "指のボーンがありません。手は楽器を持ちますが、指は動きません。",
    ),
    "character_words.lips_do_not_form_embouchure": (
        "Lip shaping for the embouchure is not available: no matching morphs were found.",
        "唇はアンブシュアの形になりません（該当するモーフがありません）。",
    ),
    "character_words.mouth_does_not_open_it": (
        "Mouth opening is not available: no jaw bone or matching morph was found.",
        "口は開きません（顎のボーンもモーフもありません）。",
    ),
    "character_words.these_fingers_do_not_move": ("Fingers that do not move: {fingers}", "動かない指: {fingers}"),
    "characters_dialog.add": ("Add...", "追加..."),
    "characters_dialog.characters": ("Characters", "キャラクター"),
    "characters_dialog.close": ("Close", "閉じる"),
    "characters_dialog.edit": ("Edit...", "編集..."),
    "characters_dialog.remove": ("Remove...", "削除..."),
    "characters_dialog.your_own_characters_from_vrm": (
        (
            "Your characters, imported from VRM, glTF or FBX files. To add one, click Add or drop a file here. Any "
            "player can use them."
        ),
        (
            "VRM、glTF、FBX ファイルから追加した自分のキャラクターです。「追加」をクリックするか、"
            "ファイルをここにドロップすると追加できます。どの奏者にも割り当てられます。"
        ),
    ),
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
            "zooms."
        ),
        (
            "モーションの時刻（秒）に対する角加速度（rad/s²）。青: 区切り、オレンジ: アクセント、緑: 音楽の打楽器。"
            "線をドラッグで移動、ダブルクリックで区切りを追加、Delete で削除、Ctrl+ホイールで拡大縮小します。"
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
    "export_dialog.all_or_none": ("Select/deselect all", "すべて選択/解除"),
    "export_dialog.beats": (" beats", " 拍"),
    "export_dialog.bone_names_in_bvh": ("Bone names in BVH", "BVH のボーン名"),
    "export_dialog.export": ("Export", "書き出し"),
    "export_dialog.files": ("Formats", "形式"),
    "export_dialog.files_that_will_be_written": ("Files to write: {count}", "書き出すファイル: {count} 個"),
    "export_dialog.files_written_into_project_in": (
        (
            "Files written to the project {name}: {count}\nIn Unreal choose Suisou > Import Performance, or Update "
            "Performance if it was imported before."
        ),
        (
            "プロジェクト {name} に書き出したファイル: {count} 個\nUnreal で「Suisou > 演奏をインポート」"
            "を選んでください。インポート済みの場合は「演奏を更新」を選びます。"
        ),
    ),
    "export_dialog.files_written_to": (
        "Files written to {folder}: {count}",
        "{folder} に書き出したファイル: {count} 個",
    ),
    "export_dialog.frames_per_second": ("Frames per second", "フレームレート"),
    "export_dialog.if_unreal_has_project_open": (
        "If the project is open in Unreal, restart Unreal to load the new menu.",
        "Unreal でこのプロジェクトを開いている場合は、再起動すると新しいメニューが表示されます。",
    ),
    "export_dialog.into": ("Destination", "書き出し先"),
    "export_dialog.key_on_every_frame": ("On every frame", "全フレーム"),
    "export_dialog.keys": ("Keys", "キー"),
    "export_dialog.reduced_keys": ("Reduced", "間引く"),
    "export_dialog.reduced_keys_tip": (
        "Reduced keys keep rotations within 0.25° and joints, contacts and instruments within 0.5 mm at every frame. "
        "BVH always has every frame.",
        "間引いたキーでも、全フレームで回転は 0.25° 以内、関節・接触点・楽器は 0.5 mm 以内に収まります。"
        "BVH は常に全フレームです。",
    ),
    "export_dialog.no_longer_needed_will_be": (
        "{count} files that are no longer needed will be removed: {names}",
        "不要になったファイル {count} 個を削除します: {names}",
    ),
    "export_dialog.of_these_will_be_replaced": (
        "{count} of them will be replaced: {names}",
        "うち {count} 個は上書きされます: {names}",
    ),
    "export_dialog.performers": ("Performers", "出演者"),
    "export_dialog.players": ("Players", "奏者"),
    "export_dialog.pre_roll": ("Pre-roll", "プリロール"),
    "export_dialog.range": ("Range", "範囲"),
    "export_dialog.rig": ("Rig", "リグ"),
    "export_dialog.skeleton": ("Skeleton", "スケルトン"),
    "export_dialog.those_of_skeleton": ("Same as skeleton", "スケルトンと同じ"),
    "export_dialog.tick_at_least_one_kind": (
        "Select at least one file format.",
        "ファイル形式を 1 つ以上選んでください。",
    ),
    "export_dialog.tick_at_least_one_player": ("Select at least one player.", "奏者を 1 人以上選んでください。"),
    "export_dialog.unreal_engine": ("{name} (Unreal Engine {engine})", "{name}（Unreal Engine {engine}）"),
    "export_dialog.version_unknown": ("unknown version", "バージョン不明"),
    "face_map_page.add_morph_of_file": ("Add Morph...", "モーフを追加..."),
    "face_map_page.automatic": ("Automatic", "自動"),
    "face_map_page.face": ("Face", "顔"),
    "face_map_page.file_has_no_morphs_face": (
        "The file has no morphs, so the face does not move.",
        "ファイルにモーフがないため、顔は動きません。",
    ),
    "face_map_page.is_made_of": ("{face} ({name}) uses:", "{face}（{name}）に使うモーフ:"),
    "face_map_page.made_of": ("Morphs", "使うモーフ"),
    "face_map_page.nothing_character_does_not_do": (
        "None. The character does not show this expression.",
        "なし。このキャラクターではこの表情は表示されません。",
    ),
    "face_map_page.take_this_morph_out": ("Remove this morph", "このモーフを削除"),
    "format_chooser.bvh_body_motion": ("BVH (body motion)", "BVH（体の動き）"),
    "format_chooser.fbx_characters_and_instruments": ("FBX (characters and instruments)", "FBX（キャラクターと楽器）"),
    "format_chooser.glb_characters_and_instruments": ("GLB (characters and instruments)", "GLB（キャラクターと楽器）"),
    "format_chooser.sound_wav": ("Audio (WAV)", "オーディオ（WAV）"),
    "format_chooser.whole_stage_in_one_file": ("Whole stage in one file", "ステージ全体を 1 ファイルに"),
    "format_chooser.usd_characters_and_instruments": ("USD (characters and instruments)", "USD（キャラクターと楽器）"),
    "format_chooser.usd_package_usd_core_is": (
        "USD (requires the usd-core package)",
        "USD（パッケージ usd-core が必要です）",
    ),
    "hit_chart.how_late_every_hit_came": ("Delay of each hit", "各クリックに対する吹き始めの遅れ"),
    "hit_chart.ms": ("{count} ms", "{count} ms"),
    "follow_dialog.beats_lie_where_they_sound": (
        "Every beat is put where the recording has it. Pinned beats stay.",
        "すべての拍を音源で鳴る位置に合わせます。固定した拍は動きません。",
    ),
    "follow_dialog.cancel": ("Cancel", "キャンセル"),
    "follow_dialog.choose_file": ("Choose...", "選択..."),
    "follow_dialog.dynamics_follow": (
        "Dynamics follow the loudness of the recording",
        "強弱を音源の音量に合わせる",
    ),
    "follow_dialog.follow": ("Follow", "追従"),
    "follow_dialog.follow_recording": ("Follow Recording", "テンポを音源に追従"),
    "follow_dialog.from_the_whole": ("from the whole recording", "全体の音源から"),
    "follow_dialog.recording_of_player": ("Recording of One Player", "奏者ひとりの音源"),
    "follow_dialog.single_players": (
        "Recordings of single players (stems), which begin when the recording does:",
        "奏者ごとの音源（ステム）。全体の音源と同時に始まるもの:",
    ),
    "follow_dialog.single_notes_move": (
        "Single notes move too, where their beginnings are clear",
        "発音がはっきりしている音符は個別にも動かす",
    ),
    "follow_dialog.sound_files": ("Audio files", "音声ファイル"),
    "follow_dialog.without_file": ("Without", "使わない"),
    "import_dialog.add_dancer": ("Add dancer", "ダンサーを追加"),
    "import_dialog.automatic": ("Automatic", "自動"),
    "import_dialog.automatic_2": ("Automatic: {name}", "自動: {name}"),
    "import_dialog.automatic_another_player_for_notes": (
        ("Automatic: adds a player for notes that keep overlapping; short overlaps of one player are treated as slurs"),
        "自動: 重なり続ける音には奏者を追加し、1 人の音の短い重なりはスラーとみなします",
    ),
    "import_dialog.cancel": ("Cancel", "キャンセル"),
    "import_dialog.central_european": ("Central European ({name})", "中央ヨーロッパ（{name}）"),
    "import_dialog.character": ("Character", "キャラクター"),
    "import_dialog.choose_instrument": ("Select an instrument", "楽器を選択"),
    "import_dialog.choose_instrument_for": ("Select an instrument for {name}", "{name} の楽器を選んでください"),
    "import_dialog.cyrillic": ("Cyrillic ({name})", "キリル文字（{name}）"),
    "import_dialog.clean_take": ("Clean Take", "テイクをクリーンアップ"),
    "import_dialog.dancer_who_moves_to_percussion": (
        "Adds a dancer who dances to the percussion, in front of the players",
        "打楽器に合わせて踊るダンサーを、奏者の前に追加",
    ),
    "import_dialog.encoding": ("Text encoding", "文字コード"),
    "import_dialog.encoding_tip": (
        "Encoding of the names in the file; choose another one if they are not readable",
        "ファイル内の名前の文字コード。文字化けする場合は別のものを選びます",
    ),
    "import_dialog.finding_out_who_plays_what": ("Assigning instruments…", "楽器を割り当て中…"),
    "import_dialog.greek": ("Greek ({name})", "ギリシャ文字（{name}）"),
    "import_dialog.import": ("Import", "読み込み"),
    "import_dialog.import_midi": ("Import MIDI", "MIDI の読み込み"),
    "import_dialog.instrument": ("Instrument", "楽器"),
    "import_dialog.is_not_played": ("{name} will not be played: {reason}", "{name} は演奏されません: {reason}"),
    "import_dialog.is_not_played_dancers_dance": (
        "{name} will not be played: {reason}. Dancers use it as percussion.",
        "{name} は演奏されません: {reason}。ダンサーが打楽器として使います。",
    ),
    "import_dialog.japanese": ("Japanese ({name})", "日本語（{name}）"),
    "import_dialog.korean": ("Korean ({name})", "韓国語（{name}）"),
    "import_dialog.make_one_part_of_selected": (
        "Merge the selected tracks into one part",
        "選択したトラックを 1 つのパートにまとめる",
    ),
    "import_dialog.make_part_of_each_merged": (
        "Split the merged tracks into separate parts",
        "まとめたトラックを別々のパートに分ける",
    ),
    "import_dialog.merge_into_one_part": ("Merge into One Part", "1 つのパートにまとめる"),
    "import_dialog.name": ("Name", "名前"),
    "import_dialog.no_notes_to_import": (
        "No notes to import. You get an empty stage.",
        "読み込む音符がありません。空のステージになります。",
    ),
    "import_dialog.no_tracks_selected": (
        "No tracks selected. Select a track, or import an empty stage.",
        "トラックが選択されていません。トラックを選ぶか、空のステージとして読み込んでください。",
    ),
    "import_dialog.notes": ("Notes", "音符"),
    "import_dialog.notes_to": ("Notes: {count}\n{low} to {high}", "{count} 音\n{low}～{high}"),
    "import_dialog.notes_together": ("Overlapping notes", "重なる音"),
    "import_dialog.number_range": ("Count, range", "音数・音域"),
    "import_dialog.one_player": ("One player", "奏者 1 人"),
    "import_dialog.simplified_chinese": ("Chinese, simplified ({name})", "中国語簡体字（{name}）"),
    "import_dialog.traditional_chinese": ("Chinese, traditional ({name})", "中国語繁体字（{name}）"),
    "import_dialog.western": ("Western European ({name})", "西ヨーロッパ（{name}）"),
    "import_dialog.percussion_for_dancers": ("Percussion (for dancers)", "打楽器（ダンサー用）"),
    "import_dialog.sound_effect": ("Sound effect (not played)", "効果音（演奏しない）"),
    "import_dialog.sound_effects_no_player_plays": (
        "Sound effects such as applause or a helicopter: no player plays them, and dancers do not use them.",
        "拍手やヘリコプターなどの効果音です。奏者は演奏せず、ダンサーも使いません。",
    ),
    "import_dialog.percussion_track_no_player_plays": (
        (
            "Percussion track: not played by players, but used by dancers. It is always kept for them, even when "
            "it is not selected."
        ),
        (
            "打楽器のトラックです。奏者は演奏しませんが、ダンサーが使います。選択しなくても、"
            "ダンサーのために残されます。"
        ),
    ),
    "import_dialog.pitches": ("Pitches", "音高"),
    "import_dialog.play": ("Play", "演奏"),
    "import_dialog.players": ("Players: {count}", "奏者: {count} 人"),
    "import_dialog.share_among_players": ("Split among players", "複数の奏者で分担"),
    "import_dialog.sounding": ("Sounding", "実音"),
    "import_dialog.take_apart": ("Split", "分ける"),
    "import_dialog.text": (
        "{title} · {minutes}:{seconds:02d} · ♩= {tempo:g} · {metre}",
        "{title} · {minutes}:{seconds:02d} · ♩= {tempo:g} · {metre}",
    ),
    "import_dialog.what_reader_noticed": ("Import warnings", "読み込み時の警告"),
    "import_dialog.take_breath": (
        "Played on a wind controller: breath was sent while the notes sounded, and they lie off the beat.\n"
        "On: slips, notes struck twice in one breath and notes without breath are left out.",
        "ウインドコントローラーの演奏: 息のデータが途切れず、発音が拍からずれています。\n"
        "オン: 運指のずれ、1 つの息での二度打ち、息のない音を除きます。",
    ),
    "import_dialog.take_name": (
        "Played on a wind controller: the name of the track says so, and breath was sent.\n"
        "On: slips, notes struck twice in one breath and notes without breath are left out.",
        "ウインドコントローラーの演奏: トラック名と息のデータから判断しました。\n"
        "オン: 運指のずれ、1 つの息での二度打ち、息のない音を除きます。",
    ),
    "import_dialog.take_recorded": (
        "Recorded with suisou record.\n"
        "On: slips, notes struck twice in one breath and notes without breath are left out.",
        "suisou record で録音されたテイクです。\nオン: 運指のずれ、1 つの息での二度打ち、息のない音を除きます。",
    ),
    "import_dialog.which_pitches_file_has_of": (
        "Transposing part: sounding or written pitch?",
        "移調楽器のパート: 実音か記譜音か",
    ),
    "import_dialog.written": ("Written", "記譜音"),
    "instruments_dialog.add_alternate": ("Add Alternate", "替え指を追加"),
    "instruments_dialog.alto_clef": ("alto clef", "アルト記号"),
    "instruments_dialog.and_more": ("and {count} more", "ほか {count} 件"),
    "instruments_dialog.bass_clef": ("bass clef", "ヘ音記号"),
    "instruments_dialog.beak": ("beak", "歌口（リコーダー型）"),
    "instruments_dialog.breath_lasts_to_s": ("breath: {soft} to {loud} s", "一息: {soft}～{loud} 秒"),
    "instruments_dialog.bundled": ("Bundled", "付属"),
    "instruments_dialog.cancel": ("Cancel", "キャンセル"),
    "instruments_dialog.cents": ("Cents", "セント"),
    "instruments_dialog.choice": ("Priority", "優先順位"),
    "instruments_dialog.click_keys_to_change_fingering": (
        "Click keys to change the fingering, or type it in the table.",
        "キーをクリックするか、表に入力して運指を変更します。",
    ),
    "instruments_dialog.close": ("Close", "閉じる"),
    "instruments_dialog.cup_mouthpiece": ("cup mouthpiece", "カップマウスピース"),
    "instruments_dialog.discard": ("Discard", "破棄"),
    "instruments_dialog.double_reed": ("double reed", "ダブルリード"),
    "instruments_dialog.every_fingering_that_is_right": (
        "All fingerings of this note are already in the table.",
        "この音の運指はすべて登録されています。",
    ),
    "instruments_dialog.files_of_your_own_that": (
        "Your files with errors (the last valid version stays in use):",
        "エラーのある自分のファイル（直前の有効な内容を引き続き使います）:",
    ),
    "instruments_dialog.fingering": ("Fingering", "運指"),
    "instruments_dialog.for": ("Use", "用途"),
    "instruments_dialog.higher_choice": ("Raise Priority", "優先順位を上げる"),
    "instruments_dialog.instruments": ("Instruments", "楽器"),
    "instruments_dialog.instruments_with_fingerings_that_are": (
        "Instruments with unsaved fingerings: {count}",
        "運指が未保存の楽器: {count} 個",
    ),
    "instruments_dialog.lip_plate": ("lip plate", "リッププレート"),
    "instruments_dialog.lower_choice": ("Lower Priority", "優先順位を下げる"),
    "instruments_dialog.model": ("model {file}", "モデル {file}"),
    "instruments_dialog.redo": ("Redo", "やり直す"),
    "instruments_dialog.remove": ("Remove", "削除"),
    "instruments_dialog.revert_all_notes": ("Revert All Notes", "すべての音を元に戻す"),
    "instruments_dialog.revert_this_note": ("Revert This Note", "この音を元に戻す"),
    "instruments_dialog.save": ("Save", "保存"),
    "instruments_dialog.save_as_my_own": ("Save to My Instruments", "自分の楽器に保存"),
    "instruments_dialog.seated": ("seated", "座奏"),
    "instruments_dialog.show_my_folder": ("Open My Folder", "自分のフォルダーを開く"),
    "instruments_dialog.single_reed": ("single reed", "シングルリード"),
    "instruments_dialog.sounds": ("Sounding", "実音"),
    "instruments_dialog.sounds_to": ("sounding {low} to {high}", "実音 {low}～{high}"),
    "instruments_dialog.standing": ("standing", "立奏"),
    "instruments_dialog.tenor_clef": ("tenor clef", "テノール記号"),
    "instruments_dialog.treble_clef": ("treble clef", "ト音記号"),
    "instruments_dialog.undo": ("Undo", "元に戻す"),
    "instruments_dialog.written": ("Written", "記譜音"),
    "instruments_dialog.written_to_semitones": (
        "written {low} to {high} ({semitones} semitones)",
        "記譜 {low}～{high}（{semitones} 半音）",
    ),
    "instruments_dialog.your_own_version": ("Your version: {file}", "自分のバージョン: {file}"),
    "joint.chest": ("Chest", "胸"),
    "joint.eye": ("Eye", "目"),
    "joint.foot": ("Foot", "足"),
    "joint.hand": ("Hand", "手"),
    "joint.head": ("Head", "頭"),
    "joint.hips": ("Hips", "腰"),
    "joint.index_finger": ("Index finger", "人差し指"),
    "joint.index_finger_base": ("Index finger, base", "人差し指・付け根"),
    "joint.index_finger_middle": ("Index finger, middle", "人差し指・中"),
    "joint.index_finger_tip": ("Index finger, tip", "人差し指・先"),
    "joint.jaw": ("Jaw", "顎"),
    "joint.l": ("{part} L", "{part} 左"),
    "joint.little_finger": ("Little finger", "小指"),
    "joint.little_finger_base": ("Little finger, base", "小指・付け根"),
    "joint.little_finger_middle": ("Little finger, middle", "小指・中"),
    "joint.little_finger_tip": ("Little finger, tip", "小指・先"),
    "joint.lower_arm": ("Lower arm", "前腕"),
    "joint.lower_leg": ("Lower leg", "すね"),
    "joint.middle_finger": ("Middle finger", "中指"),
    "joint.middle_finger_base": ("Middle finger, base", "中指・付け根"),
    "joint.middle_finger_middle": ("Middle finger, middle", "中指・中"),
    "joint.middle_finger_tip": ("Middle finger, tip", "中指・先"),
    "joint.neck": ("Neck", "首"),
    "joint.r": ("{part} R", "{part} 右"),
    "joint.ring_finger": ("Ring finger", "薬指"),
    "joint.ring_finger_base": ("Ring finger, base", "薬指・付け根"),
    "joint.ring_finger_middle": ("Ring finger, middle", "薬指・中"),
    "joint.ring_finger_tip": ("Ring finger, tip", "薬指・先"),
    "joint.shoulder": ("Shoulder", "肩"),
    "joint.spine": ("Spine", "背骨"),
    "joint.thumb": ("Thumb", "親指"),
    "joint.thumb_base": ("Thumb, base", "親指・付け根"),
    "joint.thumb_middle": ("Thumb, middle", "親指・中"),
    "joint.thumb_tip": ("Thumb, tip", "親指・先"),
    "joint.toes": ("Toes", "つま先"),
    "joint.upper_arm": ("Upper arm", "上腕"),
    "joint.upper_chest": ("Upper chest", "上胸"),
    "joint.upper_leg": ("Upper leg", "太もも"),
    "latency_dialog.blow_short_note_on_every": (
        "Play a short note on each click: {count} of {all}",
        "クリックごとに短く吹いてください: {count}/{all}",
    ),
    "latency_dialog.blow_short_note_on_every_click_what_is": (
        (
            "Play a short note on each click. The result is the combined delay of audio output and device. It "
            "includes your own timing, as most players are slightly early or late. You can also type a known value."
        ),
        (
            "クリックごとに短く吹いてください。オーディオ出力とデバイスを合わせた遅れを測定します。"
            "多くの人は少し早めか遅めに吹くため、演奏の癖も含まれます。正しい値が分かっている場合は入力できます。"
        ),
    ),
    "latency_dialog.close": ("Close", "閉じる"),
    "latency_dialog.comes_ms_late_of_hits": (
        "{device}: latency {count} ms ({used} of {all} hits used, deviation ±{spread} ms).",
        "{device} のレイテンシーは {count} ms です（{all} 回のうち {used} 回を使用、ばらつき ±{spread} ms）。",
    ),
    "latency_dialog.device_has_gone_or_take": (
        "Measurement stopped because the device was disconnected or recording started.",
        "デバイスが切断されたか録音が始まったため、測定を中止しました。",
    ),
    "latency_dialog.hits_differ_by_ms_too": (
        ("The hits deviate by ±{spread} ms, which is too much for a result. Try again with shorter, harder notes."),
        "ばらつきが ±{spread} ms と大きく、測定できません。もっと短くはっきりと吹いて、もう一度試してください。",
    ),
    "latency_dialog.it_is_taken_off_from": (
        "This latency will be compensated from now on.",
        "今後の録音でこのレイテンシーを補正します。",
    ),
    "latency_dialog.latency": ("Latency", "レイテンシー"),
    "latency_dialog.listen_and_play_along_first": (
        "Listen and play along. The first {count} clicks do not count.",
        "クリックに合わせて吹いてください。最初の {count} 回は数えません。",
    ),
    "latency_dialog.ms": ("ms", "ms"),
    "latency_dialog.ms_are_taken_off_now": (
        "{device}: {count} ms compensation is active.",
        "{device}: 現在 {count} ms を補正しています。",
    ),
    "latency_dialog.no_device_is_connected_choose": (
        "No device is connected. Select one in Record > MIDI Devices, or type a value.",
        "デバイスが接続されていません。「録音 > MIDI デバイス」で選ぶか、値を入力してください。",
    ),
    "latency_dialog.only_of_clicks_were_hit": (
        "Only {count} of {all} clicks were matched; at least {least} are required. Try again.",
        "{all} 回のうち {count} 回しか合いませんでした（{least} 回以上必要です）。もう一度試してください。",
    ),
    "latency_dialog.start": ("Start", "開始"),
    "latency_dialog.stop": ("Stop", "停止"),
    "latency_dialog.taken_off_time_of_everything": (
        "Compensation applied to all input from this device",
        "このデバイスからの入力すべてに適用する補正値",
    ),
    "latency_dialog.there_is_no_audio_device": (
        (
            "No audio output device was found. Play when the light flashes, and measure again once a device is "
            "connected."
        ),
        (
            "オーディオ出力デバイスが見つかりません。ライトの点滅に合わせて吹いてください。"
            "デバイスを接続したら測定し直してください。"
        ),
    ),
    "latency_dialog.use": ("Apply", "適用"),
    "learn_dialog.add": ("Add...", "追加..."),
    "learn_dialog.add_dancer_with_it": ("Add Dancer with This Choreography", "この振り付けでダンサーを追加"),
    "learn_dialog.add_motion_and_music": ("Add Motion and Music", "モーションと音楽を追加"),
    "learn_dialog.add_motion_files_and_midi": (
        "Add motion files and their MIDI files, or drop them here.",
        "モーションファイルと、対応する MIDI ファイルを追加するか、ここにドロップしてください。",
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
    "learn_dialog.motion_and_midi_files": ("Motion and MIDI files", "モーションと MIDI ファイル"),
    "learn_dialog.music": ("Music", "音楽"),
    "learn_dialog.neither_motion_nor_midi": (
        "Not a motion or MIDI file: {files}",
        "モーションでも MIDI でもないファイル: {files}",
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
    "learn_dialog.pair_choose_its_music": ("Pair {n}: select a MIDI file.", "組 {n}: MIDI ファイルを選んでください。"),
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
    "metadata_differences_dialog.close": ("Close", "閉じる"),
    "metadata_differences_dialog.in_file": ("In the file", "ファイル"),
    "metadata_differences_dialog.in_piece": ("In the piece", "曲"),
    "metadata_differences_dialog.metadata_of_piece_and_file": (
        "Metadata of the piece and {file}",
        "曲と {file} のメタデータ",
    ),
    "metadata_differences_dialog.place": ("Place", "場所"),
    "midi_devices_dialog.any": ("Any", "すべて"),
    "midi_devices_dialog.bite": ("Bite", "バイト"),
    "midi_devices_dialog.blow_now_soft_loud_and": (
        "Blow now: soft, loud, soft. {count} s",
        "吹いてください: 弱く、強く、弱く。あと {count} 秒",
    ),
    "midi_devices_dialog.breath": ("Breath", "ブレス"),
    "midi_devices_dialog.cancel": ("Cancel", "キャンセル"),
    "midi_devices_dialog.cannot_be_opened": ("cannot open", "開けません"),
    "midi_devices_dialog.channel": ("Channel", "チャンネル"),
    "midi_devices_dialog.chosen_device": ("Selected device", "選択中のデバイス"),
    "midi_devices_dialog.click_device_that_you_play": ("Select your device.", "使用するデバイスを選んでください。"),
    "midi_devices_dialog.close": ("Close", "閉じる"),
    "midi_devices_dialog.connect_wind_controller_by_usb": (
        ("Connect a wind controller by USB or a MIDI interface and switch it on. It then appears here automatically."),
        (
            "ウインドコントローラーを USB か MIDI インターフェースで接続し、電源を入れてください。"
            "自動的にここに表示されます。"
        ),
    ),
    "midi_devices_dialog.connected": ("connected", "接続済み"),
    "midi_devices_dialog.device": ("Device", "デバイス"),
    "midi_devices_dialog.devices": ("Devices", "デバイス"),
    "midi_devices_dialog.finds_with_what_breath_and": (
        "Detects which MIDI messages carry breath and bite ({count} s each). Esc to cancel.",
        "ブレスとバイトを送る MIDI メッセージを検出します（各 {count} 秒）。Esc で取り消します。",
    ),
    "midi_devices_dialog.found_breath_bite_channel": (
        "Detected: breath {source}, bite {bite}, channel {number}.",
        "検出結果: ブレス {source}、バイト {bite}、チャンネル {number}。",
    ),
    "midi_devices_dialog.found_breath_channel_no_bite": (
        "Detected: breath {source}, channel {number}. No bite was received.",
        "検出結果: ブレス {source}、チャンネル {number}。バイトは受信していません。",
    ),
    "midi_devices_dialog.kind": ("Kind", "種類"),
    "midi_devices_dialog.latency": ("Latency", "レイテンシー"),
    "midi_devices_dialog.learn_by_blowing": ("Detect Breath and Bite", "ブレスとバイトを検出"),
    "midi_devices_dialog.measure": ("Measure...", "測定..."),
    "midi_devices_dialog.midi_devices": ("MIDI Devices", "MIDI デバイス"),
    "midi_devices_dialog.ms": ("{count} ms", "{count} ms"),
    "midi_devices_dialog.no_breath_came_in_blow": (
        "No breath was received. Blow harder, or enable breath output on the device, and try again.",
        ("ブレスを受信しませんでした。もっと強く吹くか、デバイスのブレス送信を有効にして、もう一度試してください。"),
    ),
    "midi_devices_dialog.no_device": ("No device", "デバイスなし"),
    "midi_devices_dialog.nothing_came_in_from_device": (
        "Nothing was received from the device. Check that it is switched on.",
        "デバイスから何も受信しませんでした。電源が入っているか確認してください。",
    ),
    "midi_devices_dialog.now_blow_evenly_bite_and": (
        "Blow evenly, then bite and release several times. {count} s",
        "一定に吹きながら、リードを噛んで緩める動作を何度か繰り返してください。あと {count} 秒",
    ),
    "midi_devices_dialog.short_tone_on_audio_device": (
        "Plays a short tone on the audio output device",
        "オーディオ出力デバイスで短い音を再生",
    ),
    "midi_devices_dialog.state": ("State", "状態"),
    "midi_devices_dialog.test_beep": ("Test Beep", "テスト音"),
    "midi_devices_dialog.there_is_no_audio_device": (
        "No audio output device was found. Connect one and try again.",
        "オーディオ出力デバイスが見つかりません。接続してもう一度試してください。",
    ),
    "midi_devices_dialog.unplugged": ("disconnected", "切断"),
    "midi_devices_dialog.volume_of_transport_is_0": (
        "The volume in the transport bar is 0.",
        "トランスポートの音量が 0 です。",
    ),
    "midi_devices_dialog.waiting_for_it": ("waiting…", "待機中…"),
    "midi_devices_dialog.what_comes_in": ("Input monitor", "入力モニター"),
    "midi_devices_dialog.you_should_hear_short_tone": ("You should hear a short tone.", "短い音が聞こえれば正常です。"),
    "midi_monitor.begins_velocity": ("{pitch} on, velocity {value}", "{pitch} オン、ベロシティ {value}"),
    "midi_monitor.bite": ("Bite", "バイト"),
    "midi_monitor.breath": ("Breath", "ブレス"),
    "midi_monitor.channel": ("Channel {number}", "チャンネル {number}"),
    "midi_monitor.channel_2": ("{text}   (channel {number})", "{text}（チャンネル {number}）"),
    "midi_monitor.ends": ("{pitch} off", "{pitch} オフ"),
    "midi_monitor.last_messages": ("Recent messages", "最近のメッセージ"),
    "midi_monitor.nothing_has_come_in_yet": ("No messages received.", "メッセージを受信していません。"),
    "midi_monitor.plays_on_channel_but_only": (
        "Receiving on channel {number}, but only channel {requested} is enabled.",
        "チャンネル {number} で受信していますが、有効なのはチャンネル {requested} だけです。",
    ),
    "midi_monitor.pressure_on": ("Key pressure {pitch}: {value}", "{pitch} のキープレッシャー: {value}"),
    "midi_monitor.program": ("Program {value}", "プログラム {value}"),
    "midi_source.aftertouch": ("Aftertouch", "アフタータッチ"),
    "midi_source.cc_11_expression": ("CC 11 (expression)", "CC 11（エクスプレッション）"),
    "midi_source.cc_1_modulation": ("CC 1 (modulation)", "CC 1（モジュレーション）"),
    "midi_source.cc_2_breath": ("CC 2 (breath)", "CC 2（ブレス）"),
    "midi_source.cc_7_volume": ("CC 7 (volume)", "CC 7（ボリューム）"),
    "midi_source.nothing": ("None", "なし"),
    "midi_source.pitch_bend": ("Pitch bend", "ピッチベンド"),
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
    "pair_form.midi_files": ("MIDI files", "MIDI ファイル"),
    "pair_form.midi_with_percussion": ("MIDI with percussion", "打楽器を含む MIDI"),
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
    "pair_form.pair_is_motion_and_midi": (
        "A pair is a motion and the MIDI file of its music.",
        "組は、モーションと、その音楽の MIDI ファイルからなります。",
    ),
    "pair_form.reading_files": ("Reading files…", "ファイルを読み込み中…"),
    "pair_form.seconds": (" s", " 秒"),
    "pair_form.text_files": ("Text files", "テキストファイル"),
    "pair_form.time_of_motion_at_which": ("Motion time at which the music starts", "音楽が始まる、モーション内の時刻"),
    "pair_form.to_check": ("Check: {notes}", "要確認: {notes}"),
    "pair_form.true_frame_rate_of_motion": (
        "Correct frame rate of the motion, if the file states a wrong one",
        "ファイルの値が誤っている場合の、正しいフレームレート",
    ),
    "pair_form.txt_file_beside_motion": (".txt file next to the motion", "モーションと同じフォルダーの .txt"),
    "piece_settings_dialog.all_but_title_as_in": (
        "Reset everything except the title to the values of a new piece",
        "タイトル以外を新しい曲の初期値に戻します",
    ),
    "piece_settings_dialog.another_seed_is_another_performance": (
        "Another seed gives another performance: other sways and glances",
        "シードを変えると、体の揺れや視線の違う演奏になります",
    ),
    "piece_settings_dialog.automatic_by_metre_and_tempo": (
        "Automatic (from time signature and tempo)",
        "自動（拍子とテンポから）",
    ),
    "piece_settings_dialog.beats": (" beats", " 拍"),
    "piece_settings_dialog.breaths_cues_sway_and_pre": (
        "Unit of breaths, cues, sway and pre-roll",
        "ブレス、合図、体の揺れ、プリロールの単位",
    ),
    "piece_settings_dialog.conductor": ("Conductor", "指揮者"),
    "piece_settings_dialog.conductor_ahead": (
        "Towards the audience from the middle of the stage",
        "ステージ中央から客席側への距離",
    ),
    "piece_settings_dialog.conductor_gives_entries": ("On stage, gives the entries", "ステージ上で入りの合図を出す"),
    "piece_settings_dialog.conductor_left": (
        "To the right of the audience from the middle of the stage",
        "ステージ中央から客席の右手側への距離",
    ),
    "piece_settings_dialog.conductor_tip": (
        "For a conductor whom you animate yourself: players look up there instead of cueing each other.\n"
        "Off: no one stands there, and the players cue each other.",
        "指揮者を自分でアニメーションする場合にオン: 奏者は互いに合図せず、指揮者を見ます。\n"
        "オフ: 指揮者はおらず、奏者どうしで合図します。",
    ),
    "piece_settings_dialog.cancel": ("Cancel", "キャンセル"),
    "piece_settings_dialog.dotted_eighth": ("Dotted eighth", "付点8分音符"),
    "piece_settings_dialog.dotted_half": ("Dotted half", "付点2分音符"),
    "piece_settings_dialog.dotted_quarter": ("Dotted quarter", "付点4分音符"),
    "piece_settings_dialog.eighth": ("Eighth", "8分音符"),
    "piece_settings_dialog.felt_beat": ("Beat unit", "拍の単位"),
    "piece_settings_dialog.felt_beats_before_first_note": (
        "Beats before the first note, at least one second",
        "最初の音符までの拍数（少なくとも 1 秒）",
    ),
    "piece_settings_dialog.frame_rate": ("Frame rate", "フレームレート"),
    "piece_settings_dialog.frame_rate_type_number_from": (
        "Frame rate: enter a number from {low} to {high}, such as 24, 29.97 or 30000/1001.",
        "フレームレート: {low} から {high} までの数を入力してください（例: 24、29.97、30000/1001）。",
    ),
    "piece_settings_dialog.half": ("Half", "2分音符"),
    "piece_settings_dialog.multiplies_acting_of_all_players": (
        "Multiplies the acting of all players: 0 none, 1 as their styles and parameters, 2 twice as much",
        "全奏者の演技に掛ける倍率。0 でなし、1 でスタイルとパラメーターどおり、2 で 2 倍",
    ),
    "piece_settings_dialog.names_piece_in_midi_file": (
        "Name of the piece in MIDI files and in Unreal",
        "MIDI ファイルと Unreal で使われる曲名",
    ),
    "piece_settings_dialog.of_ruler_and_of_steps": (
        "For the ruler and frame steps; the default for exports",
        "ルーラーとコマ送りに使われ、書き出しの初期値になります",
    ),
    "piece_settings_dialog.ok": ("OK", "OK"),
    "piece_settings_dialog.piece_settings": ("Piece Settings", "曲の設定"),
    "piece_settings_dialog.pre_roll": ("Pre-roll", "プリロール"),
    "piece_settings_dialog.quarter": ("Quarter", "4分音符"),
    "piece_settings_dialog.quarters": ("{count} quarter notes", "四分音符 {count} 個分"),
    "piece_settings_dialog.randomise": ("Randomise", "ランダム"),
    "piece_settings_dialog.reset_to_defaults": ("Reset to Defaults", "初期値に戻す"),
    "piece_settings_dialog.seed": ("Seed", "シード"),
    "piece_settings_dialog.seed_type_whole_number_from": (
        "Seed: enter a whole number from {low} to {high}.",
        "シード: {low} から {high} までの整数を入力してください。",
    ),
    "piece_settings_dialog.section_intensity": ("Section intensity", "全体の演技の強さ"),
    "piece_settings_dialog.sixteenth": ("Sixteenth", "16分音符"),
    "piece_settings_dialog.times": (" ×", " ×"),
    "piece_settings_dialog.title": ("Title", "タイトル"),
    "piece_settings_dialog.whole": ("Whole", "全音符"),
    "place_chooser.choose": ("Browse...", "参照..."),
    "place_chooser.choose_folder": ("Select a folder.", "フォルダーを選んでください。"),
    "place_chooser.choose_uproject_file_of_your": (
        "Select the .uproject file of your Unreal project.",
        "Unreal プロジェクトの .uproject ファイルを選んでください。",
    ),
    "place_chooser.folder": ("Folder", "フォルダー"),
    "place_chooser.folder_for_files": ("Destination folder", "書き出し先フォルダー"),
    "place_chooser.folder_of_files": ("Folder", "フォルダー"),
    "place_chooser.unreal_project": ("Unreal project", "Unreal プロジェクト"),
    "place_chooser.unreal_project_2": ("Unreal project", "Unreal プロジェクト"),
    "place_chooser.uproject_file": (".uproject file", ".uproject ファイル"),
    "playblast_dialog.as_viewport_shows_it": ("Current viewport", "現在のビューポート"),
    "playblast_dialog.choose": ("Browse...", "参照..."),
    "playblast_dialog.ensemble": ("Ensemble", "全体"),
    "playblast_dialog.feet": ("Feet", "足元"),
    "playblast_dialog.file": ("File", "ファイル"),
    "playblast_dialog.film": ("Video", "動画"),
    "playblast_dialog.film_is_written": ("Video saved: {file}", "動画を保存しました: {file}"),
    "playblast_dialog.films_mp4": ("Videos (*.mp4)", "動画 (*.mp4)"),
    "playblast_dialog.frames_per_second": ("Frames per second", "フレームレート"),
    "playblast_dialog.front": ("Front", "正面"),
    "playblast_dialog.hands": ("Hands", "手元"),
    "playblast_dialog.loop": ("Loop", "ループ範囲"),
    "playblast_dialog.make_film": ("Create Video", "動画を作成"),
    "playblast_dialog.mouth": ("Mouth", "口元"),
    "playblast_dialog.playblast": ("Playblast", "プレイブラスト"),
    "playblast_dialog.range": ("Range", "範囲"),
    "playblast_dialog.selection": ("Selection", "選択範囲"),
    "playblast_dialog.side": ("Side", "側面"),
    "playblast_dialog.size": ("Size", "サイズ"),
    "playblast_dialog.sound": ("Audio", "オーディオ"),
    "playblast_dialog.this_file_is_there_and": (
        "The file already exists and will be replaced.",
        "ファイルは既に存在し、上書きされます。",
    ),
    "playblast_dialog.top": ("Top", "上面"),
    "playblast_dialog.view": ("View", "ビュー"),
    "playblast_dialog.whole_piece": ("Whole piece", "曲全体"),
    "playblast_dialog.include_audio": ("Include Audio", "オーディオを含める"),
    "preferences_dialog.general": ("General", "一般"),
    "preferences_dialog.instruments": ("Instruments", "楽器"),
    "preferences_dialog.keyboard_shortcuts": ("Keyboard Shortcuts", "キーボードショートカット"),
    "preferences_dialog.preferences": ("Preferences", "環境設定"),
    "preferences_dialog.show_folder": ("Open Folder", "フォルダーを開く"),
    "preferences_dialog.your_own": ("Your instruments: {maps}", "自分の楽器: {maps}"),
    "preferences_dialog.your_own_instruments_map_toml": (
        ("Folder for your instruments. Each has a map (.toml) and a model (.glb). Changes are loaded automatically."),
        ("自分の楽器のフォルダー。楽器ごとにマップ（.toml）とモデル（.glb）を置きます。変更は自動で読み込まれます。"),
    ),
    "range_chooser.bars": ("Bars", "小節"),
    "range_chooser.bars_of_selection": ("Selected bars", "選択した小節"),
    "range_chooser.last_bar_comes_before_first": (
        "The last bar is before the first bar.",
        "最後の小節が最初の小節より前にあります。",
    ),
    "range_chooser.whole_piece": ("Whole piece", "曲全体"),
    "reimport_dialog.cancel": ("Cancel", "キャンセル"),
    "reimport_dialog.changed_by_hand": ("Edited here", "手動修正"),
    "reimport_dialog.changed_here_and_in_file": (
        "Notes changed both here and in the file take the version from the file ({count})",
        "ここでもファイルでも変更された音符は、ファイルの内容になります（{count}）",
    ),
    "reimport_dialog.controllers": ("controllers", "コントローラー"),
    "reimport_dialog.erased": ("deleted", "削除済み"),
    "reimport_dialog.gone": ("Removed", "削除"),
    "reimport_dialog.kept": ("Kept", "維持"),
    "reimport_dialog.metres": ("time signatures", "拍子"),
    "reimport_dialog.new": ("New", "新規"),
    "reimport_dialog.new_parts_without_player": (
        "New parts without a player. To give one a player, import the file again as a new project:",
        "奏者のいない新しいパートです。奏者を付けるには、新規プロジェクトとして読み込んでください:",
    ),
    "reimport_dialog.new_players": ("New players: {names}", "新しい奏者: {names}"),
    "reimport_dialog.not_in_file_any_more": ("no longer in the file", "ファイルに存在しません"),
    "reimport_dialog.part": ("Part", "パート"),
    "reimport_dialog.players_whose_part_is_gone": (
        "These players' parts are no longer in the file. They keep their notes; check the players to remove:",
        "次の奏者のパートはファイルにありません。奏者と音符は残ります。削除する奏者をチェックしてください:",
    ),
    "reimport_dialog.re_import": ("Re-import", "再読み込み"),
    "reimport_dialog.re_import_midi": ("Re-import MIDI", "MIDI の再読み込み"),
    "reimport_dialog.replaced_by_file": (
        "Changed both here and in the file; the version from the file is used: {kinds}",
        "ここでもファイルでも変更されているため、ファイルの内容になります: {kinds}",
    ),
    "reimport_dialog.says_nothing_new": ("{file} contains no changes.", "{file} に変更はありません。"),
    "reimport_dialog.says_nothing_new_but_lies_elsewhere": (
        "{file} contains no changes. Re-import it to use this file from now on.",
        "{file} に変更はありません。再読み込みすると、今後はこのファイルを使います。",
    ),
    "reimport_dialog.tempo": ("tempo", "テンポ"),
    "reimport_dialog.these_corrections_have_lost_their": (
        "These corrections no longer have a matching note. They are kept; re-attach them in the inspector:",
        "次の手動修正は対応する音符がなくなりました。残してあるので、インスペクターで付け直してください:",
    ),
    "reimport_dialog.what_changes_fingerings_breaths_and": (
        (
            "Changes from {file}. Manual corrections stay with their notes, and notes edited here are kept unless "
            "the file changed them too. The update can be undone."
        ),
        (
            "{file} による変更内容です。手動修正は音符とともに残り、ここで変更した音符も、"
            "ファイル側で変更されていなければ残ります。この更新は元に戻せます。"
        ),
    ),
    "shortcuts_page.action": ("Command", "コマンド"),
    "shortcuts_page.all_back_to_default": ("Reset All to Default", "すべて既定に戻す"),
    "shortcuts_page.assign": ("Assign", "割り当て"),
    "shortcuts_page.default": ("Reset to Default", "既定に戻す"),
    "shortcuts_page.keys": ("Shortcut", "ショートカット"),
    "shortcuts_page.menu": ("Menu", "メニュー"),
    "shortcuts_page.new_keys": ("New shortcut", "新しいショートカット"),
    "shortcuts_page.opens_menu_choose_other_keys": (
        "This shortcut opens the menu {menu}. Select another one.",
        "「{menu}」メニューを開くショートカットです。別のキーを選んでください。",
    ),
    "shortcuts_page.remove_keys": ("Remove Shortcut", "ショートカットを削除"),
    "shortcuts_page.search_actions_or_keys": ("Search commands or shortcuts", "コマンドまたはショートカットを検索"),
    "shortcuts_page.used_by_assigning_takes_it": (
        "Used by: {names}. Assigning removes it there.",
        "使用中: {names}。割り当てると、そちらから削除されます。",
    ),
    "shortcuts_page.works": ("Context", "有効な場所"),
    "rig_chooser.instrument_free": ("Instrument: Free", "楽器: 独立"),
    "rig_chooser.instrument_on_ik_target": ("Instrument: On IK Target", "楽器: IK ターゲットに固定"),
    "rig_chooser.instrument_on_socket": ("Instrument: On Hand Socket", "楽器: 手のソケットに固定"),
    "rig_chooser.rest_a_pose": ("Rest Pose: A-Pose", "レストポーズ: A ポーズ"),
    "rig_chooser.rest_as_modelled": ("Rest Pose: As Modelled", "レストポーズ: モデルのまま"),
    "rig_chooser.rest_t_pose": ("Rest Pose: T-Pose", "レストポーズ: T ポーズ"),
    "rig_chooser.root_at_origin": ("Root Bone: At Origin", "ルートボーン: 原点"),
    "rig_chooser.root_at_place": ("Root Bone: At Stage Position", "ルートボーン: ステージ上の位置"),
    "rig_chooser.root_in_motion": ("Root Bone: Root Motion", "ルートボーン: ルートモーション"),
    "rig_chooser.twist_bones": ("Twist bones of the arms", "腕のツイストボーン"),
    "skeleton_chooser.and_more": ("and {count} more", "ほか {count} 件"),
    "skeleton_chooser.asset_has_another_skeleton_its": (
        "The asset has a different skeleton; its animation would be lost or damaged.",
        "アセットのスケルトンが異なるため、アニメーションが失われるか崩れます。",
    ),
    "skeleton_chooser.characters": ("Characters", "キャラクター"),
    "skeleton_chooser.choose": ("Browse...", "参照..."),
    "skeleton_chooser.comparing": ("Comparing…", "比較中…"),
    "skeleton_chooser.every_bone_is_as_in": (
        "✓ All bones match the asset.",
        "✓ すべてのボーンがアセットと一致します。",
    ),
    "skeleton_chooser.fbx_of_asset_to_compare": (
        "Asset FBX to compare with (optional)",
        "比較するアセットの FBX（任意）",
    ),
    "skeleton_chooser.file_of_asset": ("Asset file", "アセットのファイル"),
    "skeleton_chooser.of_characters_own_file": ("From the character file", "キャラクターのファイルと同じ"),
    "skeleton_chooser.skeletons_are_being_compared": ("Comparing skeletons…", "スケルトンを比較中…"),
    "skeleton_chooser.suisou_vrm_1_0": ("Suisou (VRM 1.0)", "Suisou（VRM 1.0）"),
    "skeleton_chooser.there_is_no_file_of": (
        "The file to compare with was not found.",
        "比較するファイルが見つかりません。",
    ),
    "skeleton_chooser.unreal_engine_5_mannequin": ("Unreal Engine 5 mannequin", "Unreal Engine 5 マネキン"),
    "skeleton_chooser.with_fbx_of_mannequin_exported": (
        (
            "With an FBX of the mannequin exported from Unreal, its rest rotations are used. Otherwise the "
            "standard axes are used; retarget with Unreal's IK Retargeter."
        ),
        (
            "Unreal から書き出したマネキンの FBX を指定すると、そのレスト回転を使います。"
            "指定しない場合は標準の軸になるため、Unreal の IK リターゲッターを使ってください。"
        ),
    ),
    "stream_dialog.arkit_jawopen": ("ARKit: jawOpen", "ARKit: jawOpen"),
    "stream_dialog.arkit_with_capitals_jawopen_perfect": (
        "ARKit, capitalised: JawOpen (Perfect Sync)",
        "ARKit、頭文字が大文字: JawOpen（パーフェクトシンク）",
    ),
    "stream_dialog.close": ("Close", "閉じる"),
    "stream_dialog.computer": ("Destination computer", "送信先のコンピューター"),
    "stream_dialog.everyone_on_stage_each_on": (
        "All performers, each on a separate port",
        "全出演者（1 人ずつ別のポート、ステージ上の位置のまま）",
    ),
    "stream_dialog.frames_per_second": ("Frames per second", "フレームレート"),
    "stream_dialog.live_stream": ("Live Stream", "ライブ配信"),
    "stream_dialog.looking_for": ("Resolving {host}…", "{host} を検索中…"),
    "stream_dialog.names_of_face": ("Blendshape naming", "ブレンドシェイプの命名"),
    "stream_dialog.no_receiver_there_yet_start": (
        "No receiver found at the destination. Start receiving in the other program, on the same port.",
        "送信先に受信側が見つかりません。受信側のプログラムで、同じポートの受信を開始してください。",
    ),
    "stream_dialog.not_sent": ("{name}: not sent. {reason}", "{name}: 送信していません。{reason}"),
    "stream_dialog.nothing_is_sent": ("Not streaming.", "配信していません。"),
    "stream_dialog.performer": ("Performer", "出演者"),
    "stream_dialog.performers": ("Performers", "出演者"),
    "stream_dialog.port": ("Port", "ポート"),
    "stream_dialog.selected_player_in_middle": ("Selected player, at centre stage", "選択した奏者（ステージの中央）"),
    "stream_dialog.send_anyway": ("Send Anyway", "それでも送信"),
    "stream_dialog.sending_frames_per_second_fewer": (
        "Sending {count} frames per second; fewer when nothing moves.",
        "毎秒 {count} フレームを送信しています（動きがないときは少なくなります）。",
    ),
    "stream_dialog.sends_performers_poses_faces_and": (
        (
            "Sends the poses, faces and instruments of the performers through the VMC protocol during playback, "
            "scrubbing and recording. Unreal (VMC4UE), VSeeFace, Warudo and Blender add-ons can receive it. Each "
            "port carries one character."
        ),
        (
            "再生・スクラブ・録音中に、出演者のポーズ、表情、楽器を VMC プロトコルで送信します。Unreal（VMC4UE）、"
            "VSeeFace、Warudo、Blender のアドオンなどで受信できます。1 つのポートで 1 キャラクターです。"
        ),
    ),
    "stream_dialog.start_streaming": ("Start Streaming", "配信を開始"),
    "stream_dialog.stop_streaming": ("Stop Streaming", "配信を停止"),
    "stream_dialog.this_computer": ("This Computer", "このコンピューター"),
    "stream_dialog.vrm_presets_blink_l_joy": ("VRM presets: A, Blink_L, Joy", "VRM プリセット: A、Blink_L、Joy"),
    "stream_dialog.what_is_sent_leaves_this": (
        (
            "The stream leaves this computer and can be read by anyone on the network. Allow this port in the "
            "firewall of the receiving computer."
        ),
        (
            "配信内容はこのコンピューターの外に送信され、ネットワーク上の誰でも読み取れます。"
            "受信側のコンピューターのファイアウォールで、このポートを許可してください。"
        ),
    ),
    "working_dialog.cancel": ("Cancel", "キャンセル"),
    "working_dialog.close": ("Close", "閉じる"),
    "working_dialog.show_in_folder": ("Show in Folder", "フォルダーで表示"),
    "rules_dialog.accent": ("Accent: louder than around it by", "アクセント: 周囲との音量差"),
    "rules_dialog.add": ("Add", "追加"),
    "rules_dialog.add_tip": ("Add a rule (Ins)", "ルールを追加（Ins）"),
    "rules_dialog.anchor_end": ("End of the note", "音符の終わり"),
    "rules_dialog.anchor_onset": ("Onset of the note", "音符の始まり"),
    "rules_dialog.any": ("Any", "指定なし"),
    "rules_dialog.apart": ("At least apart", "最小の間隔"),
    "rules_dialog.apart_tip": (
        "From one time to the next; expressions closer than this become one",
        "次に行うまでの最小の時間。これより近い表情は一つにまとめられます",
    ),
    "rules_dialog.cancel": ("Cancel", "キャンセル"),
    "rules_dialog.chance": ("Probability", "確率"),
    "rules_dialog.changed_from_ours": ("Bundled rule that you changed", "変更した付属のルール"),
    "rules_dialog.do": ("Do", "動作"),
    "rules_dialog.does": ("What", "内容"),
    "rules_dialog.duplicate": ("Duplicate", "複製"),
    "rules_dialog.duplicate_tip": ("Duplicate the selected rule (Ctrl+D)", "選択したルールを複製（Ctrl+D）"),
    "rules_dialog.effort_above": ("Effort at least", "負担が次の値以上"),
    "rules_dialog.ends": ("Ends after", "終了位置"),
    "rules_dialog.expression": ("Expression: {name}", "表情: {name}"),
    "rules_dialog.fade_in": ("Fade in", "フェードイン"),
    "rules_dialog.fade_out": ("Fade out", "フェードアウト"),
    "rules_dialog.fault_do": (
        "choose an expression or a gesture under What.",
        "「内容」で表情かジェスチャーを選んでください。",
    ),
    "rules_dialog.fault_fades": (
        "a gesture has its own fades; turn Fade in and Fade out off.",
        "ジェスチャーは独自のフェードを持ちます。「フェードイン」と「フェードアウト」をオフにしてください。",
    ),
    "rules_dialog.fault_growth": (
        "to grow with {growth}, turn on the condition “{needed}”.",
        "{growth}に比例させるには、条件「{needed}」をオンにしてください。",
    ),
    "rules_dialog.fault_growth_at_moment": (
        "a moment has nothing to grow with; leave Grows with at Nothing.",
        "音符以外のタイミングでは「強さを決めるもの」を「なし」にしてください。",
    ),
    "rules_dialog.fault_moment": (
        "moments are for expressions; choose Note under Moment, or an expression.",
        "このタイミングは表情用です。「タイミング」を「音符」にするか、表情を選んでください。",
    ),
    "rules_dialog.fault_name": (
        "a name in the file must be letters, digits and underscores; rename it there.",
        "ファイル内の名前には英数字とアンダースコアだけが使えます。ファイルで名前を変えてください。",
    ),
    "rules_dialog.fault_stays": (
        "a gesture ends when it is done; set Stays longer to 0.",
        "ジェスチャーは終われば消えます。「余韻」を 0 にしてください。",
    ),
    "rules_dialog.fault_when": (
        "turn on a condition, or choose a place, a style, a habit or a moment.",
        "条件をオンにするか、位置・演奏スタイル・癖・タイミングを選んでください。",
    ),
    "rules_dialog.gesture": ("Gesture: {name}", "ジェスチャー: {name}"),
    "rules_dialog.grows_from": ("Least share of the strength", "強さの最小の割合"),
    "rules_dialog.grows_with": ("Grows with", "強さを決めるもの"),
    "rules_dialog.grows_with_tip": (
        "The strength is reached where this is at its most; of several it goes with their mean",
        "これが最大のときに設定した強さになります。複数選ぶと平均で決まります",
    ),
    "rules_dialog.growth_accent": ("accent", "アクセント"),
    "rules_dialog.growth_depth": ("depth", "音の低さ"),
    "rules_dialog.growth_effort": ("effort", "負担"),
    "rules_dialog.growth_height": ("height", "音の高さ"),
    "rules_dialog.growth_length": ("length", "長さ"),
    "rules_dialog.growth_loudness": ("loudness", "音量"),
    "rules_dialog.habits": ("Habits", "癖"),
    "rules_dialog.leap_down": ("Leap down of at least", "次の値以上の下行跳躍"),
    "rules_dialog.leap_up": ("Leap up of at least", "次の値以上の上行跳躍"),
    "rules_dialog.list_tip": (
        "Space switches a rule on and off; * marks your own",
        "スペースキーでルールのオンとオフを切り替えます。* は自分のルールです",
    ),
    "rules_dialog.longer_s": ("Lasts at least", "長さが次の値以上"),
    "rules_dialog.loudness_above": ("Loudness at least", "音量が次の値以上"),
    "rules_dialog.loudness_below": ("Loudness at most", "音量が次の値以下"),
    "rules_dialog.moment": ("Moment", "タイミング"),
    "rules_dialog.moment_ending": ("After a bright end", "明るい終わりの後"),
    "rules_dialog.moment_gives_entry": ("Gives an entry", "入りの合図を出すとき"),
    "rules_dialog.moment_note": ("Note", "音符"),
    "rules_dialog.moment_takes_entry": ("Breath before an entry", "入りの前のブレス"),
    "rules_dialog.not_styles": ("Except styles", "除外するスタイル"),
    "rules_dialog.nothing": ("Nothing", "なし"),
    "rules_dialog.ours": ("Bundled rule", "付属のルール"),
    "rules_dialog.place": ("Place", "位置"),
    "rules_dialog.place_after_rest": ("after a rest", "休みの後"),
    "rules_dialog.place_before_rest": ("before a rest", "休みの前"),
    "rules_dialog.place_climax": ("climax of a phrase", "フレーズの頂点"),
    "rules_dialog.place_first": ("first note", "最初の音符"),
    "rules_dialog.place_last": ("last note", "最後の音符"),
    "rules_dialog.place_phrase_end": ("end of a phrase", "フレーズの終わり"),
    "rules_dialog.played_longer_s": ("Has played for at least", "演奏した時間が次の値以上"),
    "rules_dialog.preview": ("Preview", "プレビュー"),
    "rules_dialog.preview_tip": (
        "Play by these rules now, without saving them",
        "保存せずに、このルールで今すぐ生成し直します",
    ),
    "rules_dialog.remove": ("Remove", "削除"),
    "rules_dialog.remove_tip": (
        "Remove your rule, undo your changes, or switch a bundled rule off (Del)",
        "自分のルールを削除、変更を取り消し、または付属のルールをオフにします（Del）",
    ),
    "rules_dialog.rest_after_longer_s": ("Rest after it at least", "後の休みが次の値以上"),
    "rules_dialog.rest_longer_s": ("Rest before it at least", "前の休みが次の値以上"),
    "rules_dialog.revert": ("Revert", "元に戻す"),
    "rules_dialog.rule_number": ("Rule {number}", "ルール {number}"),
    "rules_dialog.rules": ("Acting Rules", "演技のルール"),
    "rules_dialog.save": ("Save", "保存"),
    "rules_dialog.save_tip": ("Save the rules (Ctrl+Enter)", "ルールを保存（Ctrl+Enter）"),
    "rules_dialog.saved_in": ("Saved in {folder}", "保存先: {folder}"),
    "rules_dialog.scaled_by_puff": (
        "As far as the instrument lets air into the cheeks",
        "楽器によるほおの膨らみやすさに比例",
    ),
    "rules_dialog.semitones_above_easy": ("Above the easy range by at least", "楽な音域より次の値以上高い"),
    "rules_dialog.semitones_below_easy": ("Below the easy range by at least", "楽な音域より次の値以上低い"),
    "rules_dialog.shorter_s": ("Lasts at most", "長さが次の値以下"),
    "rules_dialog.spread": ("Starts later by up to", "開始を遅らせる最大値"),
    "rules_dialog.spread_tip": (
        "A gesture begins up to so much later, differently by player, place and seed, so that no two begin at once",
        "ジェスチャーの開始を、奏者、位置、シードに応じて最大でこの時間だけ遅らせ、同時に始まらないようにします",
    ),
    "rules_dialog.starts": ("Starts after", "開始位置"),
    "rules_dialog.stays": ("Stays longer by", "余韻"),
    "rules_dialog.stays_tip": (
        "An expression stays so much longer, up to the next one of the rule",
        "表情がこの時間だけ長く残ります（同じルールの次の表情まで）",
    ),
    "rules_dialog.strength": ("Strength", "強さ"),
    "rules_dialog.styles": ("Styles", "演奏スタイル"),
    "rules_dialog.switch_off": ("Switch Off", "オフにする"),
    "rules_dialog.title": ("Title", "名前"),
    "rules_dialog.unit_percent": (" %", " %"),
    "rules_dialog.unit_s": (" s", " 秒"),
    "rules_dialog.unit_semitones": (" semitones", " 半音"),
    "rules_dialog.when": ("When", "条件"),
    "rules_dialog.yours": ("Your own rule", "自分のルール"),
}
