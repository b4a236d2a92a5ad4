"""Draws the pictures of ``docs/record-your-first-take.md``: a whole recording in the real window.

Run from the repository: ``python -m tests.support.recording_pictures``; needs jackd, Pillow and a display (without a
screen: ``xvfb-run -a -s "-screen 0 2560x1600x24"``). What is played is made by rule, not by the user; so that the
window looks as with an audio device, one that no one hears stands in for it.
"""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from contextlib import closing
from pathlib import Path
from typing import Final

from PIL import Image
from PySide6.QtCore import QEventLoop, QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QPushButton, QTreeWidget, QWidget

from app.audio.playback import Playback
from app.audio.sink import SilentSink
from app.capture.recorder import SYSTEM_VARIABLE
from app.editor.recorder import Recorder
from app.editor.settings import Settings
from app.project.autosave import Autosave
from app.project.running_editors import Presence
from app.shell.app import Program, make_application
from tests.gui.timeline.lane_hands import drag
from tests.support.jack import QUICK_FRAMES, jack_server
from tests.support.wind_player import Played, WindPlayer
from tests.support.windows import child
from widgets.common.actions import actions
from widgets.dialogs.latency import CLICKS_S, LEAD, LatencyDialog
from widgets.dialogs.midi_devices import MidiDevicesDialog

ROOT: Final = Path(__file__).parents[2]
TARGET: Final = ROOT / "docs" / "pictures"
PIECE: Final = ROOT / "tests" / "data" / "midi" / "ensemble" / "brass_quartet_lutkin_2tpt_tbn_tuba.mid"
FIRST_BAR, LAST_BAR = 4, 8
LATE_S, UNEVEN_S = 0.045, 0.009


class Wind:
    """The player, in a process of its own: a window that draws does not make them stumble."""

    def __init__(self) -> None:
        command = [sys.executable, "-m", "tests.support.recording_pictures", "--wind"]
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, cwd=ROOT, text=True)

    def play(self, played: Sequence[tuple[int, bytes]]) -> None:
        """Blow messages at moments of `time.perf_counter_ns`, after what was to be blown before."""
        self._process.stdin.write(json.dumps([(ns, message.hex()) for ns, message in played]) + "\n")
        self._process.stdin.flush()

    def send(self, message: bytes) -> None:
        """Blow now."""
        self.play([(0, message)])

    def close(self) -> None:
        """Unplug."""
        self._process.stdin.close()
        try:
            self._process.wait(3.0)
        except subprocess.TimeoutExpired:
            # JACK may hold up who closes a port.
            self._process.kill()
            self._process.wait()


def blow() -> None:
    """Return what the player's process does."""
    with WindPlayer("EWI5000", "MIDI 1") as wind:
        for line in sys.stdin:
            for ns, raw in json.loads(line):
                time.sleep(max((ns - time.perf_counter_ns()) / 1e9, 0.0))
                wind.send(bytes.fromhex(raw))


