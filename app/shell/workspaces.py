"""Workspaces: arrangements of panels and lanes for kinds of work, each stored as the user left it.

`WorkspaceSwitch` is the row of buttons in the menu bar.
"""

from __future__ import annotations

import base64
import binascii
from dataclasses import dataclass, field
from typing import Final, Literal

from PySide6.QtCore import QByteArray, QObject, Qt, Signal
from PySide6.QtWidgets import QLayout, QMainWindow, QToolButton, QWidget

from app.editor.design_tokens import LEAST_TARGET_PX
from app.editor.settings import Settings
from app.shell.actions import ActionTable
from app.shell.docks import Dock
from widgets.common.controls import Retranslated, named
from widgets.common.layouts import in_row
from widgets.inspector.panel import InspectorPanel
from widgets.players.panel import PlayersPanel
from widgets.timeline.lane_layout import LaneState
from widgets.timeline.panel import TimelinePanel

LAYOUT_VERSION: Final = 2
"""Version of stored layouts; those of other versions are ignored."""
SHORT_PX: Final = 880
"""Window height in pixels below which the inspector takes the full height beside the timeline, and the players' panel
none of it.
"""

CHROME_PX: Final = 105
"""Approximate height in pixels of everything above and below the panels: menus, transport bar, status line and
splitter.
"""

Area = Qt.DockWidgetArea
LEFT, RIGHT, BOTTOM = Area.LeftDockWidgetArea, Area.RightDockWidgetArea, Area.BottomDockWidgetArea
Whole = Literal["always", "never", "if_high", "if_low"]


@dataclass(frozen=True)
class Workspace:
    """Default arrangement of the panels.

    Attributes
    ----------
    id : str
        Id of the workspace, under which its layout is stored.
    text_id : str
        Text id of the name on the button.
    left, right : tuple of str
        Names of the panels at each side, from the top; other panels are closed, except for the timeline.
    left_px, right_px : int
        Widths of the sides in pixels.
    timeline_share : float
        Height of the timeline as a share of the window's height, 0..1.
    left_whole, right_whole : Whole
        Whether the panels at that side reach down beside the timeline or end above it; may depend on the window's
        height.
    lists_share : float
        Height of the lists of problems, corrections and history as a share of the inspector's height, 0..1.
    keeps_lists : bool
        Whether the lists keep this height even if they are short.
    lanes : LaneState
        Lanes that the timeline shows.
    """

    id: str
    text_id: str
    left: tuple[str, ...]
    right: tuple[str, ...]
    left_px: int
    right_px: int
    timeline_share: float
    left_whole: Whole
    right_whole: Whole
    lists_share: float
    keeps_lists: bool = False
    lanes: LaneState = field(default_factory=LaneState)


WORKSPACES: Final = (
    Workspace(
        "animate",
        "workspace_switch.animate",
        left=("players",),
        right=("inspector",),
        left_px=300,
        right_px=320,
        timeline_share=0.444,
        left_whole="if_high",
        right_whole="if_low",
        lists_share=0.55,
        lanes=LaneState(
            order=(
                *("audio", "roll", "dynamics", "takes", "fingering", "breath", "acting", "problems", "additive"),
                *("curves", "dance"),
            ),
            folded=("curves", "additive"),
        ),
    ),
    Workspace(
        "record",
        "workspace_switch.record",
        left=("recording", "players"),
        right=(),
        left_px=300,
        right_px=320,
        timeline_share=0.62,
        left_whole="always",
        right_whole="never",
        lists_share=0.3,
        lanes=LaneState(
            order=(
                *("audio", "roll", "dynamics", "takes", "curves", "breath", "fingering", "acting", "dance"),
                *("problems", "additive"),
            ),
            shown=("takes",),
            folded=("fingering", "acting", "problems", "additive"),
        ),
    ),
    Workspace(
        "check",
        "workspace_switch.check",
        left=(),
        right=("inspector",),
        left_px=300,
        right_px=420,
        timeline_share=0.32,
        left_whole="never",
        right_whole="always",
        lists_share=0.62,
        keeps_lists=True,
        lanes=LaneState(
            order=(
                *("problems", "roll", "dynamics", "takes", "fingering", "breath", "acting", "additive", "curves"),
                *("dance", "audio"),
            ),
            folded=("acting", "additive", "curves", "audio"),
        ),
    ),
)
"""The workspaces in the order of the menu. Animate: timeline, viewport, inspector and players. Record: a tall timeline
with the takes, and the device. Check: problems beside a large viewport.
"""
_BY_ID: Final = {workspace.id: workspace for workspace in WORKSPACES}


