"""Which program this is, what it runs on, and where things are."""

from __future__ import annotations

import platform
from pathlib import Path

import PySide6
from PySide6.QtCore import QEvent, Qt, qVersion
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QPushButton, QVBoxLayout, QWidget

from app.shell.crash_handler import log_path
from app.version import program_version
from widgets.common.plain import Label


class AboutDialog(QDialog):
    """About Suisou.

    Parameters
    ----------
    settings : Path
        Where the settings are.
    """

    def __init__(self, settings: Path, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("about")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._settings = settings
        self._name, self._text = Label("Suisou"), Label()
        font = self._name.font()
        font.setPointSizeF(20.0)
        self._name.setFont(font)
        self._text.setObjectName("about_text")
        self._text.setWordWrap(True)
        self._text.setTextInteractionFlags(
            Qt.TextInteractionFlag.TextSelectableByMouse | Qt.TextInteractionFlag.TextSelectableByKeyboard
        )
        self._text.setMinimumWidth(440)
        self._buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        self._buttons.rejected.connect(self.reject)
        self._licences = QPushButton()
        self._licences.setObjectName("about_licences")
        self._licences.clicked.connect(self._show_licences)
        self._buttons.addButton(self._licences, QDialogButtonBox.ButtonRole.HelpRole)
        column = QVBoxLayout(self)
        column.setContentsMargins(24, 20, 24, 16)
        column.setSpacing(12)
        column.addWidget(self._name)
        column.addWidget(self._text)
        column.addWidget(self._buttons)
        self.retranslate()

    def retranslate(self) -> None:
        """Set the texts."""
        self.setWindowTitle(self.tr("about_dialog.about_suisou"))
        self._licences.setText(self.tr("about_dialog.licences"))
        versions = f"Python {platform.python_version()}, Qt {qVersion()}, PySide6 {PySide6.__version__}"
        self._text.setText(
            "\n\n".join(
                (
                    self.tr("about_dialog.performance_of_wind_ensemble_from"),
                    self.tr("about_dialog.version_under_apache_license_2").format(version=program_version()),
                    versions,
                    self.tr("about_dialog.settings").format(path=self._settings),
                    self.tr("about_dialog.faults_are_noted_in").format(path=log_path()),
                )
            )
        )

    def _show_licences(self) -> None:
        from app.shell.licences_dialog import LicencesDialog

        LicencesDialog(self).open()

    def changeEvent(self, event: QEvent) -> None:
        """Another language."""
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)