class Film:
    """The editor, and a player before it."""

    def __init__(self, application: QApplication, folder: Path, wind: Wind) -> None:
        self.application, self.wind = application, wind
        settings = Settings(folder / "editor.toml")
        settings.language, settings.theme = "en", "dark"
        make = lambda: Playback(lambda: SilentSink(time.perf_counter))  # noqa: E731
        self.program = Program(
            settings,
            autosave=Autosave(Presence(folder / "recovery")),
            playback=make(),
            recorder=lambda session, files, settings, sound: Recorder(
                session, files, settings, sound, make_playback=make
            ),
        )
        self.session, self.window = self.program.session, self.program.window
        self.session.noticed.connect(lambda message, severity: print(message.id, dict(message.arguments)))
        self.chance = random.Random(5)

    def wait(self, until: Callable[[], bool], most_s: float = 120.0) -> None:
        """Let the window live until something is so."""
        end_s = time.monotonic() + most_s
        while not until():
            if time.monotonic() > end_s:
                raise TimeoutError
            self.application.processEvents(QEventLoop.ProcessEventsFlag.AllEvents, 5)
            time.sleep(0.001)

    def rest(self, seconds: float) -> None:
        """Let the window live for a while."""
        end_s = time.monotonic() + seconds
        self.wait(lambda: time.monotonic() >= end_s)

    def picture(self, name: str, widget: QWidget, crop: tuple[float, float, float, float] = (0, 0, 1, 1)) -> None:
        """Write a picture of a widget, or of a part of it (left, top, right and bottom as shares)."""
        TARGET.mkdir(parents=True, exist_ok=True)
        path = TARGET / f"{name}.png"
        widget.grab().save(str(path))
        image = Image.open(path).convert("RGB")
        width, height = image.size
        box = (crop[0] * width, crop[1] * height, crop[2] * width, crop[3] * height)
        image = image.crop(tuple(round(edge) for edge in box))
        image.save(path, optimize=True)
        print(f"{path.relative_to(ROOT)}: {image.width} x {image.height}, {path.stat().st_size // 1024} KB")

    def play(self, played: Sequence[Played], now_s: Callable[[], float]) -> None:
        """Have it blown when a clock is there."""
        begin_ns = time.perf_counter_ns() - round(now_s() * 1e9)
        self.wind.play([(begin_ns + round(due_s * 1e9), message) for due_s, message in played])

    def part_played(self, seed: int) -> list[Played]:
        """The part of the player in front as someone might play it: a little uneven, breath by phrase."""
        chance = random.Random(seed)
        project, score = self.session.project, self.session.project.score
        first, last = score.metre_map.tick_of_bar(FIRST_BAR), score.metre_map.tick_of_bar(LAST_BAR)
        notes = [note for note in project.part(project.players[0]).notes if first <= note.onset_tick < last]
        played: list[Played] = []
        for number, note in enumerate(notes):
            onset_s = score.tempo_map.seconds(float(note.onset_tick)) + chance.gauss(0.01, 0.012)
            end_s = score.tempo_map.seconds(float(note.end_tick)) + chance.gauss(-0.01, 0.01)
            pitch = note.pitch + (chance.random() < 0.12)
            played += [(onset_s, bytes((0x90, pitch, 80))), (end_s, bytes((0x80, pitch, 0)))]
            rests = number + 1 == len(notes) or notes[number + 1].onset_tick > note.end_tick
            steps = max(round((end_s - onset_s) / 0.03), 2)
            level = chance.uniform(70, 105)
            for step in range(steps + 1):
                share = step / steps
                swell = level * (0.75 + 0.25 * (1.0 - abs(2.0 * share - 1.0))) * (1.0 - share if rests else 1.0) ** 0.3
                played.append((onset_s - 0.02 + share * (end_s - onset_s), bytes((0xB0, 2, round(swell)))))
                if share > 0.4 and end_s - onset_s > 0.8:
                    bend = 8192 + round(500.0 * self.chance.uniform(-1.0, 1.0))
                    played.append((onset_s + share * (end_s - onset_s), bytes((0xE0, bend & 0x7F, bend >> 7))))
        return sorted(played, key=lambda item: item[0])


def open_piece(film: Film) -> None:
    """The quartet, as large as the README's pictures."""
    window, session = film.window, film.session
    window.resize(1600, 1000)
    window.show()
    window.resize(1600, 1000)
    film.program.editor.files.open(PIECE, ask=False)
    film.wait(lambda: film.program.editor.files.is_open)
    film.wait(lambda: session.performance.project is session.project)
    film.wait(lambda: film.program.generator.ready_share >= 1.0, 600.0)
    window.reset_workspace()
    session.set_players((session.project.players[0].id,))
    film.rest(1.5)


def devices(film: Film) -> None:
    """The device is chosen, and something comes in."""
    actions(film.session)["record.devices"].trigger()
    dialog = child(film.window, MidiDevicesDialog, "midi_devices")
    tree = child(dialog, QTreeWidget, "midi_device_list")
    film.wait(lambda: tree.topLevelItemCount() > 1)
    film.rest(0.5)
    item = tree.topLevelItem(1)
    assert item is not None
    QTest.mouseClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=tree.visualItemRect(item).center())
    film.wait(lambda: film.session.recording.connection == "open")
    for pitch in (65, 67, 69):
        film.wind.send(bytes((0x90, pitch, 84)))
        for step in range(30):
            film.wind.send(bytes((0xB0, 2, 40 + 2 * step)))
            film.wind.send(bytes((0xD0, 40 + 2 * step)))
            bend = 8192 + 120 * step
            film.wind.send(bytes((0xE0, bend & 0x7F, bend >> 7)))
            film.rest(0.005)
        if pitch != 69:
            film.wind.send(bytes((0x80, pitch, 0)))
    film.rest(0.5)
    film.picture("devices", dialog)
    film.wind.send(bytes((0x80, 69, 0)))
    film.wind.send(bytes((0xB0, 2, 0)))
    film.wind.send(bytes((0xE0, 0, 64)))
    dialog.close()
    film.rest(0.3)


