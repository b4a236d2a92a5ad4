"""Settings of the piece as a whole: title, frame rate, pre-roll, felt beat, intensity, conductor and seed."""

from __future__ import annotations

import unicodedata
from fractions import Fraction
from functools import partial
from typing import Any, Final, TypeVar, cast

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QDoubleSpinBox, QLineEdit, QWidget

from app.editor.session import Session
from app.errors import Message
from app.project import limits
from app.project.casting import ConductorPlace, conductor_place
from app.project.edit.generation import vary_everyone
from app.project.edit.piece import PieceSettings, piece_settings, set_piece_settings, set_seed, usual_settings
from app.project.frame_rate import USUAL_RATES, frame_rate, frame_rate_text
from widgets.common.controls import Button, Caption, Check, Retranslated, Wording, named, said, wrapped
from widgets.common.help import with_help
from widgets.common.icons import icon
from widgets.common.layouts import STRETCH, in_column, in_form, in_row
from widgets.common.plain import ComboBox, Label
from widgets.dialogs.automatic_number import TEXT_MARGIN_PX

PROBLEM_PX = 40
"""Height in pixels of two lines of messages, so that the layout does not change."""

_BEATS: Final[dict[float | None, str]] = {
    None: "automatic_by_metre_and_tempo",
    0.25: "sixteenth",
    0.5: "eighth",
    0.75: "dotted_eighth",
    1.0: "quarter",
    1.5: "dotted_quarter",
    2.0: "half",
    3.0: "dotted_half",
    4.0: "whole",
}
"""Felt beats in quarters, and their names."""
Value = TypeVar("Value", str, float)


