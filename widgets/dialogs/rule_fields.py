"""Fields of a rule (names, bounds, units) and their widgets."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final, NamedTuple, get_args

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QDoubleSpinBox, QMenu, QPushButton, QSizePolicy

from metadata.rules import Place
from widgets.common.clicks import on_click
from widgets.common.controls import Check, named
from widgets.common.plain import verbatim
from widgets.dialogs.automatic_number import TEXT_MARGIN_PX

SECONDS: Final = "rules_dialog.unit_s"
SEMITONES: Final = "rules_dialog.unit_semitones"


class Field(NamedTuple):
    """Input field for a number of a rule: key in the table, text id, bounds, step, text id of the unit, and initial
    value."""

    name: str
    text_id: str
    low: float
    high: float
    step: float
    unit_id: str
    first: float


CONDITIONS: Final = (
    Field("loudness_above", "rules_dialog.loudness_above", 0.0, 1.0, 0.05, "", 0.8),
    Field("loudness_below", "rules_dialog.loudness_below", 0.0, 1.0, 0.05, "", 0.4),
    Field("accent", "rules_dialog.accent", 0.0, 1.0, 0.05, "", 0.1),
    Field("effort_above", "rules_dialog.effort_above", 0.0, 1.0, 0.05, "", 0.5),
    Field("semitones_above_easy", "rules_dialog.semitones_above_easy", -60.0, 60.0, 1.0, SEMITONES, 0.0),
    Field("semitones_below_easy", "rules_dialog.semitones_below_easy", -60.0, 60.0, 1.0, SEMITONES, 0.0),
    Field("leap_up", "rules_dialog.leap_up", 0.0, 60.0, 1.0, SEMITONES, 7.0),
    Field("leap_down", "rules_dialog.leap_down", 0.0, 60.0, 1.0, SEMITONES, 7.0),
    Field("longer_s", "rules_dialog.longer_s", 0.0, 600.0, 0.1, SECONDS, 1.0),
    Field("shorter_s", "rules_dialog.shorter_s", 0.0, 600.0, 0.1, SECONDS, 0.3),
    Field("rest_longer_s", "rules_dialog.rest_longer_s", 0.0, 600.0, 0.5, SECONDS, 2.0),
    Field("rest_after_longer_s", "rules_dialog.rest_after_longer_s", 0.0, 600.0, 0.5, SECONDS, 2.0),
    Field("played_longer_s", "rules_dialog.played_longer_s", 0.0, 3600.0, 10.0, SECONDS, 60.0),
)
"""Fields of a rule's conditions about notes."""
PLACES: Final[Mapping[str, str]] = {place: f"rules_dialog.place_{place}" for place in get_args(Place)}
MOMENTS: Final[Mapping[str, str]] = {
    "": "rules_dialog.moment_note",
    **{id: f"rules_dialog.moment_{id}" for id in ("gives_entry", "takes_entry", "ending")},
}
GROWTHS: Final[Mapping[str, str]] = {
    id: f"rules_dialog.growth_{id}" for id in ("loudness", "height", "depth", "length", "accent", "effort")
}
ANCHORS: Final[Mapping[str, str]] = {"onset": "rules_dialog.anchor_onset", "end": "rules_dialog.anchor_end"}


def kept(value: float, before: float) -> float:
    """Return the original number ``before`` if the displayed, rounded one is unchanged, else the displayed one."""
    return before if abs(value - before) < 5e-4 else value


class Number(QDoubleSpinBox):
    """A number with its unit and without trailing zeros; the wheel works only with keyboard focus."""

    def __init__(self, name: str, low: float, high: float, step: float) -> None:
        super().__init__()
        self.setObjectName(name)
        self.setDecimals(3)
        self.setRange(low, high)
        self.setSingleStep(step)
        self.setKeyboardTracking(False)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.lineEdit().setTextMargins(TEXT_MARGIN_PX, 0, 0, 0)

    def textFromValue(self, value: float) -> str:
        return self.locale().toString(value, "g", 6)

    def wheelEvent(self, event: QWheelEvent) -> None:
        if self.hasFocus():
            super().wheelEvent(event)
        else:
            event.ignore()


class OptionalNumberField:
    """An optional number: a check box with its name and the number field next to it."""

    def __init__(self, field: Field, changed: Callable[[], None]) -> None:
        self.field = field
        self.check = named(Check(field.text_id), f"rule_{field.name}_asked")
        self.number = Number(f"rule_{field.name}", field.low, field.high, field.step)
        self.check.texted(self.number, name=field.text_id, suffix=field.unit_id)
        self.check.toggled.connect(self.number.setEnabled)
        on_click(self.check, changed)
        self.number.valueChanged.connect(lambda _value: changed())
        self.number.setEnabled(False)

    @property
    def value(self) -> float | None:
        """The number; None if it is not set."""
        return self.number.value() if self.check.isChecked() else None

    def kept(self, of: object) -> float | None:
        """Return the number; if the field is unchanged, the number that ``of`` has in the field's key, since the
        displayed one may be rounded.
        """
        value, before = self.value, getattr(of, self.field.name)
        return value if value is None or before is None else kept(value, before)

    def show_value(self, value: float | None) -> None:
        """Display a number, or the initial value for None, without emitting a signal."""
        self.number.blockSignals(True)
        self.number.setValue(self.field.first if value is None else value)
        self.number.blockSignals(False)
        self.check.setChecked(value is not None)


class Several(QPushButton):
    """A button with a menu for selecting any number of items.

    Signals
    -------
    changed()
        The user selected or deselected an item.
    """

    changed = Signal()

    def __init__(self, name: str) -> None:
        super().__init__()
        self.setObjectName(name)
        self.setAutoDefault(False)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self._menu = QMenu(self)
        self.setMenu(self._menu)
        self._chosen: tuple[str, ...] = ()
        self._names: dict[str, str] = {}
        self._none = ""

    @property
    def chosen(self) -> tuple[str, ...]:
        """Names of the selected items, in the order of the list."""
        return self._chosen

    def show_choice(self, names: Mapping[str, str], chosen: Sequence[str], none: str) -> None:
        """Set the items by id; ``none`` is the text for an empty selection. Selected ids that do not exist are listed
        as well.
        """
        self._names = {**{id: id for id in chosen}, **names}
        self._chosen, self._none = tuple(chosen), none
        self._menu.clear()
        for id, text in self._names.items():
            entry = self._menu.addAction(verbatim(text))
            entry.setObjectName(id)
            entry.setCheckable(True)
            entry.setChecked(id in self._chosen)
            on_click(entry, self._toggle, id)
        self._say()

    def _toggle(self, id: str) -> None:
        chosen = {*self._chosen} ^ {id}
        self._chosen = tuple(one for one in self._names if one in chosen)
        self._say()
        self.changed.emit()

    def _say(self) -> None:
        text = ", ".join(self._names[id] for id in self._chosen) or self._none
        self.setText(verbatim(text))
        self.setToolTip(text)
