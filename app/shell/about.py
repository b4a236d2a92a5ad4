"""About dialog: version, libraries and folders."""

from __future__ import annotations

import platform
from pathlib import Path

import PySide6
from PySide6.QtCore import Qt, qVersion
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QWidget

from app.shell.crash_handler import log_path
from app.version import program_version
from widgets.common.controls import Button, Retranslated, named, sized, wrapped
from widgets.common.help import with_help
from widgets.common.layouts import in_column
from widgets.common.plain import Label


class AboutDialog(Retranslated, QDialog):
    """The dialog Help > About Suisou.

    Parameters
    ----------
    settings : Path
        Path of the settings.
    """

    def __init__(self, settings: Path, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("about")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._settings = settings
        self._text = wrapped(named(Label(), "about_text"))
        self._text.setTextInteractionFlags(
            Qt.TextInteractionFlag.TextSelectableByMouse | Qt.TextInteractionFlag.TextSelectableByKeyboard
        )
        self._text.setMinimumWidth(440)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        buttons.rejected.connect(self.reject)
        licences = Button("about_dialog.licences", self._show_licences, "about_licences")
        buttons.addButton(licences, QDialogButtonBox.ButtonRole.ActionRole)
        in_column(
            sized(Label("Suisou"), 20.0), self._text, with_help(buttons), of=self, margins=(24, 20, 24, 16), spacing=12
        )
        self.texted(self, title="about_dialog.about_suisou")
        self.retranslate()

    def retranslate(self) -> None:
        versions = f"Python {platform.python_version()}, Qt {qVersion()}, PySide6 {PySide6.__version__}"
        paragraphs = (
            self.tr("about_dialog.performance_of_wind_ensemble_from"),
            self.tr("about_dialog.version_under_apache_license_2").format(version=program_version()),
            versions,
            self.tr("about_dialog.settings").format(path=self._settings),
            self.tr("about_dialog.log_file").format(path=log_path()),
        )
        self._text.setText("\n\n".join(paragraphs))

    def _show_licences(self) -> None:
        from app.shell.licences_dialog import LicencesDialog

        LicencesDialog(self).open()