def latency(film: Film) -> None:
    """Someone blows on the clicks."""
    actions(film.session)["record.latency"].trigger()
    dialog = child(film.window, LatencyDialog, "latency")
    film.rest(0.5)
    QTest.mouseClick(child(dialog, QPushButton, "latency_start"), Qt.MouseButton.LeftButton)
    film.wait(lambda: dialog.sounding_s() > 0.0)
    blown: list[Played] = []
    for number, click_s in enumerate(CLICKS_S):
        late_s = LATE_S + film.chance.gauss(0.0, UNEVEN_S) + (0.13 if number == LEAD + 3 else 0.0)
        if number != LEAD + 7:
            blown += [(click_s + late_s, bytes((0x90, 67, 90))), (click_s + late_s + 0.1, bytes((0x80, 67, 0)))]
    film.play(blown, dialog.sounding_s)
    film.wait(lambda: not dialog.is_measuring)
    film.rest(0.3)
    film.picture("latency", dialog)
    QTest.mouseClick(child(dialog, QPushButton, "latency_take"), Qt.MouseButton.LeftButton)
    dialog.close()
    film.rest(0.3)


def record(film: Film) -> None:
    """Three takes over the others."""
    session = film.session
    score, playback = session.project.score, session.playback
    assert playback is not None
    start_s = score.tempo_map.seconds(float(score.metre_map.tick_of_bar(FIRST_BAR)))
    end_s = score.tempo_map.seconds(float(score.metre_map.tick_of_bar(LAST_BAR)))
    session.viewport.set_view("hands")
    session.listening.set(click=True)
    beat_s = score.tempo_map.seconds(float(session.project.metre_map.felt_ticks_at(0)))
    player = session.project.players[0].id
    for number in range(3):
        session.set_playhead(start_s)
        film.window.timeline.axis.show(start_s - 4.0, end_s + 2.0)
        film.rest(0.5)
        played = film.part_played(number)
        actions(session)["record.toggle"].trigger()
        film.wait(lambda: session.recording.running and playback.position_s() > session.recording.counted_from_s)
        film.play(played, playback.position_s)
        if number == 0:
            film.wait(lambda: session.playhead_s >= start_s - 2.0 * beat_s + 0.02)
            film.picture("count-in", film.window, (0.0, 0.0, 0.8, 0.12))
            film.wait(lambda: session.playhead_s >= (start_s + end_s) / 2)
            film.picture("recording", film.window, (0.0, 0.0, 0.8, 0.72))
        film.wait(lambda: session.playhead_s >= end_s)
        actions(session)["record.toggle"].trigger()
        count = number + 1
        film.wait(lambda count=count: len(_takes(film, player)) == count)
    session.set_playhead(start_s)


def _takes(film: Film, player: str) -> tuple[object, ...]:
    recorded = film.session.project.takes.get(player)
    return recorded.takes if recorded is not None else ()


def takes(film: Film) -> None:
    """The takes, and a part put together from them by swiping."""
    session = film.session
    panel = film.window.timeline
    score = session.project.score
    first, last = score.metre_map.tick_of_bar(FIRST_BAR), score.metre_map.tick_of_bar(LAST_BAR)
    for id in ("audio", "fingering", "breath", "acting", "curves", "problems"):
        panel.lanes[id].set_folded(True)
    panel.takes.set_folded(False)
    film.rest(1.0)
    panel.axis.show(score.tempo_map.seconds(float(first)) - 1.0, score.tempo_map.seconds(float(last)) + 1.0)
    film.rest(2.0)
    film.picture("takes", film.window, (0.0, 0.455, 1.0, 1.0))
    for row, begin, end in ((1, 0.0, 0.3), (2, 0.3, 0.62)):
        swipe(film, row, first + begin * (last - first), first + end * (last - first))
        film.rest(0.5)
    film.rest(2.0)
    film.picture("comp", film.window, (0.0, 0.455, 1.0, 1.0))


def swipe(film: Film, row: int, start_tick: float, end_tick: float) -> None:
    """Drag over the row of a take."""
    lane = film.window.timeline.takes
    tempo_map = film.session.project.score.tempo_map
    start_px, end_px = (lane.axis.x_px(tempo_map.seconds(tick)) for tick in (start_tick, end_tick))
    drag(lane, QPointF(start_px, lane.row_rect(row).center().y()), dx=end_px - start_px)


def main() -> None:
    """Record, and write the pictures."""
    os.environ[SYSTEM_VARIABLE] = "jack"
    application = make_application()
    with (
        tempfile.TemporaryDirectory() as folder,
        jack_server("suisou-pictures", QUICK_FRAMES, is_in_step=True),
        closing(Wind()) as wind,
    ):
        film = Film(application, Path(folder), wind)
        try:
            open_piece(film)
            devices(film)
            latency(film)
            record(film)
            takes(film)
        finally:
            film.program.end()
            film.window.hide()


if __name__ == "__main__":
    blow() if "--wind" in sys.argv else main()
