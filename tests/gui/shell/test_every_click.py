"""Everything that can be clicked in the window, clicked by the mouse in many states, judged by what changed.

Each button, choice and menu entry has a row in `tests.support.click_table`, which names the subjects of
`tests.support.window_state` that its click changes. What is in the window and not in the table fails, and so does a
click that changes nothing, or anything else.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from PySide6.QtCore import QByteArray, QUrl
from PySide6.QtGui import QColor, QDesktopServices
from PySide6.QtWidgets import QApplication, QColorDialog, QComboBox, QFileDialog, QMenu, QTabWidget, QToolButton

from app.choreography.accent_grid import grid_of
from app.choreography.dance import Manner, SegmentStep
from app.choreography.generate import Choreographer
from app.choreography.rhythm import Rhythm
from app.editor.design_tokens import LIGHT
from app.editor.selection import Selection
from app.editor.viewport_state import SHOWN
from app.errors import Message
from app.performance.ensemble import Performance
from app.project.casting import StagePosition
from app.project.edit.players import change, place
from app.project.edit.takes import comp
from app.project.model import Project
from app.shell.commands import fingerings
from tests.support import mouse
from tests.support.click_table import TABLE, expected
from tests.support.clicker import CHOSEN, NOTHING, Clicker, click
from tests.support.desk import (
    Deed,
    Desk,
    a_breath,
    afresh,
    dancing,
    has_percussion,
    has_recording,
    has_video,
    quieten,
    recorded,
)
from tests.support.window_state import Watcher
from tests.support.windows import child
from widgets.common.actions import actions
from widgets.common.number_slider import NumberSlider
from widgets.common.section import SectionHeader
from widgets.inspector.correction_list import CorrectionList
from widgets.inspector.face_picture import FacePicture
from widgets.viewport.panel import ViewportPanel


def command(action_id: str) -> Deed:
    return lambda desk: actions(desk.session)[action_id].trigger()


def muted_light_japanese(desk: Desk) -> None:
    actions(desk.session)["players.mute"].trigger()
    desk.session.set_tokens(LIGHT)
    desk.program.editor.speak("ja")


def by_hand(desk: Desk) -> None:
    """Change a player's place and acting, and the fingerings and marks of notes."""
    there = {desk.player.id: StagePosition(0.3, 1.2, 0.25)}
    actions(desk.session)["players.randomise"].trigger()
    actions(desk.session)["fingering.cycle"].trigger()
    actions(desk.session)["marks.staccato"].trigger()
    actions(desk.session)["cameras.keep"].trigger()
    tabs, corrections = desk.program.window.findChild(QTabWidget), desk.program.window.findChild(CorrectionList)
    assert isinstance(tabs, QTabWidget)
    assert isinstance(corrections, CorrectionList)
    tabs.setCurrentWidget(corrections)
    desk.session.attempt(
        Message("edit.place_players", {"of": "Trumpet 1"}),
        lambda project: change(place(project, there), (desk.player.id,), colour="#204060"),
    )


def typing_fingerings(desk: Desk) -> None:
    """Select notes of a trombone that have every position and type 1, which T completes; drums play too."""
    has_percussion(desk)
    player = next(player for player in desk.project.players if "trombone" in player.instrument_id)
    notes = {
        fingering.label: note.id
        for note in desk.project.part(player).notes
        for fingering in desk.session.performance.instrument(player).fingerings_for(note.pitch)
    }
    assert {*"1234567", "T1"} <= set(notes)
    desk.session.set_players((player.id,))
    desk.session.select(Selection(frozenset(notes.values())))
    actions(desk.session)["fingering.type_1"].trigger()


def takes_of_a_part(desk: Desk) -> None:
    """Select a span of a take, half of which is used in the part."""
    recorded("take:2", (0, 4000))(desk)
    desk.session.attempt(
        Message("edit.comp", {"take": "2"}), lambda project: comp(project, desk.player.id, "take:2", 2000, 4000)
    )


STATES: dict[str, Deed | None] = {
    "no piece": None,
    "nothing selected": lambda desk: desk.session.select(Selection()),
    "notes": lambda desk: None,
    "breath": a_breath,
    "gesture": command("gesture.sway"),
    "by hand": by_hand,
    "playing": command("play.toggle"),
    "recording": command("record.toggle"),
    "muted, light, Japanese": muted_light_japanese,
    "dancer": dancing,
    "recording and video": lambda desk: (has_recording(desk), has_video(desk)),
    "takes": takes_of_a_part,
    "typing fingerings": typing_fingerings,
}
BAR_ONLY = ("typing fingerings",)
WITH_BAR = ("no piece", "by hand")
WITH_MENUS = ("by hand",)
WITH_CONTEXT = ("by hand", "takes")
ARRANGED = frozenset(("folded", "full_screen", "lanes", "page", "panels", "workspace"))
"""Subjects of the window's layout."""