class Workspaces(QObject):
    """Arranges the window's panels by workspace.

    Parameters
    ----------
    window : QMainWindow
    docks : dict of Dock
        Docks by the name of their panel.
    timeline : TimelinePanel
        Timeline whose lanes belong to the workspace.
    inspector : InspectorPanel
        Inspector whose lists get a share of its height.
    players : PlayersPanel
        List of the players.
    settings : Settings
        Settings that store the layout of each workspace and the chosen workspace.

    Signals
    -------
    changed()
        Another workspace was chosen.
    """

    changed = Signal()

    def __init__(
        self,
        window: QMainWindow,
        docks: dict[str, Dock],
        timeline: TimelinePanel,
        inspector: InspectorPanel,
        players: PlayersPanel,
        settings: Settings,
    ) -> None:
        super().__init__(window)
        self._window, self._docks, self._settings = window, docks, settings
        self._timeline, self._inspector, self._players = timeline, inspector, players
        self._panels: dict[str, TimelinePanel | InspectorPanel | PlayersPanel] = {
            "timeline": timeline,
            "inspector": inspector,
            "players": players,
        }
        self._shown = False
        self._setting = False
        timeline.arranged.connect(self._lanes_arranged)

    @property
    def current(self) -> str:
        """Return the id of the chosen workspace."""
        return self._settings.workspace if self._settings.workspace in _BY_ID else WORKSPACES[0].id

    def choose(self, workspace_id: str) -> None:
        """Store the current workspace's layout, and show another workspace with the layout stored for it."""
        if workspace_id == self.current:
            return
        self.keep()
        self._settings.workspace = workspace_id
        if self._shown:
            self._show()
        self.changed.emit()

    def show(self) -> None:
        """Show the panels of the current workspace; called when a project is opened."""
        if not self._shown:
            self._shown = True
            self._show()

    def leave(self) -> None:
        """Hide all panels; called when no project is open any more."""
        self.keep()
        self._shown = False
        for dock in self._docks.values():
            dock.hide()

    def keep(self) -> None:
        """Store the layout of the window's panels as that of the current workspace."""
        if self._shown:
            layout = base64.b64encode(self._window.saveState(LAYOUT_VERSION).data()).decode()
            states = {name: panel.save_state() for name, panel in self._panels.items()}
            self._settings.set_workspace_state(self.current, layout=layout, **states)

    def reset(self) -> None:
        """Restore the default layout of the current workspace."""
        if self._shown:
            self._arrange(_BY_ID[self.current])
            self._settings.forget_workspace(self.current)

    def _show(self) -> None:
        # Panels that the stored state does not mention are arranged as initially.
        self._arrange(_BY_ID[self.current])
        state = self._settings.workspace_state(self.current)
        self._setting = True
        try:
            layout = base64.b64decode(state.get("layout", ""), validate=True)
        except (binascii.Error, ValueError):
            layout = b""
        self._window.restoreState(QByteArray(layout), LAYOUT_VERSION)
        for name, panel in self._panels.items():
            if name in state:
                panel.restore_state(state[name])
        self._setting = False

    def _lanes_arranged(self) -> None:
        # Saved not only at the end: lanes are folded often, and the program may be killed.
        if self._shown and not self._setting:
            self._settings.set_workspace_state(self.current, timeline=self._timeline.save_state())

    # Initial arrangement

    def _arrange(self, workspace: Workspace) -> None:
        self._setting = True
        window = self._window
        sides = {LEFT: workspace.left, RIGHT: workspace.right, BOTTOM: ("timeline",)}
        shown = [name for names in sides.values() for name in names]
        for name, dock in self._docks.items():
            dock.setFloating(False)
            if name not in shown:
                dock.hide()
        for area, names in sides.items():
            for number, name in enumerate(names):
                window.addDockWidget(area, self._docks[name])
                if number:
                    window.splitDockWidget(self._docks[names[number - 1]], self._docks[name], Qt.Orientation.Vertical)
                self._docks[name].show()
        self._size(workspace)
        self._timeline.restore_state(workspace.lanes)
        self._inspector.divide(workspace.lists_share, kept=workspace.keeps_lists)
        self._players.divide()
        self._setting = False

    def _size(self, workspace: Workspace) -> None:
        """Give the panels the workspace's default sizes, which depend on the size of the window."""
        window, low = self._window, self._window.height() < SHORT_PX
        whole = {"always": True, "never": False, "if_high": not low, "if_low": low}
        left = LEFT if whole[workspace.left_whole] else BOTTOM
        right = RIGHT if whole[workspace.right_whole] else BOTTOM
        window.setCorner(Qt.Corner.BottomLeftCorner, left)
        window.setCorner(Qt.Corner.BottomRightCorner, right)
        for names, width_px in ((workspace.left, workspace.left_px), (workspace.right, workspace.right_px)):
            docks = [self._docks[name] for name in names]
            window.resizeDocks(docks, [width_px] * len(docks), Qt.Orientation.Horizontal)
            if len(docks) > 1:
                first = _height_px(docks[0])
                rest = [(window.height() - CHROME_PX - first) // (len(docks) - 1)] * (len(docks) - 1)
                window.resizeDocks(docks, [first, *rest], Qt.Orientation.Vertical)
        height = round(workspace.timeline_share * window.height())
        window.resizeDocks([self._docks["timeline"]], [height], Qt.Orientation.Vertical)


def _height_px(dock: Dock) -> int:
    """Return the height in pixels that a panel needs.

    The panel is polished first, since only polished widgets have their font.
    """
    for widget in dock.findChildren(QWidget):
        widget.ensurePolished()
    for layout in dock.findChildren(QLayout):
        layout.invalidate()
    return dock.sizeHint().height()


class WorkspaceSwitch(Retranslated, QWidget):
    """A row of buttons, one for each workspace; the button of the current workspace is pressed.

    Parameters
    ----------
    table : ActionTable
        Actions that the buttons trigger.
    """

    def __init__(self, table: ActionTable) -> None:
        super().__init__()
        self.setObjectName("workspace_switch")
        buttons = []
        for workspace in WORKSPACES:
            button = named(QToolButton(), f"workspace_{workspace.id}")
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextOnly)
            # The full name of a command includes its kind.
            action = self.texted(table.actions[f"workspace.{workspace.id}"], short=workspace.text_id)
            button.setDefaultAction(action)
            button.setMinimumHeight(LEAST_TARGET_PX)
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            buttons.append(button)
        in_row(*buttons, of=self, margins=0, spacing=1)
