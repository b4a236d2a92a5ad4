"""A synthetic wind player: NOT the user's playing, but what one does to a recorder, made by rule.

Phrases with a breath curve on controller 2 (and the same as channel pressure, as an EWI USB sends it), legato overlaps,
ghost notes, bite vibrato as pitch bend, bursts of 1,000 messages a second; through a virtual port of JACK's.
"""

from __future__ import annotations

import math
import random
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Self

from tests.support.jack import CLIENT_SYSTEM

Played = tuple[float, bytes]
"""When a message is due, seconds from the begin, and its bytes."""


def phrase(pitches: Sequence[int], *, beat_s: float = 0.4, seed: int = 0, ghosts: int = 0) -> list[Played]:
    """A legato phrase in one breath.

    A note's end comes 5 to 20 ms after the next one's begin; ghost notes are 8 ms long, soft, and lie between.
    """
    by_chance = random.Random(seed)
    length_s = beat_s * len(pitches)
    played: list[Played] = []
    for index in range(int(length_s / 0.02) + 1):
        at_s = index * 0.02
        pressure = round(100.0 * math.sin(math.pi * min(at_s / length_s, 1.0)) ** 0.7)
        played += [(at_s, bytes([0xB0, 2, pressure])), (at_s, bytes([0xD0, pressure]))]
        if at_s > length_s / 2:
            bend = 8192 + round(600.0 * math.sin(2.0 * math.pi * 5.5 * at_s))
            played.append((at_s, bytes([0xE0, bend & 0x7F, bend >> 7])))
    for index, pitch in enumerate(pitches):
        begin_s = 0.03 + index * beat_s
        overlap_s = by_chance.uniform(0.005, 0.02) if index + 1 < len(pitches) else -0.05
        played += [
            (begin_s, bytes([0x90, pitch, 80])),
            (begin_s + beat_s + overlap_s, bytes([0x80, pitch, 64])),
        ]
    for _ in range(ghosts):
        at_s = by_chance.uniform(0.1, length_s - 0.1)
        pitch = by_chance.choice(pitches) + 1
        played += [(at_s, bytes([0x90, pitch, 4])), (at_s + 0.008, bytes([0x80, pitch, 64]))]
    return sorted(played, key=lambda item: item[0])


def burst(seconds: float, rate_hz: float = 1000.0) -> Iterator[Played]:
    """Bend messages that count, so many a second: each tells its place, modulo 16384."""
    for number in range(int(seconds * rate_hz)):
        yield number / rate_hz, bytes([0xE0, number & 0x7F, number >> 7 & 0x7F])


class WindPlayer:
    """Plays into a virtual port of its own.

    Parameters
    ----------
    client, port : str
        Over JACK the port is called ``client:port``.
    """

    def __init__(self, client: str = "EWI", port: str = "EWI USB") -> None:
        self.name = f"{client}:{port}"
        self._client, self._port = client, port
        self._midi: Any = None
        self.plug_in()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.unplug()

    def plug_in(self) -> None:
        """Appear."""
        import rtmidi

        self._midi = rtmidi.MidiOut(getattr(rtmidi, CLIENT_SYSTEM), self._client)
        self._midi.open_virtual_port(self._port)

    def unplug(self) -> None:
        """Vanish."""
        if self._midi is not None:
            self._midi.close_port()
            self._midi.delete()
            self._midi = None

    def send(self, message: bytes) -> int:
        """Play one message; the moment of `time.perf_counter_ns` just before."""
        ns = time.perf_counter_ns()
        self._midi.send_message(message)
        return ns

    def play(self, played: Sequence[Played] | Iterator[Played]) -> list[tuple[int, bytes]]:
        """Play in time; what was sent and when."""
        begin_ns = time.perf_counter_ns()
        sent = []
        for due_s, message in played:
            left_s = due_s - (time.perf_counter_ns() - begin_ns) / 1e9
            if left_s > 0.0:
                time.sleep(left_s)
            sent.append((self.send(message), message))
        return sent


class PlayerProcess:
    """A burst from a process of its own, as a device does not wait for the editor's Python.

    Parameters
    ----------
    client : str
    seconds, rate_hz : float
    """

    def __init__(self, client: str, seconds: float, rate_hz: float = 1000.0) -> None:
        self.name = f"{client}:EWI USB"
        self._process = subprocess.Popen(
            [sys.executable, "-m", __name__, client, str(seconds), str(rate_hz)],
            cwd=Path(__file__).parents[2],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        self._process.communicate()

    def start(self) -> None:
        """Begin to play."""
        assert self._process.stdin is not None
        self._process.stdin.write("\n")
        self._process.stdin.flush()

    def sent(self) -> list[tuple[int, bytes]]:
        """Wait for the end; what was sent and when."""
        assert self._process.stdout is not None
        found = []
        for line in self._process.stdout:
            if not line.strip():
                break
            ns, message = line.split()
            found.append((int(ns), bytes.fromhex(message)))
        return found


def main() -> None:
    """Appear, wait for a line, play a burst, tell what was sent, stay until killed."""
    client, seconds, rate_hz = sys.argv[1:]
    with WindPlayer(client) as player:
        sys.stdin.readline()
        for ns, message in player.play(burst(float(seconds), float(rate_hz))):
            print(ns, message.hex())
        print(flush=True)
        sys.stdin.readline()


if __name__ == "__main__":
    main()
