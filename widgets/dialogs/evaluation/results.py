"""Dialog with the results of an evaluation: conclusions, plot and tables from viewers' files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final, TypeAlias

from PySide6.QtCore import QByteArray, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QDragEnterEvent, QDropEvent, QGuiApplication, QImage, QPainter, QPaintEvent
from PySide6.QtSvg import QSvgRenderer
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QHeaderView,
    QListWidget,
    QPlainTextEdit,
    QScrollArea,
    QTableWidget,
    QTableWidgetItem,
    QTabWidget,
    QWidget,
)

from app.encoding import shown
from app.errors import AppError, Message
from app.evaluation.conclusions import conclude
from app.evaluation.plot import plot
from app.evaluation.report import write_results
from app.evaluation.tables import ResultTable, tables
from app.evaluation.viewer_files import Gathered
from app.messages import text
from widgets.common.controls import Button, Caption, Retranslated, named, selectable, wrapped
from widgets.common.help import with_help
from widgets.common.instrument_name import language
from widgets.common.layouts import begin_with_size, in_column, in_row
from widgets.common.paths import ask_for_file, ask_for_files, ask_for_folder, dropped_paths, show_folder
from widgets.common.plain import Label
from widgets.common.text import message_text

Gather: TypeAlias = Callable[[Sequence[Path], Path | None], Gathered]
"""Type of `app.evaluation.viewer_files.gather`."""

_AT_CONTROLS: Final = {
    "results.no_key": "results.no_key_here",
    "results.other_evaluation": "results.other_evaluation_here",
    "results.unknown_clip": "results.unknown_clip_here",
    "results.unasked": "results.unasked_here",
}
"""Ids of errors, and of texts that mention the dialog's controls instead of command options."""
_SIZE: Final = QSize(1120, 700)
_SHARPER: Final = 2
"""Scale factor of a copied picture."""


