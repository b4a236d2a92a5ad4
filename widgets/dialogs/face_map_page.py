"""Page that maps a character's morphs to ARKit's face shapes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QTreeWidgetItem, QWidget

from app.editor.session import Session
from metadata.model import ARKIT_MORPHS
from widgets.common.combo import Combo, Option
from widgets.common.controls import Button, ColumnList, IconButton, Retranslated, named, wrapped
from widgets.common.layouts import in_column, in_row
from widgets.common.morph_names import morph_name
from widgets.common.number_slider import NumberSlider
from widgets.common.plain import Label

MOST_FACTOR = 2.0


class FaceMapPage(Retranslated, QWidget):
    """List of face shapes with their morphs.

    Parameters
    ----------
    morphs : sequence of str
        Morphs of the file.

    Signals
    -------
    chosen(str)
        The user selected the face shape with this ARKit name.
    changed(str, object, object)
        The morphs of a face shape were changed (a mapping of weights; None for automatic); token of the gesture.
    released()
        A drag of a slider ended.
    """

    chosen = Signal(str)
    changed = Signal(str, object, object)
    released = Signal()

    def __init__(self, session: Session, morphs: Sequence[str], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session, self._morphs = session, tuple(morphs)
        self._parts: dict[str, dict[str, float]] = {}
        self._own: frozenset[str] = frozenset()
        self._face = ARKIT_MORPHS[0]
        self._listed: tuple[object, ...] = ()
        self._rows = list[_Part]()
        self.list = ColumnList("face_list", "face_map_page.face", "face_map_page.made_of", stretches=(1,))
        self._items = {face: QTreeWidgetItem() for face in ARKIT_MORPHS}
        for face, item in self._items.items():
            item.setData(0, Qt.ItemDataRole.UserRole, face)
            self.list.addTopLevelItem(item)
        self.list.setCurrentItem(self._items[self._face])
        self.list.currentItemChanged.connect(self._chosen)
        none = "nothing_character_does_not_do" if morphs else "no_morphs"
        self._title, self._none = Label(), self.texted(wrapped(Label()), text=f"face_map_page.{none}")
        self._add = named(Combo(), "face_add")
        self.texted(self._add, placeholder="face_map_page.add_morph", name="face_map_page.add_morph")
        self._add.chosen.connect(lambda morph: self._set_part(morph, 1.0, None))
        self._reset = Button("face_map_page.automatic", lambda: self.changed.emit(self._face, None, None), "face_reset")
        self._column = in_column(spacing=4)
        self._build()
        session.theme_changed.connect(self._show)
        self.retranslate()

    def _build(self) -> None:
        line = in_row((self._add, 1), self._reset)
        editor = in_column(self._title, self._none, self._column, line, spacing=6)
        in_column((self.list, 1), editor, of=self, margins=(0, 8, 0, 0))

    @property
    def face(self) -> str:
        """Name of the selected face shape."""
        return self._face

    def choose(self, face: str) -> None:
        """Select a face shape in the list."""
        self.list.setCurrentItem(self._items[face])

    def show_parts(self, parts: Mapping[str, Mapping[str, float]], own: frozenset[str]) -> None:
        """Show the morphs of the face shapes, and the shapes that the user has changed."""
        self._parts, self._own = {face: dict(made) for face, made in parts.items()}, own
        self._show()

    # User actions

    def _chosen(self, item: QTreeWidgetItem | None, before: QTreeWidgetItem | None = None) -> None:
        if item is not None:
            self._face = item.data(0, Qt.ItemDataRole.UserRole)
            self._show_editor()
            self.chosen.emit(self._face)

    def _set_part(self, morph: str, factor: float, token: object) -> None:
        self.changed.emit(self._face, {**self._parts.get(self._face, {}), morph: factor}, token)

    def _remove_part(self, morph: str) -> None:
        left = {name: factor for name, factor in self._parts.get(self._face, {}).items() if name != morph}
        self.changed.emit(self._face, left, None)

    # Display

    def _show(self) -> None:
        tokens = self._session.tokens
        for face, item in self._items.items():
            parts = self._parts.get(face, {})
            item.setText(0, morph_name(face))
            item.setToolTip(0, face)
            item.setText(1, made_of(parts))
            item.setForeground(0, QColor(tokens.text if parts else tokens.text_dim))
            item.setForeground(1, QColor(tokens.by_hand if face in self._own else tokens.text_dim))
        self._show_editor()

    def _show_editor(self) -> None:
        parts = self._parts.get(self._face, {})
        self._title.setText(
            self.tr("face_map_page.morphs_of_face").format(face=morph_name(self._face), name=self._face)
        )
        self._none.setVisible(not parts)
        self._none.setStyleSheet(f"color: {self._session.tokens.text_dim};")
        names = tuple(parts)
        if names != tuple(row.morph for row in self._rows):
            self._make_rows(names)
        for row in self._rows:
            row.slider.show_value(parts[row.morph])
        self._add.set_options([Option(morph, morph) for morph in self._morphs if morph not in parts])
        self._add.show_option(None)
        self._add.setEnabled(any(morph not in parts for morph in self._morphs))
        self._reset.setEnabled(self._face in self._own)

    def _make_rows(self, morphs: Sequence[str]) -> None:
        for row in self._rows:
            self._column.removeWidget(row)
            row.hide()
            row.deleteLater()
        self._rows = [_Part(self._session, morph, partial(self._remove_part, morph)) for morph in morphs]
        for row in self._rows:
            row.slider.changed.connect(partial(self._set_part, row.morph))
            row.slider.released.connect(self.released)
            self._column.addWidget(row)

    def retranslate(self) -> None:
        self._show()


class _Part(QWidget):
    """A morph with its weight in a face shape, as a row of controls."""

    def __init__(self, session: Session, morph: str, remove: Callable[[], object]) -> None:
        super().__init__()
        self.morph = morph
        self.slider = named(NumberSlider(session, 0.0, MOST_FACTOR, default=1.0, step=0.05), f"face_part_{morph}")
        self.slider.set_texts(morph)
        button = IconButton(session, "close", "face_map_page.remove_morph", remove, f"face_remove_{morph}")
        in_row((self.slider, 1), button, of=self, margins=0)


def made_of(parts: Mapping[str, float]) -> str:
    """Return a face shape as text: a sum of morphs with weights on one line."""
    return " + ".join(morph if factor == 1.0 else f"{morph} × {factor:g}" for morph, factor in parts.items())
