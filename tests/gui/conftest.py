"""Fixtures for tests of the editor: a session with the bundled quartet, the theme, and failure on Qt's warnings."""

from __future__ import annotations

import gc
import traceback
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from PySide6.QtCore import QCoreApplication, QEvent, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from app.choreography.model_file import write_model
from app.editor.design_tokens import DARK
from app.editor.session import Session
from app.editor.tasks import ThreadTasks
from app.errors import AppError
from app.performance.ensemble import Performance
from app.project.model import Project, map_choices, project_from_score
from app.score.contents import PieceContents
from app.score.read import read_contents, read_midi
from app.shell.crash_handler import CrashHandler
from app.shell.language import Language
from app.shell.theme import apply_theme
from instrument_maps.load import bundled_maps
from tests.gui.japanese import speaking
from tests.support.dances import model
from tests.support.motions import know_motion
from tests.support.tasks import ImmediateTasks
from widgets.common.font import apply_font
from widgets.viewport import canvas

QUARTET = Path(__file__).parents[2] / "resources" / "examples" / "quartet.mid"

# A worker that triggers the collection would destroy widgets in its own thread: here it happens between tests alone.
gc.disable()
# Smooth edges take the processor a third of the time in which it draws.
canvas.SAMPLES = 0
# Before the application is made: the viewport's context survives docking and floating.
QCoreApplication.setAttribute(Qt.ApplicationAttribute.AA_ShareOpenGLContexts)


@cache
def quartet_project() -> Project:
    """The bundled quartet, read once; values never change."""
    maps = bundled_maps()
    return project_from_score(read_midi(QUARTET, maps=map_choices(maps.values())), maps)


@cache
def _contents() -> PieceContents:
    return read_contents(QUARTET)


@pytest.fixture(autouse=True)
def _quartet_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cache the file of the quartet, which editors open often."""
    monkeypatch.setattr(
        "app.editor.files.read_contents",
        lambda path, **options: _contents() if path == QUARTET and not options else read_contents(path, **options),
    )


@cache
def planned_quartet() -> Performance:
    """Performance of the quartet with complete plans."""
    performance = Performance(quartet_project())
    performance.prepare()
    return performance


@pytest.fixture(autouse=True)
def _plans_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cache the plans of the bundled quartet for all tests, so that editors need not plan it."""
    monkeypatch.setattr("app.editor.session.Performance", lambda project: Performance(project, planned_quartet()))


@pytest.fixture(autouse=True)
def _motion_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cache the motion of these plans; motion of edited ones is computed in each test."""
    know_motion(monkeypatch, lambda: planned_quartet().plans.values() if planned_quartet.cache_info().currsize else ())


@pytest.fixture(scope="session")
def qapp_args() -> list[str]:
    """Name of the program."""
    return ["suisou"]


def delete_now() -> None:
    """Delete all objects with a pending deletion."""
    QCoreApplication.processEvents()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete.value)


@pytest.fixture(scope="session")
def qapp(qapp: QApplication) -> QApplication:
    """The application, in English."""
    Language()
    return qapp


@pytest.fixture
def qt_app(qapp: QApplication) -> QApplication:
    """The application in the dark theme."""
    apply_font(qapp)
    apply_theme(qapp, DARK)
    return qapp


@pytest.fixture
def tasks() -> ImmediateTasks:
    """Task runner that works synchronously."""
    return ImmediateTasks()


@pytest.fixture(autouse=True)
def _planned_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Plan small pieces synchronously even on a slow machine, so that tests need not wait."""
    monkeypatch.setattr("app.editor.generator.AT_ONCE_S", 60.0)


@pytest.fixture
def session(qt_app: QApplication, tasks: ImmediateTasks) -> Iterator[Session]:
    """The editor's state with the bundled quartet open."""
    result = Session(quartet_project(), tasks)
    yield result
    result.deleteLater()


@pytest.fixture(autouse=True)
def _widgets_die_here(qapp: QApplication) -> Iterator[None]:
    """Delete the widgets that a test leaves behind before the next test begins, so that a fault shows in the test that
    made it."""
    # Objects that exist now will stay, such as characters loaded by the previous test: they are collected once here and
    # then exempted.
    gc.collect()
    gc.freeze()
    yield
    held = QGuiApplication.mouseButtons()
    if held != Qt.MouseButton.NoButton:
        # Needed after a double click of `QTest`, which ends with a press.
        QTest.mouseRelease(QWidget(), held)
    for widget in QApplication.topLevelWidgets():
        widget.close()
        widget.deleteLater()
    delete_now()
    gc.collect()
    assert QGuiApplication.mouseButtons() == Qt.MouseButton.NoButton


@pytest.fixture(autouse=True)
def _faults_of_the_program_fail(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Fail tests in which the program's crash handler receives an exception, unless marked ``at_fault``. pytest-qt and
    pytest handle other uncaught exceptions, including those of threads and finalisers.

    Other uncaught exceptions are pytest-qt's, and pytest's own for threads and finalisers.
    """
    faults: list[BaseException] = []
    report = CrashHandler.report

    def noted(handler: CrashHandler, error: BaseException) -> None:
        if not isinstance(error, AppError):
            faults.append(error)
        report(handler, error)

    monkeypatch.setattr(CrashHandler, "report", noted)
    yield
    if faults and request.node.get_closest_marker("at_fault") is None:
        pytest.fail("".join("".join(traceback.format_exception(fault)) for fault in faults), pytrace=False)


@pytest.fixture
def japanese(qt_app: QApplication) -> Iterator[None]:
    with speaking():
        yield


@pytest.fixture
def threaded(qt_app: object) -> Iterator[Session]:
    """A session with the bundled quartet whose tasks run in threads, as in the program."""
    tasks = ThreadTasks()
    session = Session(quartet_project(), tasks)
    yield session
    tasks.cancel_all(5.0)
    session.deleteLater()


@pytest.fixture(scope="session")
def choreography(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """File of a learned choreography that the editor's user chooses."""
    path = tmp_path_factory.mktemp("dances") / "steps & more.choreography"
    write_model(path, model())
    return path
