"""Texts of the dialogs that read MIDI files and recordings: id -> English and Japanese."""

from __future__ import annotations

from typing import Final

TEXTS: Final[dict[str, tuple[str, str]]] = {
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
    "import_dialog.import_midi": ("Import", "読み込み"),
    "import_dialog.instrument": ("Instrument", "楽器"),
    "import_dialog.is_not_played": ("{name} will not be played: {reason}", "{name} は演奏されません: {reason}"),
    "import_dialog.is_not_played_dancers_dance": (
        "{name} will not be played: {reason}. Dancers use it as percussion.",
        "{name} は演奏されません: {reason}。ダンサーが打楽器として使います。",
    ),
    "import_dialog.left_out_of_part": ("{name}: {reason}.", "{name}: {reason}。"),
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
    "import_dialog.player": ("Player {number}", "奏者 {number}"),
    "import_dialog.player_tip": (
        "The instrument of this player alone; Automatic takes that of the part",
        "この奏者だけの楽器です。「自動」ではパートの楽器になります",
    ),
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
    "reimport_dialog.notes_left_out": ("Notes left out of parts that are played:", "演奏されるパートから除いた音:"),
    "reimport_dialog.not_in_file_any_more": ("no longer in the file", "ファイルに存在しません"),
    "reimport_dialog.players_whose_part_is_gone": (
        "These players' parts are no longer in the file. They keep their notes; check the players to remove:",
        "次の奏者のパートはファイルにありません。奏者と音符は残ります。削除する奏者をチェックしてください:",
    ),
    "reimport_dialog.re_import": ("Re-import", "再読み込み"),
    "reimport_dialog.re_import_midi": ("Re-import File", "ファイルの再読み込み"),
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
            "Changes from {file}. Uncheck players whose notes are to stay. Manual corrections stay with their notes, "
            "and notes edited here are kept unless the file changed them too. The update can be undone."
        ),
        (
            "{file} による変更内容です。今の音符を残す奏者はチェックを外してください。"
            "手動修正は音符とともに残り、ここで変更した音符も、"
            "ファイル側で変更されていなければ残ります。この更新は元に戻せます。"
        ),
    ),
    "reimport_dialog.all_changes": ("All Changes", "すべての変更"),
    "reimport_dialog.and": (", ", "、"),
    "reimport_dialog.bar": ("{count} bar", "{count} 小節"),
    "reimport_dialog.bars": ("{count} bars", "{count} 小節"),
    "reimport_dialog.change": ("Changes", "変更内容"),
    "reimport_dialog.controllers_changed": ("Controllers or mutes changed", "コントローラーまたはミュートの変更"),
    "reimport_dialog.count.added": ("{count} added", "追加 {count}"),
    "reimport_dialog.count.changed": ("{count} changed", "変更 {count}"),
    "reimport_dialog.count.controllers": ("controllers", "コントローラー"),
    "reimport_dialog.count.marks": ("marks: {count}", "記号 {count}"),
    "reimport_dialog.count.moved": ("{count} moved", "移動 {count}"),
    "reimport_dialog.count.removed": ("{count} removed", "削除 {count}"),
    "reimport_dialog.for_whole_piece": ("Also changed, for all players: {kinds}", "全奏者に共通の変更: {kinds}"),
    "reimport_dialog.length_changed": ("length {before} → {now}", "長さ {before} → {now}"),
    "reimport_dialog.mark.added": ("{mark} added", "{mark}を追加"),
    "reimport_dialog.mark.changed": ("{mark} moved", "{mark}を移動"),
    "reimport_dialog.mark.removed": ("{mark} removed", "{mark}を削除"),
    "reimport_dialog.next": ("Next", "次へ"),
    "reimport_dialog.next_change_tip": ("Go to the next change (F8)", "次の変更へ移動（F8）"),
    "reimport_dialog.no_changes": ("no changes", "変更なし"),
    "reimport_dialog.note.added": ("{pitch} added", "{pitch} を追加"),
    "reimport_dialog.note.moved": ("{pitch} moved by {distance}", "{pitch} を {distance} 移動"),
    "reimport_dialog.note.removed": ("{pitch} removed", "{pitch} を削除"),
    "reimport_dialog.notes_moved": ("{count} notes moved by {distance}", "{count} 個の音符を {distance} 移動"),
    "reimport_dialog.only_added": ("Added", "追加"),
    "reimport_dialog.only_changed": ("Pitch, Length or Velocity", "音高・長さ・ベロシティ"),
    "reimport_dialog.only_controllers": ("Controllers and Mutes", "コントローラーとミュート"),
    "reimport_dialog.only_marks": ("Marks", "記号"),
    "reimport_dialog.only_moved": ("Moved", "移動"),
    "reimport_dialog.only_removed": ("Removed", "削除"),
    "reimport_dialog.player": ("Player", "奏者"),
    "reimport_dialog.previous": ("Previous", "前へ"),
    "reimport_dialog.previous_change_tip": ("Go to the previous change (Shift+F8)", "前の変更へ移動（Shift+F8）"),
    "reimport_dialog.ticks": ("{count} ticks", "{count} ティック"),
    "reimport_dialog.velocity_changed": ("velocity {before} → {now}", "ベロシティ {before} → {now}"),
}
