"""Menus of the lane of additive curves: channels, and commands for a point."""

from __future__ import annotations

from collections.abc import Callable, Collection

from PySide6.QtGui import QAction, QActionGroup
from PySide6.QtWidgets import QMenu

from app.editor.translated import tr
from app.plan.by_hand.additive_curve import INTERPOLATIONS, AdditiveCurve
from widgets.common.channel_names import body_groups, face_groups, way_name
from widgets.common.clicks import on_click, on_switch
from widgets.common.plain import verbatim
from widgets.timeline.lanes.additive.additive_edits import CurveEditing

MARKED = "• "
"""Prefix of the names of channels with curves."""


def fill_channels(menu: QMenu, channel: str, used: Collection[str], chosen: Callable[[str], None]) -> None:
    """Fill a menu with all channels by parts of body and face, with ``used`` ones marked."""
    menu.clear()
    group = QActionGroup(menu)

    def offer(into: QMenu, channels: tuple[str, ...]) -> None:
        for each in channels:
            mark = MARKED if each in used else ""
            entry = into.addAction(mark + verbatim(way_name(each)))
            entry.setObjectName(f"channel_{each}")
            entry.setCheckable(True)
            entry.setChecked(each == channel)
            group.addAction(entry)
            on_click(entry, chosen, each)

    def marked(name: str, channels: Collection[str]) -> str:
        return (MARKED if any(each in used for each in channels) else "") + verbatim(name)

    for name, channels in body_groups():
        offer(menu.addMenu(marked(name, channels)), channels)
    everything = [each for _, channels in face_groups() for each in channels]
    face = menu.addMenu(marked(tr("channel.face"), everything))
    for name, channels in face_groups():
        offer(face.addMenu(marked(name, channels)), channels)


def add_key_entries(menu: QMenu, lane: CurveEditing) -> None:
    """Append to a context menu the entries that act on the selected keys, such as their interpolation."""
    keys = lane.chosen()
    names = {
        "bezier": tr("additive_lane.bezier"),
        "linear": tr("additive_lane.linear"),
        "constant": tr("additive_lane.constant"),
    }
    kinds = menu.addMenu(tr("additive_lane.interpolation"))
    for interpolation in INTERPOLATIONS:
        entry = kinds.addAction(names[interpolation])
        entry.setObjectName(f"interpolation_{interpolation}")
        entry.setCheckable(True)
        entry.setChecked(all(key.interpolation == interpolation for key in keys))
        on_click(entry, lane.interpolate, interpolation)
    tangents = menu.addMenu(tr("additive_lane.tangents"))
    automatic = add_entry(tangents, "tangents_automatic", tr("additive_lane.automatic"), lane.free)
    automatic.setCheckable(True)
    automatic.setChecked(all(key.arrive is None and key.leave is None for key in keys))
    add_entry(tangents, "tangents_flat", tr("additive_lane.flat"), lane.flatten)
    menu.addSeparator()
    add_entry(menu, "key_value", tr("additive_lane.value"), lane.type_value)
    add_entry(menu, "copy_keys", tr("additive_lane.copy_keys"), lane.copy)
    add_entry(menu, "delete_keys", tr("additive_lane.delete_keys"), lane.delete)


def add_curve_entries(menu: QMenu, lane: CurveEditing, curve: AdditiveCurve) -> None:
    """Append to a context menu the entries that act on a whole additive curve, such as switching it off or deleting
    it."""
    name = curve.name
    menu.addSeparator()
    enabled = menu.addAction(tr("additive_lane.enabled"))
    enabled.setObjectName("curve_enabled")
    enabled.setCheckable(True)
    enabled.setChecked(curve.enabled)
    on_switch(enabled, lambda checked: lane.enable(name, checked))
    add_entry(menu, "curve_weight", tr("additive_lane.weight"), lambda: lane.type_weight(name))
    add_entry(menu, "curve_title", tr("additive_lane.rename"), lambda: lane.type_title(name))
    add_entry(menu, "delete_curve", tr("additive_lane.delete_curve"), lambda: lane.delete_curve(name))


def add_entry(menu: QMenu, name: str, text: str, run: Callable[[], None]) -> QAction:
    """Add a menu entry with an object name and a function, and return it."""
    entry = menu.addAction(text)
    entry.setObjectName(name)
    on_click(entry, run)
    return entry
