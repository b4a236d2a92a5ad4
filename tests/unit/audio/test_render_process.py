"""Rendering in a separate process: equal sound, running threads are not blocked, and nothing remains afterwards."""

from __future__ import annotations

import gc
import threading
import time

import numpy as np
import pytest

from app.audio.render_process import RenderProcess
from app.audio.rendering import rendered
from app.audio.synth import Synthesiser, phrases
from app.score.tempo import TempoMap
from tests.unit.audio.pieces import melody

TEMPO = TempoMap(480)
LONG = phrases(melody(*((120 * i, 120, 60 + i % 12) for i in range(32))), TEMPO, 56)


def test_it_sounds_as_it_does_here() -> None:
    process = RenderProcess()
    for phrase in LONG:
        assert np.array_equal(process(phrase.midi), rendered(phrase.midi))


def test_other_threads_go_on_meanwhile() -> None:
    process = RenderProcess()
    process(LONG[0].midi)
    synthesiser = Synthesiser(process)
    beats, rendering = [], threading.Event()

    def beat() -> None:
        while not rendering.is_set():
            beats.append(time.thread_time())
            time.sleep(0.0005)

    thread = threading.Thread(target=beat)
    thread.start()
    cpu_s = time.process_time()
    for phrase in LONG:
        synthesiser.render(phrase)
    cpu_s = time.process_time() - cpu_s
    rendering.set()
    thread.join()
    start_s = time.process_time()
    for phrase in LONG:
        rendered(phrase.midi)
    here_s = time.process_time() - start_s
    assert cpu_s < 0.5 * here_s, "the work is not done by this process, and holds up none of its threads"
    assert beats


def test_a_killed_child_is_not_missed() -> None:
    process = RenderProcess()
    process(LONG[0].midi)
    process._child.process.kill()
    process._child.process.wait()
    assert np.array_equal(process(LONG[0].midi), rendered(LONG[0].midi))


def test_where_no_process_can_be_started(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.executable", "/nowhere/python")
    assert np.array_equal(RenderProcess()(LONG[0].midi), rendered(LONG[0].midi))


def test_the_child_ends_with_its_owner() -> None:
    process = RenderProcess()
    process(LONG[0].midi)
    child = process._child
    assert child.process.poll() is None
    del process
    gc.collect()
    assert child.process.poll() == 0


def test_the_child_ends_when_its_input_does() -> None:
    process = RenderProcess()
    process(LONG[0].midi)
    child = process._child
    child.hang_up()
    assert child.process.wait(10.0) == 0
