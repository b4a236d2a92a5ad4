"""Export: which players, files and bars, where to; what will be replaced; progress, cancel, show in folder."""

from __future__ import annotations

import threading
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

from PySide6.QtCore import QEvent, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QCloseEvent
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QListWidget,
    QListWidgetItem,
    QProgressBar,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from app.editor.session import Session, Severity
from app.editor.tasks import Progress, StopRequested
from app.editor.tokens import LEAST_TARGET_PX
from app.encoding import shown
from app.errors import AppError, Message
from app.export.request import Request
from app.performance.ensemble import Performance
from app.performance.span import bars_span, whole_span
from app.project.frame_rate import USUAL_RATES, frame_rate_text
from app.project.model import Player
from metadata.load import load_bone_names
from widgets.common.paths import show_folder
from widgets.common.plain import ComboBox, Label
from widgets.common.text import message_text, sentence
from widgets.dialogs.export_destination import Destination, Done, foresee, write
from widgets.dialogs.export_formats import FormatChooser
from widgets.dialogs.export_place import PlaceChooser
from widgets.dialogs.export_range import TEXT_MARGIN_PX, RangeChooser
from widgets.dialogs.export_skeleton import SkeletonChooser

SHOW_MS = 50
"""Progress is shown this often."""
OUTCOME_PX = 84
"""Room for some lines of what comes of an export; more are scrolled to."""
_NAMES = 6
"""Of the files that are replaced or removed, so many are named."""


def _some(names: tuple[str, ...]) -> str:
    return ", ".join(names[:_NAMES]) + (" …" if len(names) > _NAMES else "")


