"""Settings of the editor on this computer, in the user's configuration folder.

The file is a TOML table that may be edited by hand. Invalid values are ignored; an unreadable file is not changed, and
new values are kept in memory until it is readable or the editor ends.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated, Any, Final, TypeAlias

import msgspec
import platformdirs

from app import encoding
from app.editor.listening import Source
from app.editor.session import Session
from app.editor.setting_bindings import FOLDED, GROUPED, THEME, TIME, SettingBinding, within
from app.editor.stored_settings import BytesSetting, FilePathSetting, Setting, StoredSettings
from app.editor.video_state import DEFAULT_OPACITY, Placement
from app.editor.viewport_state import Follows
from app.formats.images import USUAL_TEXTURE_PX, TextureSize
from app.formats.keys import KeyChoice
from app.formats.levels_of_detail import LevelChoice
from app.messages import LANGUAGES
from app.messages.pitches import PitchNames
from app.stream.sender import LEAST_PORT, MOST_PORT

MOST_RECENT: Final = 12
"""Greatest number of recent files."""
MOST_VIEWS: Final = 60_000
"""Greatest number of characters of all stored views of pieces."""
_Share: TypeAlias = Annotated[float, msgspec.Meta(ge=0.0, le=1.0)]


def settings_path() -> Path:
    """Return the path of the user's settings."""
    return Path(platformdirs.user_config_dir("suisou", appauthor=False)) / "editor.toml"


