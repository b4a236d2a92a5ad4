"""Dialog with the choreography of the selected dancer: basic motions, their order, and their percussion."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QDialog, QPlainTextEdit, QTabWidget, QWidget

from app.arrays import FloatArray
from app.editor.session import Session
from app.errors import AppError, Message, Progress, StopRequested
from app.performance.ensemble import Performance
from app.project.performers import Dancer
from app.project.undoable_document import Change
from widgets.common.controls import Button, Retranslated, named, wrapped
from widgets.common.help import HelpButton
from widgets.common.layouts import STRETCH, begin_with_size, in_column, in_row, panel
from widgets.common.percussion_names import percussion_names
from widgets.common.plain import Label, verbatim_title
from widgets.common.text import sentence
from widgets.dialogs.choreography.motion_gallery import MotionGallery
from widgets.dialogs.choreography.probability_table import ProbabilityTable, Side
from widgets.dialogs.choreography.transition_graph import TransitionGraph

if TYPE_CHECKING:
    # Modules of dances are loaded only for pieces with dancers.
    from app.choreography.model import ChoreographyModel
    from app.choreography.overview import BasicMotion

_SIZE: Final = QSize(1000, 820)
_MOTION_ROW_PX: Final = 40
_SOUND_ROW_PX: Final = 26
_MOST_NAMED: Final = 3
"""Greatest number of following motions and sounds listed for a basic motion."""


@dataclass(frozen=True, eq=False)
class ChoreographyView:
    """Contents of the dialog.

    Attributes
    ----------
    used : mapping of int to int
        Number of times that the dancer dances each basic motion in the piece.
    symbols : tuple of int
        Percussion symbols that were learned or occur in the piece.
    struck : frozenset of int
        Symbols that occur in the piece.
    derived : bool
        Whether the symbols are derived because the piece has no percussion.
    error : Message or None
        Reason why the dancer does not dance; None if the dancer does.
    """

    dancer: Dancer
    model: ChoreographyModel
    motions: tuple[BasicMotion, ...]
    used: Mapping[int, int]
    symbols: tuple[int, ...]
    struck: frozenset[int]
    derived: bool
    error: Message | None


class ChoreographyDialog(Retranslated, QDialog):
    """Shows the learned contents of the selected dancer's choreography, read-only. Not modal; follows the selection."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("choreography")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._session = session
        self._shown: ChoreographyView | None = None
        self._error: AppError | None = None
        self._asked: tuple[Performance, Dancer] | None = None
        self._heading = wrapped(named(Label(), "choreography_heading"))
        self._use = wrapped(named(Label(), "choreography_use"))
        names = ("motions", "transitions", "graph", "percussion")
        self._hints = {name: wrapped(Label()) for name in names}
        self._details = {name: named(wrapped(Label()), f"choreography_{name}_details") for name in names}
        self.tabs = named(QTabWidget(), "choreography_tabs")
        self.gallery = named(MotionGallery(session), "choreography_motions")
        self.transitions = named(ProbabilityTable(session, _MOTION_ROW_PX), "choreography_transitions")
        self.graph = named(TransitionGraph(session), "choreography_graph")
        self.percussion = named(ProbabilityTable(session, _SOUND_ROW_PX), "choreography_percussion")
        self.credits = named(QPlainTextEdit(), "choreography_credits")
        self._close = Button("choreography_dialog.close", self.close, "choreography_close")
        self._build()
        self.gallery.selected.connect(lambda state: self._details["motions"].setText(self._about(state)))
        self.graph.pointed.connect(lambda state: self._details["graph"].setText(self._about(state)))
        self.transitions.pointed.connect(self._details["transitions"].setText)
        self.percussion.pointed.connect(self._details["percussion"].setText)
        session.dancer_changed.connect(self._ask)
        session.performance_changed.connect(self._ask)
        session.changed.connect(self._changed)
        session.theme_changed.connect(self._show)
        self.retranslate()
        begin_with_size(self, _SIZE)
        self._ask()

    def _build(self) -> None:
        views: tuple[QWidget, ...] = (self.gallery, self.transitions, self.graph, self.percussion)
        for view, hint, details in zip(views, self._hints.values(), self._details.values(), strict=True):
            self.tabs.addTab(panel(in_column(hint, (view, 1), details, margins=(0, 10, 0, 0), spacing=8)), "")
        # Two lines high, so that the cards do not move.
        for name in ("motions", "graph"):
            self._details[name].setMinimumHeight(2 * self._details[name].fontMetrics().lineSpacing() + 2)
            self._details[name].setAlignment(Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignLeft)
        self.credits.setReadOnly(True)
        self.credits.setTabChangesFocus(True)
        self.tabs.addTab(panel(in_column(self.credits, margins=(0, 10, 0, 0))), "")
        titles = (
            "choreography_dialog.basic_motions",
            "choreography_dialog.transitions",
            "choreography_dialog.graph",
            "choreography_dialog.percussion",
            "choreography_dialog.credits",
        )
        self.texted(self.tabs, tabs=titles)
        for view, title in zip((*views, self.credits), titles, strict=True):
            self.texted(view, name=title)
        self.texted(self._hints["motions"], text="choreography_dialog.gallery_heading")
        self.texted(self._hints["transitions"], text="choreography_dialog.transition_table_hint")
        self.texted(self._hints["graph"], text="choreography_dialog.transitions_hint")
        bottom = in_row(HelpButton(), STRETCH, self._close)
        in_column(self._heading, self._use, (self.tabs, 1), bottom, of=self, margins=14, spacing=8)

    # Display

    def _changed(self, change: Change) -> None:
        if change.opened or change.before.dancers is not change.after.dancers:
            self._ask()

    def _ask(self) -> None:
        """Compute the selected dancer's dance in the background."""
        dancer, performance = self._session.dancer, self._session.performance
        if dancer is None:
            self._asked = self._shown = self._error = None
            self._show()
        elif self._asked is None or self._asked[0] is not performance or self._asked[1] is not dancer:
            self._asked = performance, dancer
            self._session.tasks.run(
                Message("work.choreography"),
                _finder(performance, dancer),
                self._found,
                self._failed,
                key="choreography",
            )

    def _found(self, shown: ChoreographyView) -> None:
        if self._asked is not None and self._asked[1] is shown.dancer:
            self._shown, self._error = shown, None
            self._show()

    def _failed(self, error: AppError) -> None:
        self._shown, self._error = None, error
        self._show()

    def _show(self) -> None:
        shown = self._shown
        self.tabs.setVisible(shown is not None)
        self._use.setVisible(shown is not None)
        if shown is None:
            self.setWindowTitle(self.tr("choreography_dialog.choreography"))
            no_dancer = (
                self.tr("choreography_dialog.no_dancer_is_selected")
                if self._asked is None
                else self.tr("choreography_dialog.reading")
            )
            self._heading.setText(sentence(self._error.message) if self._error is not None else no_dancer)
            return
        model = shown.model
        self.setWindowTitle(
            verbatim_title(self.tr("choreography_dialog.choreography_of").format(dancer=shown.dancer.name))
        )
        length_s = sum((one.end - one.start) / float(model.clips[one.clip].fps) for one in model.segments)
        self._heading.setText(
            self.tr("choreography_dialog.model_summary").format(
                name=model.name,
                motions=model.states,
                segments=len(model.segments),
                minutes=round(length_s) // 60,
                seconds=round(length_s) % 60,
                sources=len(model.sources),
            )
        )
        self._use.setText(self._use_text(shown))
        colour, mirrored = self._session.colour(shown.dancer), shown.dancer.mirrored
        self.gallery.show_motions(shown.motions, shown.used, len(model.sources), colour, mirrored)
        self._show_tables(shown, mirrored)
        self.credits.setPlainText(self._credits_text(model))

    def _use_text(self, shown: ChoreographyView) -> str:
        if shown.error is not None:
            return sentence(shown.error, self._session, shown.dancer.id)
        return self.tr("choreography_dialog.dances_of_basic_motions_in").format(
            dancer=shown.dancer.name, used=len(shown.used), count=shown.model.states
        )

    def _show_tables(self, shown: ChoreographyView, mirrored: bool) -> None:
        model, names = shown.model, percussion_names()
        figures: FloatArray = np.array([motion.poses[1] for motion in shown.motions])
        if mirrored:
            figures = figures * (-1.0, 1.0)
        states = Side(
            tuple(str(state + 1) for state in range(model.states)),
            frozenset(shown.used),
            {state: self.tr("choreography_dialog.text").format(count=count) for state, count in shown.used.items()},
            figures,
        )
        self.transitions.show_table(model.transition, states, states, self._followed(model.transition))
        self.graph.show_graph(model.transition, figures, frozenset(shown.used), self._session.colour(shown.dancer))
        symbols = list(shown.symbols)
        marked = frozenset(row for row, symbol in enumerate(symbols) if symbol in shown.struck)
        sounds = Side(tuple(names[symbol] for symbol in symbols), marked, {})
        shares = model.emission[:, symbols].T
        self.percussion.show_table(shares, sounds, states, self._struck(shares, sounds.names))
        self._hints["percussion"].setText(self._percussion_hint(shown.derived))

    def _followed(self, transition: FloatArray) -> Callable[[int, int], str]:
        def text(row: int, column: int) -> str:
            words = (
                self.tr("choreography_dialog.repeat_probability")
                if row == column
                else self.tr("choreography_dialog.transition_probability")
            )
            return words.format(number=row + 1, next=column + 1, share=_percent(transition[row, column]))

        return text

    def _struck(self, shares: FloatArray, names: tuple[str, ...]) -> Callable[[int, int], str]:
        def text(row: int, column: int) -> str:
            return self.tr("choreography_dialog.of_strokes_during_basic_motion").format(
                share=_percent(shares[row, column]), number=column + 1, sound=names[row]
            )

        return text

    def _about(self, state: int) -> str:
        """Return all information about a basic motion; empty for none."""
        shown = self._shown
        if shown is None or not 0 <= state < len(shown.motions):
            return ""
        model, names = shown.model, percussion_names()
        sources = ", ".join(
            f"{Path(model.sources[source].motion_name).stem} ({count})"
            for source, count in shown.motions[state].sources
        )
        parts = [
            self.tr("choreography_dialog.basic_motion").format(number=state + 1),
            self.tr("choreography_dialog.from").format(sources=sources),
            self.tr("choreography_dialog.followed_by").format(
                motions=_most(model.transition[state], [str(number + 1) for number in range(model.states)])
            ),
            self.tr("choreography_dialog.danced_to").format(sounds=_most(model.emission[state], names)),
        ]
        return " · ".join(parts)

    def _credits_text(self, model: ChoreographyModel) -> str:
        """Return the sources as text, grouped by equal credits."""
        together: dict[str, list[str]] = {}
        for source in model.sources:
            names = self.tr("choreography_dialog.with").format(motion=source.motion_name, music=source.music_name)
            together.setdefault(source.credits.strip(), []).append(names)
        none = self.tr("choreography_dialog.no_credits_are_given_for")
        return "\n\n".join("\n".join((*names, "", credits or none)) for credits, names in together.items())

    # Texts

    def retranslate(self) -> None:
        self._hints["percussion"].setText(self._percussion_hint(self._shown is not None and self._shown.derived))
        self._show()

    def _percussion_hint(self, derived: bool) -> str:
        if derived:
            return self.tr("choreography_dialog.percussion_hint")
        return self.tr("choreography_dialog.what_is_struck_during_each_basic_motion_in")


