"""The switch of workspaces in the bar of menus."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QToolButton, QWidget

from app.editor.tokens import LEAST_TARGET_PX
from app.shell.actions import ActionTable
from app.shell.workspaces import WORKSPACES
from widgets.common.controls import Retranslated, named
from widgets.common.layouts import in_row


class WorkspaceSwitch(Retranslated, QWidget):
    """A button for each workspace; the one that is shown is down.

    Parameters
    ----------
    table : ActionTable
        Its rows are what the buttons do.
    """

    def __init__(self, table: ActionTable) -> None:
        super().__init__()
        self.setObjectName("workspace_switch")
        buttons = []
        for workspace in WORKSPACES:
            button = named(QToolButton(), f"workspace_{workspace.id}")
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextOnly)
            # A command's own name says what kind of thing it is.
            action = self.texted(table.actions[f"workspace.{workspace.id}"], short=workspace.text_id)
            button.setDefaultAction(action)
            button.setMinimumHeight(LEAST_TARGET_PX)
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            buttons.append(button)
        in_row(*buttons, of=self, margins=0, spacing=1)
