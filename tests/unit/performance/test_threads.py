"""Window and workers load tables simultaneously."""

from __future__ import annotations

import subprocess
import sys

SCRIPT = """
import sys, threading
from instrument_maps.load import bundled_maps
from metadata.load import load_body, load_expression, names
from app.project.running_editors import PresenceNote
sys.setswitchinterval(1e-6)
barrier = threading.Barrier(4)
def work():
    barrier.wait()
    load_body()
    bundled_maps()
    [load_expression(name) for name in names("expression")]
threads = [threading.Thread(target=work) for _ in range(4)]
[thread.start() for thread in threads]
[thread.join() for thread in threads]
print("lived")
"""


def test_tables_are_loaded_by_several_threads_at_once() -> None:
    # In a process of its own: what would be wrong ends it (msgspec, types used for the first time by two threads).
    for _ in range(3):
        done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=False)
        assert (done.returncode, done.stdout.strip()) == (0, "lived"), done.stderr
