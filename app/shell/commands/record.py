"""Commands for recording MIDI: takes, the armed player, the count-in and the punch range."""

from __future__ import annotations

from functools import partial
from math import ceil, floor

from app.editor.session import Session
from app.shell.action import Action
from app.shell.commands.command_targets import selected_ticks
from app.shell.editor import Editor, EditorAction


def devices(editor: Editor) -> None:
    """Open the dialog of MIDI devices, whose choices apply immediately."""
    from widgets.dialogs.midi_devices import MidiDevicesDialog

    recorder = editor.recorder

    def make() -> MidiDevicesDialog:
        dialog = MidiDevicesDialog(editor.session, recorder.make_playback(), editor.window)
        dialog.chosen.connect(recorder.choose)
        dialog.controller_chosen.connect(recorder.set_controller)
        dialog.mapping_chosen.connect(recorder.set_mapping)
        dialog.latency_asked.connect(partial(latency, editor))
        recorder.begin()
        return dialog

    editor.show_once(MidiDevicesDialog, make)


def latency(editor: Editor) -> None:
    """Measure the latency of the MIDI device."""
    from widgets.dialogs.latency import LatencyDialog

    recorder = editor.recorder

    def make() -> LatencyDialog:
        dialog = LatencyDialog(editor.session, recorder.make_playback(), recorder.now_ns, editor.window)
        dialog.latency_chosen.connect(recorder.set_latency)
        recorder.begin()
        return dialog

    editor.show_once(LatencyDialog, make)


def arm(session: Session, on: bool = True) -> None:
    """Arm the active player for recording, or disarm it."""
    player = session.player
    if player is not None:
        session.recording.set(armed="" if session.recording.armed == player.id else player.id)


def punch(session: Session, on: bool = True) -> None:
    """Limit recording to the selected or looped range, or remove the limit."""
    recording = session.recording
    span = _span(session)
    if span is None or (recording.punch and recording.punch_ticks == span):
        recording.set(punch=False)
    else:
        recording.set(punch=True, punch_ticks=span)


def _span(session: Session) -> tuple[int, int] | None:
    """Return the selected ticks: those of a range, of notes, or else of the loop."""
    selected, tempo_map = selected_ticks(session), session.project.score.tempo_map
    if selected is not None:
        return selected
    if session.loop_s is not None:
        start_s, end_s = session.loop_s
        return max(floor(tempo_map.ticks(start_s) + 1e-6), 0), max(ceil(tempo_map.ticks(end_s) - 1e-6), 1)
    return session.recording.punch_ticks


def _count_in(id: str, bars: int) -> EditorAction:
    return EditorAction(
        id,
        lambda editor, on: editor.recorder.set_count_in(bars),
        "record/count_in",
        checked=lambda editor: editor.session.recording.count_in_bars == bars,
    )


def _has_device(editor: Editor) -> bool:
    recording = editor.session.recording
    return bool(recording.port) and not recording.running


def _can_record(session: Session) -> bool:
    return session.playback is not None and session.player is not None


ACTIONS: tuple[Action | EditorAction, ...] = (
    EditorAction(
        "record.toggle",
        lambda editor: editor.recorder.toggle(),
        "record",
        "Ctrl+R",
        enabled=lambda editor: _can_record(editor.session),
        icon="record",
    ),
    Action(
        "record.arm",
        arm,
        "record",
        enabled=_can_record,
        checked=lambda session: session.player is not None and session.recording.armed == session.player.id,
    ),
    Action(
        "record.punch",
        punch,
        "record",
        enabled=lambda session: _can_record(session) and _span(session) is not None,
        checked=lambda session: session.recording.punch,
    ),
    _count_in("record.count_in_0", 0),
    _count_in("record.count_in_1", 1),
    _count_in("record.count_in_2", 2),
    EditorAction("record.devices", devices, "record", icon="settings"),
    EditorAction("record.latency", latency, "record", enabled=_has_device, icon="clock"),
)
