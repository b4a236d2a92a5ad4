"""Find clickable controls in the editor's window, click them with the mouse, and record the changes."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from functools import partial

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAction, QContextMenuEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QApplication, QComboBox, QMainWindow, QMenu, QToolButton, QWidget
from shiboken6 import isValid

from app.shell.app import Program
from tests.support import mouse
from tests.support.click_table import Row, expected
from tests.support.window_state import Watcher, Widgets, changed, names_of
from widgets.common.actions import actions
from widgets.common.section import SectionHeader

Path = tuple[str, ...]
"""Names of the submenus that contain an entry, and of the entry."""
Open = Callable[[], QMenu | None]
"""Function that opens a menu like a user; None if no menu opened."""
CALM = frozenset(
    ("sought", "view", "turned", "framed", "shown", "posing", "sound", "time", "pitch", "ghosts", "tool", "follow")
)
"""Subjects that may stay changed before the next click."""
NOTHING = frozenset(("unchanged",))
TRIES = 4
"""Number of positions at which an entry of a context menu is tried until it has an effect."""
ATTEMPTS = 4
"""Number of attempts at a click, since menus close or stay open now and then if the display is late: Qt takes a menu
whose window the display shows again for the one in front, and closes none when an entry of its submenu is clicked.
"""
CHOSEN = frozenset(("chosen already",))
"""Result of clicking the selected one of several exclusive choices, which changes nothing."""


def controls(window: QMainWindow) -> dict[str, QWidget]:
    """Visible buttons, choices and section titles by name, except for Qt's own parts."""
    widgets = Widgets(window)
    found: list[QWidget] = [
        widget
        for widget in (*widgets[QAbstractButton], *widgets[QComboBox], *widgets[SectionHeader])
        if widget.isVisible()
        and widget.window() is window
        and not widget.objectName().startswith("qt_")
        and widget.objectName() not in ("ScrollLeftButton", "ScrollRightButton")
    ]
    return names_of(found)


def has_menu_only(control: QWidget) -> bool:
    """Return whether a click on a button opens its menu and does nothing else."""
    return (
        isinstance(control, QToolButton)
        and control.menu() is not None
        and control.popupMode() == QToolButton.ToolButtonPopupMode.InstantPopup
    )


def click(control: QWidget) -> bool:
    """Click a control, in a choice another entry. Return False if there is no other entry."""
    if not isinstance(control, QComboBox):
        mouse.press(control)
        return True
    model, now = control.model(), control.currentIndex()
    others = [
        row
        for row in (*range(now + 1, control.count()), *range(now - 1, -1, -1))
        if model.flags(model.index(row, 0)) & Qt.ItemFlag.ItemIsEnabled
    ]
    if not others:
        return False
    mouse.bring_into_view(control)
    control.showPopup()
    QApplication.processEvents()
    view = control.view()
    # The list ignores the mouse for a moment after it came; its keys work at once.
    step = Qt.Key.Key_Down if others[0] > control.currentIndex() else Qt.Key.Key_Up
    for _ in range(control.count()):
        if view.currentIndex().row() == others[0]:
            break
        QTest.keyClick(view, step)
    QTest.keyClick(view, Qt.Key.Key_Return)
    return True


def is_chosen_already(control: QWidget | QAction) -> bool:
    """Return whether a control is the selected one of several exclusive choices."""
    if isinstance(control, QAbstractButton):
        group = control.group()
        exclusive = control.autoExclusive() or (group is not None and group.exclusive())
        return control.isCheckable() and control.isChecked() and exclusive
    return isinstance(control, QAction) and control.isCheckable() and control.isChecked()


def leaves(menu: QMenu, above: Path = ()) -> Iterator[Path]:
    """Entries of a menu and its submenus that perform an action."""
    for entry in menu.actions():
        if entry.isSeparator() or not entry.isVisible() or not entry.isEnabled():
            continue
        path, inner = (*above, name_of(entry)), entry.menu()
        if isinstance(inner, QMenu):
            yield from leaves(inner, path)
        else:
            yield path


def name_of(entry: QAction) -> str:
    """Object name of an entry or its submenu, else its text."""
    inner = entry.menu()
    return entry.objectName() or (inner.objectName() if isinstance(inner, QMenu) else "") or entry.text()


def entry_at(menu: QMenu, path: Path) -> tuple[QMenu, QAction]:
    """Navigate to an entry by clicking the submenus above it."""
    for name in path[:-1]:
        above = next(entry for entry in menu.actions() if name_of(entry) == name)
        inner = above.menu()
        assert isinstance(inner, QMenu)
        mouse.open_submenu(menu, above, inner)
        menu = inner
    return menu, next(entry for entry in menu.actions() if name_of(entry) == path[-1])


def popup() -> QMenu | None:
    """Currently open menu."""
    QApplication.processEvents()
    found = QApplication.activePopupWidget()
    return found if isinstance(found, QMenu) else None


