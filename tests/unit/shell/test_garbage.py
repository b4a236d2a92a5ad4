"""Cycles of Python that hold widgets die in the window's thread, whoever makes the rubbish."""

from __future__ import annotations

import subprocess
import sys

SCRIPT = """
import gc, threading, time
from PySide6.QtCore import QCoreApplication, QObject
from app.shell.garbage import Garbage

application = QCoreApplication([])
garbage = Garbage()
gc.set_threshold(1, 1, 1)
died = []

class Cycle(QObject):
    def __init__(self):
        super().__init__()
        self.me = self
    def __del__(self):
        died.append(threading.get_ident())

def busy(end):
    while not end.is_set():
        made = []
        made.append(made)

end = threading.Event()
worker = threading.Thread(target=busy, args=(end,))
worker.start()
until = time.monotonic() + 20
made = 0
while len(died) < 40 and time.monotonic() < until:
    if made < 40:
        Cycle()
        made += 1
    application.processEvents()
    time.sleep(0.01)
garbage.stop()
Cycle()
time.sleep(0.05)
end.set()
worker.join()
assert len(died) == 40, died
assert set(died) == {threading.get_ident()}
"""


def test_cycles_die_in_the_window_s_thread_alone() -> None:
    done = subprocess.run(
        [sys.executable, "-X", "faulthandler", "-c", SCRIPT], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
