"""Choice between a folder and an Unreal project; each keeps its path."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QWidget

from app.encoding import stored
from widgets.common.controls import Button, Retranslated, named
from widgets.common.layouts import in_column, in_row
from widgets.common.paths import PathEdit, ask_for_file, ask_for_folder
from widgets.common.plain import ComboBox
from widgets.dialogs.export_destination import Destination

_DESTINATIONS: tuple[Destination, ...] = ("folder", "unreal")


class PlaceChooser(Retranslated, QWidget):
    """Choice of destination with the path of the folder or project file.

    Parameters
    ----------
    folder : Path
        Last folder.
    unreal : Path or None
        Last Unreal project; None if there was none.
    destination : str
        Last kind of destination, ``"folder"`` or ``"unreal"``.
    parent : QWidget, optional
    """

    changed = Signal()

    def __init__(
        self, folder: Path, unreal: Path | None, destination: Destination, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._paths = {"folder": stored(folder), "unreal": "" if unreal is None else stored(unreal)}
        self._box = named(ComboBox(), "export_destination")
        for choice in _DESTINATIONS:
            self._box.addItem("", choice)
        self.texted(self._box, items=("place_chooser.folder_of_files", "place_chooser.unreal_project_2"))
        self._box.setCurrentIndex(_DESTINATIONS.index(destination))
        self._path = named(PathEdit(folder if destination == "folder" else unreal), "export_folder")
        self._choose = Button("place_chooser.choose", self._choose_path)
        path = in_row((self._path, 1), self._choose)
        in_column(self._box, path, of=self, margins=0)
        self._path.textChanged.connect(self._remember)
        self._box.currentIndexChanged.connect(self._change)
        self.retranslate()

    @property
    def destination(self) -> Destination:
        """The chosen kind of destination: a folder or an Unreal project."""
        return "unreal" if self._box.currentData() == "unreal" else "folder"

    @property
    def path(self) -> Path:
        """The chosen folder, or the Unreal project's file or folder."""
        return self._path.path or Path()

    @property
    def problem(self) -> str:
        """Return the text of what is missing; empty if nothing."""
        if self._path.path is not None:
            return ""
        if self.destination == "unreal":
            return self.tr("place_chooser.choose_uproject_file_of_your")
        return self.tr("place_chooser.choose_folder")

    def _remember(self, text: str) -> None:
        self._paths[self.destination] = text
        self.changed.emit()

    def _change(self) -> None:
        # The change is reported once, with the path of the new destination.
        self._path.blockSignals(True)
        self._path.setText(self._paths[self.destination])
        self._path.blockSignals(False)
        self.retranslate()
        self.changed.emit()

    def _choose_path(self) -> None:
        if self.destination == "unreal":
            title = self.tr("place_chooser.unreal_project")
            chosen = ask_for_file(self, title, self._path.path, f"{title} (*.uproject)")
        else:
            chosen = ask_for_folder(self, self.tr("place_chooser.destination_folder"), self._path.path)
        if chosen is not None:
            self._path.set_path(chosen)

    def retranslate(self) -> None:
        """Set the texts by the kind of destination."""
        unreal = self.destination == "unreal"
        self._path.setPlaceholderText(
            self.tr("place_chooser.uproject_file") if unreal else self.tr("place_chooser.folder")
        )
