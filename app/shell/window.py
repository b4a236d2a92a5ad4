"""The main window: panels around the viewport, transport bar above, status line below."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from PySide6.QtCore import QByteArray, QEvent, QPoint, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent, QKeySequence, QResizeEvent
from PySide6.QtOpenGLWidgets import QOpenGLWidget
from PySide6.QtWidgets import QMainWindow, QPushButton, QStackedWidget, QToolBar, QWidget

from app.editor.files import AUDIO_SUFFIXES, VIDEO_SUFFIXES, Files
from app.editor.generator import Generator
from app.editor.questions import Questions
from app.editor.session import Session
from app.editor.settings import Settings
from app.editor.tasks import ThreadTasks
from app.encoding import shown
from app.formats.other_computers import is_file, may_touch
from app.project.storage import SUFFIX
from app.rig.characters.read_figure import SUFFIXES as CHARACTER_SUFFIXES
from app.score.suffixes import MUSIC
from app.shell.actions import CONTEXTS, ActionTable
from app.shell.banner import Banner
from app.shell.docks import Dock, TabsStay
from app.shell.file_questions import FileQuestions
from app.shell.focus_mark import FocusMark
from app.shell.menus import Menus
from app.shell.palette import Palette
from app.shell.start_page import StartPage
from app.shell.status import StatusLine
from app.shell.workspaces import LAYOUT_VERSION, Workspaces, WorkspaceSwitch
from widgets.common.clicks import on_click
from widgets.common.controls import Retranslated, named
from widgets.common.icons import icon
from widgets.common.layouts import in_column, in_row, panel
from widgets.common.paths import dropped_paths
from widgets.common.plain import verbatim, verbatim_title
from widgets.inspector.panel import InspectorPanel
from widgets.players.panel import PlayersPanel
from widgets.recording.panel import RecordingPanel
from widgets.timeline.panel import TimelinePanel
from widgets.transport.bar import TransportBar
from widgets.viewport.panel import ViewportPanel

SIZE: Final = QSize(1600, 1000)
FRAME: Final = QSize(16, 48)
"""Largest width and height in pixels that a window's frame and title bar take."""
LEAST_SIZE: Final = QSize(960, 600)
NARROW_PX: Final = 1060
"""Width in pixels below which the command field hides its shortcut."""
DOCKED: Final = ("players", "inspector", "timeline", "recording")
"""Names of the panels docked around the viewport."""


