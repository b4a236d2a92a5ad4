"""Calls requested by other threads are executed in the window's thread, in order, each in its own turn of the event
loop.
"""

from __future__ import annotations

import gc
import threading

from PySide6.QtCore import QEventLoop
from pytestqt.qtbot import QtBot

from app.editor.window_thread_calls import Calls


def test_they_are_made_here_in_order(qtbot: QtBot) -> None:
    calls, made = Calls(), list[tuple[int, int]]()

    def thread() -> None:
        for number in range(2000):
            calls.ask(lambda number=number: made.append((number, threading.get_ident())))

    worker = threading.Thread(target=thread)
    worker.start()
    # More calls than fit into a socket's buffer are requested before the window handles any.
    worker.join()
    assert made == []
    qtbot.waitUntil(lambda: len(made) == 2000)
    assert made == [(number, threading.get_ident()) for number in range(2000)]


def test_one_that_fails_keeps_none_from_being_made(qtbot: QtBot) -> None:
    calls, made = Calls(), list[int]()

    def fail() -> None:
        raise KeyError("of the test")

    with qtbot.captureExceptions() as faults:
        calls.ask(fail)
        calls.ask(lambda: made.append(1))
        qtbot.waitUntil(lambda: made == [1])
    assert [kind for kind, _, _ in faults] == [KeyError]


def test_one_that_waits_in_a_dialog_does_not_hold_the_others(qtbot: QtBot) -> None:
    calls, loop, made = Calls(), QEventLoop(), list[str]()

    def wait() -> None:
        loop.exec()
        made.append("dialog closed")

    calls.ask(wait)
    calls.ask(lambda: made.append("other"))
    calls.ask(loop.quit)
    qtbot.waitUntil(lambda: len(made) == 2)
    assert made == ["other", "dialog closed"]


def test_asking_a_window_that_is_gone_harms_no_one(qtbot: QtBot) -> None:
    calls = Calls()
    ask = calls.ask
    del calls
    gc.collect()
    ask(lambda: None)
    qtbot.wait(10)
