"""Reference cycles that contain widgets are freed in the window's thread, whichever thread causes the collection."""

from __future__ import annotations

import subprocess
import sys

SCRIPT = """
import gc, threading, time
from PySide6.QtCore import QCoreApplication, QObject
from app.shell.garbage_collection import Garbage

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
        [sys.executable, "-X", "faulthandler", "-c", SCRIPT], capture_output=True, text=True, timeout=900
    )
    assert done.returncode == 0, done.stderr


LASTING = """
import gc, weakref
from PySide6.QtCore import QCoreApplication
from app.shell import garbage_collection as subject

application = QCoreApplication([])
garbage = subject.Garbage()
gc.set_threshold(0, 0, 0)

class Cycle:
    def __init__(self):
        self.me = self

def full():
    for generation in (0, 1, 1):
        [[] for _ in range(3)]
        gc.collect(generation)
    garbage.collect()

lasts = Cycle()
known = weakref.ref(lasts)
full()
frozen = gc.get_freeze_count()
assert frozen > 10_000
fleeting = weakref.ref(Cycle())
full()
assert fleeting() is None
del lasts
full()
assert known() is not None
assert len(gc.get_objects()) < 2000
grown = [[number] for number in range(int(frozen * subject.GROWN))]
full()
assert known() is None
assert gc.get_freeze_count() > frozen * subject.GROWN
garbage.stop()
assert gc.get_freeze_count() == 0
"""


def test_what_lasts_is_set_aside_and_looked_through_again_once_it_has_grown() -> None:
    done = subprocess.run([sys.executable, "-c", LASTING], capture_output=True, text=True, timeout=900)
    assert done.returncode == 0, done.stderr