def _finder(performance: Performance, dancer: Dancer) -> Callable[[Progress, StopRequested], ChoreographyView]:
    def work(progress: Progress, stop_requested: StopRequested) -> ChoreographyView:
        from app.choreography.hit_log_odds import learned_symbols
        from app.choreography.model_file import read_model
        from app.choreography.overview import basic_motions
        from app.choreography.performed.dance_steps import dance_of
        from app.choreography.performed.dancers import rhythm_of
        from app.project.choreography_files import choreography_path

        dance = dance_of(performance, dancer)
        model = dance.model if dance.error is None else read_model(choreography_path(dancer.choreography))
        rhythm = rhythm_of(performance)
        struck = frozenset(rhythm.symbols.tolist())
        return ChoreographyView(
            dancer,
            model,
            basic_motions(model),
            Counter(step.state for step in dance.steps),
            tuple(sorted(struck.union(learned_symbols(model)))),
            struck,
            rhythm.derived,
            dance.error,
        )

    return work


def _percent(share: float) -> str:
    return f"{100.0 * share:.1f}"


def _most(shares: FloatArray, names: list[str] | tuple[str, ...]) -> str:
    """Return the names with the largest shares and their percentages, such as "step (40 %)", separated by commas."""
    order = np.argsort(-shares, kind="stable")[:_MOST_NAMED]
    return ", ".join(f"{names[at]} ({100.0 * shares[at]:.0f} %)" for at in order.tolist())
