"""Dialog that makes an evaluation: clips and a questionnaire, compared with a film of real players."""

from __future__ import annotations

import os
import secrets
from collections.abc import Callable
from pathlib import Path
from typing import Final, TypeAlias, get_args

from PySide6.QtCore import QSize, QTimer
from PySide6.QtWidgets import QDoubleSpinBox, QLayout, QSpinBox, QWidget

from app.editor.session import Session, Severity
from app.encoding import restored, shown, stored
from app.errors import AppError, Message, Progress, StopRequested
from app.evaluation.design import Presentations
from app.evaluation.key import KEY_FILE, VARIANTS, Variant
from app.evaluation.process import EvaluationFinished, Report
from app.evaluation.request import EXCERPTS, LEAST_S, MOST_EXCERPTS, MOST_S, SECONDS, EvaluationRequest
from app.formats.video import SUFFIXES
from app.project.model import Project
from app.rig.motion_file import SUFFIXES as MOTION_SUFFIXES
from widgets.common.controls import Button, Caption, Check, named, selectable, wrapped
from widgets.common.layouts import Scrolled, begin_with_size, in_column, in_form, in_row
from widgets.common.paths import PathEdit, ask_for_file, ask_for_folder, show_folder
from widgets.common.plain import ComboBox, Label
from widgets.common.text import message_text
from widgets.dialogs.export_range import TEXT_MARGIN_PX, RangeChooser
from widgets.dialogs.progress_dialog import WorkingDialog, stopping

Make: TypeAlias = Callable[[Project, EvaluationRequest, Report, StopRequested], EvaluationFinished]
"""Function that makes an evaluation in the background; see `app.evaluation.process.made_by_process`."""

SIZES: Final = ((640, 360), (960, 540), (1280, 720), (360, 640))
_BY_SOUND, _FOLLOWED, _BY_HAND = "sound", "follow", "hand"
_LONGEST_S: Final = 24 * 3600.0
_AT_CONTROLS: Final = {
    "evaluate.silent_video": "evaluate.silent_video_here",
    "evaluate.other_piece": "evaluate.other_piece_here",
    "evaluate.not_followed": "evaluate.not_followed_here",
    "evaluate.other_tempo": "evaluate.other_tempo_here",
    "evaluate.no_excerpt": "evaluate.no_excerpt_here",
    "evaluate.not_covered": "evaluate.not_covered_here",
    "evaluate.keyframes_lacking": "evaluate.keyframes_lacking_here",
    "evaluate.keyframes_report": "evaluate.keyframes_report_here",
}
"""Ids of errors, and of texts that mention the dialog's controls instead of command options."""
_OF_FILES: Final[tuple[Variant, ...]] = ("film", "keyframes")
_VARIANTS: Final[dict[Variant, str]] = {variant: f"evaluation_dialog.variant_{variant}" for variant in VARIANTS}
_PLACES: Final = {
    _BY_SOUND: "evaluation_dialog.by_sound",
    _FOLLOWED: "evaluation_dialog.followed",
    _BY_HAND: "evaluation_dialog.by_hand",
}
_KEYFRAMES_PLACES: Final = {_BY_SOUND: "evaluation_dialog.found", _BY_HAND: "evaluation_dialog.by_hand"}
_VIEWS: Final = {view: f"playblast_dialog.{view}" for view in ("ensemble", "front", "side", "hands", "mouth", "feet")}
_PRESENTATIONS: Final = {id: f"evaluation_dialog.presentation_{id}" for id in get_args(Presentations)}
"""Text ids of the choices by value."""


