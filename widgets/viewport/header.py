"""The viewport's header: views, pose tool, and additional display options."""

from __future__ import annotations

from functools import partial
from typing import Final

from PySide6.QtCore import QEvent, QObject, QSize, Qt
from PySide6.QtGui import QAction, QActionGroup, QKeyEvent, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QButtonGroup, QLineEdit, QMenu, QSizePolicy, QToolButton, QWidget

from app.editor.design_tokens import LEAST_TARGET_PX
from app.editor.session import Session
from app.editor.viewport_state import SHOWN, Shown
from app.errors import Message
from app.project.camera_bookmarks import VIEWS, CameraBookmark, View
from app.project.edit.camera_bookmarks import rename_camera
from widgets.common.actions import actions, with_keys
from widgets.common.clicks import on_click, on_switch
from widgets.common.controls import Retranslated, named
from widgets.common.icons import icon
from widgets.common.layouts import in_row
from widgets.common.menus import add_actions
from widgets.common.plain import Label, verbatim

_VIEWS: Final[dict[View, tuple[str, str]]] = {
    "ensemble": ("header.ensemble", "header.everyone_from_audience"),
    "front": ("header.front", "header.selected_players_from_their_front"),
    "side": ("header.side", "header.selected_players_from_their_right"),
    "top": ("header.top", "header.selected_players_from_above"),
    "hands": ("header.hands", "header.hands_of_player_in_front"),
    "mouth": ("header.mouth", "header.mouth_of_player_in_front"),
    "feet": ("header.feet", "header.feet_of_player_in_front"),
}
"""Text and tool tip ids of the views."""
_SHOWN: Final[dict[Shown, tuple[str, str]]] = {
    "names": ("header.players_names", "player"),
    "skeleton": ("header.skeleton", "skeleton"),
    "contacts": ("header.contact_points_and_their_distances", "contacts"),
    "wireframe": ("header.wireframe", "wireframe"),
    "props": ("header.props", "seated"),
}
"""Text ids and icons of the additional display options."""
FULL_SCREEN = "application.full_screen"
"""Action of the shell, since only a window can fill the screen."""
_BETWEEN: Final = " · "
"""Separator between the parts of the note."""
_OF_CAMERAS: Final = ("cameras.keep", "cameras.update", "cameras.rename", "cameras.remove")


