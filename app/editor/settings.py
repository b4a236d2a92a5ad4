"""What the user chose for the editor on this machine; in a file of their configuration folder, never in a project.

The file is a TOML table that may be edited by hand. A value that is not possible is as if it were not there; a file
that cannot be read at all is left as it is, and what is chosen meanwhile is kept until it can be, or the editor ends.

Messages: ``settings.value``, ``settings.set_aside``.
"""

from __future__ import annotations

import base64
import binascii
import os
from functools import partial
from pathlib import Path
from typing import Annotated, Any, Final, Generic, TypeVar, overload

import msgspec
import platformdirs
from PySide6.QtCore import QByteArray, QCoreApplication, QObject, QTimer, Signal

from app import encoding
from app.editor.listening import Source
from app.editor.session import Session
from app.editor.setting_bindings import FOLDED, THEME, TIME, SettingBinding, in_listening, in_pitches, in_video
from app.editor.video_state import DEFAULT_OPACITY, Placement
from app.errors import AppError, FileError, MapError, Message
from app.formats.atomic import atomic_write
from app.formats.files import cannot_write
from app.formats.keys import KeyChoice
from app.formats.toml import read_toml, shaped, toml
from app.messages import LANGUAGES
from app.stream.sender import LEAST_PORT, MOST_PORT

T = TypeVar("T")

MOST_RECENT: Final = 12
"""Recent files kept."""
WRITE_MS: Final = 300
"""Interval of writing: a dragged value changes many times a second."""


def settings_path() -> Path:
    """Return where the settings of this user are."""
    return Path(platformdirs.user_config_dir("suisou", appauthor=False)) / "editor.toml"


class Setting(Generic[T]):
    """One setting, an attribute of `Settings`: declared here once, restored, remembered and shown by what it says.

    Parameters
    ----------
    key : str
        ``section/name``, or a whole section.
    kind : type, optional
        What is possible, as msgspec understands it; by default the default's type.
    held : SettingBinding, optional
        It is restored at the start, and remembered whenever it changes there.
    label : str
        In the preferences; empty: it is not there.
    options : tuple of (value, word)
        What is possible, if not all of a kind. The words are ids of texts, like the label.
    """

    def __init__(
        self,
        key: str,
        default: T,
        kind: Any = None,
        *,
        held: SettingBinding | None = None,
        label: str = "",
        options: tuple[tuple[T, str], ...] = (),
    ) -> None:
        section, _, name = key.partition("/")
        self.keys = section, name
        self.default = default
        self.held, self.label, self.options = held, label, options
        self._kind = type(default) if kind is None else kind

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    @property
    def words(self) -> tuple[str, ...]:
        """Its label and the words of its options."""
        return (self.label, *(word for _, word in self.options))

    @overload
    def __get__(self, settings: None, owner: type) -> Setting[T]: ...
    @overload
    def __get__(self, settings: Settings, owner: type) -> T: ...
    def __get__(self, settings: Settings | None, owner: type) -> T | Setting[T]:
        if settings is None:
            return self
        stored = settings.stored(self.keys)
        return self.default if stored is None else self.read(stored, "")

    def __set__(self, settings: Settings, value: T) -> None:
        settings.store(self.keys, self.written(value))

    def read(self, stored: object, file: str) -> T:
        """The value; MapError where it is not possible."""
        value: T = shaped(stored, self._kind, file)
        possible = [one for one, _ in self.options]
        if possible and value not in possible:
            raise MapError("table.invalid", file=file, place="", detail=f"possible: {', '.join(map(str, possible))}")
        return value

    def written(self, value: T) -> object:
        """As the file has it."""
        return value


class _Bytes(Setting[QByteArray]):
    """Bytes of Qt, as base64."""

    def __init__(self, key: str) -> None:
        super().__init__(key, QByteArray(), str)

    def read(self, stored: object, file: str) -> QByteArray:
        try:
            return QByteArray(base64.b64decode(shaped(stored, str, file), validate=True))
        except (binascii.Error, ValueError):
            return self.default

    def written(self, value: QByteArray) -> object:
        return base64.b64encode(value.data()).decode()


class _FilePath(Setting[str]):
    """A path, also one whose name is not UTF-8."""

    def read(self, stored: object, file: str) -> str:
        return encoding.restored(super().read(stored, file))

    def written(self, value: str) -> object:
        return encoding.stored(value)


