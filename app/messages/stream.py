"""Live streaming to other programs."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "stream.host_unknown": (
        "no computer is called {host!r}: check the spelling, or type its address in numbers such as 192.168.0.20"
    ),
    "stream.broadcast": (
        "--host {host} is a multicast or broadcast address, which every computer on the network can receive from; add "
        "--broadcast if that is intended"
    ),
    "stream.to_many": (
        "{host} is a multicast or broadcast address: every computer on the network could receive what is sent. Nothing "
        "was sent"
    ),
    "stream.nobody": "there are no players or dancers to stream",
    "stream.from": "--from {time_s:g}: the piece goes from {first_s:g} to {end_s:g} seconds",
    "stream.port": "{port} is no port that can be sent to; possible: {least} to {most}",
    "stream.no_room": (
        "{count} {count:performer needs|performers need} {count} {count:port|ports} from {port} on, "
        "and the last one is {most}: choose a lower port"
    ),
    "stream.not_sent": (
        "nothing can be sent to {host}, port {port} ({reason}): check the address and the network; it is tried again"
    ),
}
