"""The tour of first steps by mouse and keys in the whole editor."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QRect, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialog, QPushButton, QWidget

from app.editor.files import EXAMPLE
from app.shell.app import Program
from app.shell.first_steps.bubble import Bubble
from app.shell.first_steps.tour import FirstSteps
from tests.gui.conftest import QUARTET
from tests.gui.shell.conftest import Answers, trigger
from tests.gui.timeline.lane_hands import click, drag, middle
from tests.support import mouse
from tests.support.desk import Desk
from tests.support.windows import child, show_in_front, wait_until
from widgets.common.actions import actions
from widgets.common.chip import Chip
from widgets.common.number_slider import NumberSlider
from widgets.timeline.lanes.breath import BreathLane
from widgets.timeline.lanes.fingering.alternates import Alternates

SPACE = Qt.Key.Key_Space


def tour_of(program: Program) -> FirstSteps:
    """The running tour."""
    tour = child(program.window, FirstSteps)
    assert wait_until(lambda: tour.progress is not None and tour.bubble.isVisible())
    return tour


def at(tour: FirstSteps) -> tuple[str, bool]:
    """Current stop and whether it is done; empty after the end of the tour."""
    return (tour.progress.stop, tour.progress.is_done) if tour.progress is not None else ("", False)


def in_window(program: Program, widget: QWidget) -> QRect:
    """Rectangle of a widget in the window."""
    return QRect(widget.mapTo(program.window, QPoint()), widget.size())


def test_the_whole_tour_from_the_start_page(desk: Desk) -> None:
    program, window = desk.program, desk.program.window
    mouse.press(child(window, QPushButton, "start_first_steps"))
    tour = tour_of(program)
    # The bundled file is read as MIDI, so no project file could be overwritten.
    assert program.editor.files.path is None
    assert EXAMPLE in desk.project.source
    assert at(tour) == ("play", False)
    assert not tour.bubble.back.isEnabled()
    assert tour.bubble.next.text() == "Skip"
    # The keyboard is where it was: nothing is in the way of the work.
    assert window.timeline.isAncestorOf(QApplication.focusWidget())

    mouse.press(child(window, QWidget, "play_toggle"))
    assert at(tour) == ("play", True)
    QTest.keyClick(QApplication.focusWidget(), SPACE)
    assert not desk.session.playing
    assert tour.bubble.next.text() == "Next"
    mouse.press(tour.bubble.next)

    assert at(tour) == ("fingering", False)
    lane = window.timeline.lanes["fingering"]
    assert tour.frame.geometry().contains(in_window(program, lane).center())
    assert not tour.bubble.geometry().intersects(in_window(program, window.docks["timeline"]))
    instrument = desk.session.performance.instrument(desk.player)
    pitches = {note.id: note.pitch for note in desk.notes()}
    event = next(e for e in desk.plan.fingerings if len(instrument.fingerings_for(pitches[e.note_id])) > 1)
    click(lane, QPoint(round(window.timeline.axis.x_px(event.start_s)) + 2, lane.plot.height() // 2))
    alternates = next(found for found in window.findChildren(Alternates) if found.isVisible())
    mouse.press(next(chip for chip in alternates.findChildren(Chip) if chip.isVisible() and not chip.isChecked()))
    assert at(tour) == ("fingering", True)
    mouse.press(tour.bubble.next)

    assert at(tour) == ("breath", False)
    breaths = window.timeline.lanes["breath"]
    assert isinstance(breaths, BreathLane)
    second = sorted((b for b in desk.plan.breaths if b.kind == "breath"), key=lambda b: b.start_tick)[1]
    # Deeper alone is not moved.
    drag(breaths, middle(breaths, second.id), dy=6.0)
    assert at(tour) == ("breath", False)
    desk.session.document.undo()
    drag(breaths, middle(breaths, second.id), dx=-40.0)
    assert wait_until(lambda: at(tour) == ("breath", True))
    mouse.press(tour.bubble.next)

    assert at(tour) == ("amplitude", False)
    slider = child(window, NumberSlider, "parameter_amplitude")
    assert tour.frame.geometry().contains(in_window(program, slider))
    slider.setFocus()
    QTest.keyClick(slider, Qt.Key.Key_Right)
    assert at(tour) == ("amplitude", True)
    # Going back and on by the keyboard.
    trigger(program, "help.first_steps")
    assert tour.bubble.next.hasFocus()
    QTest.keyClick(tour.bubble.next, SPACE)
    assert at(tour) == ("export", False)
    QTest.keyClick(tour.bubble.next, Qt.Key.Key_Backtab)
    QTest.keyClick(QApplication.focusWidget(), SPACE)
    assert at(tour) == ("amplitude", True)
    trigger(program, "help.first_steps")
    QTest.keyClick(tour.bubble.next, SPACE)

    QTest.keyClick(window, Qt.Key.Key_E, Qt.KeyboardModifier.ControlModifier)
    dialog = next(top for top in QApplication.topLevelWidgets() if top.objectName() == "export_files")
    assert isinstance(dialog, QDialog)
    assert wait_until(lambda: at(tour) == ("export", True))
    dialog.close()
    show_in_front(window)
    assert tour.bubble.next.text() == "Finish"
    mouse.press(tour.bubble.next)
    assert at(tour) == ("", False)
    assert not tour.bubble.isVisible()
    assert not tour.frame.isVisible()


def test_steps_can_be_skipped_and_the_tour_closed_and_begun_again(program: Program, answers: Answers) -> None:
    trigger(program, "help.first_steps")
    tour = tour_of(program)
    assert answers.asked == []
    seen = []
    for _ in range(5):
        seen.append(at(tour)[0])
        mouse.press(tour.bubble.next)
    assert seen == ["play", "fingering", "breath", "amplitude", "export"]
    assert tour.progress is None
    trigger(program, "help.first_steps")
    assert tour_of(program) is tour
    mouse.press(child(tour.bubble, QWidget, "first_steps_close"))
    assert tour.progress is None
    assert not tour.bubble.isVisible()
    assert window_has_keys(program)


def window_has_keys(program: Program) -> bool:
    return program.window.isAncestorOf(QApplication.focusWidget() or program.window.menuBar())


def test_unsaved_work_is_asked_about_and_kept(program: Program, answers: Answers) -> None:
    actions(program.session)["players.randomise"].trigger()
    before = program.session.project
    answers.answer = "cancel"
    trigger(program, "help.first_steps")
    assert answers.asked == ["unsaved"]
    assert program.session.project is before
    assert child(program.window, Bubble).isHidden()
    # A piece that is opened later is no answer to it, unless it is the quartet.
    answers.answer = "discard"
    program.editor.files.begin()
    QApplication.processEvents()
    assert child(program.window, Bubble).isHidden()


def test_the_tour_shows_what_it_is_about(program: Program) -> None:
    """Also with closed panels and folded lanes, in both languages, in small and large windows."""
    window = program.window
    window.show_panel("players", False)
    window.timeline.fold_lanes(True)
    trigger(program, "help.first_steps")
    tour = tour_of(program)
    for size in ((1366, 700), (1600, 1000)):
        window.resize(*size)
        for language in ("ja", "en"):
            program.editor.speak(language)
            while tour.progress.number:
                mouse.press(tour.bubble.back)
            for stop in ("play", "fingering", "breath", "amplitude", "export"):
                assert at(tour)[0] == stop
                assert wait_until(tour.frame.isVisible)
                QApplication.processEvents()
                assert window.rect().contains(tour.bubble.geometry())
                assert not tour.bubble.geometry().intersects(tour.frame.geometry())
                if stop != "export":
                    mouse.press(tour.bubble.next)


def test_the_tour_ends_with_the_piece(program: Program, answers: Answers) -> None:
    trigger(program, "help.first_steps")
    tour = tour_of(program)
    answers.answer = "discard"
    program.editor.files.close()
    assert tour.progress is None
    assert tour.bubble.isHidden()
    program.editor.files.open(QUARTET, ask=False)
    QApplication.processEvents()
    assert tour.progress is None