class EvaluationDialog(WorkingDialog):
    """Dialog that makes an evaluation.

    Parameters
    ----------
    make : Make
        Makes the evaluation; called in a background thread.
    folder : path
        Proposed folder for its files.
    """

    def __init__(self, session: Session, make: Make, folder: Path, title: str, parent: QWidget | None = None) -> None:
        super().__init__("evaluation", "evaluation", parent)
        self._session, self._make, self._title = session, make, title
        self._now: list[tuple[float, Message]] = []
        """Share done and current activity: written by the thread, shown by the window."""
        self._timer = QTimer(self, interval=100)
        self._timer.timeout.connect(self._show_progress)
        self._film = named(PathEdit(), "evaluation_film")
        self._place = self.texted(named(ComboBox(), "evaluation_place"), options=_PLACES)
        self._offset = _seconds(-_LONGEST_S, _LONGEST_S, 0.0, "evaluation_offset")
        self._keyframes = named(PathEdit(), "evaluation_keyframes")
        self._keyframes_place = named(ComboBox(), "evaluation_keyframes_place")
        self.texted(self._keyframes_place, options=_KEYFRAMES_PLACES)
        self._keyframes_offset = _seconds(-_LONGEST_S, _LONGEST_S, 0.0, "evaluation_keyframes_offset")
        self._variants = {
            variant: named(Check(text_id), f"evaluation_{variant}") for variant, text_id in _VARIANTS.items()
        }
        self._bars = RangeChooser(
            session, session.project.score, prefix="evaluation", otherwise_id="evaluation_dialog.chosen_excerpts"
        )
        self._excerpts = named(QSpinBox(), "evaluation_excerpts")
        self._excerpts.lineEdit().setTextMargins(TEXT_MARGIN_PX, 0, 0, 0)
        self._excerpts.setRange(1, MOST_EXCERPTS)
        self._excerpts.setValue(EXCERPTS)
        self._length = _seconds(LEAST_S, MOST_S, SECONDS, "evaluation_length")
        self._view = self.texted(named(ComboBox(), "evaluation_view"), options=_VIEWS)
        self._presentation = named(ComboBox(), "evaluation_presentation")
        self.texted(self._presentation, options=_PRESENTATIONS)
        for number in (self._length, self._offset, self._keyframes_offset):
            self.texted(number, suffix="evaluation_dialog.seconds")
        self._size = named(ComboBox(), "evaluation_size")
        for width, height in SIZES:
            self._size.addItem(f"{width} × {height}", (width, height))
        self._folder = named(PathEdit(folder), "evaluation_folder")
        self._state = selectable(wrapped(named(Label(), "evaluation_state")))
        self._state.setMinimumHeight(60)
        self._lay_out()
        for variant, check in self._variants.items():
            check.setChecked(variant not in _OF_FILES)
            check.toggled.connect(self._show_state)
        for variant, field in (("film", self._film), ("keyframes", self._keyframes)):
            field.textChanged.connect(lambda text, variant=variant: self._file_changed(variant, bool(text.strip())))
        self._folder.textChanged.connect(self._show_state)
        self._place.currentIndexChanged.connect(self._show_state)
        self._keyframes_place.currentIndexChanged.connect(self._show_state)
        self._bars.changed.connect(self._show_state)
        self.texted(self, title="evaluation_dialog.title")
        self.retranslate()
        begin_with_size(self, QSize(720, 700))

    def _lay_out(self) -> None:
        film_button = Button("evaluation_dialog.choose", lambda: self._choose(self._film), "evaluation_browse_film")
        keyframes_button = Button(
            "evaluation_dialog.choose", lambda: self._choose(self._keyframes), "evaluation_browse_keyframes"
        )
        keyframes_folder = Button(
            "evaluation_dialog.choose_folder", self._choose_keyframes_folder, "evaluation_browse_keyframes_folder"
        )
        folder_button = Button("evaluation_dialog.choose", self._choose_folder, "evaluation_browse")
        variants: QLayout = in_column(*self._variants.values(), spacing=2)
        form = in_form(
            {
                "evaluation_dialog.film": in_row((self._film, 1), film_button),
                "evaluation_dialog.place": in_row((self._place, 1), self._offset),
                "evaluation_dialog.keyframes": in_row((self._keyframes, 1), keyframes_button, keyframes_folder),
                "evaluation_dialog.keyframes_place": in_row((self._keyframes_place, 1), self._keyframes_offset),
                "evaluation_dialog.bars": self._bars,
                "evaluation_dialog.excerpts": self._excerpts,
                "evaluation_dialog.length": self._length,
                "evaluation_dialog.view": self._view,
                "evaluation_dialog.presentation": self._presentation,
                "evaluation_dialog.size": self._size,
                "evaluation_dialog.folder": in_row((self._folder, 1), folder_button),
            }
        )
        form.insertRow(4, Caption("evaluation_dialog.variants"), variants)
        self.fields = (
            *(self._film, self._place, self._offset, self._keyframes, self._keyframes_place, self._keyframes_offset),
            *(
                *self._variants.values(),
                self._bars,
                self._excerpts,
                self._length,
                self._view,
                self._presentation,
                self._size,
                self._folder,
            ),
            *(film_button, keyframes_button, keyframes_folder, folder_button),
        )
        buttons = self._box("evaluation_dialog.make", self.start, self._show_folder)
        choices = in_column(form, (self._state, 1))
        in_column((Scrolled(choices), 1), self._under_way, self._progress, buttons, of=self)

    def start(self) -> None:
        """Start making the evaluation with the chosen options."""
        if self._running or not self._start.isEnabled():
            return
        request, project, make = self.request(), self._session.project, self._make
        # A new object for each run, since a cancelled run may still report progress.
        self._now = now = [(0.0, Message("work.evaluation"))]
        self._show.hide()
        self._set_running(True)
        self._timer.start()
        stop = self._stop

        def work(progress: Progress, stop_requested: StopRequested) -> EvaluationFinished:
            def report(share: float, message: Message) -> None:
                now[0] = (share, message)
                progress(share)

            return make(project, request, report, stopping(stop, stop_requested))

        self._session.tasks.run(
            Message("work.evaluation"),
            work,
            self._done,
            self._failed,
            key="evaluation",
            ended=self._finish,
            writes=True,
        )

    def request(self) -> EvaluationRequest:
        """Return the request that results from the fields."""
        film, keyframes, folder = self._film.path, self._keyframes.path, self._folder.path
        assert folder is not None, "the button is disabled without one"
        place, view = self._place.currentData(), self._view.currentData()
        by_hand = self._keyframes_place.currentData() == _BY_HAND
        players = self._session.players[:1] if view != "ensemble" else ()
        if view != "ensemble" and not players:
            players = tuple(player.id for player in self._session.project.bodies[:1])
        return EvaluationRequest(
            folder=stored(folder),
            title=self._title,
            film="" if film is None else stored(film),
            keyframes="" if keyframes is None else stored(keyframes),
            film_offset_s=self._offset.value() if film is not None and place == _BY_HAND else None,
            keyframes_offset_s=self._keyframes_offset.value() if keyframes is not None and by_hand else None,
            follow_film=film is not None and place == _FOLLOWED,
            variants=self._chosen(),
            bars=self._bars.bars,
            excerpts=self._excerpts.value(),
            excerpt_s=self._length.value(),
            view=view,
            player_ids=tuple(players),
            size=self._size.currentData(),
            presentation=self._presentation.currentData(),
            seed=secrets.randbits(31),
        )

    def _chosen(self) -> tuple[Variant, ...]:
        return tuple(variant for variant, check in self._variants.items() if check.isChecked() and self._there(variant))

    def _there(self, variant: Variant) -> bool:
        """Return whether the file that a variant needs was chosen."""
        field = {"film": self._film, "keyframes": self._keyframes}.get(variant)
        return field is None or field.path is not None

    def _file_changed(self, variant: Variant, there: bool) -> None:
        self._variants[variant].setChecked(there)
        self._show_state()

    def _done(self, made: EvaluationFinished) -> None:
        self._under_way.hide()
        page = f"{shown(restored(self.request().folder))}{os.sep}evaluation.html"
        lines = [self.tr("evaluation_dialog.done").format(page=page, clips=made.clips, pairs=made.pairs)]
        if made.confidence is not None and made.offset_s is not None:
            placed = {"offset_s": made.offset_s, "percent": round(100 * made.confidence)}
            lines.append(self.tr("evaluation_dialog.placed").format(**placed))
        for player, reason in made.left_out:
            left_out = Message("player.left_out", {"player": player, "reason": message_text(reason)})
            lines.append(message_text(left_out))
            self._session.notice(left_out, Severity.WARNING)
        self._state.setText("\n".join(lines))
        self._show.show()

    def _failed(self, error: AppError) -> None:
        message = error.message
        self._state.setText(message_text(Message(_AT_CONTROLS.get(message.id, message.id), message.arguments)))

    def _finish(self) -> None:
        self._timer.stop()
        self._set_running(False)

    def _choose(self, field: PathEdit) -> None:
        films = " ".join(f"*{suffix}" for suffix in SUFFIXES)
        kinds, title = f"{self.tr('evaluation_dialog.videos')} ({films})", "evaluation_dialog.film"
        if field is self._keyframes:
            motions = " ".join(f"*{suffix}" for suffix in MOTION_SUFFIXES)
            kinds = f"{self.tr('evaluation_dialog.videos_or_motion')} ({films} {motions})"
            title = "evaluation_dialog.keyframes"
        chosen = ask_for_file(self, self.tr(title), self._near(field), kinds)
        if chosen is not None:
            field.set_path(chosen)

    def _choose_keyframes_folder(self) -> None:
        field = self._keyframes
        chosen = ask_for_folder(self, self.tr("evaluation_dialog.keyframes"), self._near(field))
        if chosen is not None:
            field.set_path(chosen)

    def _near(self, field: PathEdit) -> Path | None:
        return field.path or (None if self._folder.path is None else self._folder.path.parent)

    def _choose_folder(self) -> None:
        chosen = ask_for_folder(self, self.tr("evaluation_dialog.folder"), self._folder.path)
        if chosen is not None:
            self._folder.set_path(chosen)

    def _show_folder(self) -> None:
        if self._folder.path is not None:
            show_folder(self._folder.path)

    def _show_state(self) -> None:
        """Enable the fields, and show what is missing."""
        if self._running:
            return
        film, folder = self._film.path is not None, self._folder.path
        self._place.setEnabled(film)
        self._offset.setEnabled(film and self._place.currentData() == _BY_HAND)
        keyframes = self._keyframes.path is not None
        self._keyframes_place.setEnabled(keyframes)
        self._keyframes_offset.setEnabled(keyframes and self._keyframes_place.currentData() == _BY_HAND)
        for field in (self._excerpts, self._length):
            field.setEnabled(self._bars.bars is None)
        for variant in _OF_FILES:
            self._variants[variant].setEnabled(self._there(variant))
        lacking = ""
        if folder is not None and os.path.lexists(folder / KEY_FILE):
            lacking = message_text(Message("evaluate.there_already", {"file": str(folder)}))
        elif len(self._chosen()) < 2:
            lacking = message_text(Message("evaluate.too_few", {}))
        elif self._bars.problem:
            lacking = self._bars.problem
        self._start.setEnabled(folder is not None and not lacking)
        self._state.setText(lacking)

    def _show_progress(self) -> None:
        share, message = self._now[0]
        self._show_share(share)
        self._state.setText(message_text(message))

    def retranslate(self) -> None:
        super().retranslate()
        if not self._running and not self._show.isVisible():
            self._show_state()


def _seconds(least: float, most: float, value: float, name: str) -> QDoubleSpinBox:
    box = named(QDoubleSpinBox(), name)
    box.lineEdit().setTextMargins(TEXT_MARGIN_PX, 0, 0, 0)
    box.setRange(least, most)
    box.setDecimals(2)
    box.setSingleStep(0.5)
    box.setValue(value)
    return box
