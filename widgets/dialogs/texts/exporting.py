"""Texts of the dialogs that write files: id -> English and Japanese."""

from __future__ import annotations

from typing import Final

TEXTS: Final[dict[str, tuple[str, str]]] = {
    "export_dialog.under_way": ("Writing {what}, {number} of {count}", "{what} を書き出し中（{number} / {count}）"),
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
    "export_dialog.unreal_engine": ("{name} (Unreal Engine{engine})", "{name}（Unreal Engine{engine}）"),
    "format_chooser.body_motion": ("{format} (body motion)", "{format}（体の動き）"),
    "format_chooser.characters_and_instruments": (
        "{format} (characters and instruments)",
        "{format}（キャラクターと楽器）",
    ),
    "format_chooser.requires_package": (
        "{format} (requires the {package} package)",
        "{format}（パッケージ {package} が必要です）",
    ),
    "format_chooser.sound_wav": ("Audio (WAV)", "オーディオ（WAV）"),
    "format_chooser.whole_stage_in_one_file": ("Whole stage in one file", "ステージ全体を 1 ファイルに"),
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
    "playblast_dialog.frame": ("Frame {number} of {count}", "フレーム {number} / {count}"),
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
    "playblast_dialog.include_marks": ("Names, marks and selection", "奏者名、マーク、選択表示"),
    "playblast_dialog.overlays": ("Overlays", "オーバーレイ"),
    "playblast_dialog.sound": ("Audio", "オーディオ"),
    "playblast_dialog.this_file_is_there_and": (
        "The file already exists and will be replaced.",
        "ファイルは既に存在し、上書きされます。",
    ),
    "playblast_dialog.top": ("Top", "上面"),
    "playblast_dialog.view": ("View", "ビュー"),
    "playblast_dialog.whole_piece": ("Whole piece", "曲全体"),
    "playblast_dialog.include_audio": ("Include Audio", "オーディオを含める"),
    "range_chooser.bars": ("Bars", "小節"),
    "range_chooser.bars_of_selection": ("Selected bars", "選択した小節"),
    "range_chooser.last_bar_comes_before_first": (
        "The last bar is before the first bar.",
        "最後の小節が最初の小節より前にあります。",
    ),
    "range_chooser.whole_piece": ("Whole piece", "曲全体"),
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
    "working_dialog.estimating": ("estimating time left…", "残り時間を計算中…"),
    "working_dialog.finishing": ("finishing…", "仕上げ中…"),
    "working_dialog.left": ("about {minutes}:{seconds:02d} left", "残り約 {minutes}:{seconds:02d}"),
    "working_dialog.cancel": ("Cancel", "キャンセル"),
    "working_dialog.close": ("Close", "閉じる"),
    "working_dialog.show_in_folder": ("Show in Folder", "フォルダーで表示"),
}