class Window(Retranslated, QMainWindow):
    """The editor's main window.

    Parameters
    ----------
    session : Session
        Session that the panels show and change.
    files : Files
        Opens files that are dropped or chosen on the start page.
    settings : Settings
        Stores the layout.
    questions : Questions
        Asks the user about files before the window closes.
    table : ActionTable
        Actions for menus, palette and shortcuts.
    generator : Generator
        Generates the motion that the viewport shows.

    Signals
    -------
    character_dropped(Path)
        A character's file was dropped on the window.
    help_requested(QWidget)
        The user asked for the guide section about this widget.
    """

    character_dropped = Signal(object)
    help_requested = Signal(QWidget)

    def __init__(
        self,
        session: Session,
        files: Files,
        settings: Settings,
        questions: Questions,
        table: ActionTable,
        generator: Generator,
    ) -> None:
        super().__init__()
        self.setObjectName("window")
        self.setAcceptDrops(True)
        self.setDockNestingEnabled(True)
        self.setMinimumSize(LEAST_SIZE)
        self.session, self._files, self._settings, self._questions = session, files, settings, questions
        self._table = table
        self._closing = self._narrow = False
        self._full: QByteArray | None = None

        self.viewport = ViewportPanel(self.session, generator.live)
        self.timeline = TimelinePanel(self.session)
        self.players = PlayersPanel(self.session)
        inspector = InspectorPanel(self.session)
        self.panels: dict[str, QWidget] = {
            "viewport": self.viewport,
            "timeline": self.timeline,
            "players": self.players,
            "inspector": inspector,
            "recording": RecordingPanel(self.session),
            "transport": TransportBar(self.session),
        }
        self.banner = Banner(self.session)
        self.file_questions = FileQuestions(self.banner, session, files, questions, table)
        self.start_page = StartPage(self.session, self._files, settings)
        self._pages = QStackedWidget()
        for page in (self.start_page, self.viewport):
            self._pages.addWidget(page)
        self.setCentralWidget(panel(in_column(self.banner, (self._pages, 1), margins=0, spacing=0)))
        tools = {"timeline": self.timeline.tool_bar}
        self.docks = {name: Dock(name, self.panels[name], self.session, self, tools.get(name)) for name in DOCKED}
        TabsStay(self)
        self.workspaces = Workspaces(self, self.docks, self.timeline, inspector, self.players, settings)
        self.bar = named(QToolBar(), "transport_bar")
        tasks = self.session.tasks
        self.status = StatusLine(self.session, self._files, tasks if isinstance(tasks, ThreadTasks) else None, self)
        self.menus = Menus(self.menuBar(), self._table)
        self.workspace_switch = WorkspaceSwitch(self._table)
        self.palette_field = self.texted(named(QPushButton(), "palette_button"), name="window.search_commands")
        self.palette_popup = Palette(self.session, self._table, self)
        self.focus_mark = FocusMark(self.session, self, {**self.panels, **self.docks})
        self._build()
        self._connect(generator)
        self._restore()
        self._apply_theme()
        self.retranslate()
        self._show_page()
        self._table.refresh()

    def _build(self) -> None:
        for dock in self.docks.values():
            self.addDockWidget(Qt.DockWidgetArea.LeftDockWidgetArea, dock)
        self.bar.setMovable(False)
        self.bar.setFloatable(False)
        self.bar.toggleViewAction().setEnabled(False)
        self.bar.setContextMenuPolicy(Qt.ContextMenuPolicy.PreventContextMenu)
        self.bar.addWidget(self.panels["transport"])
        self.addToolBar(Qt.ToolBarArea.TopToolBarArea, self.bar)
        self.setStatusBar(self.status)
        self._corner = panel(in_row(self.workspace_switch, self.palette_field, margins=0, spacing=8))
        self.menuBar().setCornerWidget(self._corner, Qt.Corner.TopRightCorner)
        for name in CONTEXTS:
            place = self.docks.get(name) or self.panels.get(name) or self.findChild(QWidget, name)
            if place is not None:
                self._table.attach(name, place)
        # Shortcuts of the window also work while the menu is hidden, as in full screen.
        self._table.attach("window", self)
        # Below Open, as in other programs.
        menu, recent = self.menus.menu("file"), self.menus.menu("file/open_recent")
        menu.removeAction(recent.menuAction())
        menu.insertMenu(self._table.actions["file.open_example"], recent)

    def _connect(self, generator: Generator) -> None:
        generator.motion_changed.connect(self.viewport.poses_changed)
        generator.front_changed.connect(self.viewport.draw_now)
        generator.ready_changed.connect(self.status.set_ready)
        for dock in self.docks.values():
            dock.visibilityChanged.connect(self._table.refresh_soon)
        self.workspaces.changed.connect(self._table.refresh_soon)
        self._table.context_changed.connect(self.focus_mark.mark)
        on_click(self.palette_field, self.show_palette)
        self.menus.menu("file/open_recent").aboutToShow.connect(self._fill_recent)
        self._files.changed.connect(self._report_title)
        self._files.opened.connect(self._show_page)
        self.session.theme_changed.connect(self._apply_theme)
        picture = self.viewport.findChild(QOpenGLWidget)
        if isinstance(picture, QOpenGLWidget):
            picture.frameSwapped.connect(self.status.painted)

    # Layout

    def _restore(self) -> None:
        settings = self._settings
        if settings.geometry.isEmpty() or not self.restoreGeometry(settings.geometry):
            available = self.screen().availableGeometry()
            size = SIZE.boundedTo(available.size() - FRAME)
            self.resize(size)
            spare = (available.size() - FRAME - size) / 2
            self.move(available.topLeft() + QPoint(spare.width(), spare.height()))

    def remember(self) -> None:
        """Store the layout of the panels for the next start."""
        settings = self._settings
        if self._full is None:
            settings.geometry = self.saveGeometry()
            self.workspaces.keep()
        settings.sync()

    def choose_workspace(self, workspace_id: str) -> None:
        """Show the panels and lanes of a workspace."""
        self.set_full_screen(False)
        with self._keys_kept():
            self.workspaces.choose(workspace_id)

    def reset_workspace(self) -> None:
        """Restore the panels and lanes of the workspace to the default."""
        self.set_full_screen(False)
        with self._keys_kept():
            self.workspaces.reset()

    @contextmanager
    def _keys_kept(self) -> Iterator[None]:
        """Keep the keyboard focus in its widget while panels move, since Qt takes it from a moved panel."""
        held = self.focusWidget()
        yield
        if self._files.is_open:
            kept = held if held is not None and held.isVisible() else self.timeline
            kept.setFocus(Qt.FocusReason.OtherFocusReason)

    def _show_page(self) -> None:
        """Show the panels while a project is open, else the start page."""
        is_open = self._files.is_open
        self.set_full_screen(False)
        self.banner.hide()
        shown = self._pages.currentWidget() is self.viewport
        if is_open:
            self.workspaces.show()
        else:
            self.workspaces.leave()
            self.start_page.refresh()
        self._pages.setCurrentWidget(self.viewport if is_open else self.start_page)
        for widget in (self.bar, self.workspace_switch):
            widget.setVisible(is_open)
        self._fit_corner()
        if is_open and not shown:
            # Keys go to the notes and not to the first button that Qt finds.
            self.timeline.setFocus(Qt.FocusReason.OtherFocusReason)
        self._table.refresh_soon()
        self._report_title()

    def show_panel(self, name: str, shown: bool) -> None:
        """Show or hide the dock panel with a name; a shown one is raised and receives the keyboard."""
        dock = self.docks[name]
        dock.setVisible(shown)
        if shown:
            dock.raise_()
            self.panels[name].setFocus(Qt.FocusReason.ShortcutFocusReason)

    def is_panel_shown(self, name: str) -> bool:
        """Return whether a panel is open, even if it is behind another tab."""
        return not self.docks[name].isHidden()

    @property
    def is_full_screen(self) -> bool:
        """Return whether the viewport alone fills the screen."""
        return self._full is not None

    def set_full_screen(self, on: bool) -> None:
        """Show the viewport alone on the whole screen, or restore the window."""
        if on == self.is_full_screen:
            return
        if on:
            self._full = self.saveState(LAYOUT_VERSION)
            for widget in (*self.docks.values(), self.bar, self.status, self.menuBar()):
                widget.hide()
            self.showFullScreen()
        elif self._full is not None:
            before, self._full = self._full, None
            self.showNormal()
            self.menuBar().show()
            self.status.show()
            self.restoreState(before, LAYOUT_VERSION)
        self._table.refresh_soon()

    # Requests of commands

    def show_palette(self) -> None:
        """Open the command palette at the top right of the window."""
        self.palette_popup.open_at(self.mapToGlobal(QPoint(self.width() - 8, self.menuBar().height() + 2)))

    def show_help(self, about: QWidget) -> None:
        """Show the guide section about a widget of the window or of its dialogs."""
        self.help_requested.emit(about)

    def rename_player(self) -> None:
        """Open the field for the name of the active player."""
        self.show_panel("players", True)
        self.players.list.rename_current()

    def _fill_recent(self) -> None:
        menu = self.menus.menu("file/open_recent")
        menu.clear()
        for text in self._settings.recent:
            path = Path(text)
            row = menu.addAction(verbatim(f"{shown(path.name)}    {shown(path.parent)}"))
            row.setEnabled(is_file(path) or not may_touch(path))
            on_click(row, self._files.open, path)
        if menu.isEmpty():
            menu.addAction(self.tr("window.nothing_yet")).setEnabled(False)

    # Appearance

    def _report_title(self) -> None:
        if self._files.is_open:
            self.setWindowTitle(f"{verbatim_title(self._files.name)}[*] — Suisou")
        else:
            self.setWindowTitle("Suisou")
        self.setWindowModified(not self._files.is_saved)
        self._table.refresh_soon()

    def _apply_theme(self) -> None:
        tokens = self.session.tokens
        self.palette_field.setIcon(icon("search", tokens, tokens.text_dim))
        self.palette_field.setStyleSheet(
            f"QPushButton {{ background: {tokens.sunken}; color: {tokens.text_dim}; border: 1px solid {tokens.line};"
            f" border-radius: 4px; padding: 2px 12px; margin: 1px 6px 1px 0; min-height: 18px; text-align: left; }}"
            f"QPushButton:hover, QPushButton:focus {{ border-color: {tokens.accent}; }}"
        )

    def retranslate(self) -> None:
        for name, dock in self.docks.items():
            dock.setWindowTitle(self.tr(f"window.{name}"))
            dock.set_tip(self.tr("dock.drag_with_ctrl"))
        # Qt names the button after the window, which must have room for the current text.
        self.workspace_switch.word()
        self._fit_corner()
        self._report_title()

    def _fit_corner(self) -> None:
        """Fit the widgets at the right of the menu bar, which show less in a narrow window."""
        self._narrow = self.width() < NARROW_PX
        keys = self._table.actions["application.palette"].shortcut().toString(QKeySequence.SequenceFormat.NativeText)
        self.palette_field.setText(self.tr("window.search").format(keys="" if self._narrow else keys).strip())
        self._corner.adjustSize()
        # The menu bar computes its width only when its corner widget is set.
        self.menuBar().setCornerWidget(self._corner, Qt.Corner.TopRightCorner)

    # Qt overrides

    def keyPressEvent(self, event: QEvent) -> None:
        """Leave full screen when Escape is pressed."""
        if event.key() == Qt.Key.Key_Escape and self.is_full_screen:  # type: ignore[attr-defined]
            self.set_full_screen(False)
            return
        super().keyPressEvent(event)  # type: ignore[arg-type]

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Fit the widgets at the right of the menu bar to the new width."""
        super().resizeEvent(event)
        if (self.width() < NARROW_PX) != self._narrow:
            self._fit_corner()

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Accept a dragged file that can be opened."""
        if dropped_file(event) is not None:
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        """Open the project, MIDI file, score or other file that was dropped on the window."""
        path = dropped_file(event)
        if path is not None:
            event.acceptProposedAction()
            if path.suffix.lower() in CHARACTER_SUFFIXES:
                self.character_dropped.emit(path)
            else:
                self._files.open(path)

    def closeEvent(self, event: QCloseEvent) -> None:
        """Close after unsaved changes are saved or discarded and running exports are finished or cancelled."""
        writing = self.session.tasks.writing
        if writing and not self._closing and not self._questions.stop_writing(writing):
            event.ignore()
            return
        if not self._closing and not self._files.is_saved:
            event.ignore()
            # Qt does not close a window while it handles another close event.
            self._files.let_go(lambda: QTimer.singleShot(0, self._close_now))
            return
        self.remember()
        self._files.end()
        super().closeEvent(event)

    def _close_now(self) -> None:
        self._closing = True
        self.close()


def dropped_file(event: QDropEvent) -> Path | None:
    """Return the first file of a drop that can be opened."""
    for path in dropped_paths(event):
        if path.suffix.lower() in (SUFFIX, *MUSIC, *AUDIO_SUFFIXES, *VIDEO_SUFFIXES, *CHARACTER_SUFFIXES):
            return path
    return None