class Settings(StoredSettings):
    """All settings and remembered values of the editor on this computer."""

    language = Setting(
        "interface/language", "", label="setting.language", options=(("", "setting_choice.systems"), *LANGUAGES.items())
    )
    theme = Setting(
        "interface/theme",
        "dark",
        held=THEME,
        label="setting.theme",
        options=(("dark", "setting_choice.dark"), ("light", "setting_choice.light")),
    )
    written_pitch = Setting(
        "pitch/written",
        False,
        held=within("pitch_display", "written"),
        label="setting.written_pitch",
        options=((False, "setting_choice.concert_pitch"), (True, "setting_choice.written_pitch")),
    )
    middle_c_octave = Setting(
        "pitch/middle_c_octave",
        4,
        held=within("pitch_display", "middle_c_octave"),
        label="setting.middle_c_octave",
        options=((4, "setting_choice.c4"), (3, "setting_choice.c3")),
    )
    pitch_names = Setting[PitchNames](
        "pitch/names",
        "letters",
        PitchNames,
        held=within("pitch_display", "names"),
        label="setting.pitch_names",
        options=(
            ("letters", "setting_choice.c_d_e"),
            ("german", "setting_choice.german"),
            ("syllables", "setting_choice.do_re_mi"),
        ),
    )
    time_display = Setting(
        "interface/time_display",
        "bars",
        held=TIME,
        label="setting.time_display",
        options=(
            ("bars", "setting_choice.bars_and_beats"),
            ("seconds", "setting_choice.seconds"),
            ("frames", "setting_choice.frames"),
        ),
    )
    folded = Setting("interface/folded", dict[str, bool](), dict[str, bool], held=FOLDED)
    """Collapsed sections of panels, by name."""
    groups_players = Setting("interface/groups_players", True, held=GROUPED)

    volume = Setting("sound/volume", 0.8, _Share, held=within("listening", "volume"))
    """Volume 0..1 on a scale of perceived loudness."""
    click = Setting("sound/click", False, held=within("listening", "click"))
    """True if the metronome is audible."""
    percussion = Setting("sound/percussion", True, held=within("listening", "percussion"))
    """True if the percussion is audible."""
    scrub_sound = Setting("sound/scrub", True, held=within("listening", "scrub_sound"))
    """True if scrubbing is audible."""
    source = Setting("sound/source", "recording", Source, held=within("listening", "source"))
    """Sound that is played in a project with a recording."""

    follows_selection = Setting("viewport/follows_selection", True, held=within("viewport", "follows_selection"))
    """True if the playhead moves to a selected note."""

    camera_follows = Setting[Follows](
        "viewport/camera_follows", "close_ups", Follows, held=within("viewport", "camera_follows")
    )
    """Views in which the camera moves to a selected or corrected event."""

    video_placement = Setting[Placement]("video/placement", "beside", Placement, held=within("video", "placement"))
    video_opacity = Setting(
        "video/opacity",
        DEFAULT_OPACITY,
        _Share,
        held=within("video", "opacity"),
    )
    """Opacity 0..1 of the video behind the players."""

    midi_port = Setting("midi/port", "")
    """Name of the MIDI device for recording; empty if none was chosen."""
    count_in_bars = Setting("midi/count_in_bars", 1, Annotated[int, msgspec.Meta(ge=0, le=4)])

    stream_host = Setting("stream/host", "")
    """Host name of the streaming receiver; empty if none was chosen."""
    stream_port = Setting("stream/port", 0, Annotated[int, msgspec.Meta(ge=LEAST_PORT, le=MOST_PORT)])
    """Port of the streaming receiver; 0 if none was chosen."""
    stream_everyone = Setting("stream/everyone", False)
    """True if all players are streamed instead of the first selected one."""
    stream_faces = Setting("stream/faces", "")
    """One of `app.stream.faces.FACE_NAMES`; empty if none was chosen."""
    stream_rate_hz = Setting("stream/rate_hz", 0)
    """Streaming rate in frames per second; 0 if none was chosen."""

    geometry = BytesSetting("window/geometry")
    """Position and size of the window."""
    workspace = Setting("window/workspace", "")
    """One of `app.shell.workspaces.WORKSPACES`; empty if none was chosen."""
    _workspaces = Setting("workspaces", dict[str, dict[str, str]](), dict[str, dict[str, str]])

    folder = FilePathSetting("files/folder", "")
    """Folder in which a file was last opened or saved."""
    export_folder = FilePathSetting("files/export_folder", "")
    """Folder of the last export."""
    unreal_project = FilePathSetting("files/unreal_project", "")
    """Unreal project of the last export; empty if there was none."""
    export_into = Setting("files/export_into", "folder")
    """Destination of the last export: ``"folder"`` or ``"unreal"``."""
    export_texture_px = Setting[TextureSize]("files/export_texture_px", USUAL_TEXTURE_PX, TextureSize)
    """Longest side in pixels of textures in the last export; 0 for no textures."""
    export_levels = Setting[LevelChoice]("files/export_levels", 0, LevelChoice)
    """Number of levels of detail in the last export; 0 for the default."""
    export_keys = Setting[KeyChoice]("files/export_keys", "every", KeyChoice)
    """Key reduction in the last export."""
    _recent = Setting("files/recent", tuple[str, ...](), tuple[str, ...])

    _pieces = Setting("pieces", dict[str, str](), dict[str, str])
    """Views of pieces by file, as text, the most recently closed piece last."""
    _shortcuts = Setting("shortcuts", dict[str, str](), dict[str, str])
    _midi_devices = Setting("midi_devices", dict[str, dict[str, str]](), dict[str, dict[str, str]])

    def _read(self) -> dict[str, Any]:
        table = super()._read()
        pitch = table.get("pitch")
        # Version 0.1 stored either letters or syllables.
        if isinstance(pitch, dict) and pitch.pop("syllables", False) is True:
            pitch.setdefault("names", "syllables")
        return table

    def hold(self, session: Session) -> None:
        """Restore the settings that belong to the session, and store them whenever they change."""
        for setting in SETTINGS:
            if setting.held is not None:
                setting.held.set(session, getattr(self, setting.name))
        for setting in SETTINGS:
            if setting.held is not None:
                setting.held.changed(session).connect(partial(self._remember, session, setting, setting.held))

    def _remember(self, session: Session, setting: Setting[Any], held: SettingBinding) -> None:
        # Many other changes notify as well, such as each rendered phrase; only values chosen by the user are written.
        value = held.get(session)
        if getattr(self, setting.name) != value:
            setattr(self, setting.name, value)

    # Settings with several values

    def midi_device(self, port: str, name: str) -> str:
        """Return a stored property of a MIDI device, such as its latency; empty if it is not stored."""
        return self._midi_devices.get(port, {}).get(name, "")

    def set_midi_device(self, port: str, name: str, value: str) -> None:
        """Store a property of a MIDI device; do nothing if ``port`` is empty."""
        if port:
            devices = self._midi_devices
            self._midi_devices = {**devices, port: {**devices.get(port, {}), name: value}}

    def rename_midi_device(self, before: str, port: str) -> None:
        """Copy the stored properties of a device to its new port name, unless that has properties already."""
        devices = self._midi_devices
        if before in devices:
            self._midi_devices = {**devices, port: {**devices[before], **devices.get(port, {})}}

    def workspace_state(self, workspace_id: str) -> dict[str, str]:
        """Return the stored layout of a workspace as a text for each part; empty for the default layout."""
        return dict(self._workspaces.get(workspace_id, {}))

    def set_workspace_state(self, workspace_id: str, **parts: str) -> None:
        """Store some parts of the layout of a workspace, keeping its other parts."""
        known = self._workspaces
        self._workspaces = {**known, workspace_id: {**known.get(workspace_id, {}), **parts}}

    def forget_workspace(self, workspace_id: str) -> None:
        """Reset a workspace to its default layout."""
        self._workspaces = {id: state for id, state in self._workspaces.items() if id != workspace_id}

    def piece_view(self, path: str) -> str:
        """Return the stored view of the piece in a file; empty if none is stored."""
        return self._pieces.get(encoding.stored(path), "")

    def set_piece_view(self, path: str, view: str) -> None:
        """Store the view of the piece in a file; the oldest stored views are dropped."""
        path = encoding.stored(path)
        pieces = {other: text for other, text in self._pieces.items() if other != path} | {path: view}
        sizes = [len(f"{other}{text}") for other, text in pieces.items()]
        while sum(sizes) > MOST_VIEWS and len(sizes) > 1:
            del sizes[0], pieces[next(iter(pieces))]
        self._pieces = pieces

    @property
    def recent(self) -> tuple[str, ...]:
        """Return the paths of the recently opened files, the newest first."""
        return tuple(path for text in self._recent[:MOST_RECENT] if (path := encoding.restored(text)))

    def add_recent(self, path: Path) -> None:
        """Add a file to the top of the recent files."""
        text = str(path)
        others = tuple(other for other in self.recent if other != text)
        self._recent = tuple(map(encoding.stored, (text, *others)))[:MOST_RECENT]

    def remove_recent(self, path: str) -> None:
        """Remove a path from the list of recently opened files."""
        self._recent = tuple(encoding.stored(other) for other in self.recent if other != path)

    def shortcut(self, action_id: str) -> str | None:
        """Return the user's shortcuts of an action, separated by ``;`` (empty for no shortcut); None if the user
        changed none.
        """
        return self._shortcuts.get(action_id)

    def set_shortcut(self, action_id: str, keys: str | None) -> None:
        """Store the user's shortcuts of an action; None to use the default ones again."""
        others = {id: own for id, own in self._shortcuts.items() if id != action_id}
        self._shortcuts = others if keys is None else {**others, action_id: keys}


SETTINGS: Final = Settings.declared()
"""Descriptions of all settings."""
