"""Form of one rule: its conditions and effects."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import msgspec
from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFormLayout, QGridLayout, QGroupBox, QLineEdit, QWidget

from app.editor.session import Session
from metadata.library import MetadataLibrary
from metadata.rules import Rule
from metadata.tables import Title
from widgets.common.clicks import on_click
from widgets.common.combo import Combo, Option
from widgets.common.controls import Check, Retranslated, named
from widgets.common.event_names import expression_name, gesture_name, habit_name, style_name
from widgets.common.instrument_name import language
from widgets.common.layouts import in_column, in_form, in_row, panel
from widgets.dialogs.rule_fields import (
    ANCHORS,
    CONDITIONS,
    GROWTHS,
    MOMENTS,
    PLACES,
    SECONDS,
    Field,
    Number,
    OptionalNumberField,
    Several,
    kept,
)

_END = Field("end_s", "rules_dialog.ends", -60.0, 60.0, 0.1, SECONDS, 0.0)
_FADE_IN = Field("fade_in_s", "rules_dialog.fade_in", 0.01, 60.0, 0.05, SECONDS, 0.2)
_FADE_OUT = Field("fade_out_s", "rules_dialog.fade_out", 0.01, 60.0, 0.05, SECONDS, 0.3)


class RuleForm(Retranslated, QWidget):
    """Form that shows and changes a rule.

    Signals
    -------
    changed(Rule)
        The user changed the rule to this one.
    """

    changed = Signal(object)

    def __init__(self, session: Session, library: MetadataLibrary, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session, self._library = session, library
        self._rule: Rule | None = None
        self._title = named(QLineEdit(), "rule_title")
        self._title.setMaxLength(120)
        self._title.editingFinished.connect(self._edited)
        self._asked = [OptionalNumberField(field, self._edited) for field in CONDITIONS]
        self._moment, self._does, self._start, self._end_of = (
            named(Combo(), f"rule_{name}") for name in ("moment", "does", "start", "end")
        )
        self._places, self._styles, self._not_styles, self._habits, self._growth = (
            named(Several(f"rule_{name}"), f"rule_{name}")
            for name in ("place", "styles", "not_styles", "habits", "grows_with")
        )
        self._chance = self._number("chance", 0.0, 100.0, 5.0, "rules_dialog.unit_percent")
        self._strength = self._number("strength", 0.0, 1.0, 0.05)
        self._grows_from = self._number("grows_from", 0.0, 1.0, 0.05)
        self._start_s = self._number("start_s", -60.0, 60.0, 0.1, SECONDS)
        self._spread = self._number("spread_s", 0.0, 60.0, 0.1, SECONDS)
        self._stays = self._number("stays_s", 0.0, 60.0, 0.1, SECONDS)
        self._apart = self._number("apart_s", 0.0, 600.0, 0.5, SECONDS)
        self.texted(self._spread, tip="rules_dialog.spread_tip")
        self.texted(self._stays, tip="rules_dialog.stays_tip")
        self.texted(self._apart, tip="rules_dialog.apart_tip")
        self.texted(self._growth, tip="rules_dialog.grows_with_tip")
        self._end, self._fade_in, self._fade_out = (
            OptionalNumberField(field, self._edited) for field in (_END, _FADE_IN, _FADE_OUT)
        )
        self._puff = named(Check("rules_dialog.scaled_by_puff"), "rule_scaled_by")
        on_click(self._puff, self._edited)
        for combo in (self._moment, self._does, self._start, self._end_of):
            combo.chosen.connect(lambda _id: self._edited())
        for several in (self._places, self._styles, self._not_styles, self._habits, self._growth):
            several.changed.connect(self._edited)
        self._when, self._do = QGroupBox(), QGroupBox()
        self._lay_out()
        self.texted(self._when, heading="rules_dialog.when")
        self.texted(self._do, heading="rules_dialog.do")
        self.retranslate()

    def _number(self, name: str, low: float, high: float, step: float, unit_id: str = "") -> Number:
        number = self.texted(Number(f"rule_{name}", low, high, step), suffix=unit_id)
        number.valueChanged.connect(lambda _value: self._edited())
        return number

    def _lay_out(self) -> None:
        grid = QGridLayout()
        for row, asked in enumerate(self._asked):
            grid.addWidget(asked.check, row, 0)
            grid.addWidget(asked.number, row, 1)
        grid.setColumnStretch(1, 1)
        among = in_form(
            {
                "rules_dialog.moment": self._moment,
                "rules_dialog.place": self._places,
                "rules_dialog.styles": self._styles,
                "rules_dialog.not_styles": self._not_styles,
                "rules_dialog.habits": self._habits,
                "rules_dialog.chance": self._chance,
            }
        )
        in_column(among, grid, of=self._when)
        does = in_form(
            {
                "rules_dialog.does": self._does,
                "rules_dialog.strength": self._strength,
                "rules_dialog.grows_with": self._growth,
                "rules_dialog.grows_from": self._grows_from,
                "rules_dialog.starts": in_row((self._start, 1), self._start_s),
                "rules_dialog.spread": self._spread,
                "rules_dialog.stays": self._stays,
                "rules_dialog.apart": self._apart,
            }
        )
        more = QGridLayout()
        more.addWidget(self._end.check, 0, 0)
        more.addWidget(panel(in_row((self._end_of, 1), self._end.number, margins=0)), 0, 1)
        for row, asked in enumerate((self._fade_in, self._fade_out), 1):
            more.addWidget(asked.check, row, 0)
            more.addWidget(asked.number, row, 1)
        more.setColumnStretch(1, 1)
        in_column(does, self._puff, more, of=self._do)
        title: QFormLayout = in_form({"rules_dialog.title": self._title})
        in_column(title, self._when, self._do, None, of=self)

    # Rule

    def show_rule(self, rule: Rule | None) -> None:
        """Show a rule; None for no rule."""
        self._rule = None
        self.setEnabled(rule is not None)
        if rule is None:
            return
        when, do = rule.when, rule.do
        self._title.setText(rule.title.in_language(language()))
        for asked in self._asked:
            asked.show_value(getattr(when, asked.field.name))
        self._end.show_value(do.end_s)
        self._fade_in.show_value(do.fade_in_s)
        self._fade_out.show_value(do.fade_out_s)
        self._show_choices(rule)
        numbers = {
            self._chance: 100.0 * when.chance,
            self._strength: do.strength,
            self._grows_from: do.grows_from,
            self._start_s: do.start_s,
            self._spread: do.spread_s,
            self._stays: do.stays_s,
            self._apart: rule.apart_s,
        }
        for number, value in numbers.items():
            number.blockSignals(True)
            number.setValue(value)
            number.blockSignals(False)
        self._puff.setChecked(do.scaled_by == "puff")
        self._rule = rule
        self._enable()

    def _show_choices(self, rule: Rule) -> None:
        when, do, library = rule.when, rule.do, self._library
        anyone, nothing = self.tr("rules_dialog.any"), self.tr("rules_dialog.nothing")
        self._places.show_choice(self._texts(PLACES), when.place, anyone)
        self._styles.show_choice(_by_name(library.styles.items, style_name), when.styles, anyone)
        self._not_styles.show_choice(_by_name(library.styles.items, style_name), when.not_styles, nothing)
        self._habits.show_choice(_by_name(library.habits.items, habit_name), when.habits, anyone)
        self._growth.show_choice(self._texts(GROWTHS), do.growth, nothing)
        _choose(self._moment, self._texts(MOMENTS), when.moment or "")
        _choose(self._start, self._texts(ANCHORS), do.start)
        _choose(self._end_of, self._texts(ANCHORS), do.end)
        faces = _by_name(library.expressions_by_name, expression_name)
        moves = _by_name(library.gestures.items, gesture_name)
        face, move = self.tr("rules_dialog.expression"), self.tr("rules_dialog.gesture")
        does = {f"expression:{name}": face.format(name=text) for name, text in faces.items()}
        does |= {f"gesture:{name}": move.format(name=text) for name, text in moves.items()}
        now = f"gesture:{do.gesture}" if do.gesture else f"expression:{do.expression}"
        _choose(self._does, {**does, **({} if now in does else {now: now.split(":", 1)[1]})}, now)

    def _enable(self) -> None:
        """Disable fields that have no effect because of the values of others."""
        rule = self._rule
        if rule is None:
            return
        gesture = bool(rule.do.gesture)
        for widget in (self._stays, self._fade_in.check, self._fade_out.check):
            widget.setEnabled(not gesture)
        self._spread.setEnabled(gesture)
        self._grows_from.setEnabled(bool(rule.do.growth))
        self._end_of.setEnabled(rule.do.end_s is not None)

    def _edited(self) -> None:
        before = self._rule
        if before is None:
            return
        asked: dict[str, Any] = {one.field.name: one.kept(before.when) for one in self._asked}
        does, _, name = (self._does.shown or "").partition(":")
        when = msgspec.structs.replace(
            before.when,
            **asked,
            place=self._places.chosen,
            styles=self._styles.chosen,
            not_styles=self._not_styles.chosen,
            habits=self._habits.chosen,
            moment=self._moment.shown or None,
            chance=kept(self._chance.value() / 100.0, before.when.chance),
        )
        growth = self._growth.chosen
        do = msgspec.structs.replace(
            before.do,
            expression=name if does == "expression" else "",
            gesture=name if does == "gesture" else "",
            strength=kept(self._strength.value(), before.do.strength),
            grows_with=before.do.grows_with if growth == before.do.growth else _growth(growth),
            grows_from=kept(self._grows_from.value(), before.do.grows_from),
            scaled_by="puff" if self._puff.isChecked() else None,
            start=self._start.shown,
            start_s=kept(self._start_s.value(), before.do.start_s),
            end=self._end_of.shown,
            end_s=self._end.kept(before.do),
            fade_in_s=self._fade_in.kept(before.do),
            fade_out_s=self._fade_out.kept(before.do),
            spread_s=kept(self._spread.value(), before.do.spread_s) if does == "gesture" else 0.0,
            stays_s=kept(self._stays.value(), before.do.stays_s),
        )
        apart_s = kept(self._apart.value(), before.apart_s)
        rule = msgspec.structs.replace(before, when=when, do=do, apart_s=apart_s, title=self._titled(before.title))
        if rule != before:
            self._rule = rule
            self._enable()
            self.changed.emit(rule)

    def _titled(self, before: Title) -> Title:
        text = " ".join(self._title.text().split())
        if text == before.in_language(language()):
            return before
        if language() == "ja":
            return Title(before.en or text, text)
        return msgspec.structs.replace(before, en=text)

    def _texts(self, ids: Mapping[str, str]) -> dict[str, str]:
        return {id: self.tr(text) for id, text in ids.items()}

    def retranslate(self) -> None:
        if self._rule is not None:
            self.show_rule(self._rule)


def _growth(chosen: tuple[str, ...]) -> Any:
    return None if not chosen else chosen[0] if len(chosen) == 1 else chosen


def _by_name(items: Mapping[str, object], name_of: Callable[[str], str]) -> dict[str, str]:
    return {id: name_of(id) for id in sorted(items, key=name_of)}


def _choose(combo: Combo, texts: Mapping[str, str], chosen: str) -> None:
    combo.set_options([Option(id, text) for id, text in texts.items()])
    combo.show_option(chosen)