class EvaluationResultsDialog(Retranslated, QDialog):
    """Reads viewers' files, chosen or dropped, and shows their results.

    Parameters
    ----------
    gather : Gather
        Reads and evaluates viewers' files.
    folder : Path
        Initial folder for files.
    """

    def __init__(self, gather: Gather, folder: Path, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("evaluation_results")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setAcceptDrops(True)
        self._gather, self._folder = gather, folder
        self._files: list[Path] = []
        self._key_file: Path | None = None
        self._found: Gathered | None = None
        self._list = named(QListWidget(), "results_files")
        self._list.setSelectionMode(QListWidget.SelectionMode.ExtendedSelection)
        self._list.itemSelectionChanged.connect(self._show_buttons)
        self._key = selectable(wrapped(named(Label(), "results_key")))
        self._state = selectable(wrapped(named(Label(), "results_state")))
        self._words = named(QPlainTextEdit(), "results_words")
        self._words.setReadOnly(True)
        self._picture = _Picture()
        self._room = named(QScrollArea(), "results_room")
        self._room.setWidgetResizable(True)
        self._room.setWidget(self._picture)
        self._tabs = named(QTabWidget(), "results_tabs")
        self._add = Button("results_dialog.add", self._ask, "results_add")
        self._remove = Button("results_dialog.remove", self._remove_chosen, "results_remove")
        self._choose_key = Button("results_dialog.choose_key", self._ask_key, "results_choose_key")
        self._copy = Button("results_dialog.copy", self.copy, "results_copy")
        self._save = Button("results_dialog.save", self._ask_folder, "results_save")
        self._lay_out()
        self.texted(self, title="results_dialog.title")
        self.retranslate()
        begin_with_size(self, _SIZE)

    def _lay_out(self) -> None:
        box = QDialogButtonBox()
        for button in (self._copy, self._save):
            box.addButton(button, QDialogButtonBox.ButtonRole.ActionRole)
        box.addButton(Button("results_dialog.close", self.reject, "results_close"), box.ButtonRole.RejectRole)
        files = QWidget()
        in_column(
            Caption("results_dialog.files", self._list),
            (self._list, 1),
            in_row(self._add, self._remove),
            Caption("results_dialog.key"),
            self._key,
            self._choose_key,
            of=files,
            margins=0,
        )
        files.setFixedWidth(230)
        in_column((in_row(files, (self._tabs, 1)), 1), self._state, with_help(box), of=self)

    # Display

    def add_files(self, paths: Sequence[Path]) -> None:
        """Add files with viewers' answers, each once, and evaluate all files again."""
        self._files += [path for path in dict.fromkeys(paths) if path not in self._files]
        self._evaluate()

    def set_key(self, path: Path) -> None:
        """Use a key file other than the one next to the viewers' files."""
        self._key_file = path
        self._evaluate()

    def copy(self) -> None:
        """Copy the current tab to the clipboard: text, a table for spreadsheets, or the plot."""
        shown_now, clipboard = self._tabs.currentWidget(), QGuiApplication.clipboard()
        if shown_now is self._words:
            clipboard.setText(self._words.toPlainText())
        elif isinstance(shown_now, _TableView):
            clipboard.setText(shown_now.as_text())
        else:
            clipboard.setImage(self._picture.image(_SHARPER))

    def save(self, folder: Path) -> None:
        """Write the report into a folder, in both languages."""
        assert self._found is not None, "the button is disabled without results"
        try:
            written = write_results(self._found.results, self._found.measures, folder)
        except AppError as error:
            self._state.setText(message_text(error.message))
            return
        names = ", ".join(path.name for path in written)
        self._state.setText(self.tr("results_dialog.saved").format(folder=shown(str(folder)), names=names))
        show_folder(folder)

    def _evaluate(self) -> None:
        """Read and evaluate all files again."""
        self._found, said = None, ""
        if self._files:
            try:
                self._found = self._gather(tuple(self._files), self._key_file)
            except AppError as error:
                message = error.message
                said = message_text(Message(_AT_CONTROLS.get(message.id, message.id), message.arguments))
        self._state.setText(said)
        self._show_files()
        self._show_results()

    def _show_files(self) -> None:
        self._list.clear()
        for path in self._files:
            self._list.addItem(shown(path.name))
            self._list.item(self._list.count() - 1).setToolTip(shown(str(path)))
        key_file = self._key_file if self._found is None else self._found.key_file
        self._key.setText(self.tr("results_dialog.beside") if key_file is None else shown(str(key_file)))
        self._show_buttons()

    def _show_buttons(self) -> None:
        self._remove.setEnabled(bool(self._list.selectedItems()))
        for button in (self._copy, self._save):
            button.setEnabled(self._found is not None)

    def _show_results(self) -> None:
        """Fill the tabs with the results in the language of the editor."""
        front = self._tabs.currentIndex()
        while self._tabs.count():
            page = self._tabs.widget(0)
            self._tabs.removeTab(0)
            if isinstance(page, _TableView):
                page.deleteLater()
        self._tabs.addTab(self._words, self.tr("results_dialog.conclusions"))
        self._words.setPlainText(self.tr("results_dialog.nothing_yet") if self._found is None else self._said())
        if self._found is None:
            return
        self._picture.show_svg(plot(self._found.results, language()))
        self._tabs.addTab(self._room, self.tr("results_dialog.picture"))
        for table in tables(self._found.results, self._found.measures, language()):
            self._tabs.addTab(_TableView(table), table.title)
        self._tabs.setCurrentIndex(max(min(front, self._tabs.count() - 1), 0))

    def _said(self) -> str:
        """Return the conclusions of the evaluation as text: what may be claimed and what not."""
        assert self._found is not None
        results = self._found.results
        conclusions = conclude(results)
        spoken = language()
        lines = [text(Message("results.title", {"piece": results.piece}), spoken)]
        for heading, said in (("results.may", conclusions.may), ("results.may_not", conclusions.may_not)):
            lines += ["", f"{text(Message(heading), spoken)}:", *(f"• {text(message, spoken)}" for message in said)]
        return "\n".join(lines)

    # Requests

    def _ask(self) -> None:
        start = self._files[-1] if self._files else self._folder
        kinds = f"{self.tr('results_dialog.answers')} (*.csv)"
        chosen = ask_for_files(self, self.tr("results_dialog.add"), start, kinds)
        if chosen:
            self.add_files(chosen)

    def _ask_key(self) -> None:
        start = self._files[-1].parent if self._files else self._folder
        kinds = f"{self.tr('results_dialog.key')} (*.json)"
        chosen = ask_for_file(self, self.tr("results_dialog.choose_key"), start, kinds)
        if chosen is not None:
            self.set_key(chosen)

    def _ask_folder(self) -> None:
        chosen = ask_for_folder(self, self.tr("results_dialog.save"), self._files[0].parent)
        if chosen is not None:
            self.save(chosen)

    def _remove_chosen(self) -> None:
        rows = {self._list.row(item) for item in self._list.selectedItems()}
        self._files = [path for row, path in enumerate(self._files) if row not in rows]
        self._evaluate()

    def retranslate(self) -> None:
        self._show_files()
        self._show_results()

    # Qt overrides

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if dropped_paths(event):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        event.acceptProposedAction()
        self.add_files(dropped_paths(event))


class _TableView(QWidget):
    """A table of results with explanations of its columns."""

    def __init__(self, table: ResultTable) -> None:
        super().__init__()
        self._table = table
        grid = QTableWidget(len(table.rows), len(table.head))
        grid.setHorizontalHeaderLabels(list(table.head))
        grid.setEditTriggers(QTableWidget.EditTrigger.NoEditTriggers)
        grid.verticalHeader().hide()
        for row, cells in enumerate(table.rows):
            for column, cell in enumerate(cells):
                item = QTableWidgetItem(cell)
                if column >= table.names:
                    item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
                grid.setItem(row, column, item)
        grid.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        in_column((grid, 1), selectable(wrapped(Label(table.note))), of=self)

    def as_text(self) -> str:
        """Return the rows with tabs between cells, for spreadsheets."""
        return "\n".join("\t".join(row) for row in (self._table.head, *self._table.rows))


class _Picture(QWidget):
    """A picture that is scaled in proportion."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("results_picture")
        self._renderer = QSvgRenderer(self)

    def show_svg(self, source: str) -> None:
        """Replace the displayed diagram by an SVG text."""
        self._renderer.load(QByteArray(source.encode()))
        self.setMinimumSize(self._renderer.defaultSize())
        self.update()

    def image(self, factor: int) -> QImage:
        """Return the picture as an image, enlarged by a factor."""
        image = QImage(self._renderer.defaultSize() * factor, QImage.Format.Format_RGB32)
        image.fill(QColor("white"))
        painter = QPainter(image)
        self._renderer.render(painter)
        painter.end()
        return image

    def paintEvent(self, event: QPaintEvent) -> None:
        size = self._renderer.defaultSize().scaled(self.size(), Qt.AspectRatioMode.KeepAspectRatio)
        left, top = (self.width() - size.width()) / 2, (self.height() - size.height()) / 2
        painter = QPainter(self)
        self._renderer.render(painter, QRectF(left, top, size.width(), size.height()))
        painter.end()
