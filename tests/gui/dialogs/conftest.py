"""The dialog of an export, shown."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from widgets.dialogs.export_files import ExportDialog

ShowExport = Callable[..., ExportDialog]


@pytest.fixture
def show_export(qtbot: QtBot, tmp_path: Path) -> ShowExport:
    """Shows the dialog for a session, with options of its own."""

    def show(session: Session, **options: object) -> ExportDialog:
        dialog = ExportDialog(session, tmp_path / "out", "quartet.mid", "Suisou test", **options)
        dialog.show()
        return dialog

    return show


@pytest.fixture
def dialog(session: Session, show_export: ShowExport) -> ExportDialog:
    """The dialog for the bundled quartet."""
    return show_export(session)
