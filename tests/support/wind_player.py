"""A synthetic wind player, made by rule and not a recording of a person. It sends phrases with a breath curve on
controller 2 (and as channel pressure, like an EWI USB), legato overlaps, ghost notes, bite vibrato as pitch bend and
bursts of 1,000 messages a second through a virtual port of JACK.

Phrases with a breath curve on controller 2 (and the same as channel pressure, as an EWI USB sends it), legato overlaps,
ghost notes, bite vibrato as pitch bend, bursts of 1,000 messages a second; through a virtual port of JACK's.
"""

from __future__ import annotations

import json
import math
import os
import random
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Self

from app.capture.midi_library import PythonRtmidi, load_library

Played = tuple[float, bytes]
"""Time in seconds from the beginning at which a message is due, and its bytes."""


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
    """Numbered pitch bend messages at a constant rate; each value is its index modulo 16384."""
    for number in range(int(seconds * rate_hz)):
        yield number / rate_hz, bytes([0xE0, number & 0x7F, number >> 7 & 0x7F])


class WindPlayer:
    """Plays into a virtual port of a separate process, whose timing does not depend on this process. In this process,
    closing the port could crash, since JACK's thread may be in the library's callback.

    In this process, closing the port could crash it: JACK's thread may be in the library's callback.

    Parameters
    ----------
    client, port : str
        Over JACK the port is called ``client:port``.
    """

    def __init__(self, client: str = "EWI", port: str = "EWI USB") -> None:
        self.name = f"{client}:{port}"
        self._arguments = client, port
        self._process: subprocess.Popen[str] | None = None
        self.plug_in()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.unplug()

    def plug_in(self) -> None:
        """Open the port."""
        self._process = subprocess.Popen(
            [sys.executable, "-m", __name__, *self._arguments],
            cwd=Path(__file__).parents[2],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self._answer()

    def unplug(self) -> None:
        """Close the port."""
        if self._process is not None:
            # At the end of its input it closes the port and ends, unless it still plays.
            try:
                self._process.communicate(timeout=2.0)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.communicate()
            self._process = None

    def send(self, message: bytes) -> int:
        """Send one message and return the moment of `time.perf_counter_ns` just before."""
        ((ns, _),) = self.play([(0.0, message)])
        return ns

    def play(self, played: Iterable[Played]) -> list[tuple[int, bytes]]:
        """Send messages at their times and return them with the times at which they were sent."""
        self.start(played)
        return self.sent()

    def start(self, played: Iterable[Played]) -> None:
        """Start sending."""
        assert self._process.stdin is not None
        json.dump([(due_s, message.hex()) for due_s, message in played], self._process.stdin)
        self._process.stdin.write("\n")
        self._process.stdin.flush()

    def sent(self) -> list[tuple[int, bytes]]:
        """Wait for the end and return the messages with the times at which they were sent."""
        return [(ns, bytes.fromhex(message)) for ns, message in self._answer()]

    def _answer(self) -> list[tuple[int, str]]:
        line = self._process.stdout.readline()
        assert line, f"{self.name} ended with {self._process.wait()}"
        answer: list[tuple[int, str]] = json.loads(line)
        return answer


@contextmanager
def virtual_output(client: str, port: str) -> Iterator[Callable[[bytes], None]]:
    """Open a virtual port of JACK with the program's library and return a function that sends."""
    library = load_library()
    if isinstance(library, PythonRtmidi):
        import rtmidi

        midi = rtmidi.MidiOut(rtmidi.API_UNIX_JACK, client)
        midi.open_virtual_port(port)
        yield midi.send_message
        midi.close_port()
        midi.delete()
        return
    import rtmidi2

    midi = rtmidi2.MidiOut(client, api=rtmidi2.API_UNIX_JACK)
    midi.open_virtual_port(port)
    yield lambda message: midi.send_raw(*message)
    midi.close_port()


def main() -> None:
    """Open the port and print a line; for every line of input send its messages and print their times; close the port
    at the end of input.
    """
    with virtual_output(*sys.argv[1:]) as send:
        print("[]", flush=True)
        for line in sys.stdin:
            begin_ns = time.perf_counter_ns()
            sent = []
            for due_s, message in json.loads(line):
                raw = bytes.fromhex(message)
                left_s = due_s - (time.perf_counter_ns() - begin_ns) / 1e9
                if left_s > 0.0:
                    time.sleep(left_s)
                sent.append((time.perf_counter_ns(), message))
                send(raw)
            print(json.dumps(sent), flush=True)
    # Errors of the libraries at the end of the process are irrelevant to tests.
    os._exit(0)


if __name__ == "__main__":
    main()
