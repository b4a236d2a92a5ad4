"""Form for a pair of motion and music, with the contents of its files."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Final

import msgspec
from PySide6.QtCore import QRect, Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QGridLayout, QScrollArea, QWidget

from app.choreography.music_offset import offset_doubt
from app.choreography.read_pair import CREDITS_SUFFIX, to_check
from app.encoding import shown
from app.formats.rates import exact_rate
from app.rig.motion_file import SUFFIXES as MOTION_SUFFIXES
from app.score.suffixes import MUSIC
from widgets.common.combo import Combo, Option
from widgets.common.controls import Button, Caption, Retranslated, named, wrapped
from widgets.common.paths import PathEdit, ask_for_file
from widgets.common.plain import Label
from widgets.common.text import message_text, sentence
from widgets.dialogs.automatic_number import AutomaticNumber
from widgets.dialogs.choreography.learn_draft import (
    PairContents,
    PairDraft,
    is_offset_outside,
    offset_range_s,
    offset_s_of,
)

_FILES = {"motion": MOTION_SUFFIXES, "music": MUSIC, "credits": (CREDITS_SUFFIX,)}
_LABELS: Final = {
    "motion": "pair_form.motion",
    "figure": "pair_form.figure",
    "music": "pair_form.music",
    "credits": "pair_form.credits",
    "offset": "pair_form.offset",
    "fps": "pair_form.frame_rate",
}
_PLACEHOLDERS: Final = {
    "motion": "pair_form.bvh_fbx_or_glb",
    "music": "pair_form.midi_with_percussion",
    "credits": "pair_form.txt_file_beside_motion",
}
_LONGEST_S = 24 * 3600.0
"""Greatest offset in seconds before the files are read."""
_NOTES_LINES = 3
"""Least number of visible lines of notes; further lines are scrolled."""


class PairForm(Retranslated, QWidget):
    """Form with the fields of a pair of motion and music.

    Signals
    -------
    changed(PairDraft)
        The user changed a field.
    """

    changed = Signal(object)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._draft, self._found, self._busy = PairDraft(), PairContents(), False
        self._figures: tuple[str, ...] = ()
        self._figures_of: Path | None = None
        self._figure_read = ""
        self._labels = {name: Caption(text_id) for name, text_id in _LABELS.items()}
        self._paths = {name: self.texted(PathEdit(), placeholder=text_id) for name, text_id in _PLACEHOLDERS.items()}
        self._figure = self.texted(named(Combo(), "learn_figure"), tip="pair_form.figure_tip")
        self._offset = self.texted(
            AutomaticNumber("learn_offset", -_LONGEST_S, _LONGEST_S, step=0.01, decimals=3),
            tip="pair_form.time_of_motion_at_which",
        )
        self._fps = self.texted(
            AutomaticNumber("learn_fps", 1.0, 1000.0, step=1.0, decimals=3), tip="pair_form.true_frame_rate_of_motion"
        )
        self._notes = wrapped(named(Label(), "learn_pair_notes"))
        self._notes.setAlignment(Qt.AlignmentFlag.AlignTop)
        self._room = named(_WholeLines(self._notes), "learn_pair_notes_room")
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setColumnStretch(1, 1)
        self._labels["figure"].setBuddy(self._figure)
        grid.addWidget(self._labels["figure"], 1, 0)
        grid.addWidget(self._figure, 1, 1, 1, 2)
        self._figure.chosen.connect(self._figure_chosen)
        for row, name in zip((0, 2, 3), _FILES, strict=True):
            path = self._paths[name]
            button = Button("pair_form.choose", partial(self._ask, name), f"learn_{name}_choose")
            path.setObjectName(f"learn_{name}")
            path.setAcceptDrops(False)
            self._labels[name].setBuddy(path)
            grid.addWidget(self._labels[name], row, 0)
            grid.addWidget(path, row, 1)
            grid.addWidget(button, row, 2)
            path.editingFinished.connect(lambda name=name: self._typed(name))
        for row, (name, field) in enumerate({"offset": self._offset, "fps": self._fps}.items(), start=1 + len(_FILES)):
            self._labels[name].setBuddy(field)
            grid.addWidget(self._labels[name], row, 0)
            grid.addWidget(field, row, 1, 1, 2)
            field.changed.connect(self._number_changed)
        grid.addWidget(self._room, len(_FILES) + 3, 0, 1, 3)
        grid.setRowStretch(len(_FILES) + 3, 1)
        self.texted(self._offset.check, text="pair_form.automatic")
        self.texted(self._offset.number, suffix="pair_form.seconds")
        self.texted(self._fps.check, text="pair_form.from_file")
        self.texted(self._fps.number, suffix="pair_form.frames_s")
        self.retranslate()

    def show_pair(self, draft: PairDraft, found: PairContents, busy: bool) -> None:
        """Show a pair and the contents of its files; ``busy`` while these are read."""
        self._draft, self._found, self._busy = draft, found, busy
        for name, edit in self._paths.items():
            path: Path | None = getattr(draft, name)
            if edit.path != path:
                edit.set_path(path)
        self._show_figures()
        self._show_numbers()
        self._show_notes()

    def _show_figures(self) -> None:
        """Show the choice of skeletons for a file with several."""
        skeleton, motion = self._found.skeleton, self._draft.motion
        if skeleton is not None or motion != self._figures_of:
            # The former figures stay while another file is read, or if it cannot be read.
            self._figures_of = motion
            self._figures = () if skeleton is None else skeleton.figures
            self._figure_read = "" if skeleton is None else skeleton.figure_name
        self._figure.set_options([Option(name, shown(name)) for name in self._figures])
        self._figure.show_option(self._draft.figure or self._figure_read or None)
        for widget in (self._labels["figure"], self._figure):
            widget.setVisible(bool(self._figures))

    def _show_numbers(self) -> None:
        read, analysis = self._found.read, self._found.analysis
        self._offset.set_range(*(offset_range_s(self._found) or (-_LONGEST_S, _LONGEST_S)))
        self._offset.show_value(
            self._draft.offset_s, None if analysis is None else offset_s_of(PairDraft(), self._found)
        )
        fps = self._draft.fps
        self._fps.show_value(None if fps is None else float(fps), None if read is None else float(read.motion.file_fps))

    def _show_notes(self) -> None:
        read, analysis = self._found.read, self._found.analysis
        notes = []
        if self._found.error is not None:
            notes.append(sentence(self._found.error))
        elif self._busy:
            notes.append(self.tr("pair_form.reading_files"))
        elif self._draft.motion is None or self._draft.music is None:
            notes.append(self.tr("pair_form.pair_explanation"))
        elif read is not None and analysis is not None:
            bounds = offset_range_s(self._found)
            if bounds is not None and is_offset_outside(self._draft, self._found):
                least, most = (f"{bound_s:.3f}" for bound_s in bounds)
                notes.append(self.tr("pair_form.offset_outside").format(least=least, most=most))
            if self._draft.offset_s is None:
                confidence = analysis.offset.confidence
                doubt = offset_doubt(offset_s_of(self._draft, self._found), confidence)
                notes.append(
                    self.tr("pair_form.offset_detected").format(confidence=f"{confidence:.2f}")
                    if doubt is None
                    else sentence(doubt)
                )
            guessed = [message_text(message) for message in to_check(read)]
            if guessed:
                notes.append(self.tr("pair_form.to_check").format(notes="; ".join(guessed)))
            notes.append(message_text(read.motion.checked))
            if not read.pair.credits:
                notes.append(self.tr("pair_form.no_credits_say_where_motion"))
        self._notes.setText("\n".join(notes))
        self._room.fit()

    def _typed(self, name: str) -> None:
        self._change(**{name: self._paths[name].path})

    def _ask(self, name: str) -> None:
        draft = self._draft
        near = getattr(draft, name) or draft.motion or draft.music
        filters = f"{self._kind(name)} ({' '.join(f'*{suffix}' for suffix in _FILES[name])})"
        path = ask_for_file(self, self._labels[name].text(), near.parent if near is not None else None, filters)
        if path is not None:
            self._change(**{name: path})

    def _figure_chosen(self, name: str) -> None:
        self._change(figure=name)

    def _number_changed(self) -> None:
        fps = self._fps.value
        rate = self._draft.fps
        # Three decimals are displayed.
        if fps is None:
            rate = None
        elif rate is None or round(float(rate), 3) != fps:
            rate = exact_rate(fps, 0.0005 / fps)
        self._change(offset_s=self._offset.value, fps=rate)

    def _change(self, **fields: object) -> None:
        draft = msgspec.structs.replace(self._draft, **fields)
        if draft != self._draft:
            self._draft = draft
            self.changed.emit(draft)

    def _kind(self, name: str) -> str:
        return {
            "motion": self.tr("pair_form.motion_files"),
            "music": self.tr("pair_form.midi_files"),
            "credits": self.tr("pair_form.text_files"),
        }[name]

    def retranslate(self) -> None:
        self._show_notes()


def file_name(path: Path | None) -> str:
    """Return the name of a file without folders; a dash if there is none."""
    return "–" if path is None else shown(path.name)


class _WholeLines(QScrollArea):
    """Scroll area that shows no partial lines of a text.

    Parameters
    ----------
    text : Label
        Label, which is scrolled line by line.
    """

    def __init__(self, text: Label) -> None:
        super().__init__()
        self._text = text
        self.setFrameShape(QScrollArea.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setWidgetResizable(True)
        self.setWidget(text)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Fit the text to the new width."""
        super().resizeEvent(event)
        self.fit()

    def fit(self) -> None:
        """Adjust the height so that no partial line is visible below the text. Japanese lines are higher than the
        font's.
        """
        line = self._text.fontMetrics().boundingRect(QRect(), Qt.TextFlag.TextSingleLine, self._text.text())
        line_px = max(line.height(), self._text.fontMetrics().lineSpacing())
        self.setMinimumHeight(_NOTES_LINES * line_px)
        self.verticalScrollBar().setSingleStep(line_px)
        self.setViewportMargins(0, 0, 0, self.height() % line_px)
