"""The help window: guides with contents, search and history."""

from __future__ import annotations

from typing import Final

from PySide6.QtCore import QSize, Qt, QUrl
from PySide6.QtGui import QDesktopServices, QGuiApplication, QKeySequence, QShortcut, QWindow
from PySide6.QtWidgets import (
    QDialog,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QSplitter,
    QStackedWidget,
    QTreeWidget,
    QTreeWidgetItem,
    QWidget,
)

from app.editor.session import Session
from app.shell.help.guides import FOLDER, Guide, guide, names, search
from app.shell.help.page import GuidePage
from app.shell.help.visits import Place, Visits
from app.shell.language import Language
from widgets.common.controls import IconButton, Retranslated, named, selectable, wrapped
from widgets.common.layouts import in_column, in_row, panel
from widgets.common.plain import Label

SIZE: Final = QSize(940, 640)
LIST_PX: Final = 280
DEEPEST: Final = 3
"""Level of the deepest headings in the contents."""
WEB: Final = ("http", "https")
"""Schemes of links that the web browser opens."""
_PLACE: Final = int(Qt.ItemDataRole.UserRole)


class HelpWindow(Retranslated, QDialog):
    """The window in which guides are read; it stays usable while a modal dialog is open.

    Parameters
    ----------
    session : Session
    language : Language
        Language in which guides are shown.
    parent : QWidget
        The editor's window.
    """

    def __init__(self, session: Session, language: Language, parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Window)
        self.setObjectName("help")
        self._session, self._language, self._editor = session, language, parent
        self._visits = Visits()
        self._items: dict[Place, QTreeWidgetItem] = {}
        self.page = GuidePage(session)
        self.page.followed.connect(self._follow)
        self.search_field = self.texted(
            named(QLineEdit(), "help_search"), placeholder="help_window.search", name="help_window.search"
        )
        self.search_field.setClearButtonEnabled(True)
        self.search_field.textChanged.connect(self._search)
        self.contents = self.texted(named(QTreeWidget(), "help_contents"), name="help_window.contents")
        self.contents.setHeaderHidden(True)
        self.contents.itemClicked.connect(lambda item: self._visit(item.data(0, _PLACE)))
        self.contents.itemActivated.connect(lambda item: self._visit(item.data(0, _PLACE)))
        self.hits = self.texted(named(QListWidget(), "help_hits"), name="help_window.search")
        self.hits.setWordWrap(True)
        self.hits.setSpacing(3)
        self.hits.itemClicked.connect(self._go_to_hit)
        self.hits.itemActivated.connect(self._go_to_hit)
        self.search_field.returnPressed.connect(self._go_to_first_hit)
        self._lists = QStackedWidget()
        for part in (self.contents, self.hits):
            self._lists.addWidget(part)
        self._notice = selectable(wrapped(named(Label(), "help_notice")))
        self._notice.setContentsMargins(14, 6, 14, 6)
        self.back = IconButton(session, "chevron_left", "help_window.back", self.go_back, "help_back")
        self.forward = IconButton(session, "chevron_right", "help_window.forward", self.go_forward, "help_forward")
        zoom = self.page.zoom
        smaller = IconButton(session, "zoom_out", "help_window.smaller", lambda: zoom(-1), "help_smaller")
        larger = IconButton(session, "zoom_in", "help_window.larger", lambda: zoom(1), "help_larger")
        tools = in_row(self.back, self.forward, (self.search_field, 1), smaller, larger, margins=(8, 8, 8, 6))
        split = QSplitter()
        split.addWidget(self._lists)
        split.addWidget(panel(in_column(self._notice, (self.page, 1), margins=0, spacing=0)))
        split.setStretchFactor(1, 1)
        split.setSizes([LIST_PX, SIZE.width() - LIST_PX])
        in_column(tools, (split, 1), of=self, margins=0, spacing=0)
        for keys, run in (
            ("Alt+Left", self.go_back),
            ("Alt+Right", self.go_forward),
            ("Ctrl+F", self.search_field.setFocus),
            ("Ctrl++", lambda: zoom(1)),
            ("Ctrl+=", lambda: zoom(1)),
            ("Ctrl+-", lambda: zoom(-1)),
            ("Ctrl+0", lambda: zoom(0)),
            ("Escape", self._leave),
        ):
            QShortcut(QKeySequence(keys), self, run)
        self.resize(SIZE.boundedTo(parent.screen().availableSize() - QSize(40, 80)))
        # Over the players and the inspector, so that the timeline stays visible.
        corner = parent.frameGeometry().topRight()
        self.move(max(corner.x() - self.width() - 24, parent.screen().availableGeometry().left()), corner.y() + 60)
        session.theme_changed.connect(self._apply_theme)
        application = QGuiApplication.instance()
        if isinstance(application, QGuiApplication):
            application.focusWindowChanged.connect(self._stay_usable)
        self.retranslate()
        self._apply_theme()

    # Sections

    def read(self, name: str, section: str | int = "") -> None:
        """Open a guide at a section, and raise the window.

        Parameters
        ----------
        name : str
            See `Guide.name`.
        section : str or int
            Anchor of a section in the English guide, or its index; an unknown anchor opens the beginning of the guide.
        """
        number = section if isinstance(section, int) else guide(name, "en").number(section) or 0
        self.show()
        self._stay_usable(QGuiApplication.modalWindow())
        self.raise_()
        self.activateWindow()
        self.search_field.clear()
        self._visit((name, number))
        self.page.setFocus(Qt.FocusReason.OtherFocusReason)

    @property
    def place(self) -> Place | None:
        """Return the guide on display and the index of the section that was opened; None before the first one."""
        return self._visits.here

    def go_back(self) -> None:
        """Show the previous section in the history."""
        self._visits = self._visits.back()
        self._show_place()

    def go_forward(self) -> None:
        """Show the next section in the history."""
        self._visits = self._visits.forward()
        self._show_place()

    def _visit(self, place: Place) -> None:
        self._visits = self._visits.visit(place)
        self._show_place()

    def _show_place(self) -> None:
        place = self._visits.here
        self.back.setEnabled(self._visits.can_go_back)
        self.forward.setEnabled(self._visits.can_go_forward)
        if place is None:
            return
        found = self._guide(place[0])
        if self.page.guide is not found:
            self.page.show_guide(found)
        self.page.mark(self.search_field.text())
        self.page.go_to(min(place[1], len(found.sections) - 1))
        self._report("" if found.is_translated else self.tr("help_window.not_translated"))
        self.setWindowTitle(self.tr("help_window.title").format(guide=found.title))
        self._choose_in_contents(place)

    def _guide(self, name: str) -> Guide:
        return guide(name, self._language.code)

    def _follow(self, link: QUrl) -> None:
        """Open a link of the guide: another guide, or a web page in the browser."""
        here = self._visits.here
        if here is None:
            return
        name = here[0]
        if link.scheme() in WEB:
            QDesktopServices.openUrl(link)
            return
        if link.scheme():
            self._report(self.tr("help_window.not_opened").format(link=link.toString()))
            return
        if link.path():
            path = (FOLDER / link.path()).resolve()
            name = path.stem.removesuffix(f"_{self._language.code}")
            if path.parent != FOLDER.resolve() or name not in names():
                self._report(self.tr("help_window.leads_outside").format(path=path))
                return
        anchor = link.fragment()
        number = self._guide(name).number(anchor)
        self._visit((name, guide(name, "en").number(anchor) or 0 if number is None else number))

    def _report(self, text: str) -> None:
        self._notice.setText(text)
        self._notice.setVisible(bool(text))

    # Contents and search

    def _fill_contents(self) -> None:
        self.contents.clear()
        self._items = {}
        for name in names():
            above: list[QTreeWidgetItem] = []
            for number, section in enumerate(self._guide(name).sections):
                if section.level > DEEPEST:
                    continue
                above = above[: section.level - 1]
                item = QTreeWidgetItem([section.heading])
                item.setToolTip(0, section.heading)
                item.setData(0, _PLACE, (name, number))
                if above:
                    above[-1].addChild(item)
                else:
                    self.contents.addTopLevelItem(item)
                above.append(item)
                self._items[name, number] = item

    def _choose_in_contents(self, place: Place) -> None:
        name, number = place
        begun = [item for (guide_name, at), item in self._items.items() if guide_name == name and at <= number]
        if begun:
            self.contents.collapseAll()
            begun[0].setExpanded(True)
            self.contents.setCurrentItem(begun[-1])

    def _search(self, words: str) -> None:
        hits = search(words, self._language.code)
        self.hits.clear()
        for hit in hits:
            title = self._guide(hit.guide).title
            where = title if hit.number == 0 else f"{title} › {hit.heading}"
            item = QListWidgetItem(f"{where}\n{hit.excerpt}", self.hits)
            item.setData(_PLACE, (hit.guide, hit.number))
        if not hits:
            QListWidgetItem(self.tr("help_window.no_hits"), self.hits).setFlags(Qt.ItemFlag.NoItemFlags)
        self._lists.setCurrentWidget(self.hits if words.strip() else self.contents)
        self.page.mark(words)

    def _go_to_hit(self, item: QListWidgetItem) -> None:
        place = item.data(_PLACE)
        if place is not None:
            self._visit(tuple(place))

    def _go_to_first_hit(self) -> None:
        if self.search_field.text().strip() and self.hits.count():
            self.hits.setCurrentRow(0)
            self._go_to_hit(self.hits.item(0))

    def _leave(self) -> None:
        """Clear the search when Escape is pressed; close the window if nothing is searched."""
        if self.search_field.text():
            self.search_field.clear()
        else:
            self.close()

    # Appearance

    def retranslate(self) -> None:
        self._fill_contents()
        self._search(self.search_field.text())
        self._show_place()

    def _apply_theme(self) -> None:
        tokens = self._session.tokens
        self._notice.setStyleSheet(f"background: {tokens.raised}; color: {tokens.text_dim};")
        self.page.apply_theme()

    # Modality

    def _stay_usable(self, window: QWindow | None) -> None:
        """Make the topmost modal dialog the help window's parent, since a modal dialog blocks all windows but its
        children.
        """
        own, editor = self.windowHandle(), self._editor.windowHandle()
        if own is None or not self.isVisible():
            return
        if window is not None and window is not own and window.modality() != Qt.WindowModality.NonModal:
            own.setTransientParent(window)
        elif window is editor or own.transientParent() is None:
            # Without a parent window the program would not end with the editor's window.
            own.setTransientParent(editor)