class Stage:
    """Creates the states of the editor repeatedly."""

    def __init__(self, desk: Desk) -> None:
        self.desk = desk
        self.window = desk.program.window
        self.deed: Deed | None = None
        self._opened: Project | None = None
        self._made: tuple[Project, Selection, tuple[str, ...], str] | None = None
        self._plans: Performance | None = None
        self._layout: tuple[QByteArray, str] | None = None
        self._usual: tuple[QByteArray, str] | None = None

    def begin(self, deed: Deed | None) -> None:
        """Create another state."""
        self.deed, self._made, self._plans = deed, None, None
        quieten(self.desk)
        self.again()

    def again(self, changed: frozenset[str] | None = None) -> None:
        """Restore the current state; ``changed`` names the subjects that differ, None for possibly all."""
        desk, session = self.desk, self.desk.session
        if self.deed is None:
            quieten(desk)
            if desk.program.editor.files.is_open:
                desk.program.editor.files.close()
        elif self._made is not None and self._goes_back(self._made[0]):
            quieten(desk, looks=self.deed is not muted_light_japanese)
            project, selection, players, dancer = self._made
            while session.project is not project:
                session.document.undo()
            session.set_players(players)
            session.set_dancer(dancer)
            session.select(selection)
            if self.deed is muted_light_japanese:
                session.set_tokens(LIGHT)
                desk.program.editor.speak("ja")
            if changed is None or changed & ARRANGED:
                self._lay_out()
        else:
            self._opened = afresh(desk, self._opened)
            self._lay_out()
            tabs = self.window.findChild(QTabWidget, "inspector_tabs")
            if isinstance(tabs, QTabWidget):
                tabs.setCurrentIndex(0)
            self.deed(desk)
            # Text being typed is not part of the project yet.
            if not (session.playing or session.recording.running or self.deed is typing_fingerings):
                dancer = session.dancer.id if session.dancer is not None else ""
                self._made = (session.project, session.selection, session.players, dancer)
                self._plans = session.performance
        desk.answers.asked.clear()
        clipboard = QApplication.clipboard()
        if (changed is None or "copied" in changed) and clipboard.text():
            # A number that was copied elsewhere.
            clipboard.setText("0.37")
        QApplication.processEvents()

    def performance(self, project: Project, before: Performance, waiting: frozenset[str] = frozenset()) -> Performance:
        """Plans of a project; those of the state are computed only once."""
        known = self._plans
        is_known = known is not None and known.planned and known.project is project
        return known if known is not None and is_known else Performance(project, before, waiting)

    def _goes_back(self, project: Project) -> bool:
        document = self.desk.session.document
        return project is document.project or any(step.before is project for step in document.done)

    def _lay_out(self) -> None:
        window = self.window
        for header in window.findChildren(SectionHeader):
            header.set_open(True)
        if self._layout is None:
            self.desk.settle()
            self._layout = self._usual = self._layout_now()
        elif self._layout_now() != self._usual:
            window.restoreState(self._layout[0])
            window.timeline.restore_state(self._layout[1])
            # The sizes of docks need not be the same to the pixel.
            self._usual = self._layout_now()

    def _layout_now(self) -> tuple[QByteArray, str]:
        return self.window.saveState(), self.window.timeline.save_state()


