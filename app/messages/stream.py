"""Live streaming to other programs."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    "stream.host_unknown": (
        "computer {host!r} was not found; check the spelling, or type a numeric address such as 192.168.0.20",
        (
            "コンピューター {host!r} が見つかりません。つづりを確認するか、192.168.0.20 "
            "のような数字のアドレスを入力してください"
        ),
    ),
    "stream.broadcast": (
        (
            "--host {host} is a multicast or broadcast address, which every computer on the network can receive; "
            "add --broadcast if this is intended"
        ),
        (
            "--host {host} はマルチキャストまたはブロードキャストのアドレスで、"
            "ネットワーク上のすべてのコンピューターが受信できます。意図したものなら --broadcast を付けてください"
        ),
    ),
    "stream.to_many": (
        (
            "{host} is a multicast or broadcast address, so every computer on the network could receive the "
            "stream; nothing was sent"
        ),
        (
            "{host} はマルチキャストまたはブロードキャストのアドレスで、"
            "ネットワーク上のすべてのコンピューターが受信できます。まだ何も送信していません"
        ),
    ),
    "stream.no_players": (
        "there are no performers to stream; add a player or a dancer",
        "送信する出演者がいません。奏者またはダンサーを追加してください",
    ),
    "stream.from": (
        "--from {time_s:g} is outside the piece, which lasts from {first_s:g} to {end_s:g} s",
        "--from {time_s:g} は曲の範囲外です。曲は {first_s:g} 秒から {end_s:g} 秒までです",
    ),
    "stream.port": (
        "{port} is not a usable port; choose {least} to {most}",
        "{port} は使えるポートではありません。{least} から {most} までを指定してください",
    ),
    "stream.no_room": (
        (
            "{count} {count:performer needs|performers need} {count} {count:port|ports} starting at {port}, but "
            "the last port is {most}; choose a lower port"
        ),
        (
            "出演者 {count} 人には {port} から {count} 個のポートが必要ですが、最後のポートは {most} です。"
            "小さいポート番号を選んでください"
        ),
    ),
    "stream.not_sent": (
        (
            "cannot send to {host}, port {port} ({reason}); check the address and the network; sending is retried "
            "automatically"
        ),
        (
            "{host} のポート {port} に送信できません（{reason}）。アドレスとネットワークを確認してください。"
            "自動で再試行します"
        ),
    ),
}
