"""Playback with a device and a clock controlled by the test."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from app.audio.playback import Playback
from app.editor.session import Session
from app.editor.sound import EditorSound
from tests.gui.transport.devices import FakeDevices, Time
from tests.support.phrases import know_phrases

STEP_S = 0.01

Elapse = Callable[[float], None]


@pytest.fixture(autouse=True)
def _phrases_known(monkeypatch: pytest.MonkeyPatch) -> None:
    know_phrases(monkeypatch)


@pytest.fixture
def time() -> Time:
    return Time()


@pytest.fixture
def devices(time: Time) -> FakeDevices:
    return FakeDevices(time)


@pytest.fixture
def playback(qapp: object, devices: FakeDevices, time: Time) -> Iterator[Playback]:
    result = Playback(devices.open, time)
    result.set_span(-1.0, 20.0)
    yield result
    result.stop()
    result.deleteLater()


@pytest.fixture
def elapse(playback: Playback, time: Time) -> Elapse:
    """Advance the clock, feeding the device like its timer."""

    def run(seconds: float) -> None:
        for _ in range(round(seconds / STEP_S)):
            time.now_s += STEP_S
            playback.feed()

    return run


@pytest.fixture
def sound(session: Session, playback: Playback, devices: FakeDevices) -> Iterator[EditorSound]:
    """Sound of the session, rendered synchronously."""
    result = EditorSound(session, playback)
    yield result
    playback.stop()
