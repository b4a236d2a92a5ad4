"""Texts of the recording panel: id -> English and Japanese."""

from __future__ import annotations

from typing import Final

TEXTS: Final[dict[str, tuple[str, str]]] = {
    "recording_panel.breath": ("Breath", "ブレス"),
    "recording_panel.breath_and_note": ("Breath and note that come in now", "現在入力されているブレスと音"),
    "recording_panel.connected": ("Connected", "接続済み"),
    "recording_panel.connected_late": (
        "Connected, latency {latency:.0f} ms",
        "接続済み、レイテンシー {latency:.0f} ms",
    ),
    "recording_panel.count_in": ("Count-in", "カウントイン"),
    "recording_panel.disconnected": ("Disconnected", "切断"),
    "recording_panel.no_device": ("No device selected", "デバイス未選択"),
    "recording_panel.no_player": ("No player", "奏者なし"),
    "recording_panel.player": ("Player", "奏者"),
    "recording_panel.player_armed": ("{name} (armed)", "{name}（録音待機）"),
    "recording_panel.refused": ("Cannot be opened", "開けません"),
    "recording_panel.takes": ("Takes: {count}", "テイク: {count}"),
    "recording_panel.waiting": ("Waiting for the device…", "デバイスを待機中…"),
}
