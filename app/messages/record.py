"""Recording in the editor."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "edit.record": ("Record {count} {count:Take|Takes}", "テイクを録音（{count} 個）"),
    "record.no_player": (
        "There is no player to record. Add a player first.",
        "録音する奏者がいません。先に奏者を追加してください。",
    ),
    "record.no_device": (
        "No MIDI input selected. Select a device in Record > MIDI Devices.",
        "MIDI 入力が選択されていません。「録音 > MIDI デバイス」で選んでください。",
    ),
    "record.no_place": (
        "There is no place to save the take. Save the project first.",
        "テイクの保存先がありません。先にプロジェクトを保存してください。",
    ),
    "record.nothing_played": (
        "No notes were received, so nothing was recorded.",
        "音符を受信しなかったため、何も録音されませんでした。",
    ),
    "record.player_gone": (
        "The recorded player no longer exists. The take was kept in {file}.",
        "録音した奏者は既に存在しません。テイクは {file} に保存してあります。",
    ),
    "record.device_lost": (
        "{device} was disconnected. It will be used again when it is reconnected.",
        "{device} が切断されました。接続し直すと再び使用します。",
    ),
    "record.device_lost_running": (
        (
            "{device} was disconnected. The notes played so far are kept, and recording continues when it is "
            "reconnected."
        ),
        "{device} が切断されました。それまでの演奏は保存され、接続し直すと録音を続けます。",
    ),
    "record.device_back": ("{device} was reconnected.", "{device} が再接続されました。"),
    "record.recovered": (
        "{count} {count:take|takes} of an interrupted recording {count:was|were} recovered.",
        "中断された録音からテイクを {count} 個復元しました。",
    ),
}