class Settings(QObject):
    """Typed values in a TOML file; each is written soon after it changes, beside those of other editors.

    Parameters
    ----------
    path : Path
        Need not exist.

    Signals
    -------
    failed(Message)
        The file can no longer be read or written; reported once.
    """

    failed = Signal(object)

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
        held=in_pitches("written"),
        label="setting.written_pitch",
        options=((False, "setting_choice.as_they_sound_concert"), (True, "setting_choice.as_written_for_instrument")),
    )
    middle_c_octave = Setting(
        "pitch/middle_c_octave",
        4,
        held=in_pitches("middle_c_octave"),
        label="setting.middle_c_octave",
        options=((4, "setting_choice.c4"), (3, "setting_choice.c3")),
    )
    syllables = Setting(
        "pitch/syllables",
        False,
        held=in_pitches("syllables"),
        label="setting.syllables",
        options=((False, "setting_choice.c_d_e"), (True, "setting_choice.do_re_mi")),
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
    """Folded parts of panels, by name."""

    volume = Setting("sound/volume", 0.8, Annotated[float, msgspec.Meta(ge=0.0, le=1.0)], held=in_listening("volume"))
    """0..1 as the ear judges it."""
    click = Setting("sound/click", False, held=in_listening("click"))
    """Metronome on or off."""
    percussion = Setting("sound/percussion", True, held=in_listening("percussion"))
    """Percussion on or off."""
    scrub_sound = Setting("sound/scrub", True, held=in_listening("scrub_sound"))
    """Sound while scrubbing, on or off."""
    source = Setting("sound/source", "recording", Source, held=in_listening("source"))
    """The sound of a project that has a recording."""

    video_placement = Setting[Placement]("video/placement", "beside", Placement, held=in_video("placement"))
    video_opacity = Setting(
        "video/opacity", DEFAULT_OPACITY, Annotated[float, msgspec.Meta(ge=0.0, le=1.0)], held=in_video("opacity")
    )
    """Behind the players."""

    midi_port = Setting("midi/port", "")
    """The device that is recorded from; empty: none was chosen."""
    count_in_bars = Setting("midi/count_in_bars", 1, Annotated[int, msgspec.Meta(ge=0, le=4)])

    stream_host = Setting("stream/host", "")
    """The computer that is streamed to; empty: none was chosen."""
    stream_port = Setting("stream/port", 0, Annotated[int, msgspec.Meta(ge=LEAST_PORT, le=MOST_PORT)])
    """0: none was chosen."""
    stream_everyone = Setting("stream/everyone", False)
    """Every player is streamed, not only the one in front."""
    stream_faces = Setting("stream/faces", "")
    """One of `app.stream.faces.FACE_NAMES`; empty: none was chosen."""
    stream_rate_hz = Setting("stream/rate_hz", 0)
    """Frames in a second; 0: none were chosen."""

    geometry = _Bytes("window/geometry")
    """Position and size of the window."""
    workspace = Setting("window/workspace", "")
    """One of `app.shell.workspaces.WORKSPACES`; empty: none was chosen."""
    _workspaces = Setting("workspaces", dict[str, dict[str, str]](), dict[str, dict[str, str]])

    folder = _FilePath("files/folder", "")
    """Folder in which a file was last opened or saved."""
    export_folder = _FilePath("files/export_folder", "")
    """Folder of the last export."""
    unreal_project = _FilePath("files/unreal_project", "")
    """The Unreal project that players were last exported into; empty: none."""
    export_into = Setting("files/export_into", "folder")
    """Destination of the last export: ``"folder"`` or ``"unreal"``."""
    export_keys = Setting[KeyChoice]("files/export_keys", "every", KeyChoice)
    """Keys of the last export."""
    _recent = Setting("files/recent", tuple[str, ...](), tuple[str, ...])

    _shortcuts = Setting("shortcuts", dict[str, str](), dict[str, str])
    _midi_devices = Setting("midi_devices", dict[str, dict[str, str]](), dict[str, dict[str, str]])

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.path = path
        self.problems: tuple[Message, ...] = ()
        """Problems of the file that were found at the start."""
        self._is_reported = False
        self._changes: dict[tuple[str, str], object] = {}
        self._timer = QTimer(self, interval=WRITE_MS, singleShot=True)
        self._timer.timeout.connect(self.sync)
        try:
            self._table = self._possible(self._read())
        except AppError as error:
            self._table = {}
            self._is_reported = True
            self.problems = (error.message, Message("settings.set_aside", {"file": os.fspath(path)}))

    def hold(self, session: Session) -> None:
        """Restore what a session holds, and remember it there whenever it changes."""
        for setting in SETTINGS:
            if setting.held is not None:
                setting.held.set(session, getattr(self, setting.name))
        for setting in SETTINGS:
            if setting.held is not None:
                setting.held.changed(session).connect(partial(self._remember, session, setting, setting.held))

    def _remember(self, session: Session, setting: Setting[Any], held: SettingBinding) -> None:
        # Notified of much else, as of every phrase that is made: only what the user chose is written.
        value = held.get(session)
        if getattr(self, setting.name) != value:
            setattr(self, setting.name, value)

    # What is in the file

    def stored(self, keys: tuple[str, str]) -> object:
        """What the file has under a section and a name; None: nothing."""
        section, name = keys
        values = self._table.get(section)
        return values if not name else values.get(name) if isinstance(values, dict) else None

    def store(self, keys: tuple[str, str], value: object) -> None:
        """Put something under a section and a name, and write it soon."""
        if self.stored(keys) == value:
            return
        _put(self._table, keys, value)
        self._changes[keys] = value
        if not self._timer.isActive() and QCoreApplication.instance() is not None:
            self._timer.start()

    def sync(self) -> None:
        """Write what changed to the disk now; what other editors have written there stays, and so does a file that
        cannot be read: the changes wait until it can."""
        self._timer.stop()
        if not self._changes:
            return
        try:
            table = self._read()
            for keys, value in self._changes.items():
                _put(table, keys, value)
            self.path.parent.mkdir(parents=True, exist_ok=True)
            with atomic_write(self.path) as stream:
                stream.write(toml(table).encode("utf-8", "replace"))
        except (AppError, OSError) as error:
            if not self._is_reported:
                self._is_reported = True
                self.failed.emit(
                    error.message if isinstance(error, AppError) else cannot_write(self.path, error).message
                )
                self.failed.emit(Message("settings.set_aside", {"file": os.fspath(self.path)}))
            return
        self._changes.clear()

    def _read(self) -> dict[str, Any]:
        try:
            return read_toml(self.path)
        except FileError as error:
            if isinstance(error.__cause__, FileNotFoundError):
                return {}
            raise

    def _possible(self, table: dict[str, Any]) -> dict[str, Any]:
        """The table without values that are not possible, which are problems."""
        self._table = table
        file = os.fspath(self.path)
        for value in SETTINGS:
            if (stored := self.stored(value.keys)) is not None:
                try:
                    value.read(stored, file)
                except AppError as error:
                    place, detail = ".".join(filter(None, value.keys)), str(error.message.arguments["detail"])
                    self.problems += (Message("settings.value", {"file": file, "place": place, "detail": detail}),)
                    _put(table, value.keys, None)
        return table

    # Values that are several

    def midi_device(self, port: str, name: str) -> str:
        """What is remembered of a device; empty: nothing."""
        return self._midi_devices.get(port, {}).get(name, "")

    def set_midi_device(self, port: str, name: str, value: str) -> None:
        """Remember something of a device."""
        if port:
            devices = self._midi_devices
            self._midi_devices = {**devices, port: {**devices.get(port, {}), name: value}}

    def rename_midi_device(self, before: str, port: str) -> None:
        """Remember of a device by another name what was remembered by the one before; what that one has stays."""
        devices = self._midi_devices
        if before in devices:
            self._midi_devices = {**devices, port: {**devices[before], **devices.get(port, {})}}

    def workspace_state(self, workspace_id: str) -> dict[str, str]:
        """How a workspace was left, by what is remembered of it; empty: it is as at first."""
        return dict(self._workspaces.get(workspace_id, {}))

    def set_workspace_state(self, workspace_id: str, **parts: str) -> None:
        """Remember something of a workspace."""
        known = self._workspaces
        self._workspaces = {**known, workspace_id: {**known.get(workspace_id, {}), **parts}}

    def forget_workspace(self, workspace_id: str) -> None:
        """A workspace is as at first."""
        self._workspaces = {id: state for id, state in self._workspaces.items() if id != workspace_id}

    @property
    def recent(self) -> tuple[str, ...]:
        """Files opened lately, the newest first."""
        return tuple(path for text in self._recent[:MOST_RECENT] if (path := encoding.restored(text)))

    def add_recent(self, path: Path) -> None:
        """This file was opened or saved just now."""
        text = str(path)
        others = tuple(other for other in self.recent if other != text)
        self._recent = tuple(map(encoding.stored, (text, *others)))[:MOST_RECENT]

    def remove_recent(self, path: str) -> None:
        """Forget a file."""
        self._recent = tuple(encoding.stored(other) for other in self.recent if other != path)

    def shortcut(self, action_id: str) -> str | None:
        """The user's own shortcut of an action, ``;`` between several, empty for none; None: as it comes."""
        return self._shortcuts.get(action_id)

    def set_shortcut(self, action_id: str, keys: str | None) -> None:
        """Give an action a shortcut custom; None: as it comes."""
        others = {id: own for id, own in self._shortcuts.items() if id != action_id}
        self._shortcuts = others if keys is None else {**others, action_id: keys}


SETTINGS: Final = tuple(value for value in vars(Settings).values() if isinstance(value, Setting))
"""Every setting."""


def _put(table: dict[str, Any], keys: tuple[str, str], value: object) -> None:
    """Put a value into a table of tables; None takes it away."""
    section, name = keys
    if not name:
        table[section] = value
        return
    if not isinstance(table.get(section), dict):
        table[section] = {}
    table[section][name] = value