def menu_under(widget: QWidget, place: QPoint) -> QMenu | None:
    """Right-click at a position; None if no context menu opens or the widget is hidden."""
    # The previous click may have scrolled it out of view.
    mouse.bring_into_view(widget)
    QApplication.processEvents()
    if not widget.visibleRegion().contains(place):
        return None
    mouse.move(widget, place)
    QTest.mouseClick(widget, Qt.MouseButton.RightButton, mouse.NONE, place)
    if QApplication.activePopupWidget() is None:
        event = QContextMenuEvent(QContextMenuEvent.Reason.Mouse, place, widget.mapToGlobal(place))
        QApplication.sendEvent(widget, event)
    return popup()


def close_menus() -> None:
    """Close all open menus and popups."""
    while (found := QApplication.activePopupWidget()) is not None:
        found.close()
        QApplication.processEvents()


def places(widget: QWidget, columns: int, rows: int) -> Iterator[QPoint]:
    """Positions spread over a widget."""
    for row in range(rows):
        for column in range(columns):
            yield QPoint(
                (2 * column + 1) * widget.width() // (2 * columns), (2 * row + 1) * widget.height() // (2 * rows)
            )


class Clicker:
    """Clicks everything, state by state.

    Parameters
    ----------
    program : Program
    watcher : Watcher
    again : callable
        Makes the present state once more, after a click that changed the given subjects; None: perhaps all of them.

    Attributes
    ----------
    seen : dict of str to dict of str to frozenset of str
        Of every control and entry what its click changed, by state and, for an entry, its menu.
    state : str
    """

    def __init__(self, program: Program, watcher: Watcher, again: Callable[[frozenset[str] | None], None]) -> None:
        self._program, self._watcher, self._again = program, watcher, again
        self._window = program.window
        self.seen: dict[str, dict[str, frozenset[str]]] = defaultdict(dict)
        self.state = ""
        self._turn = 0

    def _note(self, name: str, found: frozenset[str], where: str = "") -> None:
        self.seen[name][f"{self.state}, {where}" if where else self.state] = found
        close_menus()
        if found - CALM - NOTHING - CHOSEN:
            self._again(found)

    def buttons(self, every: bool = True) -> None:
        """Click every enabled button and choice; unless ``every`` is true, controls that share a row of the table are
        clicked once, a different one in each state.
        """
        found = controls(self._window)
        for name in list(found) if every else self._one_of_each(list(found)):
            control: QWidget | None = found[name]
            if not isValid(control) or not control.isVisible():
                # Perhaps it was made again.
                control = controls(self._window).get(name)
            if control is None or not control.isEnabled() or has_menu_only(control):
                continue
            if is_chosen_already(control):
                self.seen[name][self.state] = CHOSEN
                continue
            self._click_until(name, control)

    def _click_until(self, name: str, control: QWidget) -> None:
        """Click a control, again if the layout was not done yet or a notice had just given way to another."""
        owed = expected(name)
        for attempt in range(ATTEMPTS):
            is_last = attempt == ATTEMPTS - 1
            try:
                found = control if attempt == 0 else controls(self._window)[name]
                self._click(name, found, owed=None if is_last else owed)
                return
            except (AssertionError, KeyError) as error:
                if is_last:
                    self._note(name, frozenset((f"fault: {error!r}",)))
                else:
                    self._again(None)

    def _click(self, name: str, control: QWidget, owed: Row | None = None) -> None:
        """Click a control; fail if nothing changes that the table requires."""
        before = self._watcher.state()
        if click(control):
            QApplication.processEvents()
            found = changed(before, self._watcher.state()) or NOTHING
            assert found != NOTHING or owed is None or owed.may_be_idle or owed.changes <= NOTHING, "nothing changed"
            self._note(name, found)

    def _one_of_each(self, names: list[str]) -> list[str]:
        rows: dict[str, list[str]] = {}
        for name in names:
            row = expected(name)
            rows.setdefault(row.pattern if row is not None else name, []).append(name)
        self._turn += 1
        return [alike[self._turn % len(alike)] for alike in rows.values()]

    def entries(
        self, menu_name: str, open_menu: Open, skipped: Callable[[Path], bool] = lambda path: False, where: str = ""
    ) -> None:
        """Click every entry of a menu and its submenus; ``where`` distinguishes menus of the same name."""
        menu = open_menu()
        if menu is None:
            return
        paths = [path for path in leaves(menu) if not skipped(path)]
        close_menus()
        for path in paths:
            self._note(self._full_name(menu_name, path), self._choose_until(open_menu, path), where or menu_name)

    def _choose_until(self, open_menu: Open, path: Path) -> frozenset[str]:
        """Click an entry, again if its menu does not come, closes before its submenu comes, or stays open."""
        for _ in range(ATTEMPTS - 1):
            try:
                return self._try(open_menu, path)
            except (AssertionError, StopIteration):
                self._again(None)
        try:
            return self._try(open_menu, path)
        except (AssertionError, StopIteration) as error:
            return frozenset((f"fault: {error!r}",))

    def _try(self, open_menu: Open, path: Path) -> frozenset[str]:
        """Click an entry; if it is already selected, select another one first."""
        found = self._choose(open_menu, path)
        if found == CHOSEN and (other := self._beside(open_menu, path)) is not None:
            self._choose(open_menu, other)
            found = self._choose(open_menu, path)
        return found

    def _full_name(self, menu_name: str, path: Path) -> str:
        return path[-1] if path[-1] in actions(self._program.session) else f"{menu_name} > {' > '.join(path)}"

    def _has_acted(self, name: str) -> bool:
        """Return whether a previous click on an entry made the changes that the table requires."""
        row = expected(name)
        return row is not None and any(row.changes <= found for found in self.seen.get(name, {}).values())

    def _choose(self, open_menu: Open, path: Path) -> frozenset[str]:
        close_menus()
        menu = open_menu()
        assert menu is not None, "the menu did not come again"
        before = {**self._watcher.state(), "popup": None}
        inner, entry = entry_at(menu, path)
        was_chosen = is_chosen_already(entry)
        mouse.choose(inner, entry)
        QApplication.processEvents()
        assert not (isValid(menu) and menu.isVisible()), "the menu stays open"
        return changed(before, self._watcher.state()) or (CHOSEN if was_chosen else NOTHING)

    def _beside(self, open_menu: Open, path: Path) -> Path | None:
        """Another choice in the same group as a selected one; None if there is none."""
        close_menus()
        menu = open_menu()
        assert menu is not None, "the menu did not come again"
        inner, entry = entry_at(menu, path)
        subject = name_of(entry).partition(".")[0] if "." in name_of(entry) else ""
        others = [
            (*path[:-1], name_of(other))
            for other in inner.actions()
            if other.isCheckable() and not other.isChecked() and name_of(other).startswith(subject)
        ]
        close_menus()
        # Another language changes the position and names of menus.
        return others[0] if others and subject != "language" else None

    def bar(self, every: bool = True) -> None:
        """Click every entry of the menu bar; unless ``every`` is true, only entries whose effect was not seen yet."""

        def skipped(path: Path) -> bool:
            return path[-1] == "file.quit" or (self._has_acted(path[-1]) and not every)

        bar = self._window.menuBar()
        for menu in [menu for path, menu in self._window.menus.menus.items() if "/" not in path]:

            def open_menu(menu: QMenu = menu) -> QMenu | None:
                QTest.mouseClick(bar, mouse.LEFT, mouse.NONE, bar.actionGeometry(menu.menuAction()).center())
                return menu if menu.isVisible() else None

            self.entries("bar", open_menu, skipped)

    def menus_of_buttons(self) -> None:
        """Click every entry of the menus that buttons open."""
        for name, control in controls(self._window).items():
            # A click may replace its control, as with chips of marks.
            if not isValid(control) or not control.isEnabled():
                continue

            def open_menu(name: str = name) -> QMenu | None:
                button = controls(self._window).get(name)
                if isinstance(button, QToolButton) and button.menu() is not None:
                    # A click would open it in a loop of its own: `mouse.in_menu_of`, which the eye menu's test uses.
                    button.menu().popup(button.mapToGlobal(button.rect().bottomLeft()))
                    QApplication.processEvents()
                    return button.menu()
                if button is not None:
                    mouse.press(button)
                return popup()

            opens = self.seen.get(name, {}).get(self.state, frozenset())
            has_menu = isinstance(control, QToolButton) and control.menu() is not None
            if name != "palette_button" and (has_menu or "popup" in opens):
                self.entries(name, open_menu)

    def context_menus(self, spots: dict[str, QWidget], columns: int = 8, rows: int = 3) -> None:
        """Click every entry of context menus, each at up to `TRIES` positions of a widget until it has an effect."""
        session = self._program.session
        base = session.selection, session.players
        for spot, widget in spots.items():
            if not widget.isVisible():
                continue
            mouse.bring_into_view(widget)
            QApplication.processEvents()
            tried: Counter[Path] = Counter()
            for number, place in enumerate(places(widget, columns, rows)):
                # A right-click selects: the next menu is that of the state, as it is when its entries are clicked.
                if (session.selection, session.players) != base:
                    self._again(frozenset(("selection",)))
                menu = menu_under(widget, place)
                if menu is None:
                    close_menus()
                    continue
                new = {path for path in leaves(menu) if self._is_tried_again(spot, path, tried[path])}
                close_menus()
                tried.update(new)
                if new:
                    self.entries(
                        spot, partial(menu_under, widget, place), partial(_is_known, new), f"{spot} at {number}"
                    )

    def _is_tried_again(self, spot: str, path: Path, tries: int) -> bool:
        name = self._full_name(spot, path)
        if self._has_acted(name):
            return tries == 0 and name in actions(self._program.session)
        return tries < TRIES


def _is_known(new: set[Path], path: Path) -> bool:
    return path not in new
