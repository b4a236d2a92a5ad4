"""The preferences: what a person chooses for the editor on this machine. Everything holds at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

from PySide6.QtCore import QEvent, QSize, Qt, Signal
from PySide6.QtWidgets import (
    QButtonGroup,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QHBoxLayout,
    QLineEdit,
    QPushButton,
    QRadioButton,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from app.encoding import shown
from instrument_maps.library import library, own_folder
from widgets.common.paths import show_folder
from widgets.common.plain import ComboBox, Label
from widgets.common.session import Session, TimeDisplay
from widgets.common.text import message_text
from widgets.common.tokens import THEMES
from widgets.dialogs.shortcuts import ShortcutRow, ShortcutsPage


@dataclass(frozen=True)
class Choice:
    """One of several: the key that is chosen, and all keys with their names."""

    chosen: str
    names: Mapping[str, str]


class PreferencesDialog(QDialog):
    """The preferences.

    Parameters
    ----------
    session : Session
        Theme, pitch and time are its own.
    language : Choice
        Codes and the languages' own names; the empty code is the system's.
    shortcuts, conflicts, menu_of : callable
        See `ShortcutsPage`.

    Signals
    -------
    language_chosen(str)
    shortcut_chosen(str, object)
        See `ShortcutsPage.chosen`.
    """

    language_chosen = Signal(str)
    shortcut_chosen = Signal(str, object)

    def __init__(
        self,
        session: Session,
        language: Choice,
        shortcuts: Callable[[], tuple[ShortcutRow, ...]],
        conflicts: Callable[[str, str], tuple[str, ...]],
        menu_of: Callable[[str], str],
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("preferences")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._session = session
        self._labels: dict[str, Label] = {}
        self._radios: dict[str, QRadioButton] = {}
        self._groups: list[QButtonGroup] = []
        self.tabs = QTabWidget()
        self.tabs.setObjectName("preferences_tabs")
        general = QWidget()
        self._form = QFormLayout(general)
        self._form.setContentsMargins(16, 16, 16, 16)
        self._form.setVerticalSpacing(12)
        self._form.setHorizontalSpacing(24)
        self._languages = ComboBox()
        self._languages.setObjectName("preferences_language")
        for code in language.names:
            self._languages.addItem(language.names[code], code)
        self._languages.setCurrentIndex(max(self._languages.findData(language.chosen), 0))
        self._languages.activated.connect(self._choose_language)
        self._row("language", self._languages)
        self._options("theme", [(name, partial(self._choose_theme, name)) for name in THEMES])
        pitch = session.pitch_display
        self._options(
            "pitch", [("concert", lambda: pitch.set(written=False)), ("written", lambda: pitch.set(written=True))]
        )
        self._options(
            "octave",
            [("c4", lambda: pitch.set(middle_c_octave=4)), ("c3", lambda: pitch.set(middle_c_octave=3))],
        )
        self._options(
            "names",
            [("letters", lambda: pitch.set(syllables=False)), ("syllables", lambda: pitch.set(syllables=True))],
        )
        displays: tuple[TimeDisplay, ...] = ("bars", "seconds", "frames")
        self._options("time", [(display, partial(session.set_time_display, display)) for display in displays])
        self.tabs.addTab(general, "")
        self.shortcuts = ShortcutsPage(session, shortcuts, conflicts, menu_of)
        self.shortcuts.chosen.connect(self.shortcut_chosen)
        self.tabs.addTab(self.shortcuts, "")
        self.tabs.addTab(self._instruments_page(), "")
        self._buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        self._buttons.rejected.connect(self.reject)
        column = QVBoxLayout(self)
        column.setContentsMargins(10, 8, 10, 10)
        column.addWidget(self.tabs, 1)
        column.addWidget(self._buttons)
        for signal in (
            session.theme_changed,
            session.time_display_changed,
            session.instruments_changed,
            pitch.changed,
        ):
            signal.connect(self.refresh)
        self.retranslate()
        self.refresh()

    def _row(self, name: str, field: QWidget) -> None:
        label = Label()
        label.setBuddy(field)
        self._labels[name] = label
        self._form.addRow(label, field)

    def _options(self, name: str, options: list[tuple[str, Callable[[], object]]]) -> None:
        group = QButtonGroup(self)
        field = QWidget()
        line = QHBoxLayout(field)
        line.setContentsMargins(0, 0, 0, 0)
        line.setSpacing(16)
        for key, choose in options:
            radio = QRadioButton()
            radio.setObjectName(f"preferences_{name}_{key}")
            radio.clicked.connect(partial(_call, choose))
            group.addButton(radio)
            line.addWidget(radio)
            self._radios[f"{name}.{key}"] = radio
        line.addStretch(1)
        self._groups.append(group)
        self._row(name, field)

    def _instruments_page(self) -> QWidget:
        """Where a person's own maps are, and what is wrong with them."""
        page = QWidget()
        column = QVBoxLayout(page)
        column.setContentsMargins(16, 16, 16, 16)
        column.setSpacing(12)
        self._own, self._found = Label(), Label()
        self._folder = QLineEdit(shown(own_folder()))
        self._folder.setObjectName("preferences_instruments")
        self._folder.setReadOnly(True)
        self._open = QPushButton()
        self._open.setObjectName("preferences_instruments_open")
        self._open.clicked.connect(self._open_folder)
        for label in (self._own, self._found):
            label.setWordWrap(True)
        self._found.setObjectName("preferences_instruments_found")
        self._found.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        line = QHBoxLayout()
        line.addWidget(self._folder, 1)
        line.addWidget(self._open)
        column.addWidget(self._own)
        column.addLayout(line)
        column.addWidget(self._found)
        column.addStretch(1)
        return page

    def _open_folder(self) -> None:
        folder = own_folder()
        folder.mkdir(parents=True, exist_ok=True)
        show_folder(folder)

    def _show_instruments(self) -> None:
        known = library()
        wrong = [message_text(problems[0], self._session) for problems in known.problems.values()]
        found = [self.tr("Your own: {maps}").format(maps=", ".join(known.own))] if known.own else []
        self._found.setText("\n\n".join([*found, *(f"⚠ {text}" for text in wrong)]))

    def show_page(self, page: str) -> None:
        """``"general"``, ``"shortcuts"`` or ``"instruments"``."""
        self.tabs.setCurrentIndex({"shortcuts": 1, "instruments": 2}.get(page, 0))
        if page == "shortcuts":
            self.shortcuts.search.setFocus(Qt.FocusReason.OtherFocusReason)

    def refresh(self) -> None:
        """Show what is chosen now."""
        session = self._session
        pitch = session.pitch_display
        chosen = (
            f"theme.{session.tokens.name}",
            "pitch.written" if pitch.written else "pitch.concert",
            f"octave.c{pitch.middle_c_octave}",
            "names.syllables" if pitch.syllables else "names.letters",
            f"time.{session.time_display}",
        )
        for key in chosen:
            self._radios[key].setChecked(True)
        self._show_instruments()

    def _choose_theme(self, name: str) -> None:
        self._session.set_tokens(THEMES[name])

    def _choose_language(self, index: int) -> None:
        self.language_chosen.emit(str(self._languages.itemData(index)))

    def retranslate(self) -> None:
        """Set the texts."""
        self.setWindowTitle(self.tr("Preferences"))
        self.tabs.setTabText(0, self.tr("General"))
        self.tabs.setTabText(1, self.tr("Keyboard Shortcuts"))
        self.tabs.setTabText(2, self.tr("Instruments"))
        self._open.setText(self.tr("Show Folder"))
        self._own.setText(
            self.tr(
                "Your own instruments: a map (.toml) and a model (.glb) in this folder. They are read again as soon as "
                "they change."
            )
        )
        for name, text in (
            ("language", self.tr("Language")),
            ("theme", self.tr("Theme")),
            ("pitch", self.tr("Pitches")),
            ("octave", self.tr("Middle C")),
            ("names", self.tr("Names of notes")),
            ("time", self.tr("Time")),
        ):
            self._labels[name].setText(text)
        for key, text in (
            ("theme.dark", self.tr("Dark")),
            ("theme.light", self.tr("Light")),
            ("pitch.concert", self.tr("As they sound (concert)")),
            ("pitch.written", self.tr("As written for the instrument")),
            ("octave.c4", "C4"),
            ("octave.c3", "C3"),
            ("names.letters", "C D E"),
            ("names.syllables", self.tr("Do Re Mi")),
            ("time.bars", self.tr("Bars and beats")),
            ("time.seconds", self.tr("Seconds")),
            ("time.frames", self.tr("Frames")),
        ):
            self._radios[key].setText(text)
        self._languages.setItemText(self._languages.findData(""), self.tr("The system's"))

    def sizeHint(self) -> QSize:
        """Room for the list of shortcuts."""
        return QSize(760, 560)

    def changeEvent(self, event: QEvent) -> None:
        """Another language."""
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)


def _call(choose: Callable[[], object], *_: object) -> None:
    choose()
