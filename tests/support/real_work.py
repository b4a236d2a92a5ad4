"""One real piece of work in the real editor, by mouse and keys; run as a program, so that it can be killed.

``python -m tests.support.real_work work FOLDER``: opens the Lutkin quartet, changes three fingerings, moves a breath,
lowers one player's amplitude, adds a strained expression, lifts a bell, takes a recording whose offset it estimates,
saves, edits on, and waits to be killed once the unsaved edit is written down. ``recover FOLDER``: begins the editor
anew, takes what is offered, and exports. With ``pictures`` as a further word a picture of the window is left in the
folder after every step.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
import soundfile
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QComboBox, QLineEdit, QPushButton, QSpinBox, QWidget

from app.audio.mix import mixdown
from app.editor.session import Severity
from app.editor.settings import Settings
from app.errors import Message
from app.plan.model import PlayerPlan
from app.project.autosave import Autosave
from app.project.recovery import Recoverable
from app.project.running_editors import Presence
from app.shell.app import Program, make_application
from tests.gui.shell.conftest import Answers
from tests.gui.timeline.hand import Hand
from tests.gui.timeline.lane_hands import drag, middle
from tests.support.windows import LOOK_AGAIN_MS, child, pause
from widgets.common.actions import actions
from widgets.common.number_slider import NumberSlider
from widgets.timeline.lanes.regions import RegionLane
from widgets.timeline.panel import TimelinePanel
from widgets.viewport.panel import ViewportPanel

LUTKIN = Path(__file__).parents[1] / "data" / "midi" / "ensemble" / "brass_quartet_lutkin_2tpt_tbn_tuba.mid"
OFFSET_S = -1.37
"""Time in seconds at which the recording begins, relative to the first tick."""
PATIENCE_S = 240.0


class Work:
    """An editor and its user."""

    def __init__(self, folder: Path) -> None:
        self.application: QApplication = make_application()
        self.folder = folder
        settings = Settings(folder / "settings" / "editor.toml")
        settings.language = "en"
        self.answers = Answers()
        self.program = Program(settings, questions=self.answers, autosave=Autosave(Presence(folder / "recovery"), 1.0))
        self.session = self.program.session
        self.session.noticed.connect(self._reported)
        self.window = self.program.window
        self.window.resize(1600, 800)
        self.window.show()
        self.window.activateWindow()
        self.pictures = 0

    @staticmethod
    def _reported(message: Message, severity: Severity) -> None:
        if severity is Severity.ERROR:
            raise AssertionError(message)

    def until(self, ready: Callable[[], bool], what: str) -> None:
        """Process events until a condition holds."""
        end_s = time.monotonic() + PATIENCE_S
        while not ready():
            if time.monotonic() > end_s:
                raise TimeoutError(what)
            pause(LOOK_AGAIN_MS)

    def planned(self) -> None:
        """Wait until the plans belong to the newest project."""
        self.until(lambda: self.session.performance.project is self.session.project, "plans")

    def picture(self, name: str) -> None:
        """Screenshot of the window with the figures in their planned poses."""
        self.planned()
        viewport, playhead_s = self.viewport, self.session.playhead_s
        self.until(lambda: self.program.generator.live.pose(self.front, playhead_s) is not None, "motion")
        pause(LOOK_AGAIN_MS)
        viewport.refresh()
        self.application.processEvents()
        self.pictures += 1
        self.draw(self.window, name)

    def draw(self, shown: QWidget, name: str) -> None:
        """Write a picture of a widget if pictures are requested."""
        if "pictures" in sys.argv[3:]:
            shown.grab().save(str(self.folder / f"{self.pictures:02}_{name}.jpg"))

    def do(self, action_id: str) -> None:
        """Trigger an action."""
        self.program.editor.table.refresh()
        action = actions(self.session)[action_id]
        assert action.isEnabled(), action_id
        action.trigger()
        self.application.processEvents()

    def key(self, widget: QWidget, key: Qt.Key) -> None:
        """Press a key with the focus on a widget."""
        self.keys(widget, (key,))

    def keys(self, widget: QWidget, keys: Iterable[Qt.Key]) -> None:
        """Press keys immediately one after another, faster than a slow machine draws."""
        widget.setFocus()
        self.program.editor.table.refresh()
        for key in keys:
            QTest.keyClick(widget, key)
        self.application.processEvents()

    @property
    def front(self) -> str:
        return self.session.players[0]

    @property
    def plan(self) -> PlayerPlan:
        assert self.session.player is not None
        return self.session.performance.plan(self.session.player)

    @property
    def timeline(self) -> TimelinePanel:
        panel = self.window.panels["timeline"]
        assert isinstance(panel, TimelinePanel)
        return panel

    @property
    def viewport(self) -> ViewportPanel:
        panel = self.window.panels["viewport"]
        assert isinstance(panel, ViewportPanel)
        return panel

    def lane(self, name: str) -> RegionLane:
        found = self.timeline.findChild(RegionLane, name)
        assert found is not None, name
        return found

    def show_bars(self, first: int, last: int) -> None:
        """Scroll to bars."""
        score = self.session.project.score
        clock = score.tempo_map
        start_s, end_s = (clock.seconds(float(score.metre_map.tick_of_bar(bar))) for bar in (first, last + 1))
        self.timeline.axis.show(start_s, end_s)
        self.session.set_playhead(start_s)
        self.application.processEvents()

    def click_note(self, note_id: str) -> None:
        roll = self.timeline.roll
        assert self.session.player is not None
        part = self.session.project.part(self.session.player)
        note = next(note for note in part.notes if note.id == note_id)
        seconds = self.session.project.score.tempo_map.seconds(note.onset_tick + note.duration_tick / 2)
        Hand(roll.plot).click((roll.axis.x_px(seconds), roll.y_px(note.pitch + 0.5)))


def pin_three(work: Work) -> None:
    """Type other fingerings for three notes with alternates."""
    assert work.session.player is not None
    instrument = work.session.performance.instrument(work.session.player)
    digits = {str(digit): Qt.Key(Qt.Key.Key_0.value + digit) for digit in range(10)}
    pinned = 0
    part = work.session.project.part(work.session.player)
    for event in work.plan.fingerings:
        note = next(note for note in part.notes if note.id == event.note_id)
        written = note.pitch + instrument.transposition_semitones
        others = [
            fingering.label
            for fingering in instrument.fingerings
            if fingering.written_pitch == written and fingering.label != event.label and fingering.label.isdigit()
        ]
        if not others:
            continue
        bar = work.session.project.score.metre_map.bar_of_tick(note.onset_tick)
        work.show_bars(max(bar - 1, 1), bar + 2)
        work.click_note(note.id)
        work.keys(work.timeline.roll.plot, [digits[sign] for sign in others[0]])
        work.planned()
        now = next(event for event in work.plan.fingerings if event.note_id == note.id)
        assert (now.label, now.corrected) == (others[0], True), (now, others)
        pinned += 1
        if pinned == 3:
            return
    raise AssertionError("three notes with another fingering")


def move_breath(work: Work) -> None:
    """Drag a breath to an earlier place."""
    work.show_bars(1, 8)
    lane = work.lane("lane_breath")
    breath = next(event for event in work.plan.breaths if event.kind == "breath" and event.start_s > 3.0)
    shown = work.timeline.axis
    shown.show(breath.start_s - 4.0, breath.start_s + 4.0)
    work.session.set_playhead(breath.start_s)
    work.application.processEvents()
    place = middle(lane, breath.id)
    drag(lane, place, dx=-60)
    work.planned()
    # A breath dragged across a note serves that note, and has its id.
    (moved,) = (event for event in work.plan.breaths if event.corrected)
    assert breath.start_s - 4.0 < moved.start_s < breath.start_s - 0.1


def lower_amplitude(work: Work) -> None:
    """Drag a player's slider to the left."""
    player = work.session.project.players[1]
    work.session.set_players((player.id,))
    work.application.processEvents()
    slider = child(work.window.panels["players"], NumberSlider, "parameter_amplitude")
    QTest.mousePress(slider, Qt.MouseButton.LeftButton, pos=QPoint(120, 10))
    for x in (100, 60, 40):
        QTest.mouseMove(slider, QPoint(x, 10))
    QTest.mouseRelease(slider, Qt.MouseButton.LeftButton, pos=QPoint(40, 10))
    assert work.session.project.player(player.id).parameters.amplitude < player.parameters.amplitude - 0.1


