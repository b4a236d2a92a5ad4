"""Texts of viewport: id -> English and Japanese."""

from __future__ import annotations

from typing import Final

TEXTS: Final[dict[str, tuple[str, str]]] = {
    "header.contact_points_and_their_distances": ("Contact points and distances", "接触点と距離"),
    "header.ensemble": ("Ensemble", "全体"),
    "header.everyone_from_audience": ("All players, seen from the audience", "客席側から全員を表示"),
    "header.feet": ("Feet", "足元"),
    "header.feet_of_player_in_front": (
        "Feet of the active player, followed by the camera",
        "アクティブな奏者の足元（カメラが追従）",
    ),
    "header.frame_selected_players": ("Frame selected players", "選択した奏者を画面に収める"),
    "header.front": ("Front", "正面"),
    "header.hands": ("Hands", "手元"),
    "header.hands_of_player_in_front": (
        "Hands of the active player, followed by the camera",
        "アクティブな奏者の手元（カメラが追従）",
    ),
    "header.hold_bell_head_elbows_or": (
        "Pose Tool: drag handles to adjust bell, head, elbows or torso",
        "ポーズツール: ハンドルをドラッグしてベル・頭・ひじ・上体を調整",
    ),
    "header.name_of_camera": ("Camera name", "カメラの名前"),
    "header.saved_cameras": ("Saved cameras", "保存したカメラ"),
    "header.mouth": ("Mouth", "口元"),
    "header.mouth_of_player_in_front": (
        "Mouth of the active player, followed by the camera",
        "アクティブな奏者の口元（カメラが追従）",
    ),
    "header.players_names": ("Player names", "奏者名"),
    "header.pose": ("Pose", "ポーズ"),
    "header.selected_players_from_above": ("Selected players from above", "選択した奏者を真上から表示"),
    "header.selected_players_from_their_front": ("Selected players from the front", "選択した奏者を正面から表示"),
    "header.selected_players_from_their_right": ("Selected players from their right", "選択した奏者を右側面から表示"),
    "header.show_beside_players": ("Overlays", "オーバーレイ"),
    "header.side": ("Side", "側面"),
    "header.skeleton": ("Skeleton", "スケルトン"),
    "header.top": ("Top", "上面"),
    "header.view": ("View", "ビュー"),
    "header.viewport_alone_on_whole_screen": ("Toggle full-screen viewport", "ビューポートの全画面表示を切り替え"),
    "header.wireframe": ("Wireframe", "ワイヤーフレーム"),
    "scene.down": ("down {degrees}°", "下 {degrees}°"),
    "scene.lean_left": ("lean left {degrees}°", "左へ傾き {degrees}°"),
    "scene.lean_right": ("lean right {degrees}°", "右へ傾き {degrees}°"),
    "scene.left": ("left {degrees}°", "左 {degrees}°"),
    "scene.loading_players": ("Loading players…", "奏者を読み込み中…"),
    "scene.making_first_motion": ("Generating motion…", "モーションを生成中…"),
    "scene.no_players_yet_open_or": (
        "No players. Open a project or import a MIDI file or a score to see the performance.",
        "奏者がいません。プロジェクトを開くか、MIDI ファイルや楽譜を読み込むと、演奏が表示されます。",
    ),
    "scene.right": ("right {degrees}°", "右 {degrees}°"),
    "scene.up": ("up {degrees}°", "上 {degrees}°"),
    "video_strip.behind": ("Behind", "背面"),
    "video_strip.behind_the_players": ("Show the video behind the players", "ビデオを奏者の背面に表示"),
    "video_strip.beside": ("Beside", "横に並べる"),
    "video_strip.beside_the_players": ("Show the video beside the players", "ビデオを奏者の横に表示"),
    "video_strip.find_by_sound": ("Estimate Offset", "オフセットを推定"),
    "video_strip.hide": ("Hide the reference video", "参照ビデオを隠す"),
    "video_strip.offset": ("Offset", "オフセット"),
    "video_strip.opacity": ("Opacity", "不透明度"),
    "video_strip.opacity_behind": ("Opacity of the video behind the players", "奏者の背面のビデオの不透明度"),
    "video_strip.place_by_sound": (
        "Estimate from its sound where the video begins",
        "ビデオの音声から開始位置を推定",
    ),
    "video_strip.where_it_begins": (
        "Time of the performance at which the video begins",
        "ビデオが始まる演奏上の時刻",
    ),
    "video_view.reference_video": ("Reference Video", "参照ビデオ"),
    "viewport_panel.drag_handle_shift_finely_alt": (
        "Drag a handle · Shift: fine · Alt: lean · Double-click: revert",
        "ハンドルをドラッグ · Shift: 微調整 · Alt: 傾き · ダブルクリック: 元に戻す",
    ),
    "viewport_panel.players_cannot_be_drawn_here": (
        (
            "The players cannot be displayed because OpenGL 2 is not available.\n({reason})\n\nTimeline, players, "
            "inspector, audio and export still work. Updating the graphics driver usually solves the problem."
        ),
        (
            "OpenGL 2 を使用できないため、奏者を表示できません。\n（{reason}）\n\nタイムライン、奏者、"
            "インスペクター、音声、書き出しは通常どおり使えます。グラフィックドライバーを更新すると、"
            "多くの場合は解決します。"
        ),
    ),
    "viewport_panel.viewport": ("Viewport", "ビューポート"),
}
