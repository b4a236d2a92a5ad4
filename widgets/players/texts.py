"""Texts of players: id -> English and Japanese."""

from __future__ import annotations

from typing import Final

TEXTS: Final[dict[str, tuple[str, str]]] = {
    "acting_rows.some_of_the_selected": ("Selected players with it: {count}", "選択した奏者のうち {count} 人"),
    "body_dance_rows.another_dance_for_each": (
        "Assign a different variation to each",
        "それぞれに別のバリエーションを割り当てる",
    ),
    "body_dance_rows.choreographies": ("Choreographies", "振り付け"),
    "body_dance_rows.choreography": ("Choreography", "振り付け"),
    "body_dance_rows.from_file": ("From File...", "ファイルから..."),
    "body_dance_rows.generated": ("Generated", "自動生成"),
    "layer_switch.show_layer": ("Show layer: {layer}", "レイヤーを表示: {layer}"),
    "parameter_sections.acting": ("Acting", "演技"),
    "parameter_sections.another_seed_for_each": ("Assign a different seed to each", "それぞれに別のシードを割り当てる"),
    "parameter_sections.breath": ("Breath", "ブレス"),
    "parameter_sections.character": ("Character", "キャラクター"),
    "parameter_sections.colour": ("Colour", "色"),
    "parameter_sections.colour_of_player_in_timeline": (
        "Colour of the player in the timeline and on the stage",
        "タイムラインとステージでの奏者の色",
    ),
    "parameter_sections.face": ("Face", "顔"),
    "parameter_sections.instrument": ("Instrument", "楽器"),
    "parameter_sections.motion": ("Motion", "動き"),
    "parameter_sections.part": ("Part", "パート"),
    "parameter_sections.played_seated_only": ("Seated only: {players}", "座奏のみ: {players}"),
    "parameter_sections.played_standing_only": ("Standing only: {players}", "立奏のみ: {players}"),
    "parameter_sections.player": ("Player", "奏者"),
    "place.0_faces_audience_positive_turns": (
        "0 faces the audience, positive turns to the right as the audience sees it",
        "0 で客席正面、正の値は客席から見て右向き",
    ),
    "place.metres": ("m", "m"),
    "place.to_right_as_audience_sees": (
        "To the right as the audience sees it, from the middle",
        "中央から、客席から見て右向き",
    ),
    "place.towards_audience_from_middle": ("Towards the audience, from the middle", "中央から客席向き"),
    "place.turn": ("Turn", "向き"),
    "place.x": ("X", "X"),
    "place.z": ("Z", "Z"),
    "players_panel.add_player": ("Add player", "奏者を追加"),
    "players_panel.all_players": ("all players", "全員"),
    "players_panel.amplitude_sway_weight_shift_bell": (
        (
            "Randomise amplitude, sway, weight shift, bell height, breath capacity, lip tension, the amounts of acting "
            "and seed around their average, and the habits"
        ),
        (
            "動きの大きさ、揺れ、重心移動、ベルの高さ、一息の長さ、唇の緊張、演技の各量、シードを、"
            "現在の平均を中心にランダム化し、癖も割り当てます"
        ),
    ),
    "players_panel.duplicate_same_part": (
        "Duplicate: adds a player with a copy of the part",
        "複製: パートのコピーを演奏する奏者を追加",
    ),
    "players_panel.how_far_apart_players_become": (
        "How much the players differ: 0 identical, 1 the most that is sensible",
        "奏者同士の違い: 0 で全員同じ、1 で無理のない最大",
    ),
    "players_panel.no_players_yet_add_player": (
        "No players. Add a player with ＋, or drop a MIDI file or a score onto the window.",
        "奏者がいません。＋ で奏者を追加するか、MIDI ファイルや楽譜をウィンドウにドロップしてください。",
    ),
    "players_panel.of_selected": ("{chosen} of {count} selected", "{count} 人中 {chosen} 人を選択"),
    "players_panel.played_by": ("{instrument}, played by {name}", "{instrument}（{name} が持ち替え）"),
    "players_panel.players": ("Players: {count}", "奏者: {count} 人"),
    "players_panel.randomise": ("Randomise", "ランダム化"),
    "players_panel.remove_selected_players": ("Remove selected players", "選択した奏者を削除"),
    "players_panel.reset": ("Reset", "リセット"),
    "players_panel.return_all_parameters_of_selected": (
        "Reset all parameters of the selected players to the values from import",
        "選択した奏者の全パラメーターを読み込み時の値に戻す",
    ),
    "players_panel.search": ("Search players and instruments", "奏者・楽器を検索"),
    "players_panel.search_tip": (
        "Enter selects all that are shown",
        "Enterで表示中の奏者をすべて選択",
    ),
    "players_panel.selected_players": ("selected players", "選択した奏者"),
    "players_panel.spread": ("Randomisation range", "ばらつきの範囲"),
    "players_panel.variety": ("Variety", "ばらつき"),
    "preset_section.apply_to_selected_players": ("Apply to selected players", "選択した奏者に適用"),
    "preset_section.delete_this_preset_from_your": (
        "Delete this preset from your folder",
        "このプリセットを自分のフォルダーから削除",
    ),
    "preset_section.name_for_new_preset": ("Name of new preset", "新しいプリセットの名前"),
    "preset_section.no_presets_yet": ("No presets", "プリセットなし"),
    "preset_section.presets": ("Presets", "プリセット"),
    "preset_section.save_parameters_of_player_in": (
        "Save the parameters of the active player; a preset of the same name is replaced",
        "アクティブな奏者のパラメーターを保存（同じ名前のプリセットは上書き）",
    ),
    "row_delegate.cannot_be_seen": ("Cannot be displayed", "表示できません"),
    "row_delegate.gives_entries": ("Gives cues", "合図を出す"),
    "row_delegate.is_armed": (
        "Armed for recording. Click to disarm; the active player is then recorded.",
        "録音待機中。クリックで解除すると、アクティブな奏者を録音します。",
    ),
    "row_delegate.mute_silent_but_still": (
        "Mute: silent, but still shown and exported",
        "ミュート: 音は出ませんが、表示と書き出しの対象です",
    ),
    "row_delegate.problems": ("Problems: {count}", "問題: {count} 件"),
    "row_delegate.arm_for_recording": ("Arm for recording", "録音待機にする"),
    "row_delegate.section_players": ("{name}: {count} players", "{name}: {count} 人"),
    "row_delegate.section_tip": (
        "Click to select all, drag to reorder; Left and Right fold",
        "クリックで全員を選択、ドラッグで並べ替え、← → で折りたたみ",
    ),
    "row_delegate.solo_only_these_sound": ("Solo: only soloed players sound", "ソロ: ソロにした奏者だけが鳴ります"),
    "stage_section.automatic_arc_everyone_in_order": (
        "Arrange in arc: all players in order, open to the audience",
        "扇形に配置: 全奏者を順番に、客席に開いた弧に並べます",
    ),
    "stage_section.snap_to_0_1_m": (
        "Snap to 0.1 m and 5° (hold Alt to invert)",
        "0.1 m と 5° にスナップ（Alt で一時的に反転）",
    ),
    "stage_section.stage": ("Stage", "ステージ"),
    "stage_section.stage_from_above": ("Stage, top view", "ステージ（上面）"),
    "stage_view.audience": ("▾ Audience", "▾ 客席"),
    "stage_view.grid_m": ("grid {step} m", "グリッド {step} m"),
}
