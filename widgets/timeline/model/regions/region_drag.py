"""Drag of regions in a lane, which results in a single edit."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from typing import Protocol

from msgspec.structs import replace

from app.editor.edit_names import edit_of_events
from app.editor.selection import EventKey, Selection
from app.errors import Message
from app.plan.by_hand.corrections import SetBreath
from app.plan.model import PlayerPlan
from app.project.edit.corrections import Edited
from app.project.edit.events import corrections_of, move, resize, set_amounts, set_fades
from app.project.model import Project
from widgets.timeline.model.gestures import DRAG_PX, Band, Editing, LiveEdit, MouseGesture, Plane, either, moved_edge
from widgets.timeline.model.lane_mouse import LaneMouse, PixelRect
from widgets.timeline.model.regions.shown_event import Region

MOST_FADE_S = 30.0
FINE = 0.2
"""Factor of the mouse's distance with Shift for changing an amount."""

Edit = Callable[[Project, PlayerPlan, Sequence[str]], Edited]


class RegionPlane(Plane, Protocol):
    """Scales of a lane with regions, and the limits within which they can be moved; a protocol, since lanes are
    widgets.
    """

    @property
    def session(self) -> Editing: ...
    @property
    def regions(self) -> Sequence[Region]: ...
    def place(self, region: Region) -> PixelRect: ...
    def row_box(self, row: int) -> tuple[float, float]: ...
    def snap(self, tick: float, mouse: LaneMouse) -> int: ...
    def snapped_move(self, region: Region, ticks: float, mouse: LaneMouse) -> int: ...


