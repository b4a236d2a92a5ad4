"""The guides' places for parts of the window and dialogs, by object names: one table for F1 and the help buttons."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from PySide6.QtCore import QPoint
from PySide6.QtWidgets import QApplication, QMenu, QWidget

PLACES: Final[Mapping[str, str]] = {
    # The window
    "window": "editor",
    "start_page": "editor#start-page",
    "start_first_steps": "editor#help",
    "menu_file": "editor#file",
    "menu_edit": "editor#edit",
    "menu_edit_breaths_and_acting": "acting#gestures-by-hand",
    "menu_edit_fingering": "editor#fingering",
    "menu_edit_marks": "marks#writing",
    "menu_edit_players": "editor#players",
    "menu_view": "editor#view",
    "menu_view_lanes": "editor#timeline",
    "menu_view_video": "reference-video",
    "menu_view_viewport": "editor#viewport",
    "menu_view_workspace": "editor#workspaces",
    "menu_play": "editor#play",
    "menu_play_recording": "follow-a-recording",
    "menu_record": "record-your-first-take",
    "menu_record_takes": "record-your-first-take#4-choose-and-put-together",
    "menu_generate": "editor#generate",
    "menu_export": "files-for-other-programs#which-file-for-what",
    "menu_help": "editor#help",
    "workspace_switch": "editor#workspaces",
    "palette_button": "editor#menus-and-commands",
    "transport_bar": "editor#transport",
    "transport": "editor#transport",
    "status": "editor#status-line",
    "banner": "editor#start-page",
    "first_steps": "editor#help",
    # The viewport
    "viewport": "editor#viewport",
    "viewport_pose": "editor#pose-tool",
    "video_view": "reference-video",
    "video_strip": "reference-video",
    # The timeline
    "timeline": "editor#timeline",
    "dock_timeline": "editor#timeline",
    "ruler": "editor#ruler",
    "flags": "editor#ruler",
    "lane_audio": "editor#audio",
    "lane_roll": "editor#notes",
    "lane_dynamics": "editor#dynamics",
    "lane_takes": "editor#takes",
    "lane_fingering": "editor#fingering",
    "lane_breath": "editor#breath",
    "lane_acting": "editor#acting",
    "lane_curves": "editor#lips-and-breath",
    "lane_dance": "editor#dance",
    "lane_problems": "editor#problems",
    "lane_additive": "curves#in-the-timeline",
    # Players
    "players": "editor#players",
    "dock_players": "editor#players",
    "players_motion": "editor#motion",
    "players_acting": "editor#style-and-habits",
    "players_breath": "editor#breath-and-lungs",
    "players_face": "editor#face",
    "players_player": "editor#part-and-character",
    "players_stage": "editor#stage",
    "players_variety": "editor#variety",
    "players_presets": "editor#presets",
    "dancers": "choreography#1-add-a-dancer",
    "parameter_choreography": "choreography#2-let-players-dance-while-they-play",
    # The inspector
    "inspector": "editor#inspector",
    "dock_inspector": "editor#inspector",
    "inspector_note": "editor#selected-notes",
    "note_marks": "marks#writing",
    "inspector_event": "editor#selected-events",
    "inspector_take": "record-your-first-take#4-choose-and-put-together",
    "inspector_cleaning": "record-your-first-take#4-choose-and-put-together",
    "inspector_expressions": "editor#expression-editor",
    "problems_tab": "editor#problems-tab",
    "corrections_tab": "editor#corrections-tab",
    "history_tab": "editor#history-tab",
    "recording": "record-your-first-take#3-record",
    "dock_recording": "record-your-first-take#3-record",
    # Dialogs
    "about": "editor#about",
    "licences": "licences",
    "preferences": "editor#preferences",
    "shortcuts_page": "editor#shortcuts",
    "instruments": "editor#instruments",
    "piece_settings": "piece-settings",
    "import_midi": "editor#import",
    "reimport_midi": "editor#re-import",
    "export_files": "editor#export",
    "export_skeleton": "skeletons",
    "playblast": "editor#playblast",
    "stream": "stream-live",
    "midi_devices": "record-your-first-take#1-plug-in",
    "latency": "record-your-first-take#2-measure-the-latency-once",
    "follow_recording": "follow-a-recording",
    "characters": "bring-your-own-character#in-the-editor",
    "character": "bring-your-own-character#in-the-editor",
    "rules": "metadata#without-a-text-editor",
    "metadata_differences": "metadata#what-was-said-of-a-piece",
    "choreography": "choreography#1-add-a-dancer",
    "learn_choreography": "choreography#4-learn-a-choreography-of-your-own",
    "evaluation": "evaluate#1-make-an-evaluation",
    "evaluation_results": "evaluate#3-results",
}
"""Guide, and after ``#`` the anchor of its heading. A widget without a place of its own has that of what it is in."""
ACTIONS: Final[Mapping[str, str]] = {
    "file.import_midi": "editor#import",
    "file.reimport": "editor#re-import",
    "file.add_audio": "follow-a-recording",
    "file.add_video": "reference-video",
    "file.add_character": "bring-your-own-character#in-the-editor",
    "file.rules": "metadata#without-a-text-editor",
    "file.piece_settings": "piece-settings",
    "file.evaluation": "evaluate",
    "application.instruments": "editor#instruments",
    "application.characters": "bring-your-own-character#in-the-editor",
    "application.preferences": "editor#preferences",
    "application.shortcuts": "editor#shortcuts",
    "export.files": "editor#export",
    "export.playblast": "editor#playblast",
    "stream": "stream-live",
    "record.devices": "record-your-first-take#1-plug-in",
    "record.latency": "record-your-first-take#2-measure-the-latency-once",
    "dancers": "choreography",
    "problems": "editor#problems-tab",
}
"""Places of commands, by the beginning of their ids; others have that of their menu."""


def place_of(widget: QWidget) -> str:
    """Return the place for a widget: its own, or that of the nearest part it is in."""
    found: QWidget | None = widget
    while found is not None:
        if found.objectName() in PLACES:
            return PLACES[found.objectName()]
        found = found.parentWidget()
    return PLACES["window"]


def place_in_menu(menu: QMenu) -> str:
    """Return the place for the command under the mouse in an open menu, or for the menu where it has none."""
    chosen = menu.activeAction()
    if chosen is None:
        return place_of(menu)
    known = [start for start in ACTIONS if chosen.objectName().startswith(start)]
    submenu = chosen.menu()
    return ACTIONS[max(known, key=len)] if known else place_of(submenu if isinstance(submenu, QMenu) else menu)


def part_under(pointer: QPoint, window: QWidget) -> QWidget:
    """Return the widget under the pointer if it is a part of the window, else the one that has the keyboard, else the
    window."""
    under = QApplication.widgetAt(pointer)
    part = under
    while part is not None and part is not window:
        part = part.parentWidget()
    if under is not None and part is window:
        return under
    return QApplication.focusWidget() or window
