"""The dialogs of recording, connected to the recorder."""

from __future__ import annotations

from functools import partial

from app.shell.editor import Editor
from widgets.dialogs.latency import LatencyDialog
from widgets.dialogs.midi_devices import MidiDevicesDialog


def show_devices(editor: Editor) -> None:
    """Show the MIDI devices; what is chosen there holds at once."""
    recorder = editor.recorder

    def make() -> MidiDevicesDialog:
        dialog = MidiDevicesDialog(editor.session, recorder.make_playback(), editor.window)
        dialog.chosen.connect(recorder.choose)
        dialog.controller_chosen.connect(recorder.set_controller)
        dialog.wiring_chosen.connect(recorder.set_wiring)
        dialog.latency_asked.connect(partial(show_latency, editor))
        recorder.begin()
        return dialog

    editor.show_once(MidiDevicesDialog, make)


def show_latency(editor: Editor) -> None:
    """Find out how late the MIDI device comes."""
    recorder = editor.recorder

    def make() -> LatencyDialog:
        dialog = LatencyDialog(editor.session, recorder.make_playback(), recorder.now_ns, editor.window)
        dialog.latency_chosen.connect(recorder.set_latency)
        recorder.begin()
        return dialog

    editor.show_once(LatencyDialog, make)
