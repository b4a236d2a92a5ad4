"""Reaction times of the whole window with fifty players and a hundred thousand notes. Printed, never asserted."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtWidgets import QApplication

from app.editor.selection import Selection
from app.errors import Message
from app.plan.by_hand.corrections import AddExpression, Correction, PinFingering, SetBreath
from app.project.edit import notes
from app.project.edit.corrections import with_corrections
from app.project.model import Project
from tests.bench.window.editor import LargeEditor, Turn, calibration_s, memory_mb

FRAMES = 40
LONG_S = 150.0
"""Seconds within which everything is computed, for measuring memory at rest."""
CORRECTIONS = 3
"""Number of repetitions of each correction; the median is reported."""


@pytest.fixture
def editor(qapp: QApplication, tmp_path: Path) -> Iterator[LargeEditor]:
    result = LargeEditor(tmp_path)
    yield result
    result.close()


class Frames:
    """Work that is done sixty times a second."""

    def __init__(self, editor: LargeEditor) -> None:
        self.editor = editor
        self.session = editor.session
        self.axis = editor.timeline.axis
        player = self.session.player
        assert player is not None
        self.ids = [note.id for note in self.session.project.part(player).notes]
        self.start_s = self.session.playhead_s

    def pan(self, number: int) -> None:
        self.axis.pan(self.axis.span_s * 0.03 * (1 if number % 20 < 10 else -1))

    def zoom(self, number: int) -> None:
        self.axis.zoom(1.1 if number % 2 else 1 / 1.1, (self.axis.start_s + self.axis.end_s) / 2)

    def select(self, number: int) -> None:
        self.session.select(Selection(frozenset(self.ids[10 * number : 10 * number + 200])))

    def click(self, number: int) -> None:
        self.session.select(Selection(frozenset(self.ids[number : number + 1])))

    def play(self, number: int) -> None:
        # Sound positions are never exactly at a frame.
        self.session.set_playhead(self.start_s + (number + 0.4) / 60.0)


@pytest.mark.bench
def test_whole_window(editor: LargeEditor, capsys: pytest.CaptureFixture[str]) -> None:
    unit_s = calibration_s()
    with capsys.disabled():
        for what, cpu_s, wall_s in editor.open():
            print(f"\nopened: {what}: {cpu_s:.1f} s of CPU of all threads, {wall_s:.1f} s of wall time", end="")
        kinds = {player.instrument_id for player in editor.session.project.players}
        print(f"\n{len(kinds)} kinds of instruments; calibration loop {1000 * unit_s:.1f} ms")
        session, axis = editor.session, editor.timeline.axis
        editor.phase = "making sound and motion"
        session.set_playhead(60.0)
        axis.show(50.0, 80.0)
        print(editor.rest())
        print("memory with everyone drawn {:.0f} MB, at most {:.0f} MB".format(*memory_mb()))
        with editor.still_gl():
            editor.phase = "frames"
            floor_s = editor.floor_s()
            print(f"composing the window (taken off below): {1000 * floor_s:.1f} ms of CPU")
            frames = Frames(editor)
            for act in (frames.pan, frames.zoom, frames.click, frames.select, frames.play):
                play(editor, act, floor_s, unit_s)
            print("From an edit, or its undoing, to the picture with the newest pose at the playhead:")
            for name, edit in EDITS.items():
                editor.phase = name
                correct(editor, name, edit, unit_s)
        gc.collect()
        for phase, stall in editor.stalls.items():
            print(
                f"longest stall, {phase}: {1000 * stall.cpu_s:.0f} ms of CPU, {1000 * stall.wall_s:.0f} ms of wall time"
            )
        print(editor.rest(LONG_S))
        gc.collect()
        now_mb, most_mb = memory_mb()
        print(f"memory {now_mb:.0f} MB, at most {most_mb:.0f} MB")


def play(editor: LargeEditor, act: Callable[[int], None], floor_s: float, unit_s: float) -> None:
    """One kind of frame, again and again."""
    session, axis = editor.session, editor.timeline.axis
    playing = act.__name__ == "play"
    session.set_playing(playing)
    session.listening.set(scrub_sound=False)
    axis.show(50.0, 80.0)
    for _ in range(5):
        editor.turn()
    turns = [editor.turn(lambda number=number: act(number)) for number in range(FRAMES)]
    session.set_playing(False)
    session.select(Selection())
    session.set_playhead(60.0)
    editor.turn()
    cpu_ms = [1000 * (turn.cpu_s - floor_s) for turn in turns]
    drawing_ms = float(np.median([1000 * turn.drawing_s for turn in turns]))
    wall_ms = float(np.median([1000 * turn.wall_s for turn in turns]))
    middle, most = np.percentile(cpu_ms, [50, 95])
    print(
        f"{act.__name__:>7}: {middle:6.1f} ms of CPU a frame, 95 % {most:6.1f}, "
        f"{middle / 1000 / unit_s:5.2f} x the loop; of that Python's drawing of players {drawing_ms:.1f}; "
        f"wall {wall_ms:.1f}"
    )


Edit = Callable[[LargeEditor, int], Callable[[Project], Project]]


def correction(make: Callable[[LargeEditor, int], Correction]) -> Edit:
    def edit(editor: LargeEditor, number: int) -> Callable[[Project], Project]:
        player = editor.session.player
        assert player is not None
        made = make(editor, number)
        return lambda project: with_corrections(project, player.id, [made])

    return edit


def note_at_playhead(editor: LargeEditor, number: int) -> int:
    session = editor.session
    assert session.player is not None
    events = session.performance.plan(session.player).fingerings
    return next(index for index, event in enumerate(events) if event.start_s >= session.playhead_s) + number


def fingering(editor: LargeEditor, number: int) -> Correction:
    session = editor.session
    assert session.player is not None
    events, at = session.performance.plan(session.player).fingerings, note_at_playhead(editor, number)
    other = next(event.label for event in events[at + 1 :] if event.label != events[at].label)
    return PinFingering(events[at].note_id, other)


def breath(editor: LargeEditor, number: int) -> Correction:
    session = editor.session
    assert session.player is not None
    events = session.performance.plan(session.player).fingerings
    return SetBreath(events[note_at_playhead(editor, 2 * number)].note_id, -240)


def expression(editor: LargeEditor, number: int) -> Correction:
    session = editor.session
    assert session.player is not None
    events = {note.id: note for note in session.project.part(session.player).notes}
    at = session.performance.plan(session.player).fingerings[note_at_playhead(editor, number)].note_id
    return AddExpression(f"x{number}", "strained", events[at].onset_tick, events[at].onset_tick + 960)


def pitch(editor: LargeEditor, number: int) -> Callable[[Project], Project]:
    session = editor.session
    assert session.player is not None
    at = session.performance.plan(session.player).fingerings[note_at_playhead(editor, number)].note_id
    return lambda project: notes.move(project, frozenset({at}), 0, 1)


EDITS: dict[str, Edit] = {
    "a fingering": correction(fingering),
    "a note's pitch": pitch,
    "a breath": correction(breath),
    "an expression": correction(expression),
}


def correct(editor: LargeEditor, name: str, edit: Edit, unit_s: float) -> None:
    """One kind of correction, made and taken back some times."""
    session = editor.session
    player = session.player
    assert player is not None
    pictures = list[Turn]()
    for number in range(CORRECTIONS):
        change = edit(editor, number)
        pictures.append(
            editor.picture(
                player.id,
                lambda change=change: session.attempt(Message("edit.move_notes", {"count": 1, "of": ""}), change),
            )
        )
        editor.until(lambda: False, 0.5)
        pictures.append(editor.picture(player.id, session.document.undo))
        editor.until(lambda: False, 0.5)
    for what, pick in (("best", 0), ("median", CORRECTIONS)):
        turn = sorted(pictures, key=lambda turn: turn.wall_s - turn.drawing_wall_s)[pick]
        print(
            f"{name}: the picture is right, {what} of {len(pictures)}: "
            f"{1000 * (turn.wall_s - turn.drawing_wall_s):.0f} ms of wall time, "
            f"{1000 * (turn.cpu_s - turn.drawing_s):.0f} ms of CPU, {(turn.cpu_s - turn.drawing_s) / unit_s:.2f} x "
            f"the loop; drawing besides {1000 * turn.drawing_s:.0f} ms of CPU"
        )