class PieceSettingsDialog(Retranslated, QDialog):
    """Dialog that changes the settings of the piece in a single edit."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("piece_settings")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._session = session
        self._before = piece_settings(session.project)
        self._shown: dict[str, tuple[Any, Any]] = {}
        self._has_place = False
        """Text and value that each field was given: a field may show fewer digits than the value has."""
        self._title = named(QLineEdit(), "piece_title")
        self._title.setMaxLength(limits.MOST_NAME)
        self._rate = named(ComboBox(), "piece_rate")
        self._rate.setEditable(True)
        self._rate.setInsertPolicy(ComboBox.InsertPolicy.NoInsert)
        # Completion would turn 12 into 120.
        self._rate.setCompleter(None)  # type: ignore[arg-type]
        self._rate.addItems([frame_rate_text(rate) for rate in USUAL_RATES])
        self._preroll = self.texted(named(_Beats(), "piece_preroll"), suffix="piece_settings_dialog.beats")
        self._preroll.setRange(*limits.PREROLL_BEATS)
        self._preroll.setDecimals(3)
        self._preroll.lineEdit().setTextMargins(TEXT_MARGIN_PX, 0, 0, 0)
        self._felt = named(ComboBox(), "piece_felt_beat")
        self._intensity = self.texted(named(_Beats(), "piece_section_intensity"), suffix="piece_settings_dialog.times")
        self._intensity.setRange(*limits.SECTION_INTENSITY)
        self._intensity.setDecimals(2)
        self._intensity.setSingleStep(0.05)
        self._intensity.lineEdit().setTextMargins(TEXT_MARGIN_PX, 0, 0, 0)
        self._conducted = named(Check("piece_settings_dialog.conductor_gives_entries"), "piece_conducted")
        self._conductor = named(_Beats(), "piece_conductor_x"), named(_Beats(), "piece_conductor_z")
        for name, field in zip(("X ", "Z "), self._conductor, strict=True):
            field.setRange(*limits.STAGE_M)
            field.setDecimals(2)
            field.setSingleStep(0.1)
            field.setPrefix(name)
            field.setSuffix(" m")
            field.lineEdit().setTextMargins(TEXT_MARGIN_PX, 0, 0, 0)
            self._conducted.toggled.connect(field.setEnabled)
        self._seed = named(QLineEdit(), "piece_seed")
        self._randomise = Button("piece_settings_dialog.randomise", self._another_seed, "piece_randomise")
        self._problem = named(wrapped(Label()), "piece_problem")
        self._problem.setMinimumHeight(PROBLEM_PX)
        self._problem.setAlignment(Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignLeft)
        self._problem.setStyleSheet(f"color: {session.tokens.error};")
        self._ok = Button("piece_settings_dialog.ok", self._apply, "piece_ok")
        self._ok.setDefault(True)
        self._cancel = Button("piece_settings_dialog.cancel", self.reject, "piece_cancel")
        reset_tip = "piece_settings_dialog.reset_tip"
        self._reset = Button("piece_settings_dialog.reset_to_defaults", self._reset_all, "piece_reset", reset_tip)
        self._lay_out()
        self._randomise.setIcon(icon("dice", session.tokens))
        self._fill_felt_beats()
        self._explain()
        self._show(self._before)
        for signal in (self._rate.editTextChanged, self._seed.textChanged):
            signal.connect(self._judge)
        self.texted(self, title="piece_settings_dialog.piece_settings")
        self.retranslate()
        self._title.setFocus()

    def _lay_out(self) -> None:
        form = in_form(
            {
                "piece_settings_dialog.title": self._title,
                "piece_settings_dialog.frame_rate": self._rate,
                "piece_settings_dialog.pre_roll": self._preroll,
                "piece_settings_dialog.felt_beat": self._felt,
                "piece_settings_dialog.section_intensity": self._intensity,
                "piece_settings_dialog.conductor": in_row(self._conducted, *((field, 1) for field in self._conductor)),
                "piece_settings_dialog.seed": in_row((self._seed, 1), self._randomise),
            }
        )
        buttons = QDialogButtonBox()
        buttons.addButton(self._ok, QDialogButtonBox.ButtonRole.AcceptRole)
        buttons.addButton(self._cancel, QDialogButtonBox.ButtonRole.RejectRole)
        buttons.addButton(self._reset, QDialogButtonBox.ButtonRole.ResetRole)
        in_column(form, self._problem, STRETCH, with_help(buttons), of=self)

    # Choice

    @property
    def settings(self) -> PieceSettings | None:
        """Return the settings in the fields; None if a field is invalid."""
        rate, seed = self._typed_rate(), self._typed_seed()
        if rate is None or seed is None:
            return None
        return PieceSettings(
            title=self._kept("title", self._title.text()),
            fps=rate,
            preroll_beats=self._kept("preroll", self._preroll.value()),
            felt_beat_quarters=self._felt.currentData(),
            seed=seed,
            section_intensity=self._kept("intensity", self._intensity.value()),
            conductor=self._place(),
        )

    def _place(self) -> ConductorPlace | None:
        """Return the conductor's place; None if there was none and none is chosen."""
        across, ahead = self._conductor
        on_stage = self._conducted.isChecked()
        if not on_stage and not self._has_place:
            return None
        x_m, z_m = self._kept("conductor x", across.value()), self._kept("conductor z", ahead.value())
        return ConductorPlace(x_m, z_m, on_stage)

    def _kept(self, name: str, value: Value) -> Value:
        """Return the setting's original value if the displayed one, which may be rounded, is unchanged."""
        shown, held = self._shown[name]
        return cast(Value, held) if value == shown else value

    def _typed_rate(self) -> Fraction | None:
        try:
            rate = frame_rate(self._rate.currentText())
        except (ValueError, ZeroDivisionError):
            return None
        return rate if limits.FPS[0] <= rate <= limits.FPS[1] else None

    def _typed_seed(self) -> int | None:
        text = unicodedata.normalize("NFKC", self._seed.text()).strip()
        if not text.isdecimal() or len(text) > len(str(limits.SEED[1])):
            return None
        return seed if (seed := int(text)) <= limits.SEED[1] else None

    def _show(self, settings: PieceSettings) -> None:
        self._title.setText(settings.title)
        self._title.setCursorPosition(0)
        rate = frame_rate_text(settings.fps)
        # Sets the index too, from which keys and wheel continue.
        self._rate.setCurrentIndex(self._rate.findText(rate))
        self._rate.setEditText(rate)
        self._preroll.setValue(settings.preroll_beats)
        self._felt.setCurrentIndex(self._felt.findData(settings.felt_beat_quarters))
        self._intensity.setValue(settings.section_intensity)
        self._seed.setText(str(settings.seed))
        stages = [player.stage for player in self._session.project.bodies]
        self._has_place = settings.conductor is not None
        place = settings.conductor or conductor_place(stages)
        self._conducted.setChecked(place.on_stage)
        for field, place_m in zip(self._conductor, (place.x_m, place.z_m), strict=True):
            field.setValue(place_m)
            field.setEnabled(place.on_stage)
        self._shown = {
            "title": (self._title.text(), settings.title),
            "preroll": (self._preroll.value(), settings.preroll_beats),
            "intensity": (self._intensity.value(), settings.section_intensity),
            "conductor x": (self._conductor[0].value(), place.x_m),
            "conductor z": (self._conductor[1].value(), place.z_m),
        }

    def _reset_all(self) -> None:
        """Reset all but the title to the values of a new piece."""
        title = self._kept("title", self._title.text())
        self._show(usual_settings(title, self._session.project))

    def _another_seed(self) -> None:
        project, seed = self._session.project, self._typed_seed()
        self._seed.setText(str(vary_everyone(project if seed is None else set_seed(project, seed)).seed))

    def _judge(self) -> None:
        rate, seed = self._typed_rate(), self._typed_seed()
        problems = []
        if rate is None:
            text = self.tr("piece_settings_dialog.frame_rate_type_number_from")
            problems.append(text.format(low=limits.FPS[0], high=limits.FPS[1]))
        if seed is None:
            text = self.tr("piece_settings_dialog.seed_type_whole_number_from")
            problems.append(text.format(low=limits.SEED[0], high=limits.SEED[1]))
        self._problem.setText("\n".join(problems))
        self._ok.setEnabled(not problems)

    def _apply(self) -> None:
        settings = self.settings
        if settings is None:
            return
        edit = partial(set_piece_settings, settings=settings)
        if self._session.attempt(Message("edit.piece_settings"), edit):
            self.accept()

    # Texts

    def _fill_felt_beats(self) -> None:
        names: dict[float | None, Wording] = {
            quarters: f"piece_settings_dialog.{name}" for quarters, name in _BEATS.items()
        }
        beat = self._before.felt_beat_quarters
        if beat not in names:
            names[beat] = said("piece_settings_dialog.quarters", count=f"{beat:.6g}")
        for quarters in names:
            self._felt.addItem("", quarters)
        self.texted(self._felt, items=tuple(names.values()))

    def _explain(self) -> None:
        across, ahead = self._conductor
        for field, tip in (
            (self._title, "names_piece_in_midi_file"),
            (self._rate, "of_ruler_and_of_steps"),
            (self._preroll, "felt_beats_before_first_note"),
            (self._felt, "felt_beat_tip"),
            (self._intensity, "intensity_tip"),
            (self._conducted, "conductor_tip"),
            (across, "conductor_left"),
            (ahead, "conductor_ahead"),
            (self._seed, "another_seed_is_another_performance"),
        ):
            self.texted(field, tip=f"piece_settings_dialog.{tip}")

    def retranslate(self) -> None:
        for caption in self.findChildren(Caption):
            caption.setToolTip(caption.buddy().toolTip())
        self._judge()

    def sizeHint(self) -> QSize:
        return QSize(580, 370)


class _Beats(QDoubleSpinBox):
    """Field for a number of beats, shown without trailing zeros."""

    def textFromValue(self, value: float) -> str:
        return self.locale().toString(value, "g", 6)
