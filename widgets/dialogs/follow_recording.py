"""Dialog with the choice of properties to take from the recording: beats, and optionally dynamics, also from recordings
of single players.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import QDialog, QGridLayout, QScrollArea, QWidget

from app.audio.followed_recording import FollowOptions
from app.editor.files import AUDIO_SUFFIXES
from app.editor.session import Session
from widgets.common.controls import Button, Caption, Check, OkCancel, Retranslated, named, wrapped
from widgets.common.help import with_help
from widgets.common.layouts import in_column
from widgets.common.paths import ask_for_file
from widgets.common.plain import Label, verbatim

_SIZE = QSize(560, 380)


class FollowRecordingDialog(Retranslated, QDialog):
    """Dialog to choose which properties to take from the recording, with useful defaults.

    Signals
    -------
    requested(FollowOptions)
        The user accepted these options.
    """

    requested = Signal(object)

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("follow_recording")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._session = session
        self._stems: dict[str, str] = {}
        self._files: dict[str, Label] = {}
        self._clear: dict[str, Button] = {}
        self._explained = wrapped(Caption("follow_dialog.every_beat_hint"))
        self._notes = named(Check("follow_dialog.single_notes_move"), "follow_notes")
        self._dynamics = named(Check("follow_dialog.dynamics_follow"), "follow_dynamics")
        self._about_stems = wrapped(Caption("follow_dialog.single_players"))
        self._room = named(QScrollArea(), "follow_stems")
        self._room.setWidgetResizable(True)
        self._room.setWidget(self._rows())
        self._buttons = OkCancel("follow_dialog.follow", "follow_dialog.cancel")
        self._buttons.accepted.connect(self.accept)
        self._buttons.rejected.connect(self.reject)
        self._dynamics.toggled.connect(self._show)
        in_column(
            self._explained,
            self._notes,
            self._dynamics,
            self._about_stems,
            (self._room, 1),
            with_help(self._buttons),
            of=self,
        )
        self.resize(_SIZE)
        self.texted(self, title="follow_dialog.follow_recording")
        self.retranslate()
        self._show()

    def _rows(self) -> QWidget:
        """Return a row for each player: name, file, and buttons to choose and clear it."""
        rows = QWidget()
        layout = QGridLayout(rows)
        layout.setColumnStretch(1, 1)
        for row, player in enumerate(self._session.project.players):
            self._files[player.id] = named(Label(), f"stem_file_{row}")
            choose = Button("follow_dialog.choose_file", partial(self._ask, player.id), f"stem_choose_{row}")
            self._clear[player.id] = Button(
                "follow_dialog.without_file", partial(self.set_stem, player.id, None), f"stem_clear_{row}"
            )
            for column, widget in enumerate((Label(verbatim(player.name)), self._files[player.id], choose)):
                layout.addWidget(widget, row, column)
            layout.addWidget(self._clear[player.id], row, 3)
        layout.setRowStretch(len(self._files), 1)
        return rows

    @property
    def options(self) -> FollowOptions:
        """The options chosen for following a recording: notes, dynamics, and recordings of single players."""
        dynamics = self._dynamics.isChecked()
        stems = dict(self._stems) if dynamics else {}
        return FollowOptions(notes=self._notes.isChecked(), dynamics=dynamics, stems=stems)

    def set_stem(self, player_id: str, path: Path | None) -> None:
        """Set the recording of a single player; None removes it."""
        if path is None:
            self._stems.pop(player_id, None)
        else:
            self._stems[player_id] = str(path)
        self._show()

    def _ask(self, player_id: str) -> None:
        audio = self._session.project.audio
        start = Path(audio.path).parent if audio is not None else None
        kinds = f"{self.tr('follow_dialog.sound_files')} ({' '.join(f'*{suffix}' for suffix in AUDIO_SUFFIXES)})"
        path = ask_for_file(self, self.tr("follow_dialog.recording_of_player"), start, kinds)
        if path is not None:
            self.set_stem(player_id, path)

    def _show(self) -> None:
        self._room.setEnabled(self._dynamics.isChecked())
        self._about_stems.setEnabled(self._dynamics.isChecked())
        for player_id, label in self._files.items():
            path = self._stems.get(player_id)
            label.setText(self.tr("follow_dialog.from_the_whole") if path is None else verbatim(Path(path).name))
            label.setToolTip("" if path is None else verbatim(path))
            self._clear[player_id].setEnabled(path is not None)

    def retranslate(self) -> None:
        self._show()

    def accept(self) -> None:
        """Close the dialog and request that the recording be followed with the chosen options."""
        self.requested.emit(self.options)
        super().accept()