@pytest.fixture
def stage(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> Stage:
    """The editor with dialogs of the system disabled."""
    asked = desk.answers.asked

    def noted(name: str, answer: object) -> Callable[..., object]:
        return lambda *_, **__: (asked.append(name), answer)[1]

    monkeypatch.setattr(QDesktopServices, "openUrl", noted("desktop", True))
    monkeypatch.setattr(QColorDialog, "getColor", noted("colour", QColor()))
    for name in ("getOpenFileUrl", "getOpenFileUrls", "getSaveFileUrl"):
        monkeypatch.setattr(QFileDialog, name, noted("file", (QUrl(), "")))
    # A slow machine takes its time between two signs.
    monkeypatch.setattr(fingerings, "TYPED_TOGETHER_S", float("inf"))
    # The dialogs that ask about films make none before the user says so.
    monkeypatch.setattr(ViewportPanel, "has_gl", property(lambda self: True))
    # Drawing faces is tested elsewhere and would take most of the time.
    monkeypatch.setattr(FacePicture, "_draw", lambda self: None)
    choose_steps_once(monkeypatch)
    desk.program.window.setUpdatesEnabled(False)
    desk.program.window.setAnimated(False)
    mouse.park_pointer()
    stage = Stage(desk)
    monkeypatch.setattr("app.editor.generator.Performance", stage.performance)
    return stage


def choose_steps_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Give dances of one choreography to one grid of accents the same steps: choosing those of every change takes a
    quarter of the time, and is tested elsewhere."""
    choose = Choreographer.steps
    known: dict[tuple[Choreographer, bytes], tuple[SegmentStep, ...]] = {}

    def steps(self: Choreographer, rhythm: Rhythm, manner: Manner, **options: Any) -> tuple[SegmentStep, ...]:
        key = self, grid_of(self.felt(rhythm)).times_s.tobytes()
        if key not in known:
            known[key] = choose(self, rhythm, manner, **options)
        return known[key]

    monkeypatch.setattr(Choreographer, "steps", steps)


def test_every_click_does_what_the_table_says(stage: Stage) -> None:
    desk, window = stage.desk, stage.window
    clicker = Clicker(desk.program, Watcher(desk.program, desk.answers), stage.again)
    for state, deed in STATES.items():
        clicker.state = state
        stage.begin(deed)
        if state not in BAR_ONLY:
            clicker.buttons(every=state == "notes")
            stage.again()
        clicker.bar(every=state in WITH_BAR)
        if state in WITH_MENUS:
            clicker.menus_of_buttons()
        if state in WITH_CONTEXT:
            lanes = {f"lane {lane.id}": lane.plot for lane in window.timeline.lanes.values()}
            slider = next(found for found in window.players.findChildren(NumberSlider) if found.isVisible())
            # The acting lane has a row for each kind of event.
            clicker.context_menus({"lane acting": lanes.pop("lane acting")}, rows=11)
            clicker.context_menus(
                {
                    **lanes,
                    "lane header": window.timeline.lanes["breath"].header,
                    "ruler": window.timeline.ruler,
                    "players": window.players.list.viewport(),
                    "slider": slider,
                }
            )
    wrong = faults(clicker.seen)
    assert not wrong, "\n".join(wrong)


def faults(seen: dict[str, dict[str, frozenset[str]]]) -> list[str]:
    """Compare the changes by clicks with the table, and list the differences."""
    wrong, used, acts = [], set[str](), set[str]()
    for name, states in seen.items():
        row = expected(name)
        if row is None:
            wrong.append(f"{name}: not in the table; it changes {sorted(map(sorted, set(states.values())))}")
            continue
        used.add(row.pattern)
        for state, found in states.items():
            is_idle = not found - NOTHING - (row.besides - row.changes)
            if found == CHOSEN or (is_idle and row.may_be_idle):
                continue
            if not row.changes <= found:
                wrong.append(f"{name} ({state}): changes {sorted(found)}, not {sorted(row.changes - found)}")
            elif found - row.changes - row.besides:
                wrong.append(f"{name} ({state}): also changes {sorted(found - row.changes - row.besides)}")
        if any(row.changes <= found for found in states.values()):
            acts.add(row.pattern)
    # Among similar entries, such as one for each player, those already chosen need not act.
    wrong += [f"{pattern}: does nothing in any state" for pattern in sorted(used - acts)]
    wrong += [f"{pattern}: in the table, but nowhere in the window" for pattern in TABLE if pattern not in used]
    return wrong


def test_entries_of_the_eye_menu_show_or_hide_and_arrows_in_an_open_list_are_no_shortcuts(desk: Desk) -> None:
    project = afresh(desk, None)
    state = desk.session.viewport
    eye = child(desk.program.window, QToolButton, "viewport_show")
    for at, what in enumerate(SHOWN):

        def click_entry(menu: QMenu, at: int = at) -> None:
            mouse.choose(menu, menu.actions()[at])

        before = [state.shows(other) for other in SHOWN]
        mouse.in_menu_of(eye, click_entry)
        assert [state.shows(other) for other in SHOWN] == [
            on != (other == what) for other, on in zip(SHOWN, before, strict=True)
        ]
        mouse.in_menu_of(eye, click_entry)
        assert [state.shows(other) for other in SHOWN] == before

    # Down moves selected notes in the timeline, and the choice in its list of players.
    players = child(desk.program.window, QComboBox, "front_player")
    players.setFocus()
    assert click(players)
    QApplication.processEvents()
    assert desk.project is project
    assert desk.session.players == (project.players[1].id,)
