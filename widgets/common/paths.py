"""Paths between Qt and the program.

Qt takes the name of a file for UTF-8 and drops the bytes that are not; in a URL they survive. So files come from
dialogs and drops as URLs, and a path that can be edited is written as `app.encoding.stored` has it. Qt's own file
dialog does not list names that are not UTF-8 at all; those of the desktops do, so they are used unless they speak
another language than the editor.
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
    """The path that a URL of a dialog or a drop names; None where it is no file.

    Whoever chooses a file on another computer agrees to that computer.
    """
    if not url.isLocalFile():
        return None
    if sys.platform == "win32" or url.host():
        path = Path(url.toLocalFile())
        agree(path)
        return path
    return Path(os.fsdecode(unquote_to_bytes(url.path(QUrl.ComponentFormattingOption.FullyEncoded))))


def url_of(path: Path) -> QUrl:
    """The URL of a path."""
    path = path.absolute()
    if sys.platform == "win32":
        return QUrl.fromLocalFile(str(path))
    return QUrl.fromEncoded(b"file://" + quote_from_bytes(os.fsencode(path)).encode())


def dropped_paths(event: QDropEvent) -> list[Path]:
    """The files of a drop."""
    return [path for url in event.mimeData().urls() if (path := path_of(url)) is not None]


def ask_for_file(parent: QWidget | None, title: str, start: Path | None, filters: str) -> Path | None:
    """An existing file; None where none was chosen. The dialog begins in a folder or with a file, or at home."""
    url, _ = QFileDialog.getOpenFileUrl(
        parent, title, url_of(_reachable(start)), filters, options=_options(), supportedSchemes=_SCHEMES
    )
    return path_of(url)


def ask_for_files(parent: QWidget | None, title: str, start: Path | None, filters: str) -> list[Path]:
    """Existing files; none where none was chosen. The dialog begins as that of `ask_for_file`."""
    urls, _ = QFileDialog.getOpenFileUrls(
        parent, title, url_of(_reachable(start)), filters, options=_options(), supportedSchemes=_SCHEMES
    )
    return [path for url in urls if (path := path_of(url)) is not None]


def ask_where_to_save(parent: QWidget | None, title: str, proposal: Path, filters: str) -> Path | None:
    """A file to write; None where none was chosen. Whether one that is there may be replaced was asked."""
    start = url_of(_reachable(proposal.parent) / shown(proposal.name))
    url, _ = QFileDialog.getSaveFileUrl(parent, title, start, filters, options=_options(), supportedSchemes=_SCHEMES)
    return path_of(url)


def ask_for_folder(parent: QWidget | None, title: str, start: Path | None) -> Path | None:
    """An existing folder; None where none was chosen."""
    options = _options() | QFileDialog.Option.ShowDirsOnly
    url = QFileDialog.getExistingDirectoryUrl(parent, title, url_of(_reachable(start)), options, _SCHEMES)
    return path_of(url)


def _options() -> QFileDialog.Option:
    """The system's dialog where it speaks the editor's language, else Qt's."""
    return QFileDialog.Option(0) if speaks_as_system() else QFileDialog.Option.DontUseNativeDialog


def show_folder(folder: Path) -> None:
    """Open a folder in the desktop's file manager."""
    QDesktopServices.openUrl(url_of(folder))


def _reachable(path: Path | None) -> Path:
    """The path, or the next folder above that Qt can enter; home for one that may not be touched."""
    path = path if path is not None and may_touch(path) else Path.home()
    return next(place for place in (path, *path.parents, Path()) if is_text(place))


class PathEdit(QLineEdit):
    """A path that can be typed; one that is not UTF-8 is written so that it can (`app.encoding.stored`), and its tip
    has it readable."""

    def __init__(self, path: Path | None = None, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._set: Path | None = None
        self.textChanged.connect(self._show_tip)
        self.set_path(path)

    @property
    def path(self) -> Path | None:
        """The path; None where nothing is typed."""
        if self._set is not None and self.text() == stored(self._set):
            return self._set  # also one that ends with a blank
        text = self.text().strip()
        return Path(restored(text)) if text else None

    def set_path(self, path: Path | None) -> None:
        """Show another path; None: nothing."""
        self._set = path
        self.setText("" if path is None else stored(path))

    def _show_tip(self, text: str) -> None:
        readable = shown(restored(text))
        self.setToolTip("" if readable == text else readable)
