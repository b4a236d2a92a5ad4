"""Recording: a take, who is recorded, counting in, the punch range."""

from __future__ import annotations

from math import ceil, floor

from app.editor.recorder import recorder_of
from app.editor.session import Session
from app.shell.action import Action
from app.shell.editor import editor_of


def toggle(session: Session) -> None:
    """Record, or end the take."""
    recorder = recorder_of(session)
    if recorder is not None:
        recorder.toggle()


def devices(session: Session) -> None:
    """Choose what is recorded from, and see what comes in."""
    editor_of(session).window.show_devices()


def latency(session: Session) -> None:
    """Find out how late the device comes."""
    editor_of(session).window.show_latency()


def arm(session: Session, on: bool = True) -> None:
    """Arm the active player for recording, or disarm it."""
    player = session.player
    if player is not None:
        session.recording.set(armed="" if session.recording.armed == player.id else player.id)


def punch(session: Session, on: bool = True) -> None:
    """The part takes only what is played in the range that is selected, or looped; off again."""
    recording = session.recording
    span = _span(session)
    if span is None or (recording.punch and recording.punch_ticks == span):
        recording.set(punch=False)
    else:
        recording.set(punch=True, punch_ticks=span)


def _span(session: Session) -> tuple[int, int] | None:
    """What is selected, as ticks: a range, notes, else the loop."""
    selection, tempo_map = session.selection, session.project.score.tempo_map
    if selection.span is not None:
        return selection.span
    notes = [note for part in session.project.score.parts for note in part.notes if note.id in selection.notes]
    if notes:
        return min(note.onset_tick for note in notes), max(note.end_tick for note in notes)
    if session.loop_s is not None:
        start_s, end_s = session.loop_s
        return max(floor(tempo_map.ticks(start_s) + 1e-6), 0), max(ceil(tempo_map.ticks(end_s) - 1e-6), 1)
    return session.recording.punch_ticks


def _count_in(id: str, bars: int) -> Action:
    def run(session: Session, on: bool = True) -> None:
        recorder = recorder_of(session)
        if recorder is not None:
            recorder.set_count_in(bars)

    return Action(
        id,
        run,
        "Record/Counting",
        enabled=_is_here,
        checked=lambda session: session.recording.count_in_bars == bars,
    )


def _is_here(session: Session) -> bool:
    return recorder_of(session) is not None


def _has_device(session: Session) -> bool:
    return _is_here(session) and bool(session.recording.port) and not session.recording.running


def _can_record(session: Session) -> bool:
    return _is_here(session) and session.playback is not None and session.player is not None


def _is_armed(session: Session) -> bool:
    return session.player is not None and session.recording.armed == session.player.id


ACTIONS: tuple[Action, ...] = (
    Action(
        "record.toggle",
        toggle,
        "Record",
        "Ctrl+R",
        enabled=_can_record,
        icon="record",
    ),
    Action(
        "record.arm",
        arm,
        "Record",
        enabled=_can_record,
        checked=_is_armed,
    ),
    Action(
        "record.punch",
        punch,
        "Record",
        enabled=lambda session: _can_record(session) and _span(session) is not None,
        checked=lambda session: session.recording.punch,
    ),
    _count_in("record.count_in_0", 0),
    _count_in("record.count_in_1", 1),
    _count_in("record.count_in_2", 2),
    Action(
        "record.devices",
        devices,
        "Record",
        enabled=_is_here,
        icon="settings",
    ),
    Action(
        "record.latency",
        latency,
        "Record",
        enabled=_has_device,
        icon="clock",
    ),
)
