"""Recording from MIDI devices: ports, the recorder, journals of takes."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "capture.no_library": (
        (
            "MIDI devices are not available ({detail}); install the Python package python-rtmidi (3.11, 3.12) or "
            "rtmidi2 (3.13 and newer), and on Linux the system's libasound2"
        ),
        (
            "MIDI デバイスを利用できません（{detail}）。Python パッケージ python-rtmidi（3.11、3.12）または "
            "rtmidi2（3.13 以降）をインストールしてください。Linux ではシステムの libasound2 も必要です"
        ),
    ),
    "capture.no_system": (
        ("the MIDI system does not respond; on Linux, load the kernel sequencer (sudo modprobe snd-seq) or start JACK"),
        (
            "MIDI システムが応答しません。Linux ではカーネルのシーケンサーを読み込むか（sudo modprobe snd-seq）、"
            "JACK を起動してください"
        ),
    ),
    "capture.api_unknown": (
        "the MIDI system {name!r} is not available here; choose one of: {possible}",
        "MIDI システム {name!r} はここでは使えません。使えるもの: {possible}",
    ),
    "capture.no_ports": (
        "no MIDI device is connected; connect one and switch it on",
        "MIDI デバイスが接続されていません。接続して電源を入れてください",
    ),
    "capture.port_unknown": (
        "MIDI device {port!r} was not found; connected devices: {possible}",
        "MIDI デバイス {port!r} が見つかりません。接続中のデバイス: {possible}",
    ),
    "capture.port_not_here": (
        "{port} is not connected; it will be used when it is connected",
        "{port} は接続されていません。接続されしだい使用します",
    ),
    "capture.port_refused": (
        (
            "{port} cannot be opened ({detail}); another program may be using it; close it there and it opens here "
            "automatically"
        ),
        (
            "{port} を開けません（{detail}）。ほかのプログラムが使用している可能性があります。そちらで閉じると、"
            "ここで自動的に開きます"
        ),
    ),
    "capture.port_taken": (
        "{port} cannot be opened; another program may be using it; close it there and it opens here automatically",
        (
            "{port} を開けません。ほかのプログラムが使用している可能性があります。そちらで閉じると、ここで自動的に"
            "開きます"
        ),
    ),
    "capture.not_written": (
        "{file} cannot be written: {reason}; recording continues and is written when space is available",
        "{file} に書き込めません: {reason}。録音は続いており、空きができしだい書き込みます",
    ),
    "capture.elsewhere_refused": (
        "{file} cannot be moved to a second place either: {reason}",
        "{file} は別の場所にも移せません: {reason}",
    ),
    "capture.cut_short": (
        "{file} cannot be written: {reason}; the end of the recording is missing",
        "{file} に書き込めません: {reason}。録音の終わりの部分は保存されていません",
    ),
    "capture.recorder_ended": (
        "the recorder stopped unexpectedly and was restarted; notes recorded before are kept",
        "録音プロセスが予期せず終了したため、再起動しました。それまでの録音は残っています",
    ),
    "capture.recorder_fails": (
        "the recorder cannot be started ({detail}); restart Suisou",
        "録音プロセスを開始できません（{detail}）。Suisou を再起動してください",
    ),
    "record.no_port": (
        "no device to record from is specified; add --port with a name from 'suisou ports'",
        "録音するデバイスが指定されていません。'suisou ports' の一覧から --port で指定してください",
    ),
    "record.exists": (
        "{file} already exists; choose another name or delete it",
        "{file} は既に存在します。別の名前を選ぶか、削除してください",
    ),
    "record.running": (
        "another recording to {file} is in progress; choose another name",
        "{file} への別の録音が進行中です。別の名前を選んでください",
    ),
    "record.journal_left": (
        ("{journal} already exists from an unfinished recording; write it with 'suisou record --rescue --to {file}'"),
        ("終了していない録音 {journal} が既に存在します。'suisou record --rescue --to {file}' で書き出してください"),
    ),
    "record.goes_on_elsewhere": (
        "{file} cannot be written ({reason}); the recording goes on in {journal}",
        "{file} に書き込めません（{reason}）。録音は {journal} で続きます",
    ),
    "record.written_elsewhere": (
        "{file} cannot be written ({reason}); the take is in {elsewhere} instead: move it from there",
        "{file} に書き込めません（{reason}）。代わりに {elsewhere} に書き出しました。そこから移してください",
    ),
    "record.not_written": (
        (
            "{file} cannot be written: {reason}; the recording is kept in {journal}; free some space, then write "
            "it with 'suisou record --rescue --to {file}'"
        ),
        (
            "{file} に書き込めません: {reason}。録音は {journal} に残っています。空き容量を増やしてから 'suisou "
            "record --rescue --to {file}' で書き出してください"
        ),
    ),
    "record.nothing_received": (
        "nothing was received from {port}; no file was written",
        "{port} から何も受信しませんでした。ファイルは書き出していません",
    ),
    "journal.exists": (
        "{file} already exists: another recording is in progress, or one was not finished",
        "{file} は既に存在します。別の録音が進行中か、終了していない録音が残っています",
    ),
    "journal.no_header": (
        "{file} is not a take journal: its header line is missing",
        "{file} はテイクのジャーナルではありません。ヘッダー行がありません",
    ),
    "journal.newer": (
        "{file} was saved by a newer version of Suisou (journal {version}); use that version",
        (
            "{file} は新しいバージョンの Suisou で保存されています（ジャーナル {version}）。"
            "そのバージョンを使ってください"
        ),
    ),
    "journal.line": ("{file}, line {line}: {detail}", "{file}、{line} 行目: {detail}"),
}
