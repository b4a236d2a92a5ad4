"""Performers on the stage with their poses, texts and marks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from PySide6.QtCore import QObject, QTimer, Signal

from app.arrays import FloatArray
from app.editor.live_poses import LivePoses, WornFaces
from app.editor.poses import PoseSource, same
from app.editor.session import Session, Severity
from app.editor.translated import tr
from app.errors import Message, Progress, StopRequested, raise_if_stopped
from app.messages import text
from app.performance.cast import LeftOut
from app.performance.chunks import Pose
from app.project.camera_bookmarks import OF_INSTRUMENTS, View
from app.project.performers import Dancer, Player
from widgets.common.text import message_text
from widgets.viewport.camera import Camera
from widgets.viewport.cast import Member, Stage
from widgets.viewport.colours_and_lights import Color, rgb
from widgets.viewport.contacts import touches
from widgets.viewport.figures import DrawableFigures, cast_key, is_part_of, load, moved, only, same_figures
from widgets.viewport.handles import TARGETS, Handle, handles
from widgets.viewport.limb_capsules import LimbCapsules, hit
from widgets.viewport.overlay import NameTag, OverlayMarks, over_heads_m
from widgets.viewport.pose_tool import PoseTool
from widgets.viewport.shape_model import LevelsOfDetail
from widgets.viewport.shapes import Shapes

FEW = 12
"""Number of performers up to which figures are loaded at once; with more, the active one is loaded first."""
FRONT_MS = 3000
"""Milliseconds after which the other figures are loaded even if the active player does not move yet."""
REFINED_TOGETHER = 4
"""Number of missing levels of detail made before the next picture: body and instrument of two performers."""
REST_MS = 1500
"""Milliseconds after which missing levels of detail are made once everyone is drawn."""
CONDUCTORS_NAME = "stage.conductor"
PODIUM_NAME_M = 0.5
"""Height of the podium's name above the conductor's place."""


class ViewportScene(QObject):
    """The stage of a session's project for the viewport.

    Parameters
    ----------
    session : Session
        Session with the project.
    poses : PoseSource
        Source of the poses.

    Signals
    -------
    staged()
        The performers on the stage have changed.
    shown()
        The number of players with a pose has changed.
    refined()
        Levels of detail that were missing are made.
    """

    staged = Signal()
    shown = Signal()
    refined = Signal()

    def __init__(self, session: Session, poses: PoseSource, tool: PoseTool, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._session = session
        self._poses: PoseSource = WornFaces(session, LivePoses(session, poses))
        self._tool = tool
        self._loaded: DrawableFigures | None = None
        self._shapes: Shapes | None = None
        """Those of the piece before, which may be worn again."""
        self._refining = False
        self.missing = False
        """True if a pose was missing when it was last requested."""
        self._others = QTimer(self, interval=FRONT_MS, singleShot=True)
        self._others.timeout.connect(self.load)
        self.shown.connect(lambda: self.load() if self._others.isActive() else None)
        self._rest = QTimer(self, interval=REST_MS, singleShot=True)
        self._rest.timeout.connect(self._refine_rest)
        self.shown.connect(lambda: self._rest.start() if self.stage is not None and self.stage.shown.all() else None)

    @property
    def loaded(self) -> DrawableFigures | None:
        """The drawn figures; None before they are loaded."""
        return self._loaded

    @property
    def stage(self) -> Stage | None:
        """The stage with the loaded figures; None before they are loaded."""
        return self._loaded.stage if self._loaded is not None else None

    def set_poses(self, poses: PoseSource) -> None:
        """Set the object from which the drawn poses come; live playing and previewed faces are added to it."""
        self._poses = WornFaces(self._session, LivePoses(self._session, poses))

    # Figures

    def leave(self) -> None:
        """Remove the figures of the previous piece when another is opened, unless both have the same figures."""
        loaded = self._loaded
        if loaded is not None and not same_figures(loaded.key, cast_key(self._session.project)):
            self._loaded, self._shapes = None, loaded.shapes
            self._rest.stop()
            self.staged.emit()

    def load(self) -> None:
        """Load the project's figures that are missing, in the background."""
        self._others.stop()
        project, before = self._session.project, self._loaded
        if before is not None and same_figures(before.key, cast_key(project)):
            if before.key != cast_key(project):
                self._set(moved(project, before))
            return
        shapes = before.shapes if before is not None else self._shapes
        front = self._session.player
        if before is None and front is not None and len(project.seen) > FEW:
            # The others are loaded while this one moves already.
            project = only(project, front)
        self._session.tasks.run(
            Message("work.load_figures"),
            lambda progress, stop_requested: load(project, shapes, progress, stop_requested),
            self._arrived,
            key="viewport.load",
        )

    def refine(self, coarse: Sequence[LevelsOfDetail]) -> None:
        """Make missing levels of detail in the background, after the present picture: the first ones of ``coarse``,
        since the next picture asks for those that are missing then.
        """
        if self._refining:
            return
        self._refining = True

        def make(progress: Progress, stop_requested: StopRequested) -> None:
            nearest = coarse[:REFINED_TOGETHER]
            for number, levels in enumerate(nearest):
                raise_if_stopped(stop_requested)
                levels.complete()
                progress((number + 1) / len(nearest))

        def ended() -> None:
            self._refining = False

        def begin() -> None:
            self._session.tasks.run(
                Message("work.load_figures"), make, lambda _: self.refined.emit(), key="viewport.refine", ended=ended
            )

        # Deferred until the picture is painted.
        QTimer.singleShot(0, self, begin)

    def _refine_rest(self) -> None:
        """Make all missing levels of detail in the background, so that the camera finds none missing."""
        loaded = self._loaded
        if loaded is None:
            return
        figures = (*loaded.shapes.characters.values(), *loaded.shapes.instruments.values())
        missing = [levels for levels in figures if not levels.is_complete]

        def make(progress: Progress, stop_requested: StopRequested) -> None:
            for number, levels in enumerate(missing):
                raise_if_stopped(stop_requested)
                if self._loaded is None or self._loaded.shapes is not loaded.shapes:
                    return
                levels.complete()
                progress((number + 1) / len(missing))

        if missing:
            self._session.tasks.run(
                Message("work.load_figures"), make, lambda _: self.refined.emit(), key="viewport.refine_rest"
            )

    def sent(self, shapes: Shapes) -> None:
        """Drop the vertices of the crowd of ``shapes``, which the graphics card has received."""
        if self._loaded is not None and self._loaded.shapes is shapes:
            self._loaded = replace(self._loaded, crowd=None)

    def _arrived(self, loaded: DrawableFigures) -> None:
        key = cast_key(self._session.project)
        if is_part_of(loaded.key, key):
            self._set(loaded)
            if same_figures(loaded.key, key):
                self._report_left_out(loaded.left_out)
            elif not loaded.stage.shown.any():
                # Loading them now would delay the motion of the one in front.
                self._others.start()
                return
        # Players or positions may have changed meanwhile.
        self.load()

    def _report_left_out(self, left_out: tuple[LeftOut, ...]) -> None:
        if len(left_out) == 1:
            self._session.notice(left_out[0].message(message_text), Severity.WARNING)
        elif left_out:
            names = ", ".join(one.player.name for one in left_out)
            self._session.notice(Message("player.not_seen", {"players": names}), Severity.WARNING)

    def _set(self, loaded: DrawableFigures) -> None:
        self._loaded, self._shapes = loaded, None
        self.staged.emit()

    # Poses

    def pose(self, time_s: float) -> None:
        """Set the poses at a time of those performers for whom they are computed."""
        if self._loaded is not None:
            player_ids = [member.player_id for member in self._members()]
            asked = self._poses.poses(player_ids, time_s)
            self.missing = any(pose is None for pose in asked)
            self.take(dict(zip(player_ids, asked, strict=True)))

    def pose_now(self, time_s: float, player_ids: Sequence[str] | None = None) -> None:
        """Set the poses at a time of all or some performers, and compute missing ones."""
        asked = [member.player_id for member in self._members()] if player_ids is None else player_ids
        self.take({player_id: self._poses.pose_now(player_id, time_s) for player_id in asked})

    def poses(self) -> dict[str, Pose | None]:
        """Return the poses drawn at present by player id; None for a player whose pose is being computed."""
        stage = self.stage
        if stage is None:
            return {}
        return {member.player_id: pose for member, pose in zip(stage.members, stage.poses, strict=True)}

    def take(self, poses: Mapping[str, Pose | None]) -> None:
        """Draw the performers in the given poses, by player id."""
        stage = self.stage
        if stage is not None:
            before = int(stage.shown.sum())
            stage.pose(poses)
            if int(stage.shown.sum()) != before:
                self.shown.emit()

    def is_outdated(self, time_s: float) -> bool:
        """Return whether the pose of any performer at a time differs from the displayed one."""
        shown = self.poses()
        found = self._poses.poses(tuple(shown), time_s)
        # If a pose is not ready the previous one stays.
        return any(pose is not None and not same(pose, own) for pose, own in zip(found, shown.values(), strict=True))

    def lacks(self, time_s: float) -> bool:
        """Return whether the pose of any performer at a time is not computed yet."""
        return any(pose is None for pose in self._poses.poses([one.player_id for one in self._members()], time_s))

    def _members(self) -> tuple[Member, ...]:
        stage = self.stage
        return stage.members if stage is not None else ()

    # Players

    def rows(self) -> list[int]:
        """Return the rows of the selected players, the active one first."""
        return [] if self.stage is None else self.stage.rows(self._session.players)

    def viewed_rows(self, view: View) -> list[int]:
        """Return the rows of the performers that a view is about: the selected players, or in a piece without players
        the selected dancer, unless the view needs an instrument.
        """
        ids = self._session.players if view in OF_INSTRUMENTS else self._session.in_front
        return [] if self.stage is None else self.stage.rows(ids)

    def visible(self, selected: bool) -> list[int]:
        """Return the rows of the performers with a pose: of the selected players, or of all."""
        stage = self.stage
        if stage is None:
            return []
        rows = self.rows() if selected else range(len(stage.members))
        return [row for row in rows if stage.shown[row]]

    def row_at(self, origin_m: FloatArray, direction: FloatArray) -> int | None:
        """Return the row of the first performer that a ray hits."""
        stage = self.stage
        if stage is None or not stage.shown.any():
            return None
        found = hit(LimbCapsules(stage).capsules(), origin_m, direction)
        return found[0] if found is not None else None

    def rings(self, hovered: int | None = None) -> dict[int, Color]:
        """Return the colours of the rings on the floor, by row of the stage: around selected players and dancers, and a
        faint one for the row under the mouse."""
        stage = self.stage
        if stage is None:
            return {}
        selected = {player.id: player for player in self._session.project.seen if self._is_selected(player)}
        rows = {own: stage.index(own) for own in selected}
        rings = {row: rgb(self._session.colour(selected[own])) for own, row in rows.items() if row is not None}
        if hovered is not None and hovered < len(stage.members):
            rings.setdefault(hovered, rgb(self._session.tokens.text_dim))
        return rings

    def podium(self) -> tuple[float, float, Color] | None:
        """Return X, Z (metres) and colour of the conductor's place; None if there is no conductor."""
        place = self._session.project.conducting
        return None if place is None else (place.x_m, place.z_m, rgb(self._session.tokens.text_dim))

    def _is_selected(self, performer: Player | Dancer) -> bool:
        if isinstance(performer, Player):
            played = self._session.project.played_by(performer)
            return any(player.id in self._session.players for player in played)
        dancer = self._session.dancer
        return dancer is not None and performer.id == dancer.id

    # Marks and texts

    def handles(self) -> tuple[Handle, ...]:
        """Return the handles of the first visible selected player while the pose tool is active; otherwise none."""
        stage, rows = self.stage, self.rows()
        return handles(stage, rows[0]) if self._session.viewport.posing and stage is not None and rows else ()

    def marks(self, camera: Camera) -> OverlayMarks:
        """Return names, contact points and handles to be painted over the picture."""
        stage, state, session = self.stage, self._session.viewport, self._session
        if stage is None:
            return OverlayMarks()
        project = session.project
        players = {performer.id: performer for performer in project.performers}
        rows, visible = self.rows(), self.visible(selected=False)
        bodies = [row for row in visible if stage.members[row].has_body]
        known = [(row, players[own]) for row in bodies if (own := stage.members[row].player_id) in players]
        names, skeletons = [], []
        if state.shows("names"):
            places_m = over_heads_m(stage, [row for row, _ in known], camera.up)
            for (_, player), over_m in zip(known, places_m, strict=True):
                selected = self._is_selected(player)
                names.append(NameTag(player.name, session.colour(player) if selected else "", over_m, selected))
            if project.conducting is not None:
                over_m = np.array([project.conducting.x_m, PODIUM_NAME_M, project.conducting.z_m])
                names.append(NameTag(_conductors_name(), "", over_m, False))
        if state.shows("skeleton"):
            skeletons = [(row, session.colour(player)) for row, player in known]
        touched = state.shows("contacts") and bool(rows) and rows[0] in visible
        return OverlayMarks(
            names=names,
            skeletons=skeletons,
            touches=touches(stage, rows[0]) if touched else (),
            handles=self.handles(),
            grasped=self._tool.grasped,
            corrected=self._tool.corrected(TARGETS) if state.posing else frozenset(),
            reading=self._reading(),
        )

    def message(self) -> str:
        """Return the text in the middle of the picture; empty if there is none."""
        loaded = self._loaded
        if not self._session.project.players and not self._session.project.dancers:
            return self.tr("scene.no_players_yet_open_or")
        if loaded is None:
            return self.tr("scene.loading_players")
        if loaded.stage.shown.any():
            return ""
        if loaded.left_out and not loaded.stage.members:
            return "\n".join(message_text(one.message(message_text)) for one in loaded.left_out)
        return self.tr("scene.generating")

    def _reading(self) -> str:
        """Return the angles of the correction that is being dragged as text; empty without a drag."""
        held = self._tool.correction
        if held is None:
            return ""
        parts = []
        if held.up_deg:
            parts.append((self.tr("scene.up") if held.up_deg > 0 else self.tr("scene.down"), held.up_deg))
        if held.left_deg:
            side = self.tr("scene.left") if held.left_deg > 0 else self.tr("scene.right")
            parts.append((side, held.left_deg))
        if held.roll_deg:
            lean = self.tr("scene.lean_left") if held.roll_deg > 0 else self.tr("scene.lean_right")
            parts.append((lean, held.roll_deg))
        return "  ".join(text.format(degrees=f"{abs(value):.1f}") for text, value in parts) or "0°"


def _conductors_name() -> str:
    """Return the conductor's name in the editor's language; in English if none is set, as in a film."""
    said = tr(CONDUCTORS_NAME)
    return text(Message(CONDUCTORS_NAME)) if said == CONDUCTORS_NAME else said