def strain(work: Work) -> None:
    """Add a strained expression of two bars."""
    work.session.set_players((work.session.project.players[0].id,))
    work.show_bars(16, 19)
    score = work.session.project.score
    roll = work.timeline.roll
    part = work.session.project.part(work.session.project.players[0])
    inside = [
        note
        for note in part.notes
        if score.metre_map.tick_of_bar(17) <= note.onset_tick < score.metre_map.tick_of_bar(19)
    ]
    high = max(inside, key=lambda note: note.pitch)
    left, right = (roll.axis.x_px(score.tempo_map.seconds(float(score.metre_map.tick_of_bar(bar)))) for bar in (17, 19))
    hand = Hand(roll.plot)
    hand.drag((left + 2, roll.y_px(high.pitch + 4)), (right - 2, roll.y_px(min(n.pitch for n in inside) - 1)))
    assert set(work.session.selection.notes) >= {note.id for note in inside[1:-1]}
    work.key(roll.plot, Qt.Key.Key_X)
    menu = QApplication.activePopupWidget()
    assert menu is not None
    entry = next(action for action in menu.actions() if action.objectName() == "expression_strained")
    entry.trigger()
    menu.close()
    work.planned()
    assert any(event.expression == "strained" and event.corrected for event in work.plan.expressions)
    work.session.set_playhead(score.tempo_map.seconds(float(high.onset_tick + high.duration_tick // 2)))


def lift_bell(work: Work) -> None:
    """Drag the bell's handle upwards."""
    work.session.viewport.set_view("front")
    work.session.viewport.set_posing(True)
    work.picture("pose_tool")
    viewport = work.viewport
    place = viewport.handle_places()["bell"]
    canvas = viewport.canvas_widget()
    assert canvas is not None
    Hand(canvas).drag((place.x(), place.y()), (place.x(), place.y() - 40))
    work.planned()
    assert any(event.target == "bell" and event.up_deg > 1.0 for event in work.plan.poses)


def take_recording(work: Work) -> None:
    """Add a recording that begins before the music, whose offset is estimated."""
    path = work.folder / "recording.flac"
    sound = mixdown(work.session.project, OFFSET_S, 40.0, 48_000)
    noise = np.random.default_rng(1).normal(0.0, 0.003, sound.shape).astype(np.float32)
    soundfile.write(path, np.clip(sound + noise, -1.0, 1.0), 48_000)
    work.answers.path = path
    work.do("file.add_audio")

    def estimated() -> bool:
        audio = work.session.project.audio
        return audio is not None and audio.confidence is not None

    work.until(estimated, "the estimate")
    audio = work.session.project.audio
    assert abs(audio.offset_s - OFFSET_S) < 0.02, audio


def work_until_killed(folder: Path) -> None:
    """Do all steps and wait to be killed."""
    work = Work(folder)
    work.answers.path = LUTKIN
    work.do("file.import_midi")
    work.until(lambda: len(work.session.project.players) == 4, "the import")
    work.picture("imported")
    pin_three(work)
    work.picture("three_fingerings")
    move_breath(work)
    work.picture("breath_moved")
    lower_amplitude(work)
    work.picture("amplitude_lowered")
    strain(work)
    work.session.viewport.set_view("mouth")
    work.picture("strained")
    lift_bell(work)
    work.picture("bell_lifted")
    work.session.viewport.set_posing(False)
    work.session.viewport.set_view("ensemble")
    take_recording(work)
    work.show_bars(1, 8)
    work.picture("offset")
    work.answers.path = folder / "work.suisou"
    work.do("file.save")
    work.until(lambda: work.session.document.is_saved, "saving")
    # One more edit, which is not saved.
    first = work.plan.fingerings[0].note_id
    work.click_note(first)
    work.key(work.timeline.roll.plot, Qt.Key.Key_Up)
    work.until(lambda: any(folder.glob("*.autosave")), "the autosave")
    work.picture("edited_on")
    sys.stdout.write("ready to be killed\n")
    sys.stdout.flush()
    while True:
        work.application.processEvents()
        time.sleep(0.01)


def recover_and_export(folder: Path) -> None:
    """Start the editor again, accept the offered recovery, and export."""
    work = Work(folder)
    offered: list[Recoverable] = []
    work.program.editor.files.find_recoverable(offered.extend)
    work.until(lambda: bool(offered), "what was lost")
    assert len(offered) == 1, offered
    work.pictures = 20
    work.draw(work.window, "offered")
    work.program.editor.files.recover(offered[0])
    work.until(lambda: len(work.session.project.players) == 4, "the recovery")
    work.picture("recovered")
    work.do("export.files")
    dialog = next(widget for widget in QApplication.topLevelWidgets() if widget.objectName() == "export_files")
    child(dialog, QLineEdit, "export_folder").setText(str(folder / "out"))
    bars, last_bar = dialog.findChild(QComboBox, "export_range"), dialog.findChild(QSpinBox, "export_last_bar")
    assert last_bar is not None
    bars.setCurrentIndex(1)
    last_bar.setValue(8)
    QTest.mouseClick(dialog.findChild(QPushButton, "export_start"), Qt.MouseButton.LeftButton)
    work.until(lambda: (folder / "out" / "report.json").exists(), "the export")
    pause(300)
    work.pictures += 1
    work.draw(dialog, "exported")
    work.answers.answer = "save"
    work.do("file.save")
    work.until(lambda: work.session.document.is_saved, "saving")
    dialog.close()
    work.window.close()
    work.program.end()


if __name__ == "__main__":
    {"work": work_until_killed, "recover": recover_and_export}[sys.argv[1]](Path(sys.argv[2]))
