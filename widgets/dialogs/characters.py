"""Dialog with the list of the user's own characters and their problems, for adding, changing and removing them."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QIcon, QImage, QPixmap
from PySide6.QtWidgets import QDialog, QListWidget, QListWidgetItem, QWidget

from app.editor.session import Session
from app.errors import Message, Progress, StopRequested
from app.project.usual_outfits import common_outfit
from app.rig.characters.character_library import character_library, character_problems
from app.rig.characters.dressed_characters import character_in
from app.rig.characters.read_figure import SUFFIXES
from widgets.common.character_picture import picture, seen
from widgets.common.controls import Button, Caption, Retranslated, named, selectable
from widgets.common.help import HelpButton
from widgets.common.instrument_name import character_name
from widgets.common.layouts import STRETCH, in_column, in_row
from widgets.common.paths import dropped_paths
from widgets.common.plain import Label
from widgets.common.text import message_text

_PICTURE_PX = QSize(72, 96)


class CharactersDialog(Retranslated, QDialog):
    """Dialog with the user's own characters.

    Signals
    -------
    add_asked(), make_asked()
        The user wants to add a character from a file, or to make a person.
    edit_asked(str), remove_asked(str)
        The user wants to change or remove the character with this id.
    dropped(object)
        The user dropped a character's file with this `Path`.
    """

    add_asked = Signal()
    make_asked = Signal()
    edit_asked = Signal(str)
    remove_asked = Signal(str)
    dropped = Signal(object)

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("characters")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setAcceptDrops(True)
        self._session = session
        self._pictures: dict[str, QIcon] = {}
        self._explained, self._wrong = Caption("characters_dialog.your_own_characters_from_vrm"), selectable(Label())
        self.list = named(QListWidget(), "character_list")
        self.list.setIconSize(_PICTURE_PX)
        self._add = Button("characters_dialog.add", self.add_asked.emit, "characters_add")
        self._make = Button("characters_dialog.make", self.make_asked.emit, "characters_make")
        self._edit = Button("characters_dialog.edit", lambda: self.edit_asked.emit(self.chosen), "characters_edit")
        self._remove = Button(
            "characters_dialog.remove", lambda: self.remove_asked.emit(self.chosen), "characters_remove"
        )
        self._close = Button("characters_dialog.close", self.close, "characters_close")
        self._wrong.setObjectName("characters_wrong")
        for label in (self._explained, self._wrong):
            label.setWordWrap(True)
        side = in_column(self._add, self._make, self._edit, self._remove, STRETCH, HelpButton(), self._close)
        middle = in_row((self.list, 1), side)
        in_column(self._explained, (middle, 1), self._wrong, of=self, margins=14, spacing=10)
        self.list.itemActivated.connect(lambda item: self.edit_asked.emit(self.chosen))
        self.list.currentItemChanged.connect(self._enable)
        session.characters_changed.connect(self.refresh)
        session.theme_changed.connect(self.refresh)
        self.texted(self, title="characters_dialog.characters")
        self.retranslate()
        self.resize(520, 460)

    @property
    def chosen(self) -> str:
        """Return the id of the selected character; empty for none."""
        item = self.list.currentItem()
        return "" if item is None else str(item.data(Qt.ItemDataRole.UserRole))

    def refresh(self) -> None:
        """Update the list of characters, keeping the selection."""
        before = self.chosen
        self.list.clear()
        for id in character_library().own:
            item = QListWidgetItem(self._pictures.get(id, QIcon()), character_name(id))
            item.setData(Qt.ItemDataRole.UserRole, id)
            item.setSizeHint(QSize(0, _PICTURE_PX.height() + 8))
            self.list.addItem(item)
            if id == before:
                self.list.setCurrentItem(item)
        if self.list.currentItem() is None and self.list.count():
            self.list.setCurrentRow(0)
        self._enable()
        self._draw()

    def _enable(self, *_: object) -> None:
        for button in (self._edit, self._remove):
            button.setEnabled(bool(self.chosen))

    def _draw(self) -> None:
        """Load all characters in the background, and draw each in the outfit that most players wear."""
        ids, ratio = tuple(character_library().own), self.devicePixelRatioF()
        worn = common_outfit(self._session.project)
        if not ids and not character_library().problems:
            self._wrong.hide()
            return

        def work(progress: Progress, stop_requested: StopRequested) -> tuple[dict[str, QImage], dict[str, Message]]:
            wrong, drawn = dict(character_problems()), {}
            for number, id in enumerate(ids):
                if stop_requested():
                    break
                if id not in wrong:
                    shown = seen(character_in(id, worn))
                    drawn[id] = picture(shown, round(_PICTURE_PX.width() * ratio), round(_PICTURE_PX.height() * ratio))
                progress((number + 1) / len(ids))
            return drawn, wrong

        self._session.tasks.run(Message("work.portraits"), work, self._take, key="characters_pictures")

    def _take(self, made: tuple[dict[str, QImage], dict[str, Message]]) -> None:
        drawn, wrong = made
        for id, image in drawn.items():
            copy = QImage(image)
            copy.setDevicePixelRatio(self.devicePixelRatioF())
            self._pictures[id] = QIcon(QPixmap.fromImage(copy))
        for row in range(self.list.count()):
            item = self.list.item(row)
            item.setIcon(self._pictures.get(item.data(Qt.ItemDataRole.UserRole), QIcon()))
        self._wrong.setText("\n".join(message_text(reported, self._session) for reported in wrong.values()))
        self._wrong.setStyleSheet(f"color: {self._session.tokens.error};")
        self._wrong.setVisible(bool(wrong))

    def retranslate(self) -> None:
        self.refresh()

    # Qt overrides

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if dropped_character(event) is not None:
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        path = dropped_character(event)
        if path is not None:
            event.acceptProposedAction()
            self.dropped.emit(path)


def dropped_character(event: QDropEvent) -> Path | None:
    """Return the first file of a drop with the suffix of a character."""
    for path in dropped_paths(event):
        if path.suffix.lower() in SUFFIXES:
            return path
    return None
