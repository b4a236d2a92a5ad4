"""The regions of a lane: positions, visibility and hit testing."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

import numpy as np

from app.arrays import AnyIntArray, IntArray
from app.editor.selection import EventKey
from app.errors import Message
from app.plan.by_hand.corrections import RemoveEvent
from app.plan.event_id import EventId
from app.plan.model import PlayerPlan
from app.project.model import Project
from widgets.timeline.model.lane_mouse import LaneMouse, PixelRect
from widgets.timeline.model.regions.shown_event import Region, place_of, spans_of
from widgets.timeline.model.visible_time import Scale

EDGE_PX = 6.0
HANDLE_PX = 5.0
LEAST_REGION_PX = 3.0
GLYPH_PX = 12.0
"""Width in pixels of the mark of a removed event, which has no length."""

Handle = tuple[str, tuple[float, float]]
"""Part of a fade, and the point at which it is dragged."""

_TRAITS = np.dtype([
    ("row", np.intp), ("start_s", float), ("length_s", float), ("strength", float), ("narrowable", bool)
])  # fmt: skip


def row_box(row: int, count: int, room_px: float, least_px: float, scrolled_px: float) -> tuple[float, float]:
    """Return the top and height in pixels of one of ``count`` rows: as high as possible, at least ``least_px``."""
    height = max(room_px / max(count, 1), least_px)
    return row * height - min(scrolled_px, most_scrolled(count, height, room_px)), height


def most_scrolled(count: int, height_px: float, room_px: float) -> float:
    """Return the greatest scroll offset in pixels of ``count`` rows of ``height_px`` in a height of ``room_px``."""
    return max(max(count, 1) * height_px - room_px, 0.0)


def region_box(region: Region, scale: Scale, row: tuple[float, float]) -> PixelRect:
    """Return the rectangle of a region in its row (top and height)."""
    top, height = row
    left = scale.x_px(region.start_s)
    width = GLYPH_PX if region.removed else max(scale.x_px(region.end_s) - left, LEAST_REGION_PX)
    left = left - GLYPH_PX / 2 if region.removed else left
    return PixelRect(left, top + 1.0, left + width, top + 1.0 + max(height - 2.0, 1.0))


def fade_handles(region: Region, box: PixelRect, scale: Scale) -> tuple[Handle, Handle]:
    """Return names and positions (x, y in pixels) of the two handles by which fade-in and fade-out of a region are
    dragged.
    """
    fade_in, fade_out = region.fade_in_s * scale.px_per_s, region.fade_out_s * scale.px_per_s
    if region.fades_outside:
        y = box.bottom - HANDLE_PX
        return ("fade_in", (box.left - fade_in, y)), ("fade_out", (box.right + fade_out, y))
    y = box.top + HANDLE_PX
    return (
        ("fade_in", (min(box.left + fade_in, box.right), y)),
        ("fade_out", (max(box.right - fade_out, box.left), y)),
    )


def _fade_zone(region: Region, box: PixelRect, mouse: LaneMouse, scale: Scale) -> str:
    for zone, (x, y) in fade_handles(region, box, scale):
        if abs(mouse.x_px - x) <= EDGE_PX and abs(mouse.y_px - y) <= EDGE_PX:
            return zone
    return ""


def _zone(region: Region, box: PixelRect, mouse: LaneMouse) -> str:
    if not region.removed and not region.fixed and box.width >= 3 * EDGE_PX:
        if mouse.x_px <= box.left + EDGE_PX:
            return "start"
        if mouse.x_px >= box.right - EDGE_PX:
            return "end"
    return "body"


class RegionTable:
    """The regions of a lane, ordered by their displayed start.

    Parameters
    ----------
    regions : iterable of Region
    is_calm : callable
        Returns whether a region is drawn together with its row instead of singly.
    """

    def __init__(self, regions: Sequence[Region] = (), is_calm: Callable[[Region], bool] = lambda _: False) -> None:
        self.regions = sorted(regions, key=lambda region: (region.first_s, region.end_s, region.event_id))
        self.by_key = {region.key: region for region in self.regions}
        self._spans = spans_of(self.regions)
        self._single = [region for region in self.regions if region.removed or not is_calm(region)]
        self._single_spans = spans_of(self._single)
        # Traits that decide which regions are drawn where they are crowded; corrections always are.
        self._traits = np.array(
            [(one.row, one.start_s, one.end_s - one.start_s, abs(one.amount), not one.by_hand) for one in self._single],
            _TRAITS,
        )

    def visible(
        self,
        scale: Scale,
        left_px: float,
        right_px: float,
        selected: Collection[EventKey],
        preview: Mapping[EventKey, Region],
        hidden: Collection[EventKey],
    ) -> Iterator[Region]:
        """Yield the regions between two x positions that are drawn singly: unselected ones, then selected ones, then
        the ``preview`` of a drag; ``hidden`` ones are left out.
        """
        margin_s = GLYPH_PX / scale.px_per_s
        found = self._single_spans.between(scale.seconds(left_px) - margin_s, scale.seconds(right_px) + margin_s)
        for index in self._distinct(found, scale).tolist():
            region = self._single[index]
            key = region.key
            if key not in selected and key not in preview and key not in hidden:
                yield region
        for key in selected:
            chosen = self.by_key.get(key)
            if chosen is not None and key not in preview and key not in hidden:
                yield chosen
        yield from preview.values()

    def _distinct(self, found: IntArray, scale: Scale) -> AnyIntArray:
        """Return the indices of the regions to draw: among narrow ones in the same column of pixels only the strongest.

        Zoomed out, thousands share a column, and each would take as long to draw as a wide one.
        """
        traits = self._traits[found]
        narrow = traits["narrowable"] & (traits["length_s"] * scale.px_per_s < LEAST_REGION_PX)
        crowded = found[narrow]
        # Columns are fixed in time, so that scrolling does not change the selection.
        columns = np.floor(traits["start_s"] * scale.px_per_s / LEAST_REGION_PX)[narrow]
        order = np.lexsort((-traits["strength"][narrow], columns, traits["row"][narrow]))
        places = np.stack((traits["row"][narrow], columns))[:, order]
        first = np.ones(order.size, bool)
        first[1:] = np.any(places[:, 1:] != places[:, :-1], axis=0)
        return np.sort(np.concatenate((found[~narrow], crowded[order[first]])))

    def at(
        self, mouse: LaneMouse, scale: Scale, place: Callable[[Region], PixelRect], selected: Collection[EventKey]
    ) -> tuple[Region | None, str]:
        """Return the region under the mouse, and the grabbed part of it: ``start``, ``end``, ``fade_in``, ``fade_out``
        or ``body``; None and an empty part if there is none.

        ``place`` returns the rectangle of a region. Only selected regions have handles for fades, since many handles
        would be in the way.
        """
        reach_s = (EDGE_PX + GLYPH_PX) / scale.px_per_s
        best: tuple[tuple[bool, float], Region, str] | None = None
        for index in self._spans.between(mouse.time_s - reach_s, mouse.time_s + reach_s).tolist():
            region = self.regions[index]
            box = place(region)
            # Thin regions react slightly outside their edges, wide ones only inside.
            slack = max(EDGE_PX - box.width / 2, 0.0)
            zone = _fade_zone(region, box, mouse, scale) if region.fades and region.key in selected else ""
            if not zone and not box.contains(mouse.x_px, mouse.y_px, slack):
                continue
            # A selected region wins, then the shortest: regions on top can always be reached.
            rank = (region.key not in selected, box.width)
            if best is None or rank < best[0]:
                best = (rank, region, zone or _zone(region, box, mouse))
        return (best[1], best[2]) if best is not None else (None, "")

    def beside(self, chosen: Sequence[Region], step: int, at_s: float) -> Region | None:
        """Return the region ``step`` places after those in ``chosen``; if these are none, the region nearest to the
        time ``at_s``. Other players' regions are ignored.
        """
        own = [region for region in self.regions if not region.guest]
        if not own:
            return None
        if chosen:
            index = own.index(max(chosen, key=lambda item: item.start_s * step)) + step
        else:
            index = min(range(len(own)), key=lambda place: abs(own[place].start_s - at_s))
        return own[min(max(index, 0), len(own) - 1)]


def removed_regions(
    project: Project, plan: PlayerPlan, kinds: Iterable[str], row: Callable[[str], int]
) -> list[Region]:
    """Return regions that mark where the user removed generated events."""
    among = frozenset(kinds)
    onsets: dict[str, int] = {}
    result = []
    for item in project.corrections.get(plan.player_id, ()):
        kind = EventId.parse(item.event_id).kind if isinstance(item, RemoveEvent) else ""
        if not isinstance(item, RemoveEvent) or kind not in among:
            continue
        if not onsets:
            onsets = {note.id: note.onset_tick for note in project.part(project.player(plan.player_id)).notes}
        tick = place_of(item.event_id, onsets)
        at_s = plan.time_frame.first_frame_s if tick is None else project.score.tempo_map.seconds(float(tick))
        tick = round(project.score.tempo_map.ticks(at_s))
        result.append(
            Region(
                plan.player_id,
                item.event_id,
                kind,
                tick,
                tick,
                at_s,
                at_s,
                row(kind),
                reason=Message("correction.by_hand"),
                by_hand=True,
                steady=True,
                removed=True,
            )
        )
    return result
