"""The subjects of `tests.support.window_state` that each click in the window changes.

A line reads ``name = subjects + others``: of a button by its object name (with that of a widget above it where several
share it), of an entry of the table of actions by its id, of other entries of menus by place and text. ``*`` stands for
anything. Each of the subjects changes; the others, and `BESIDES`, may. After ``?`` the subjects may stay where it is so
already; in some state they change.
"""

from __future__ import annotations

from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import cache
from typing import Final

BESIDES: Final = frozenset(
    ("axis", "choices", "notice", "playhead", "preview", "sought", "status", "tab", "typing", "view", "work")
)
"""Subjects that may change in addition, as a consequence of others or by themselves during playback."""

_LINES: Final = """
# The start page, the status line and the title of the window
start_open = asked
start_new = file page panels project + lanes view
start_first_steps = file page players project + dancer panels view
start_example, start_danced_example = file page players project + dancer panels view
midi_device, stream_state = dialog
palette_button = palette popup
problems = selection + players view
notice = popup
dismiss_notice = status

# The menu of files
file.new = project + asked file page panels players selection recording tool view
file.open, file.import_midi, file.add_character, file.save, file.save_as, file.reimport_other = asked
file.add_audio, file.add_video, file.export_midi, file.save_metadata, file.load_metadata = asked
file.compare_metadata, file.metadata_folder = asked
file.open_example, file.open_danced_example = project + asked file page players panels selection dancer lanes view
file.reimport, file.rules, file.piece_settings, file.evaluation, file.evaluation_results = dialog
file.close = file page panels project + asked players selection dancer recording tool view
export.files, export.playblast = dialog
help.guides, help.here = dialog
help.first_steps = project + asked axis file ghosts page players panels recording selection dancer lanes tool view
application.characters, application.instruments, application.preferences, application.shortcuts = dialog
application.about, record.devices, record.latency, stream.settings, dancers.learn, dancers.choreography = dialog
application.palette = palette popup
application.full_screen, viewport_full_screen = full_screen panels
stream.toggle = streaming

# Notes and events
edit.undo = project + selection players
edit.redo ? project + selection
edit.delete, notes.cut = project + selection copied players view playhead
notes.copy = copied
notes.duplicate = project selection
notes.paste, notes.join ? project selection
notes.select_all, notes.select_none, notes.select_pitch, notes.select_bar, notes.select_span ? selection
notes.tool_*, tool_select, tool_draw, tool_erase, tool_split ? tool
notes.split ? project + selection
notes.quantise = popup quantise
notes.* = project + selection
fingering.type_* ? project
fingering.* = project
marks.dynamic, add_mark = popup
mark_* = project
marks.slur, marks.non_legato ? project + notice
marks.* = project
events.gesture, events.expression, events.style = popup
events.preparation, events.give_back, events.give_back_player = project + selection
events.* = project + selection
gesture.* = project + selection
beat.* ? project

# Players and dancers
players.rename, dancers.rename ? typing
players.next, players.previous, players.select_all ? players + selection
players.add, players.duplicate, players.remove = project players + selection
players.select_section ? players + selection
players.arrange, players.reset, players.hear_everyone, players.dress_everyone ? project
players.* = project
dancers.add, dancers.duplicate, dancers.remove = project dancer + lanes
layer_*, habit_*, seed_dice, dancer_dice, randomise, dancer_mirrored = project
player_colour, players_add_button, dancers_add_button = popup
player_colour > Other Colour... = asked
player_colour > * ? project
players_add_button > * = players project
dancers_add_button > From File... = asked
dancers_add_button > * = dancer project + lanes
players_duplicate_button, players_remove_button = players project + selection
dancers_duplicate_button, dancers_remove_button = dancer project + lanes
dancer_look = dialog
dancer_choreography ? asked + project
dancer_character, dancer_source, parameter_* ? project
player_part, player_instrument, player_character, player_outfit ? project + selection
dancer_outfit ? project
player_outfit_main, player_outfit_second, player_outfit_accent = popup
player_outfit_* > Other Colour... = asked
player_outfit_* > * ? project
stage_snap = snap
stage_arc, reset_parameters ? project
*/SectionHeader = folded

# Docks and the viewport
*/float_panel, */close_panel = panels
panel.* = panels + lanes
workspace.reset ? lanes + panels workspace
workspace.*, workspace_* ? workspace + lanes panels
viewport_view_*, viewport.ensemble, viewport.front, viewport.side, viewport.top, viewport.hands ? view
viewport.mouth, viewport.feet ? view
viewport.other_side = turned
viewport.follow_selection ? playhead
viewport.dolly_* = dollied
viewport.camera_follows_* ? camera_follows
cameras.keep = project + notice
cameras.update = notice + project
cameras.rename ? typing
cameras.remove ? project
cameras.recall_* ? view + players selection
viewport_pose, viewport.pose = posing
viewport_frame, viewport.frame, viewport.frame_all = framed
viewport.names, viewport.skeleton, viewport.contacts, viewport.wireframe, viewport.props, viewport_show > * = shown
video_*, video.beside, video.behind, video.hidden ? video
video_estimate, video.estimate_offset = work + project
video.remove = project + video

# The inspector
expression_duplicate = project
expression_both = both
expression_preview = preview
expression_choice, problems_who, problems_kind ? choices
ignore_problems ? project + players selection
revert_player, revert, */revert ? project + selection
takes_listen, takes_listen_alone, takes.listen, takes.listen_alone = playing take
takes_whole, takes.whole = project
takes_remove, takes.remove = project + selection lanes
take_swatch = popup
take_beats, takes.find_beats ? notice + project
takes.rename ? lanes
takes.* ? project + selection
problems.* ? selection + players view

# The timeline
zoom_out, zoom_in, fit, timeline.zoom_*, timeline.fit ? axis
timeline.count_*, time_display > * ? time
timeline.ghosts, timeline.selected, timeline.all, timeline.alone, ghosts_mode > * ? ghosts + lanes
*/fold ? lanes + project
timeline.marks = lanes
lanes.*, lanes_menu > *, lane header > * ? lanes
front_player ? players
lane breath > * ? project + selection players view playhead
lane fingering > *, lane acting > takers > *, lane acting > givers > * ? project + selection players view playhead
lane acting > * ? project + selection players view playhead
ruler > Select Bar = selection
ruler > * ? typing
slider > Copy Value = copied
slider > Type Value = typing
slider > Paste Value = project
slider > * ? project

# Playing and recording
play_to_start, play.to_start, play.to_end, play.frame_*, play.note_*, play.bar_* ? playhead
play_toggle, play.toggle, play.bar = playing + recording
play_stop, play.stop ? sought + playing recording
play_loop, play.loop = loop
play_click, play.click, play.percussion, play.scrub, play.speed_*, play.source_*, sound_source ? sound
play_follow, play.follow = follow
play.estimate_offset, play.fit_tempo = work + project
play.follow_recording = dialog
play.remove_recording = project
snap_on, snap ? grid
record_toggle, record.toggle, recording_record_toggle = recording + playing
recording_record_arm, record.arm = recording
recording_record_punch, record.punch ? recording
recording_count_in, record.count_in_* ? recording
recording_record_devices, recording_record_latency = dialog

# Looks
pitch.*, pitch_octave.*, pitch_names.* ? pitch
theme.* ? theme
language.en ? language
language.ja = language
generate.* = project
"""


@dataclass(frozen=True)
class Row:
    """A line of the table.

    Attributes
    ----------
    pattern : str
    changes : frozenset of str
        Subjects that change.
    besides : frozenset of str
        Others that may change.
    may_be_idle : bool
        Whether nothing may change in some states.
    """

    pattern: str
    changes: frozenset[str]
    besides: frozenset[str]
    may_be_idle: bool


def _rows() -> dict[str, Row]:
    rows = {}
    for line in _LINES.strip().splitlines():
        if not line or line.startswith("#"):
            continue
        mark = " ? " if " ? " in line else " = "
        names, _, subjects = line.partition(mark)
        changes, _, others = subjects.partition(" + ")
        for name in names.split(", "):
            rows[name] = Row(name, frozenset(changes.split()), BESIDES | frozenset(others.split()), mark == " ? ")
    return rows


TABLE: Final = _rows()


@cache
def expected(name: str) -> Row | None:
    """Return the line for a control or entry: the one with its name, else the first matching pattern, else None."""
    if name in TABLE:
        return TABLE[name]
    return next((row for pattern, row in TABLE.items() if fnmatchcase(name, pattern)), None)