class RegionDrag(MouseGesture):
    """A press that may become a drag of all selected regions, or a lasso.

    Parameters
    ----------
    region : Region or None
        Region under the mouse.
    zone : str
        Part of the region under the mouse.
    before : Selection
        The selection before the press.

    Attributes
    ----------
    mode : str
        Empty until the mouse has moved far enough; ``lasso``, ``move``, ``start``, ``end``, ``amount``, ``fade_in``,
        ``fade_out`` or ``none``.
    preview : mapping of EventKey to Region
        Dragged regions at their new places, until a new plan contains them.
    hidden : frozenset of EventKey
        Regions of the plan that the preview replaces.
    """

    def __init__(
        self, lane: RegionPlane, region: Region | None, zone: str, mouse: LaneMouse, before: Selection
    ) -> None:
        session = lane.session
        selected = session.selection.events
        super().__init__(mouse, either(DRAG_PX))
        self._lane = lane
        self.region = region
        self._zone = zone
        self._before = before
        self._step = LiveEdit(session, lane)
        self._band = Band(lane, mouse, either(DRAG_PX), self._select_inside)
        self._plans: Mapping[str, PlayerPlan] = session.performance.plans if session.performance.planned else {}
        self._shown = {item.key: item for item in lane.regions if item.key in selected and not item.removed}
        together = selected if region is not None and region.key in selected else ()
        # Selected events of players that were removed, or are not planned yet, do not move.
        known = {player.id for player in session.project.players} & set(self._plans)
        self._keys = tuple(sorted(key for key in together if key.player_id in known))
        self.mode = ""
        self.preview: dict[EventKey, Region] = {}
        self.hidden: frozenset[EventKey] = frozenset()

    @property
    def lasso(self) -> PixelRect | None:
        """Rectangle of a drag that selects regions; None for another drag."""
        return self._band.box

    @property
    def edits(self) -> bool:
        """True if the drag has changed the project."""
        return self.mode not in ("", "lasso", "none")

    def follow(self, mouse: LaneMouse) -> None:
        if not self.mode:
            self.mode = self._mode_for(abs(mouse.y_px - self.at.y_px) > abs(mouse.x_px - self.at.x_px))
        region = self.region
        if self.mode == "lasso":
            self._band.drag(mouse)
        elif region is not None and self._keys and self.edits:
            if self.mode == "amount":
                self._change_amount(region, mouse)
            elif self.mode in ("fade_in", "fade_out"):
                self._change_fade(region, mouse)
            else:
                self._place(region, mouse)

    def finish(self, mouse: LaneMouse) -> None:
        if self.edits:
            self._step.end()

    def click(self, mouse: LaneMouse) -> None:
        """Handle a click: select the region, or deselect all if there is none."""
        if not (mouse.ctrl or mouse.shift):
            keys = frozenset({self.region.key}) if self.region is not None else frozenset[EventKey]()
            self._lane.session.select(Selection(events=keys))

    def cancel(self) -> None:
        """Undo the drag without an undo step."""
        session = self._lane.session
        if self.mode == "lasso":
            session.select(self._before)
        elif self.edits:
            self._step.take_back()
            session.select(Selection(events=frozenset(self._keys)))

    def _mode_for(self, across: bool) -> str:
        region = self.region
        if region is None:
            return "lasso"
        if region.removed or region.fixed or not self._plans:
            return "none"
        if self._zone != "body":
            return self._zone
        if across:
            return "none" if region.steady else "amount"
        return "move"

    def _select_inside(self, box: PixelRect, _mouse: LaneMouse) -> None:
        lane = self._lane
        inside = {region.key for region in lane.regions if not region.guest and lane.place(region).meets(box)}
        if self.at.ctrl or self.at.shift:
            inside |= self._before.events
        lane.session.select(Selection(events=frozenset(inside)))

    def _place(self, region: Region, mouse: LaneMouse) -> None:
        """Move the selected regions, or their start or end, as far as the mouse dragged ``region``."""
        lane, ticks = self._lane, mouse.tick - self.at.tick
        start = end = 0
        if self.mode == "move":
            start = end = lane.snapped_move(region, ticks, mouse)
        else:
            at_start = self.mode == "start"
            tick = lane.snap((region.start_tick if at_start else region.end_tick) + ticks, mouse)
            first, last = moved_edge(region.start_tick, region.end_tick, at_start, tick)
            start, end = first - region.start_tick, last - region.end_tick

        def edit(project: Project, plan: PlayerPlan, ids: Sequence[str]) -> Edited:
            if self.mode == "move":
                return move(project, plan, ids, start)
            return Edited(resize(project, plan, ids, start, end), tuple(ids))

        name = "edit.move_events" if self.mode == "move" else "edit.resize_events"
        preview = {
            key: self._at_ticks(item, item.start_tick + start, item.end_tick + end) for key, item in self._shown.items()
        }
        self._apply(edit_of_events(lane.session, name, self._keys), edit, preview)

    def _change_amount(self, region: Region, mouse: LaneMouse) -> None:
        """Change the amounts of all selected regions by the same difference as ``region``'s."""
        height = max(self._lane.row_box(region.row)[1] - 2.0, 1.0)
        change = (self.at.y_px - mouse.y_px) / height * (2.0 if region.signed else 1.0)
        if mouse.shift:
            change *= FINE
        preview = {}
        for key, item in self._shown.items():
            if not item.steady:
                amount = round(min(max(item.amount + change, -1.0 if item.signed else 0.0), 1.0), 3)
                preview[key] = replace(item, amount=amount, by_hand=True)

        def edit(project: Project, plan: PlayerPlan, ids: Sequence[str]) -> Edited:
            keys = [EventKey(plan.player_id, event_id) for event_id in ids]
            amounts = {key.event_id: preview[key].amount for key in keys if key in preview}
            return Edited(set_amounts(project, plan, amounts), tuple(ids))

        self._apply(edit_of_events(self._lane.session, "edit.set_event_amounts", self._keys), edit, preview)

    def _change_fade(self, region: Region, mouse: LaneMouse) -> None:
        by_s, most_s = mouse.time_s - self.at.time_s, region.end_s - region.start_s
        if region.fades_outside:
            by_s, most_s = -by_s, MOST_FADE_S
        into = min(max(region.fade_in_s + by_s, 0.0), most_s) if self.mode == "fade_in" else None
        out = min(max(region.fade_out_s - by_s, 0.0), most_s) if self.mode == "fade_out" else None

        def edit(project: Project, plan: PlayerPlan, ids: Sequence[str]) -> Edited:
            return Edited(set_fades(project, plan, ids, into, out), tuple(ids))

        shown = replace(
            region,
            by_hand=True,
            fade_in_s=region.fade_in_s if into is None else into,
            fade_out_s=region.fade_out_s if out is None else out,
        )
        self._apply(Message("edit.set_fades"), edit, {region.key: shown})

    def _apply(self, name: Message, edit: Edit, preview: Mapping[EventKey, Region]) -> None:
        """Apply an edit to the project as before the drag, show ``preview`` until it is planned, and select events with
        new ids.
        """
        session = self._lane.session
        by_player: dict[str, list[str]] = defaultdict(list)
        for key in self._keys:
            by_player[key.player_id].append(key.event_id)
        new_keys: dict[EventKey, EventKey] = {}

        def whole(project: Project) -> Project:
            for player_id, ids in by_player.items():
                project, new_ids = edit(project, self._plans[player_id], ids)
                for old, new in zip(ids, new_ids, strict=True):
                    new_keys[EventKey(player_id, old)] = EventKey(player_id, new)
            return project

        # Set before the edit, because drawing starts when the edit is reported.
        self.preview = dict(preview)
        self.hidden = frozenset(self._keys)
        if not self._step.attempt(name, whole):
            return
        self.preview = {
            new_keys[key]: self._as_corrected(replace(region, event_id=new_keys[key].event_id))
            for key, region in preview.items()
            if key in new_keys
        }
        self.hidden = frozenset(preview) | frozenset(self.preview)
        session.select(Selection(events=frozenset(new_keys.values())))

    def _as_corrected(self, region: Region) -> Region:
        """Return a region limited as a correction is: a breath ends at its note's start at the latest."""
        project = self._lane.session.project
        for item in corrections_of(project, region.player_id, (region.event_id,)):
            if isinstance(item, SetBreath):
                notes = project.part(project.player(region.player_id)).notes
                onset = next((note.onset_tick for note in notes if note.id == item.note_id), None)
                if onset is not None:
                    return self._at_ticks(region, onset + item.start_offset_tick, onset + item.end_offset_tick)
        return region

    def _at_ticks(self, region: Region, start: int, end: int) -> Region:
        seconds = self._step.base.score.tempo_map.seconds
        start_s = seconds(float(start))
        return replace(
            region,
            start_tick=start,
            end_tick=max(end, start + 1),
            start_s=start_s,
            end_s=seconds(float(max(end, start + 1))),
            peak_s=region.peak_s + start_s - region.start_s,
            by_hand=True,
        )
