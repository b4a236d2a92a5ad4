"""Export dialog: players, formats, bars, destination, replaced files, progress, and opening the folder."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

from PySide6.QtCore import QSize, Qt, QTimer, Signal
from PySide6.QtWidgets import QListWidget, QListWidgetItem, QScrollArea, QWidget

from app.editor.design_tokens import LEAST_TARGET_PX
from app.editor.exported_bars import WHOLE_PIECE, ExportedBars
from app.editor.session import Session, Severity
from app.encoding import shown
from app.errors import AppError, Message, Progress, StopRequested
from app.export.foreseen import foresee_folder, foresee_unreal
from app.export.formats import refuse_attachment, requested
from app.export.request import ExportRequest
from app.formats.images import TEXTURE_SIZES, USUAL_TEXTURE_PX, TextureSize
from app.formats.keys import KEY_CHOICES, KeyChoice
from app.formats.levels_of_detail import LEVEL_CHOICES, LevelChoice, levels_for
from app.performance.ensemble import Performance
from app.performance.span import bars_span
from app.project.frame_rate import USUAL_RATES, frame_rate_text
from app.project.performers import Player
from widgets.common.controls import Button, Caption, named, selectable, wrapped
from widgets.common.layouts import Scrolled, begin_with_size, in_column, in_form, in_row
from widgets.common.paths import show_folder
from widgets.common.plain import ComboBox, Label
from widgets.common.text import sentence
from widgets.dialogs.export_choices import bone_name_profiles, levels_of_detail, texture_sizes
from widgets.dialogs.export_destination import Destination, Done, Written, write
from widgets.dialogs.export_face import FaceChooser
from widgets.dialogs.export_formats import FormatChooser
from widgets.dialogs.export_place import PlaceChooser
from widgets.dialogs.export_range import BeatsBox, RangeChooser
from widgets.dialogs.export_rig import RigChooser
from widgets.dialogs.export_skeleton import SkeletonChooser
from widgets.dialogs.progress_dialog import WorkingDialog, stopping

SHOW_MS = 50
"""Interval of progress updates in milliseconds."""
OUTCOME_PX = 84
"""Height in pixels of the result, which scrolls if longer."""
_NAMES = 6
"""Greatest number of replaced or removed files that are listed."""


def _some(names: tuple[str, ...]) -> str:
    return ", ".join(names[:_NAMES]) + (" …" if len(names) > _NAMES else "")


class ExportDialog(WorkingDialog):
    """Dialog that exports players' files in the background, and shows the result.

    Parameters
    ----------
    session : Session
        Session with the piece.
    folder : Path
        Folder of the last export, or that of the project.
    unreal : Path, optional
        Unreal project of the last export.
    destination : str
        Kind of the last destination: ``"folder"`` or ``"unreal"``.
    keys : str
        Last choice of `KEY_CHOICES`.
    texture_px : int
        Last choice of `TEXTURE_SIZES`.
    levels : int
        Last choice of `LEVEL_CHOICES`.
    before : ExportedBars
        Bars of the piece's last export.
    source, creator : str
        Name of the piece's file; program and version, for the report.
    parent : QWidget, optional
    """

    exported = Signal(str, object)
    """Signal: kind of the destination, and its path."""

    def __init__(
        self,
        session: Session,
        folder: Path,
        source: str,
        creator: str,
        parent: QWidget | None = None,
        *,
        unreal: Path | None = None,
        destination: Destination = "folder",
        keys: KeyChoice = "every",
        texture_px: TextureSize = USUAL_TEXTURE_PX,
        levels: LevelChoice = 0,
        before: ExportedBars = WHOLE_PIECE,
    ) -> None:
        super().__init__("export_files", "export", parent)
        self._session, self._source, self._creator = session, source, creator
        # The piece is exported as it is now, regardless of later edits.
        self._project = session.project
        self._players = named(QListWidget(), "export_players")
        self._list_players()
        self._everyone = Button("export_dialog.select_all", self._toggle_everyone, "export_everyone")
        self._place = PlaceChooser(folder, unreal, destination)
        self._shown_folder = folder
        self._formats = FormatChooser()
        self._bvh_names = bone_name_profiles(self)
        self._keys = self.texted(named(ComboBox(), "export_keys"), tip="export_dialog.reduced_keys_tip")
        key_texts = ("export_dialog.key_on_every_frame", "export_dialog.reduced_keys", "export_dialog.linear_keys")
        self.texted(self._keys, options=dict(zip(KEY_CHOICES, key_texts, strict=True)))
        self._keys.setCurrentIndex(KEY_CHOICES.index(keys))
        self._textures, self._levels = texture_sizes(self, texture_px), levels_of_detail(self, levels)
        self._range = RangeChooser(session, self._project.score)
        self._range.begin_with(before.bars)
        self._preroll = self.texted(BeatsBox("export_preroll"), suffix="export_dialog.beats")
        self._preroll.setValue(self._project.preroll_beats)
        self._lead_in = self.texted(
            BeatsBox("export_lead_in"), suffix="export_dialog.beats", tip="export_dialog.lead_in_tip"
        )
        self._lead_in.setValue(before.lead_in_beats)
        self._rate = named(ComboBox(), "export_rate")
        for rate in sorted({*USUAL_RATES, self._project.fps}):
            self._rate.addItem(frame_rate_text(rate), str(rate))
        self._rate.setCurrentIndex(self._rate.findData(str(self._project.fps)))
        self._skeleton = SkeletonChooser(session, self._chosen_players)
        self._skeleton.set_destination(destination)
        self._rig = RigChooser()
        self._face = FaceChooser()
        self._files = selectable(wrapped(named(Label(), "export_outcome")))
        self._files.setAlignment(Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignLeft)
        # The list of excluded players of an orchestra may need more lines than fit.
        self._outcome = QScrollArea()
        self._outcome.setFrameShape(QScrollArea.Shape.NoFrame)
        self._outcome.setWidgetResizable(True)
        self._outcome.setWidget(self._files)
        self._outcome.setMinimumHeight(OUTCOME_PX)
        self._written = Written(())
        self._timer = QTimer(self, interval=SHOW_MS)
        self._timer.timeout.connect(self._show_written)
        self._lay_out()
        self._place.changed.connect(lambda: self._skeleton.set_destination(self._place.destination))
        for chooser in (self._skeleton, self._rig, self._place, self._range, self._formats):
            chooser.changed.connect(self._show_outcome)
        self._keys.currentIndexChanged.connect(self._show_outcome)
        self._players.itemChanged.connect(self._show_players)
        self.texted(self, title="export_dialog.export")
        self.retranslate()
        # Room for two more rows: the current work and its progress.
        begin_with_size(self, self.sizeHint() + QSize(0, 2 * LEAST_TARGET_PX))

    def _list_players(self) -> None:
        project = self._project
        performers = [(one.id, one.name) for one in project.bodies]
        performers += [(one.id, one.name) for one in project.dancers]
        for performer_id, name in performers:
            item = QListWidgetItem(name)
            item.setData(Qt.ItemDataRole.UserRole, performer_id)
            item.setFlags(Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsUserCheckable | Qt.ItemFlag.ItemIsSelectable)
            item.setCheckState(Qt.CheckState.Checked)
            item.setSizeHint(QSize(0, LEAST_TARGET_PX))
            self._players.addItem(item)

    def _lay_out(self) -> None:
        title = Caption("export_dialog.performers" if self._project.dancers else "export_dialog.players")
        left = in_column(in_row((title, 1), self._everyone), (self._players, 1))
        self._form = in_form(
            {
                "export_dialog.into": self._place,
                "export_dialog.files": self._formats,
                "export_dialog.bone_names_in_bvh": self._bvh_names,
                "export_dialog.keys": self._keys,
                "export_dialog.textures": self._textures,
                "export_dialog.levels_of_detail": self._levels,
                "export_dialog.skeleton": self._skeleton,
                "export_dialog.rig": self._rig,
                "export_dialog.face": self._face,
                "export_dialog.range": self._range,
                "export_dialog.pre_roll": self._preroll,
                "export_dialog.lead_in": self._lead_in,
                "export_dialog.frames_per_second": self._rate,
            }
        )
        self._form.addRow(Label(), self._outcome)
        self.fields = (self._players, self._everyone, self._place, self._formats, self._bvh_names, self._keys)
        self.fields += (self._textures, self._levels, self._skeleton, self._rig, self._face)
        self.fields += (self._range, self._preroll, self._lead_in, self._rate)
        columns = in_row((left, 1), (named(Scrolled(self._form), "export_choices"), 2), spacing=18)
        buttons = self._box("export_dialog.export", self.start, self._show_folder)
        in_column((columns, 1), self._under_way, self._progress, buttons, of=self)

    # Request

    @property
    def player_ids(self) -> tuple[str, ...]:
        """Ids of the ticked players and dancers."""
        items = (self._players.item(row) for row in range(self._players.count()))
        return tuple(
            str(item.data(Qt.ItemDataRole.UserRole)) for item in items if item.checkState() == Qt.CheckState.Checked
        )

    @property
    def keys(self) -> KeyChoice:
        """Choice of the frames that get keys in the exported files."""
        return KEY_CHOICES[self._keys.currentIndex()]

    @property
    def texture_px(self) -> TextureSize:
        """The chosen size of textures in pixels; 0 for none."""
        return TEXTURE_SIZES[self._textures.currentIndex()]

    @property
    def levels(self) -> LevelChoice:
        """The chosen number of levels of detail; 0 for the usual number."""
        return LEVEL_CHOICES[self._levels.currentIndex()]

    @property
    def chosen_bars(self) -> ExportedBars:
        """Bars to export, with the number of beats before them that are exported too."""
        return ExportedBars(self._range.bars, self._lead_in.value())

    def _request(self) -> ExportRequest:
        fps, bars = Fraction(self._rate.currentData()), self._range.bars
        # The visible field determines the pre-roll.
        project = self._project if bars else replace(self._project, preroll_beats=self._preroll.value())
        performance = Performance(project)
        span = bars_span(performance, fps, bars or (None, None), self._lead_in.value())
        return ExportRequest(
            performance=performance,
            players=self._chosen_players(),
            folder=self._place.path,
            formats=self._formats.formats,
            span=span,
            bars=bars,
            source=self._source,
            creator=self._creator,
            sound=self._formats.sound,
            stage=self._formats.stage,
            motion_only=self._formats.motion_only and self._place.destination == "folder",
            props=self._formats.props,
            bvh_names=self._bvh_names.currentData(),
            keys=self.keys if self._place.destination == "folder" else "every",
            texture_px=self.texture_px,
            levels=levels_for(self.levels, self._place.destination == "unreal"),
            skeleton=self._skeleton.choice,
            rig=self._rig.options,
            face=self._face.options,
            asset=self._skeleton.asset,
            dancers=tuple(dancer for dancer in project.dancers if dancer.id in self.player_ids),
        )

    def _chosen_players(self) -> tuple[Player, ...]:
        requested = set(self.player_ids)
        return tuple(player for player in self._project.players if player.id in requested)

    # Export

    def start(self) -> None:
        """Write the files, in the background."""
        if self._running or not self._start.isEnabled():
            return
        self._show.hide()
        self._set_running(True)
        stop = self._stop
        request, destination = self._request(), self._place.destination
        performers = {player.name for player in request.players} | {dancer.name for dancer in request.dancers}
        self._written = written = Written(performers)

        def work(progress: Progress, stop_requested: StopRequested) -> Done:
            def reported(share: float, label: str) -> None:
                progress(share)
                written.report(share, label)

            return write(destination, request, stopping(stop, stop_requested), reported)

        self._timer.start()
        self._session.tasks.run(
            Message("work.export"), work, self._done, self._failed, key="export", ended=self._finish, writes=True
        )

    def _show_written(self) -> None:
        written = self._written
        label, number, count = written.label, written.number, len(written.performers)
        if number is None:
            doing = self.tr("export_dialog.under_way").format(what=label) if label else ""
        else:
            counted = "export_dialog.performer_under_way" if self._project.dancers else "export_dialog.player_under_way"
            doing = self.tr(counted).format(name=label, number=number, count=count)
        self._show_share(written.share, doing)

    def _done(self, done: Done) -> None:
        self._under_way.hide()
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
        # All excluded players come first.
        lines = [sentence(message) for message in done.left_out] + list(done.warnings[:6])
        self._files.setText(text + "".join(f"\n⚠ {line}" for line in lines))
        self._shown_folder = done.folder
        self._show.show()
        self._session.notice(reported)
        for message in done.left_out[:1]:
            self._session.notice(message, Severity.WARNING)
        self.exported.emit(self._place.destination, self._place.path)

    def _failed(self, error: AppError) -> None:
        self._files.setText(sentence(error.message))

    def _finish(self) -> None:
        self._timer.stop()
        self._set_running(False)

    def _toggle_everyone(self) -> None:
        state = Qt.CheckState.Unchecked if len(self.player_ids) == self._players.count() else Qt.CheckState.Checked
        for row in range(self._players.count()):
            self._players.item(row).setCheckState(state)

    def _show_folder(self) -> None:
        show_folder(self._shown_folder)

    # Preview

    def _show_players(self) -> None:
        self._skeleton.compare()
        self._show_outcome()

    def _show_outcome(self) -> None:
        into_folder = self._place.destination == "folder"
        self._formats.show_for(into_folder)
        self._face.set_names_shown(into_folder)
        kinds = requested(self._formats.formats) if into_folder else ()
        self._form.setRowVisible(self._bvh_names, any(kind.bones_by_name for kind in kinds))
        self._form.setRowVisible(self._keys, any(kind.reduces_keys for kind in kinds))
        for surfaces in (self._textures, self._levels):
            self._form.setRowVisible(surfaces, not into_folder or any(kind.textured for kind in kinds))
        self._form.setRowVisible(self._preroll, self._range.bars is None)
        self._form.setRowVisible(self._lead_in, self._range.bars is not None)
        if not self.player_ids:
            problem = self.tr("export_dialog.tick_at_least_one_player")
        elif not self._formats.formats and into_folder:
            problem = self.tr("export_dialog.tick_at_least_one_kind")
        else:
            problem = self._range.problem or self._place.problem or self._skeleton.problem
        text = problem
        if not problem:
            try:
                refuse_attachment(self._formats.formats if into_folder else (), self._rig.options.instrument)
                text = self._foreseen()
            except AppError as error:
                problem = text = sentence(error.message)
        self._start.setEnabled(not problem and not self._running)
        self._files.setText(text)

    def _foreseen(self) -> str:
        """Return a text about the files that the export will write, replace and remove."""
        performance, ids, bars = Performance(self._project), self.player_ids, self._range.bars
        place, made, source = self._place.path, self._formats, self._source
        if self._place.destination == "unreal":
            seen = foresee_unreal(place, performance, ids, source, bars, made.props)
        else:
            seen = foresee_folder(
                place,
                performance,
                ids,
                made.formats,
                source,
                made.sound,
                made.stage,
                bars=bars,
                props=made.props,
                motion_only=made.motion_only,
                keys=self.keys,
            )
        lines = []
        if seen.project is not None:
            engine = "" if seen.project.version is None else f" {seen.project.engine}"
            lines.append(self.tr("export_dialog.unreal_engine").format(name=seen.project.name, engine=engine))
        lines.append(self.tr("export_dialog.file_count").format(count=seen.count))
        if seen.replaced:
            replaced = self.tr("export_dialog.of_these_will_be_replaced")
            lines.append(replaced.format(count=len(seen.replaced), names=_some(seen.replaced)))
        if seen.removed:
            removed = self.tr("export_dialog.removed_files")
            lines.append(removed.format(count=len(seen.removed), names=_some(seen.removed)))
        lines += [f"⚠ {sentence(message)}" for message in (*seen.kept, *seen.remarks)]
        return "\n".join(lines)

    def retranslate(self) -> None:
        super().retranslate()
        if not self._running and not self._show.isVisible():
            self._show_outcome()
