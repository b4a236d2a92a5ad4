"""Panel for setting the cuts of a motion over a plot of its acceleration."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np
from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QWidget

from app.audio.playback import Playback
from app.choreography.body_pose import body_pose
from app.choreography.cuts_by_hand import Cuts
from app.editor.session import Session
from widgets.common.controls import Button, Caption, Check, IconButton, Retranslated
from widgets.common.layouts import STRETCH, in_column, in_row
from widgets.common.plain import Label
from widgets.dialogs.choreography.cut_figure import PoseFigure
from widgets.dialogs.choreography.cut_plot import CutPlot
from widgets.dialogs.choreography.learn_draft import PairContents, PairDraft, offset_s_of
from widgets.dialogs.choreography.pair_player import PairPlayer

_EMPTY = np.zeros(0), Fraction(60), 0.0, np.zeros(0)


@dataclass(eq=False)
class CutHistory:
    """Undo history of the cuts of a motion; None stands for automatic cuts."""

    done: list[Cuts | None] = field(default_factory=list)
    undone: list[Cuts | None] = field(default_factory=list)
    token: object = None

    def push(self, before: Cuts | None, token: object) -> None:
        """Add the cuts ``before`` a change; changes with the same token (one gesture) are a single step."""
        if token is None or token is not self.token:
            self.done.append(before)
        self.undone.clear()
        self.token = token

    def undo(self, now: Cuts | None) -> Cuts | None:
        """Return the cuts before the last change, which must exist; ``now`` are the present cuts, which
        `redo` returns.
        """
        self.undone.append(now)
        self.token = None
        return self.done.pop()

    def redo(self, now: Cuts | None) -> Cuts | None:
        """Return the cuts undone last, which must exist; ``now`` are the present cuts, which `undo` returns."""
        self.done.append(now)
        self.token = None
        return self.undone.pop()


class CutPanel(Retranslated, QWidget):
    """Panel with plot, figure and tools for the cuts of a motion.

    Signals
    -------
    changed(tuple of Cut or None)
        The user changed the cuts; None for the automatic ones.
    """

    changed = Signal(object)

    def __init__(self, session: Session, playback: Playback, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._draft, self._found, self._history = PairDraft(), PairContents(), CutHistory()
        self.plot, self.figure = CutPlot(session), PoseFigure(session)
        self.player = PairPlayer(session, playback)
        self._title, self._place, self._hint = Label(), Label(), Caption("cut_panel.plot_tip")
        self._place.setObjectName("cut_place")
        self._hint.setObjectName("cut_hint")
        self._hint.setWordWrap(True)
        self._buttons = {
            "undo": IconButton(session, "undo", "cut_panel.undo_ctrl_z", self.undo, "cut_undo"),
            "redo": IconButton(session, "redo", "cut_panel.redo_ctrl_shift_z", self.redo, "cut_redo"),
            "fit": IconButton(session, "fit", "cut_panel.whole_motion_f", self.plot.fit, "cut_fit"),
        }
        self._snap = self.texted(Check("cut_panel.snap"), tip="cut_panel.cuts_stop_at_minima_accents")
        self._reset = Button("cut_panel.reset_to_automatic", lambda: self._edit(None, None), "cut_reset")
        self._snap.setObjectName("cut_snap")
        self._snap.setChecked(True)
        tools = in_row(self._title, STRETCH, self._place, 14, *self._buttons.values(), self._snap, self._reset)
        pictures = in_row((self.plot, 1), self.figure)
        in_column(tools, (pictures, 1), self.player, self._hint, of=self, margins=0)
        self.plot.edited.connect(self._edit)
        self.plot.pointed.connect(self._point_at)
        self.plot.scrubbed.connect(self.player.scrub)
        self.player.moved.connect(self._follow)
        self._snap.toggled.connect(self._set_snaps)
        for key, step in ((QKeySequence.StandardKey.Undo, self.undo), (QKeySequence.StandardKey.Redo, self.redo)):
            QShortcut(QKeySequence(key), self).activated.connect(step)
        play = QShortcut(QKeySequence(Qt.Key.Key_Space), self.plot)
        play.setContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
        play.activated.connect(self.player.toggle)
        self.texted(self.plot.plot, name="cut_panel.cuts_of_motion")
        self.retranslate()

    def show_pair(self, draft: PairDraft, found: PairContents, history: CutHistory) -> None:
        """Show motion, cuts and undo history of a pair of motion and music."""
        before, read, analysis = self._found, found.read, found.analysis
        self._draft, self._found, self._history = draft, found, history
        self.player.show_pair(draft, found)
        if read is None or analysis is None:
            self.plot.setEnabled(False)
            self.plot.show_playhead(None)
            self.figure.show_pose(None)
            self._place.setText("")
            if before.analysis is not None:
                self.plot.show_motion(*_EMPTY)
                self.plot.show_unfit(())
        else:
            start_s = read.motion.start_s
            hits_s = read.pair.rhythm.hits_s + offset_s_of(draft, found)
            if before.analysis is not analysis:
                self.plot.show_motion(analysis.segmentation.curve_rad_s2, analysis.clip.fps, start_s, hits_s)
                self.plot.show_unfit(analysis.unfit)
                self.plot.show_playhead(start_s)
                self._point(0)
            else:
                self.plot.show_hits(hits_s)
            self.plot.setEnabled(True)
            self.plot.show_cuts(analysis.segmentation.cuts if draft.cuts is None else draft.cuts)
        self._show_tools()

    def undo(self) -> None:
        """Undo the last change of the pair's cuts."""
        if self._history.done and self.plot.isEnabled():
            self.changed.emit(self._history.undo(self._draft.cuts))

    def redo(self) -> None:
        """Redo the last undone change."""
        if self._history.undone and self.plot.isEnabled():
            self.changed.emit(self._history.redo(self._draft.cuts))

    def _edit(self, cuts: Cuts | None, token: object) -> None:
        if cuts != self._draft.cuts:
            self._history.push(self._draft.cuts, token)
            self.changed.emit(cuts)

    def _point_at(self, frame: int) -> None:
        """Show the frame under the mouse, unless the motion is played."""
        if not self.player.is_playing:
            self._point(frame)

    def _follow(self, time_s: float) -> None:
        """Move the playhead of plot and figure to a time in seconds."""
        if self._found.analysis is not None:
            self.plot.show_playhead(time_s)
            self._point(self.plot.frame_of(time_s))

    def _point(self, frame: int) -> None:
        analysis = self._found.analysis
        if analysis is not None:
            self.figure.show_pose(body_pose(analysis.clip, frame))
            time_s = float(self.plot.time_s(frame))
            self._place.setText(
                self.tr("cut_panel.s_rad_s").format(
                    time=f"{time_s:.3f}", acceleration=f"{analysis.segmentation.curve_rad_s2[frame]:.1f}"
                )
            )

    def _set_snaps(self, snaps: bool) -> None:
        self.plot.snaps = snaps

    def _show_tools(self) -> None:
        free = self.plot.isEnabled()
        self._buttons["undo"].setEnabled(free and bool(self._history.done))
        self._buttons["redo"].setEnabled(free and bool(self._history.undone))
        self._buttons["fit"].setEnabled(free)
        self._reset.setEnabled(free and self._draft.cuts is not None)
        count = len(self.plot.cuts)
        self._title.setText(
            ""
            if self._found.analysis is None
            else self.tr("cut_panel.segments_found").format(n=count)
            if self._draft.cuts is None
            else self.tr("cut_panel.manual_segments").format(n=count)
        )

    def retranslate(self) -> None:
        self._show_tools()
