"""Texts of transport: id -> English and Japanese."""

from __future__ import annotations

from typing import Final

TEXTS: Final[dict[str, tuple[str, str]]] = {
    "transport_bar.bar_beat_ticks": ("Bar, beat, ticks", "小節・拍・ティック"),
    "transport_bar.bar_beat_ticks_click_to": (
        "Bar, beat, ticks. Click to type, drag to move.",
        "小節・拍・ティック。クリックで入力、ドラッグで移動します。",
    ),
    "transport_bar.both": ("Both", "両方"),
    "transport_bar.edits_snap_to_grid_alt": (
        "Snap edits to the grid; hold Alt to suspend",
        "編集をグリッドにスナップ（Alt で一時解除）",
    ),
    "transport_bar.frame": ("f", "f"),
    "transport_bar.frame_2": ("Frame", "フレーム"),
    "transport_bar.frame_click_to_type_drag": (
        "Frame. Click to type, drag to step.",
        "フレーム。クリックで入力、ドラッグでコマ送りします。",
    ),
    "transport_bar.loop_selection_else_bar": (
        "Loop the selection, or the bar if nothing is selected",
        "選択範囲をループ（選択がなければ小節）",
    ),
    "transport_bar.metronome": ("Metronome", "メトロノーム"),
    "transport_bar.minutes_and_seconds_click_to": (
        "Minutes and seconds. Click to type, drag to move.",
        "分・秒。クリックで入力、ドラッグで移動します。",
    ),
    "transport_bar.no_audio_device_silent": ("No audio output device", "オーディオ出力デバイスなし"),
    "transport_bar.play_or_stop_here": ("Play/Pause", "再生/一時停止"),
    "transport_bar.rec": ("REC", "録音中"),
    "transport_bar.rec_2": ("REC {number}", "録音中 {number}"),
    "transport_bar.record_player_in_front_or": (
        "Record the active or armed player from the playhead",
        "アクティブな奏者（または録音待機中の奏者）を再生位置から録音",
    ),
    "transport_bar.recording": ("Audio", "音源"),
    "transport_bar.seconds": ("Seconds", "秒"),
    "transport_bar.speed": ("Speed", "速度"),
    "transport_bar.speed_pitch_stays_double_click": (
        "Playback speed; the pitch is unchanged. Double-click for 100 %.",
        "再生速度（音高は変わりません）。ダブルクリックで 100 % に戻します。",
    ),
    "transport_bar.step_of_grid": ("Grid step", "グリッドの単位"),
    "transport_bar.step_of_grid_note_values": (
        "Grid step: note values, triplets (T), dotted (.)",
        "グリッドの単位: 音符、3 連符（T）、付点（.）",
    ),
    "transport_bar.stop_once_more_to_start": (
        "Stop; press again to return to the start of the loop or piece",
        "停止（もう一度押すとループまたは曲の先頭へ）",
    ),
    "transport_bar.synthesiser": ("Synthesiser", "シンセ"),
    "transport_bar.tempo_and_metre_at_playhead": (
        "Tempo and time signature at the playhead; edit them in the ruler",
        "再生位置のテンポと拍子（ルーラーで編集）",
    ),
    "transport_bar.there_is_no_audio_device": (
        "No audio output device was found, so playback is silent. Connect a device and start playback again.",
        ("オーディオ出力デバイスが見つからないため、無音で再生します。デバイスを接続してから再生し直してください。"),
    ),
    "transport_bar.timeline_follows_playhead": ("Follow playhead", "タイムラインを再生位置に追従"),
    "transport_bar.to_start": ("Go to start", "先頭へ移動"),
    "transport_bar.volume": ("Volume", "音量"),
    "transport_bar.volume_double_click_80": (
        "Volume. Double-click for 80 %.",
        "音量。ダブルクリックで 80 % に戻します。",
    ),
    "transport_bar.playback_source": ("Playback source", "再生する音"),
}
