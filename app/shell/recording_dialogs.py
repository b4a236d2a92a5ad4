"""The dialogs of recording, connected to the recorder."""

from __future__ import annotations

from app.editor.recorder import recorder_of
from app.shell.editor import Editor
from widgets.dialogs.latency import LatencyDialog
from widgets.dialogs.midi_devices import MidiDevicesDialog


def show_devices(editor: Editor) -> None:
    """Show the MIDI devices; what is chosen there holds at once."""
    recorder = recorder_of(editor.session)
    if recorder is None:
        return
    dialog = editor.window.findChild(MidiDevicesDialog)
    if dialog is None:
        dialog = MidiDevicesDialog(editor.session, recorder.make_playback(), editor.window)
        dialog.chosen.connect(recorder.choose)
        dialog.controller_chosen.connect(recorder.set_controller)
        dialog.wiring_chosen.connect(recorder.set_wiring)
        dialog.latency_asked.connect(lambda: show_latency(editor))
        recorder.begin()
    _to_front(dialog)


def show_latency(editor: Editor) -> None:
    """Find out how late the MIDI device comes."""
    recorder = recorder_of(editor.session)
    if recorder is None:
        return
    dialog = editor.window.findChild(LatencyDialog)
    if dialog is None:
        dialog = LatencyDialog(editor.session, recorder.make_playback(), recorder.now_ns, editor.window)
        dialog.latency_chosen.connect(recorder.set_latency)
        recorder.begin()
    _to_front(dialog)


def _to_front(dialog: MidiDevicesDialog | LatencyDialog) -> None:
    dialog.show()
    dialog.raise_()
    dialog.activateWindow()
