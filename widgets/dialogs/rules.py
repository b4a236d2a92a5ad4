"""Dialog of the rules by which players act: switching, changing, adding and removing them, with immediate preview, and
saving in the user's own folder.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import msgspec
from PySide6.QtCore import QSize, Qt, QTimer
from PySide6.QtGui import QKeyEvent, QKeySequence
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QScrollArea,
    QSplitter,
    QWidget,
)

from app.editor.session import Session, Severity
from app.editor.translated import tr
from app.errors import AppError, Message
from metadata.library import RULES, metadata_library
from metadata.rule_draft import Draft, added, changed, duplicated, listed, removed, sets_of, write
from metadata.rules import Rule, RuleFault, rule_faults
from widgets.common.clicks import on_click
from widgets.common.controls import Button, Check, Retranslated, named, selectable, wrapped
from widgets.common.help import HelpButton
from widgets.common.instrument_name import language
from widgets.common.layouts import begin_with_size, in_column, in_row, panel
from widgets.common.plain import Label
from widgets.dialogs.rule_fields import GROWTHS
from widgets.dialogs.rule_form import RuleForm

_SIZE = QSize(900, 720)
PREVIEW_MS = 250
"""Delay in milliseconds after a change before it is previewed, so that a typed number is previewed once."""
PROBLEM_PX = 40
"""Height in pixels of two lines of messages, so that the layout does not change."""
FAULTS = {
    kind: f"rules_dialog.fault_{kind}"
    for kind in ("name", "do", "fades", "stays", "moment", "growth_at_moment", "when")
}
"""Text ids by kind of fault; for a growth without a starting point see `NEEDED`."""
NEEDED = {
    "loudness": "rules_dialog.loudness_above",
    "height": "rules_dialog.semitones_above_easy",
    "depth": "rules_dialog.semitones_below_easy",
    "length": "rules_dialog.longer_s",
    "effort": "rules_dialog.effort_above",
}


class RulesDialog(Retranslated, QDialog):
    """List of all rules, and a form with the selected one."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("rules")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._session, self._shelf = session, RULES.now()
        self._draft: Draft = listed(self._shelf.items, self._shelf.files)
        self._saved = self._draft
        self._list = self.texted(named(_Rules(), "rules_list"), name="rules_dialog.rules", tip="rules_dialog.list_tip")
        self._form = RuleForm(session, metadata_library())
        self._problem = selectable(named(wrapped(Label()), "rules_problem"))
        self._problem.setMinimumHeight(PROBLEM_PX)
        self._problem.setAlignment(Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignLeft)
        self._problem.setStyleSheet(f"color: {session.tokens.error};")
        self._folder = selectable(named(wrapped(Label()), "rules_folder"))
        self._add = Button("rules_dialog.add", self._add_rule, "rules_add", "rules_dialog.add_tip")
        self._copy = Button("rules_dialog.duplicate", self._duplicate, "rules_duplicate", "rules_dialog.duplicate_tip")
        self._remove = named(QPushButton(), "rules_remove")
        self._remove.setAutoDefault(False)
        on_click(self._remove, self._remove_rule)
        self._preview = self.texted(
            named(Check("rules_dialog.preview"), "rules_preview"), tip="rules_dialog.preview_tip"
        )
        self._save = Button("rules_dialog.save", self._write, "rules_save", "rules_dialog.save_tip")
        self._cancel = Button("rules_dialog.cancel", self.reject, "rules_cancel")
        self._timer = QTimer(self, interval=PREVIEW_MS, singleShot=True)
        self._timer.timeout.connect(self._play)
        self._lay_out()
        self._list.currentRowChanged.connect(lambda _row: self._show_current())
        self._list.itemChanged.connect(self._switched)
        self._form.changed.connect(self._take)
        on_click(self._preview, self._play)
        self._list.keys = {
            QKeySequence("Del"): self._remove_rule,
            QKeySequence("Ins"): self._add_rule,
            QKeySequence("Ctrl+D"): self._duplicate,
        }
        self._fill(0)
        self.texted(self, title="rules_dialog.rules")
        self.retranslate()
        begin_with_size(self, _SIZE)
        self._list.setFocus()

    def _lay_out(self) -> None:
        scroll = QScrollArea()
        scroll.setWidgetResizable(True)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        scroll.setWidget(self._form)
        rules = panel(in_column((self._list, 1), in_row(self._add, self._copy, self._remove), margins=0))
        split = QSplitter()
        split.addWidget(rules)
        split.addWidget(scroll)
        split.setChildrenCollapsible(False)
        split.setSizes([320, 520])
        split.setStretchFactor(1, 1)
        buttons = QDialogButtonBox()
        buttons.addButton(self._save, QDialogButtonBox.ButtonRole.AcceptRole)
        buttons.addButton(self._cancel, QDialogButtonBox.ButtonRole.RejectRole)
        in_column((split, 1), self._problem, self._folder, in_row(HelpButton(), self._preview, None, buttons), of=self)

    # List

    @property
    def draft(self) -> Draft:
        """The edited rules, as they will be saved."""
        return self._draft

    @property
    def current(self) -> int:
        """Index of the selected rule; -1 for none."""
        return self._list.currentRow()

    def _fill(self, row: int) -> None:
        self._list.blockSignals(True)
        self._list.clear()
        for _ in self._draft:
            self._list.addItem(QListWidgetItem())
        for index in range(len(self._draft)):
            self._word(index)
        self._list.setCurrentRow(min(row, len(self._draft) - 1))
        self._list.blockSignals(False)
        self._show_current()

    def _word(self, index: int) -> None:
        """Set text, check box and tool tip of a rule in the list."""
        one, item = self._draft[index], self._list.item(index)
        blocked = self._list.blockSignals(True)
        item.setText(f"{rule_title(one.rule)} *" if one.file else rule_title(one.rule))
        item.setFlags(item.flags() | Qt.ItemFlag.ItemIsUserCheckable)
        item.setCheckState(Qt.CheckState.Checked if one.rule.enabled else Qt.CheckState.Unchecked)
        whose = self.tr("rules_dialog.ours")
        if one.file:
            whose = self.tr("rules_dialog.bundled_and_changed" if one.ours is not None else "rules_dialog.yours")
        item.setToolTip(f"{one.rule.name}\n{whose}")
        self._list.blockSignals(blocked)

    def _show_current(self) -> None:
        row = self.current
        one = self._draft[row] if row >= 0 else None
        self._form.show_rule(None if one is None else one.rule)
        self._copy.setEnabled(one is not None)
        self._remove.setEnabled(one is not None and (bool(one.file) or one.rule.enabled))
        back = one is not None and one.file and one.ours is not None
        ours = one is not None and not one.file
        does = "rules_dialog.revert" if back else "rules_dialog.switch_off" if ours else "rules_dialog.remove"
        self._remove.setText(self.tr(does))
        self._remove.setToolTip(self.tr("rules_dialog.remove_tip"))
        self._judge()

    def _switched(self, item: QListWidgetItem) -> None:
        row = self._list.row(item)
        enabled = item.checkState() == Qt.CheckState.Checked
        if enabled != self._draft[row].rule.enabled:
            self._set(changed(self._draft, row, msgspec.structs.replace(self._draft[row].rule, enabled=enabled)))
            self._word(row)
            self._show_current()

    def _take(self, rule: Rule) -> None:
        row = self.current
        self._set(changed(self._draft, row, rule))
        self._word(row)
        self._judge()

    def _add_rule(self) -> None:
        self._set(added(self._draft, "focused" if "focused" in metadata_library().expressions_by_name else "neutral"))
        self._fill(len(self._draft) - 1)

    def _duplicate(self) -> None:
        row = self.current
        if row >= 0:
            self._set(duplicated(self._draft, row))
            self._fill(row + 1)

    def _remove_rule(self) -> None:
        row = self.current
        if row >= 0 and self._remove.isEnabled():
            self._set(removed(self._draft, row))
            self._fill(row)

    # Changes

    def _set(self, draft: Draft) -> None:
        self._draft = draft
        if self._preview.isChecked():
            self._timer.start()

    def faults(self) -> list[tuple[int, RuleFault]]:
        """Return every error in the edited rules with the index of its rule."""
        return [(index, fault) for index, one in enumerate(self._draft) for fault in rule_faults(one.rule)]

    def _judge(self) -> None:
        found = self.faults()
        self._problem.setText("\n".join(self._said(index, fault) for index, fault in found[:2]))
        self._save.setEnabled(not found and self._draft != self._saved)
        self._folder.setText(self.tr("rules_dialog.saved_in").format(folder=str(RULES.folder())))

    def _said(self, index: int, fault: RuleFault) -> str:
        if fault.code == "growth":
            text = self.tr("rules_dialog.fault_growth")
            text = text.format(growth=self.tr(GROWTHS[fault.growth]), needed=self.tr(NEEDED[fault.growth]))
        else:
            text = self.tr(FAULTS[fault.code])
        return f"{rule_title(self._draft[index].rule)}: {text}"

    def _play(self) -> None:
        """Make all players act by the edited rules if the preview is on, else by the saved ones."""
        RULES.put_back(self._shelf)
        if self._preview.isChecked() and not self.faults() and self._draft != self._saved:
            made = sets_of(self._draft, self._shelf.items, self._shelf.files)
            own = [name for name, rules in made.items() if rules.rules or name in self._shelf.files]
            RULES.preview({**self._shelf.items, **{name: made[name] for name in own}}, own)
        self._session.metadata_saved.emit()

    def _write(self) -> None:
        self._timer.stop()
        RULES.put_back(self._shelf)
        try:
            made = sets_of(self._draft, self._shelf.items, self._shelf.files)
            written = write(made, self._shelf.items, RULES.folder())
        except AppError as error:
            self._session.notice(error.message, Severity.ERROR)
            return
        RULES.reload()
        self._session.metadata_saved.emit()
        if written:
            path = written[0]
            self._session.notice(Message("metadata.written", {"file": path.name, "path": str(path)}))
        self._shelf = RULES.now()
        self._saved = self._draft
        self.accept()

    def done(self, result: int) -> None:
        """Restore the saved rules when the dialog closes."""
        self._timer.stop()
        if self._preview.isChecked() and self._draft != self._saved:
            RULES.put_back(self._shelf)
            self._session.metadata_saved.emit()
        super().done(result)

    def retranslate(self) -> None:
        for index in range(self._list.count()):
            self._word(index)
        self._show_current()

    # Qt overrides

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Accept a typed value on Return; save on Ctrl+Return."""
        if event.key() not in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            super().keyPressEvent(event)
        elif event.modifiers() & Qt.KeyboardModifier.ControlModifier and self._save.isEnabled():
            self._write()

    def sizeHint(self) -> QSize:
        return _SIZE


class _Rules(QListWidget):
    """The list of rules, which handles its own shortcuts."""

    keys: Mapping[QKeySequence, Callable[[], None]] = {}

    def keyPressEvent(self, event: QKeyEvent) -> None:
        run = self.keys.get(QKeySequence(event.keyCombination()))
        if run is None:
            super().keyPressEvent(event)
        else:
            run()


def rule_title(rule: Rule) -> str:
    """Return the title of a rule for lists: its own, else one with its number."""
    number = rule.name.removeprefix("rule_")
    usual = tr("rules_dialog.rule_number").format(number=number) if number.isdecimal() else ""
    return rule.title.in_language(language()) or usual or rule.name.replace("_", " ").capitalize()
