"""Dialog of the preferences, which are stored for this computer and apply immediately."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QSize, Qt, Signal, SignalInstance
from PySide6.QtWidgets import (
    QButtonGroup,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QLineEdit,
    QPushButton,
    QRadioButton,
    QTabWidget,
    QWidget,
)

from app.editor.session import Session
from app.encoding import shown
from instrument_maps.library import library, own_folder
from widgets.common.clicks import on_click
from widgets.common.controls import Caption, Retranslated, named
from widgets.common.help import with_help
from widgets.common.layouts import STRETCH, begin_with_size, in_column, in_row, panel
from widgets.common.paths import show_folder
from widgets.common.plain import ComboBox, Label
from widgets.common.text import message_text
from widgets.dialogs.shortcuts import ShortcutRow, ShortcutsPage


@dataclass(frozen=True)
class Choice:
    """A setting of the preferences with several possible values.

    Attributes
    ----------
    options : tuple of (value, word)
        Possible values with their names. The words are English and translated in the context ``Setting``.
    chosen : callable
        Returns the present value.
    choose : callable
        Sets another value.
    changed : signal or None
        Emitted when the value changes.
    is_list : bool
        Whether to use a combo box instead of a row of buttons.
    """

    name: str
    label: str
    options: tuple[tuple[Any, str], ...]
    chosen: Callable[[], Any]
    choose: Callable[[Any], object]
    changed: SignalInstance | None = None
    is_list: bool = False


class PreferencesDialog(Retranslated, QDialog):
    """Dialog with the preferences.

    Parameters
    ----------
    choices : sequence of Choice
        Settings of the general page, in order.
    shortcuts, conflicts, menu_of : callable
        See `ShortcutsPage`.

    Signals
    -------
    shortcut_chosen(str, object)
        See `ShortcutsPage.chosen`.
    """

    shortcut_chosen = Signal(str, object)

    def __init__(
        self,
        session: Session,
        choices: Sequence[Choice],
        shortcuts: Callable[[], tuple[ShortcutRow, ...]],
        conflicts: Callable[[str, str], tuple[str, ...]],
        menu_of: Callable[[str], str],
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("preferences")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._session, self._choices = session, tuple(choices)
        self._lists: dict[str, ComboBox] = {}
        self._radios: dict[str, list[QRadioButton]] = {}
        self.tabs = named(QTabWidget(), "preferences_tabs")
        general = QWidget()
        self._form = QFormLayout(general)
        self._form.setContentsMargins(16, 16, 16, 16)
        self._form.setVerticalSpacing(12)
        self._form.setHorizontalSpacing(24)
        for choice in self._choices:
            field = self._list(choice) if choice.is_list else self._options(choice)
            label = self.texted(Label(), text=choice.label)
            label.setBuddy(field)
            self._form.addRow(label, field)
            if choice.changed is not None:
                choice.changed.connect(self.refresh)
        self.tabs.addTab(general, "")
        self.shortcuts = ShortcutsPage(session, shortcuts, conflicts, menu_of)
        self.shortcuts.chosen.connect(self.shortcut_chosen)
        self.tabs.addTab(self.shortcuts, "")
        self.tabs.addTab(self._instruments_page(), "")
        titles = "preferences_dialog.general", "preferences_dialog.keyboard_shortcuts", "preferences_dialog.instruments"
        self.texted(self.tabs, tabs=titles)
        self._buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        self._buttons.rejected.connect(self.reject)
        in_column((self.tabs, 1), with_help(self._buttons), of=self, margins=(10, 8, 10, 10))
        session.instruments_changed.connect(self.refresh)
        self.texted(self, title="preferences_dialog.preferences")
        self.texted(self._open, text="preferences_dialog.show_folder")
        self.refresh()
        # Room for the list of shortcuts.
        begin_with_size(self, QSize(760, 560))

    def _list(self, choice: Choice) -> QWidget:
        field = self._lists[choice.name] = named(ComboBox(), f"preferences_{choice.name}")
        field.addItems([""] * len(choice.options))
        self.texted(field, items=[word for _, word in choice.options])
        field.activated.connect(lambda index: choice.choose(choice.options[index][0]))
        return field

    def _options(self, choice: Choice) -> QWidget:
        radios = [named(QRadioButton(), f"preferences_{choice.name}_{value}") for value, _ in choice.options]
        field = panel(in_row(*radios, STRETCH, margins=0, spacing=16))
        group = QButtonGroup(field)
        for radio, (value, word) in zip(radios, choice.options, strict=True):
            self.texted(radio, text=word)
            on_click(radio, choice.choose, value)
            group.addButton(radio)
        self._radios[choice.name] = radios
        return field

    def _instruments_page(self) -> QWidget:
        """Return the page with the user's own instrument maps, their folder and their errors."""
        page = QWidget()
        self._own, self._found = Caption("preferences_dialog.your_own_instruments_map_toml"), Label()
        self._folder = named(QLineEdit(shown(own_folder())), "preferences_instruments")
        self._folder.setReadOnly(True)
        self._open = named(QPushButton(), "preferences_instruments_open")
        on_click(self._open, self._open_folder)
        for label in (self._own, self._found):
            label.setWordWrap(True)
        self._found.setObjectName("preferences_instruments_found")
        self._found.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        line = in_row((self._folder, 1), self._open)
        in_column(self._own, line, self._found, STRETCH, of=page, margins=16, spacing=12)
        return page

    def _open_folder(self) -> None:
        folder = own_folder()
        folder.mkdir(parents=True, exist_ok=True)
        show_folder(folder)

    def _show_instruments(self) -> None:
        known = library()
        wrong = [message_text(problems[0], self._session) for problems in known.problems.values()]
        found = [self.tr("preferences_dialog.your_own").format(maps=", ".join(known.own))] if known.own else []
        self._found.setText("\n\n".join([*found, *(f"⚠ {text}" for text in wrong)]))

    def show_page(self, page: str) -> None:
        """Switch to a page of the dialog: ``"general"``, ``"shortcuts"`` or ``"instruments"``."""
        self.tabs.setCurrentIndex({"shortcuts": 1, "instruments": 2}.get(page, 0))
        if page == "shortcuts":
            self.shortcuts.search.setFocus(Qt.FocusReason.OtherFocusReason)

    def refresh(self) -> None:
        """Display the present values of all settings."""
        for choice in self._choices:
            values = [value for value, _ in choice.options]
            chosen = values.index(choice.chosen())
            if choice.is_list:
                self._lists[choice.name].setCurrentIndex(chosen)
            else:
                self._radios[choice.name][chosen].setChecked(True)
        self._show_instruments()