class ExportDialog(QDialog):
    """Writes the players' files; stays usable while it works, and says what was written.

    Parameters
    ----------
    session : Session
    folder : Path
        Where the last export went, or beside the project.
    unreal : Path, optional
        The Unreal project that was exported into before.
    destination : str
        Where the last export went: ``"folder"`` or ``"unreal"``.
    source, creator : str
        Name of the piece's file; program and version, for the report.
    parent : QWidget, optional
    """

    exported = Signal(str, object)
    """The destination, and the place that files were written to."""

    def __init__(
        self,
        session: Session,
        folder: Path,
        source: str,
        creator: str,
        parent: QWidget | None = None,
        unreal: Path | None = None,
        destination: Destination = "folder",
    ) -> None:
        super().__init__(parent)
        self.setObjectName("export_files")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._session, self._source, self._creator = session, source, creator
        # What is exported is the piece as it is now, whatever is edited meanwhile.
        self._project = session.project
        self._running = False
        self._stop = threading.Event()

        self._players = QListWidget()
        self._players.setObjectName("export_players")
        performers = [(one.id, one.name) for one in self._project.bodies]
        performers += [(one.id, one.name) for one in self._project.dancers]
        for performer_id, name in performers:
            item = QListWidgetItem(name)
            item.setData(Qt.ItemDataRole.UserRole, performer_id)
            item.setFlags(Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsUserCheckable | Qt.ItemFlag.ItemIsSelectable)
            item.setCheckState(Qt.CheckState.Checked)
            item.setSizeHint(QSize(0, LEAST_TARGET_PX))
            self._players.addItem(item)
        self._everyone = QPushButton()
        self._everyone.setObjectName("export_everyone")
        self._everyone.setAutoDefault(False)
        self._everyone.clicked.connect(self._toggle_everyone)
        self._place = PlaceChooser(folder, unreal, destination)
        self._shown_folder = folder
        self._formats = FormatChooser()
        self._bvh_names = ComboBox()
        self._bvh_names.setObjectName("export_bvh_names")
        # As wide as there is room, not as the longest title.
        self._bvh_names.setSizeAdjustPolicy(ComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self._bvh_names.addItem("", "")
        for profile, table in load_bone_names().items():
            self._bvh_names.addItem(table.title, profile)
        self._range = RangeChooser(session, self._project.score)
        self._preroll = QDoubleSpinBox()
        self._preroll.setObjectName("export_preroll")
        self._preroll.lineEdit().setTextMargins(TEXT_MARGIN_PX, 0, 0, 0)
        self._preroll.setRange(0.0, 64.0)
        self._preroll.setSingleStep(1.0)
        self._preroll.setDecimals(2)
        self._preroll.setValue(self._project.preroll_beats)
        self._rate = ComboBox()
        self._rate.setObjectName("export_rate")
        for rate in sorted({*USUAL_RATES, self._project.fps}):
            self._rate.addItem(frame_rate_text(rate), str(rate))
        self._rate.setCurrentIndex(self._rate.findData(str(self._project.fps)))
        self._skeleton = SkeletonChooser(session, self._chosen_players)
        self._files = Label()
        self._files.setObjectName("export_outcome")
        self._files.setWordWrap(True)
        self._files.setAlignment(Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignLeft)
        # The excluded players of an orchestra may take more lines than there is room for.
        self._outcome = QScrollArea()
        self._outcome.setFrameShape(QScrollArea.Shape.NoFrame)
        self._outcome.setWidgetResizable(True)
        self._outcome.setWidget(self._files)
        self._outcome.setMinimumHeight(OUTCOME_PX)
        self._progress = QProgressBar()
        self._progress.setRange(0, 1000)
        self._progress.hide()
        self._buttons = QDialogButtonBox()
        self._export = self._buttons.addButton("", QDialogButtonBox.ButtonRole.ActionRole)
        self._export.setObjectName("export_start")
        self._export.setDefault(True)
        self._show = self._buttons.addButton("", QDialogButtonBox.ButtonRole.ActionRole)
        self._show.setObjectName("export_show_folder")
        self._show.hide()
        self._close = self._buttons.addButton("", QDialogButtonBox.ButtonRole.RejectRole)
        self._close.setObjectName("export_close")
        self._export.clicked.connect(self.start)
        self._show.clicked.connect(self._show_folder)
        self._close.clicked.connect(self._close_or_cancel)
        self._share = [0.0]
        """What is written of the whole, set by the thread."""
        self._timer = QTimer(self)
        self._timer.setInterval(SHOW_MS)
        self._timer.timeout.connect(self._show_share)

        self._labels = {
            name: Label()
            for name in ("players", "into", "files", "bvh_names", "skeleton", "range", "preroll", "rate", "outcome")
        }
        self._lay_out()
        for chooser in (self._skeleton, self._place, self._range, self._formats):
            chooser.changed.connect(self._show_outcome)
        self._players.itemChanged.connect(self._show_players)
        self.retranslate()

    def _lay_out(self) -> None:
        left = QVBoxLayout()
        top = QHBoxLayout()
        top.addWidget(self._labels["players"], 1)
        top.addWidget(self._everyone)
        left.addLayout(top)
        left.addWidget(self._players, 1)
        self._form = form = QFormLayout()
        form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        form.addRow(self._labels["into"], self._place)
        form.addRow(self._labels["files"], self._formats)
        form.addRow(self._labels["bvh_names"], self._bvh_names)
        form.addRow(self._labels["skeleton"], self._skeleton)
        form.addRow(self._labels["range"], self._range)
        form.addRow(self._labels["preroll"], self._preroll)
        form.addRow(self._labels["rate"], self._rate)
        form.addRow(self._labels["outcome"], self._outcome)
        columns = QHBoxLayout()
        columns.setSpacing(18)
        columns.addLayout(left, 1)
        columns.addLayout(form, 2)
        layout = QVBoxLayout(self)
        layout.addLayout(columns, 1)
        layout.addWidget(self._progress)
        layout.addWidget(self._buttons)

    # What is requested

    @property
    def player_ids(self) -> tuple[str, ...]:
        """The ticked players and dancers."""
        items = (self._players.item(row) for row in range(self._players.count()))
        return tuple(
            str(item.data(Qt.ItemDataRole.UserRole)) for item in items if item.checkState() == Qt.CheckState.Checked
        )

    def _request(self) -> Request:
        project = replace(self._project, preroll_beats=self._preroll.value())
        performance = Performance(project)
        fps, bars = Fraction(self._rate.currentData()), self._range.bars
        span = (
            whole_span(performance.time_frame, fps)
            if bars is None
            else bars_span(performance, fps, bars, self._preroll.value())
        )
        return Request(
            performance=performance,
            players=self._chosen_players(),
            folder=self._place.path,
            formats=self._formats.formats,
            span=span,
            bars=bars,
            source=self._source,
            creator=self._creator,
            sound=self._formats.sound,
            bvh_names=self._bvh_names.currentData(),
            skeleton=self._skeleton.choice,
            asset=self._skeleton.asset,
            dancers=tuple(dancer for dancer in project.dancers if dancer.id in self.player_ids),
        )

    def _chosen_players(self) -> tuple[Player, ...]:
        requested = set(self.player_ids)
        return tuple(player for player in self._project.players if player.id in requested)

    # Doing it

    def start(self) -> None:
        """Write the files, beside the window."""
        if self._running or not self._export.isEnabled():
            return
        self._running = True
        # The thread gets what it needs, not the dialog.
        self._stop, self._share = stop, written = threading.Event(), [0.0]
        self._progress.setValue(0)
        self._progress.show()
        self._show.hide()
        self._enable(False)
        self.retranslate()
        request, destination = self._request(), self._place.destination

        def work(progress: Progress, stop_requested: StopRequested) -> Done:
            def reported(share: float, label: str) -> None:
                progress(share)
                written[0] = share

            return write(destination, request, lambda: stop.is_set() or stop_requested(), reported)

        self._timer.start()
        self._session.tasks.run(
            Message("work.export"), work, self._done, self._failed, key="export", ended=self._finish
        )

    def _show_share(self) -> None:
        self._progress.setValue(round(1000 * self._share[0]))

    def _done(self, done: Done) -> None:
        if done.project is None:
            text = self.tr("export_dialog.files_written_to").format(folder=shown(done.folder), count=done.count)
            reported = Message("export.done", {"count": done.count, "folder": str(done.folder)})
        else:
            text = self.tr("export_dialog.files_written_into_project_in").format(
                name=done.project.name, count=done.count
            )
            if done.new_plugin:
                text += "\n" + self.tr("export_dialog.if_unreal_has_project_open")
            reported = Message("unreal.done", {"count": done.count, "project": done.project.name})
        # Excluded players come first, all of them.
        lines = [sentence(message) for message in done.left_out] + list(done.warnings[:6])
        self._files.setText(text + "".join(f"\n⚠ {line}" for line in lines))
        self._shown_folder = done.folder
        self._show.show()
        self._session.notice(reported)
        for message in done.left_out[:1]:
            self._session.notice(message, Severity.WARNING)
        self.exported.emit(self._place.destination, self._place.path)

    def _failed(self, error: AppError) -> None:
        self._files.setText(message_text(error.message))

    def _finish(self) -> None:
        self._running = False
        self._timer.stop()
        self._progress.hide()
        self._enable(True)
        self.retranslate()

    def _close_or_cancel(self) -> None:
        if self._running:
            self._stop.set()
        else:
            self.reject()

    def _enable(self, enabled: bool) -> None:
        for widget in (
            *(self._players, self._everyone, self._place, self._formats, self._bvh_names, self._skeleton),
            *(self._range, self._preroll, self._rate, self._export),
        ):
            widget.setEnabled(enabled)

    def _toggle_everyone(self) -> None:
        state = Qt.CheckState.Unchecked if len(self.player_ids) == self._players.count() else Qt.CheckState.Checked
        for row in range(self._players.count()):
            self._players.item(row).setCheckState(state)

    def _show_folder(self) -> None:
        show_folder(self._shown_folder)

    # What will come of it

    def _show_players(self) -> None:
        self._skeleton.compare()
        self._show_outcome()

    def _show_outcome(self) -> None:
        into_folder = self._place.destination == "folder"
        self._form.setRowVisible(self._labels["files"], into_folder)
        self._form.setRowVisible(self._labels["bvh_names"], into_folder and "bvh" in self._formats.formats)
        problem = ""
        if not self.player_ids:
            problem = self.tr("export_dialog.tick_at_least_one_player")
        elif not self._formats.formats and into_folder:
            problem = self.tr("export_dialog.tick_at_least_one_kind")
        else:
            problem = self._range.problem or self._place.problem or self._skeleton.problem
        text = problem
        if not problem:
            try:
                text = self._foreseen()
            except AppError as error:
                problem = text = message_text(error.message)
        self._export.setEnabled(not problem and not self._running)
        self._files.setText(text)

    def _foreseen(self) -> str:
        """What will be written, replaced and removed."""
        performance = Performance(self._project)
        seen = foresee(
            self._place.destination,
            self._place.path,
            performance,
            self.player_ids,
            self._formats.formats,
            self._source,
            self._formats.sound,
        )
        lines = []
        if seen.project is not None:
            engine = self.tr("export_dialog.version_unknown") if seen.project.version is None else seen.project.engine
            lines.append(self.tr("export_dialog.unreal_engine").format(name=seen.project.name, engine=engine))
        lines.append(self.tr("export_dialog.files_that_will_be_written").format(count=seen.count))
        if seen.replaced:
            replaced = self.tr("export_dialog.of_these_will_be_replaced")
            lines.append(replaced.format(count=len(seen.replaced), names=_some(seen.replaced)))
        if seen.removed:
            removed = self.tr("export_dialog.no_longer_needed_will_be")
            lines.append(removed.format(count=len(seen.removed), names=_some(seen.removed)))
        lines += [f"⚠ {message_text(message)}" for message in seen.kept]
        return "\n".join(lines)

    def retranslate(self) -> None:
        """Set every text anew."""
        self.setWindowTitle(self.tr("export_dialog.export"))
        texts = {
            "players": self.tr("export_dialog.performers")
            if self._project.dancers
            else self.tr("export_dialog.players"),
            "into": self.tr("export_dialog.into"),
            "files": self.tr("export_dialog.files"),
            "bvh_names": self.tr("export_dialog.bone_names_in_bvh"),
            "skeleton": self.tr("export_dialog.skeleton"),
            "range": self.tr("export_dialog.range"),
            "preroll": self.tr("export_dialog.pre_roll"),
            "rate": self.tr("export_dialog.frames_per_second"),
            "outcome": "",
        }
        for name, text in texts.items():
            self._labels[name].setText(text)
        self._everyone.setText(self.tr("export_dialog.all_or_none"))
        self._bvh_names.setItemText(0, self.tr("export_dialog.those_of_skeleton"))
        self._preroll.setSuffix(self.tr("export_dialog.beats"))
        self._range.retranslate()
        self._export.setText(self.tr("export_dialog.export"))
        self._show.setText(self.tr("export_dialog.show_in_folder"))
        self._close.setText(self.tr("export_dialog.cancel") if self._running else self.tr("export_dialog.close"))
        if not self._running and not self._show.isVisible():
            self._show_outcome()

    def sizeHint(self) -> QSize:
        return QSize(860, 440)

    def changeEvent(self, event: QEvent) -> None:
        if event.type() == QEvent.Type.LanguageChange:
            self.retranslate()
        super().changeEvent(event)

    def closeEvent(self, event: QCloseEvent) -> None:
        if self._running:
            self._stop.set()
            event.ignore()
            return
        super().closeEvent(event)