class ViewportHeader(Retranslated, QWidget):
    """Buttons over the picture; in a narrow viewport, views fold into a menu.

    Parameters
    ----------
    session : Session
        Session with the state of the 3D view.
    """

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("viewport_header")
        self._session = session
        self._pictures: dict[QToolButton, str] = {}
        self._views: dict[View, QToolButton] = {}
        self._view_rows: dict[View, QAction] = {}
        self._segments = QWidget(self)
        self._folded = self._button("viewport_view", "camera")
        self._add_views()
        self._cameras = self._button("viewport_cameras", "bookmark")
        self._cameras.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self._camera_menu = named(QMenu(self), "viewport_camera_menu")
        self._camera_menu.aboutToShow.connect(self._list_cameras)
        self._cameras.setMenu(self._camera_menu)
        self._name: QLineEdit | None = None
        """Field in which a camera's name is typed."""
        self._note_text = ""
        self._note = named(Label(parent=self), "viewport_note")
        self._note.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self._note.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self._pose = self._button("viewport_pose", "pose", checkable=True)
        self._pose.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        on_switch(self._pose, session.viewport.set_posing)
        self._frame = self._button("viewport_frame", "frame")
        on_click(self._frame, session.viewport.frame, True)
        self._show = self._button("viewport_show", "eye")
        self._show_rows = self._add_shown()
        self._full = self._button("viewport_full_screen", "full_screen")
        on_click(self._full, self._toggle_full_screen)
        self._explain()
        in_row(
            self._segments,
            self._folded,
            self._cameras,
            (self._note, 1),
            self._pose,
            self._frame,
            self._show,
            self._full,
            of=self,
            margins=(6, 2, 6, 2),
            spacing=4,
        )
        session.viewport.changed.connect(self.refresh)
        session.theme_changed.connect(self._apply_theme)
        self._apply_theme()
        self.retranslate()

    def _add_views(self) -> None:
        """Add the views as buttons, and as rows of a menu for narrow headers."""
        viewport, buttons, rows = self._session.viewport, QButtonGroup(self), QActionGroup(self)
        segments, menu = in_row(of=self._segments, margins=0, spacing=1), named(QMenu(self), "viewport_view_menu")
        for view in VIEWS:
            text_id, tip_id = _VIEWS[view]
            button = self._views[view] = self._button(f"viewport_view_{view}", checkable=True)
            self.texted(button, text=text_id, tip=with_keys(self._session, f"viewport.{view}", tip_id))
            on_click(button, viewport.set_view, view)
            buttons.addButton(button)
            segments.addWidget(button)
            row = self._view_rows[view] = self.texted(menu.addAction(""), text=text_id)
            row.setCheckable(True)
            on_click(row, viewport.set_view, view)
            rows.addAction(row)
        self._folded.setMenu(menu)
        self._folded.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self._folded.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self._folded.hide()

    def _add_shown(self) -> dict[Shown, QAction]:
        """Add a menu of additional things to display, and return its actions by kind."""
        menu = named(QMenu(self), "viewport_show_menu")
        self._show.setMenu(menu)
        self._show.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        rows = {what: self.texted(menu.addAction(""), text=_SHOWN[what][0]) for what in SHOWN}
        for what, row in rows.items():
            row.setCheckable(True)
            on_switch(row, partial(self._session.viewport.show, what))
        return rows

    def _explain(self) -> None:
        session = self._session
        self.texted(self._folded, explained="header.view")
        self.texted(self._cameras, explained=with_keys(session, "cameras.keep", "header.saved_cameras"))
        self.texted(self._show, explained="header.overlays_tip")
        pose_tip = with_keys(session, "viewport.pose", "header.hold_bell_head_elbows_or")
        self.texted(self._pose, text="header.pose", explained=pose_tip)
        self.texted(self._frame, explained=with_keys(session, "viewport.frame", "header.frame_selected_players"))
        self.texted(self._full, explained=with_keys(session, FULL_SCREEN, "header.full_screen_tip"))

    def _list_cameras(self) -> None:
        """Fill the menu of stored cameras."""
        session, menu = self._session, self._camera_menu
        menu.clear()
        table = actions(session)
        for number, camera in enumerate(session.project.cameras, 1):
            row = table.get(f"cameras.recall_{number}")
            if row is not None:
                menu.addAction(row)
            else:
                on_click(menu.addAction(verbatim(camera.name)), self._recall, camera)
        if session.project.cameras:
            menu.addSeparator()
        add_actions(menu, session, _OF_CAMERAS)

    def _recall(self, camera: CameraBookmark) -> None:
        eye = self._session.viewport.camera
        if eye is not None:
            eye.recall(camera)
            self._session.viewport.use_bookmark(camera.name)

    def ask_name(self, camera: CameraBookmark) -> None:
        """Open a field for the name of a camera."""
        self._end_typing()
        field = self._name = named(QLineEdit(camera.name, self), "camera_name")
        field.setAccessibleName(self.tr("header.name_of_camera"))
        field.setGeometry(self._cameras.geometry().right() + 4, 1, 200, self.height() - 2)
        field.selectAll()
        field.installEventFilter(self)
        field.editingFinished.connect(lambda: self._typed(camera.name))
        field.show()
        field.setFocus(Qt.FocusReason.OtherFocusReason)

    def _typed(self, before: str) -> None:
        """Rename the camera bookmark ``before`` to the typed name."""
        field = self._name
        if field is None:
            return
        name = field.text()
        self._end_typing()
        edit = partial(rename_camera, name=before, new_name=name)
        if name != before and self._session.attempt(Message("edit.rename_camera"), edit):
            self._session.viewport.use_bookmark(name)

    def _end_typing(self) -> None:
        field, self._name = self._name, None
        if field is not None:
            field.hide()
            field.deleteLater()

    def set_note(self, text: str) -> None:
        """Show a text between the buttons; as many of its parts as fit."""
        self._note_text = text
        self._note.setToolTip(text)
        self._fold()

    def refresh(self) -> None:
        """Check the buttons and menu rows as the state of the 3D view requires."""
        state = self._session.viewport
        self._views[state.view].setChecked(True)
        self._view_rows[state.view].setChecked(True)
        self._folded.setText(self._view_rows[state.view].text())
        self._pose.setChecked(state.posing)
        for what, row in self._show_rows.items():
            row.setChecked(state.shows(what))

    def retranslate(self) -> None:
        self.refresh()
        self._fold()

    def _toggle_full_screen(self) -> None:
        actions(self._session)[FULL_SCREEN].trigger()

    def _button(self, name: str, picture: str = "", checkable: bool = False) -> QToolButton:
        button = named(QToolButton(self), name)
        if picture:
            self._pictures[button] = picture
        button.setCheckable(checkable)
        button.setAutoRaise(True)
        button.setMinimumSize(LEAST_TARGET_PX + 2, LEAST_TARGET_PX + 2)
        button.setIconSize(QSize(16, 16))
        button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        return button

    def _apply_theme(self) -> None:
        tokens = self._session.tokens
        for button, picture in self._pictures.items():
            button.setIcon(icon(picture, tokens))
        for what, row in self._show_rows.items():
            row.setIcon(icon(_SHOWN[what][1], tokens))
        self._note.setStyleSheet(f"color: {tokens.text_dim};")

    def _fold(self) -> None:
        """Show the views as seven buttons if they fit, else as one button with a menu."""
        others = sum(button.sizeHint().width() + 4 for button in self._others)
        fits = self.width() >= self._segments.sizeHint().width() + others + 24
        self._segments.setVisible(fits)
        self._folded.setVisible(not fits)
        views = self._segments if fits else self._folded
        room = self.width() - views.sizeHint().width() - others - 36
        parts, metrics = self._note_text.split(_BETWEEN), self._note.fontMetrics()
        whole = (_BETWEEN.join(parts[:count]) for count in range(len(parts), 0, -1))
        self._note.setText(next((text for text in whole if metrics.horizontalAdvance(text) <= room), ""))

    @property
    def _others(self) -> tuple[QToolButton, ...]:
        """Return the buttons that stay visible when the header is narrow."""
        return self._cameras, self._pose, self._frame, self._show, self._full

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Cancel renaming of a camera on Escape."""
        if watched is self._name and isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape:
            self._end_typing()
            return True
        return super().eventFilter(watched, event)

    def minimumSizeHint(self) -> QSize:
        """Return the width of the header with the views folded into a menu."""
        shown = (self._folded, *self._others)
        return QSize(sum(button.sizeHint().width() + 4 for button in shown) + 16, super().minimumSizeHint().height())

    def showEvent(self, event: QShowEvent) -> None:
        """Update the button for full screen and the shortcuts, which are known only once the window exists."""
        self._full.setVisible(FULL_SCREEN in actions(self._session))
        self.word()
        super().showEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Fold the buttons of the views into a menu when the header becomes too narrow, and unfold them again."""
        super().resizeEvent(event)
        self._fold()
