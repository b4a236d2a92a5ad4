"""Conversion of paths between Qt and the program, and file dialogs.

Qt interprets file names as UTF-8 and drops invalid bytes; URLs preserve them. So files of dialogs and drops are passed
as URLs, and an editable path is encoded by `app.encoding.stored`. Qt's own file dialog does not list names that are not
UTF-8, but the desktop's dialogs do; these are used unless their language differs from the editor's.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from urllib.parse import quote_from_bytes, unquote_to_bytes

from PySide6.QtCore import QUrl
from PySide6.QtGui import QDesktopServices, QDropEvent
from PySide6.QtWidgets import QFileDialog, QLineEdit, QWidget

from app.editor.translated import speaks_as_system
from app.encoding import is_text, restored, shown, stored
from app.formats.other_computers import agree, may_touch

_SCHEMES = ["file"]


def path_of(url: QUrl) -> Path | None:
    """Return the path of a URL from a dialog or drop; None if it is no file.

    Choosing a file on another computer counts as consent to access that computer.
    """
    if not url.isLocalFile():
        return None
    if sys.platform == "win32" or url.host():
        path = Path(url.toLocalFile())
        agree(path)
        return path
    return Path(os.fsdecode(unquote_to_bytes(url.path(QUrl.ComponentFormattingOption.FullyEncoded))))


def url_of(path: Path) -> QUrl:
    """Return the file URL of a path, also for names that are not valid text."""
    path = path.absolute()
    if sys.platform == "win32":
        return QUrl.fromLocalFile(str(path))
    return QUrl.fromEncoded(b"file://" + quote_from_bytes(os.fsencode(path)).encode())


def dropped_paths(event: QDropEvent) -> list[Path]:
    """Return the paths of the local files that were dropped on a widget."""
    return [path for url in event.mimeData().urls() if (path := path_of(url)) is not None]


def ask_for_file(parent: QWidget | None, title: str, start: Path | None, filters: str) -> Path | None:
    """Return an existing file chosen by the user; None if cancelled. The dialog starts at the folder or file ``start``,
    or in the home folder.
    """
    url, _ = QFileDialog.getOpenFileUrl(
        parent, title, url_of(_reachable(start)), filters, options=_options(), supportedSchemes=_SCHEMES
    )
    return path_of(url)


def ask_for_files(parent: QWidget | None, title: str, start: Path | None, filters: str) -> list[Path]:
    """Return existing files chosen by the user, possibly none. The dialog starts as in `ask_for_file`."""
    urls, _ = QFileDialog.getOpenFileUrls(
        parent, title, url_of(_reachable(start)), filters, options=_options(), supportedSchemes=_SCHEMES
    )
    return [path for url in urls if (path := path_of(url)) is not None]


def ask_where_to_save(parent: QWidget | None, title: str, proposal: Path, filters: str) -> Path | None:
    """Return a file to write chosen by the user; None if cancelled. The dialog asks before an existing file is
    replaced.
    """
    start = url_of(_reachable(proposal.parent) / shown(proposal.name))
    url, _ = QFileDialog.getSaveFileUrl(parent, title, start, filters, options=_options(), supportedSchemes=_SCHEMES)
    return path_of(url)


def ask_for_folder(parent: QWidget | None, title: str, start: Path | None) -> Path | None:
    """Return an existing folder chosen by the user; None if cancelled."""
    options = _options() | QFileDialog.Option.ShowDirsOnly
    url = QFileDialog.getExistingDirectoryUrl(parent, title, url_of(_reachable(start)), options, _SCHEMES)
    return path_of(url)


def _options() -> QFileDialog.Option:
    """Return the option of a file dialog that selects the system's dialog if it has the editor's language,
    else Qt's.
    """
    return QFileDialog.Option(0) if speaks_as_system() else QFileDialog.Option.DontUseNativeDialog


def show_folder(folder: Path) -> None:
    """Open a folder in the desktop's file manager."""
    QDesktopServices.openUrl(url_of(folder))


def _reachable(path: Path | None) -> Path:
    """Return the path or the nearest parent that Qt can open; the home folder for a path without permission."""
    path = path if path is not None and may_touch(path) else Path.home()
    return next(place for place in (path, *path.parents, Path()) if is_text(place))


class PathEdit(QLineEdit):
    """An editable path; one that is not UTF-8 is encoded (`app.encoding.stored`), with the readable form as tool
    tip.
    """

    def __init__(self, path: Path | None = None, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._set: Path | None = None
        self.textChanged.connect(self._show_tip)
        self.set_path(path)

    @property
    def path(self) -> Path | None:
        """The path in the field; None if the field is empty."""
        if self._set is not None and self.text() == stored(self._set):
            return self._set  # including a path that ends with a space
        text = self.text().strip()
        return Path(restored(text)) if text else None

    def set_path(self, path: Path | None) -> None:
        """Set the path; None for an empty field."""
        self._set = path
        self.setText("" if path is None else stored(path))

    def _show_tip(self, text: str) -> None:
        readable = shown(restored(text))
        self.setToolTip("" if readable == text else readable)
