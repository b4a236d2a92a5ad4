"""What a person chose for the editor on this machine; in a file of their configuration folder, never in a project."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final, TypeVar
from urllib.parse import quote

import platformdirs
from PySide6.QtCore import QByteArray, QSettings

from app.stream.sender import LEAST_PORT, MOST_PORT

T = TypeVar("T")

MOST_RECENT: Final = 12
"""Recent files kept."""


def settings_path() -> Path:
    """Where the settings of this person are."""
    return Path(platformdirs.user_config_dir("suisou", appauthor=False)) / "editor.ini"


class Settings:
    """Typed values in an INI file; each is written at once.

    Parameters
    ----------
    path : Path
        Need not exist.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._file = QSettings(str(path), QSettings.Format.IniFormat)

    def _get(self, key: str, default: T) -> T:
        # A new process reads every value as a string unless it is told the type.
        try:
            value = self._file.value(key, default, type(default))
        except (TypeError, ValueError, EOFError):
            # Somebody edited the file by hand, or it is damaged: what cannot be understood is as if it were not there.
            return default
        return value if isinstance(value, type(default)) else default

    def _set(self, key: str, value: object) -> None:
        self._file.setValue(key, value)

    def sync(self) -> None:
        """Write to the disk now."""
        self._file.sync()

    @property
    def language(self) -> str:
        """``"en"``, ``"ja"``; empty: the system's."""
        return self._get("interface/language", "")

    @language.setter
    def language(self, value: str) -> None:
        self._set("interface/language", value)

    @property
    def theme(self) -> str:
        """``"dark"`` or ``"light"``."""
        return self._get("interface/theme", "dark")

    @theme.setter
    def theme(self, value: str) -> None:
        self._set("interface/theme", value)

    @property
    def folded(self) -> dict[str, bool]:
        """Which parts of panels are folded, by name."""
        found = {}
        for entry in self._get("interface/folded", "").split(","):
            name, _, state = entry.partition(":")
            if name and state in ("0", "1"):
                found[name] = state == "1"
        return found

    @folded.setter
    def folded(self, value: Mapping[str, bool]) -> None:
        self._set("interface/folded", ",".join(f"{name}:{int(folded)}" for name, folded in sorted(value.items())))

    @property
    def written_pitch(self) -> bool:
        """Pitches as written for the instrument instead of as they sound."""
        return self._get("pitch/written", False)

    @written_pitch.setter
    def written_pitch(self, value: bool) -> None:
        self._set("pitch/written", value)

    @property
    def middle_c_octave(self) -> int:
        """3 or 4."""
        return 3 if self._get("pitch/middle_c_octave", 4) == 3 else 4

    @middle_c_octave.setter
    def middle_c_octave(self, value: int) -> None:
        self._set("pitch/middle_c_octave", value)

    @property
    def syllables(self) -> bool:
        """Do re mi instead of C D E."""
        return self._get("pitch/syllables", False)

    @syllables.setter
    def syllables(self, value: bool) -> None:
        self._set("pitch/syllables", value)

    @property
    def time_display(self) -> str:
        """``"bars"``, ``"seconds"`` or ``"frames"``."""
        return self._get("interface/time_display", "bars")

    @time_display.setter
    def time_display(self, value: str) -> None:
        self._set("interface/time_display", value)

    @property
    def volume(self) -> float:
        """0..1 as the ear judges it."""
        # Read as a number, a word is 0, and nobody would hear anything.
        try:
            value = float(self._get("sound/volume", ""))
        except ValueError:
            return 0.8
        return value if 0.0 <= value <= 1.0 else 0.8

    @volume.setter
    def volume(self, value: float) -> None:
        self._set("sound/volume", value)

    @property
    def click(self) -> bool:
        """Whether a metronome is heard."""
        return self._get("sound/click", False)

    @click.setter
    def click(self, value: bool) -> None:
        self._set("sound/click", value)

    @property
    def scrub_sound(self) -> bool:
        """Whether moving the playhead by hand is heard."""
        return self._get("sound/scrub", True)

    @scrub_sound.setter
    def scrub_sound(self, value: bool) -> None:
        self._set("sound/scrub", value)

    @property
    def source(self) -> str:
        """What is heard where a project has a recording: ``"recording"``, ``"synthesiser"`` or ``"both"``."""
        return self._get("sound/source", "recording")

    @source.setter
    def source(self, value: str) -> None:
        self._set("sound/source", value)

    @property
    def midi_port(self) -> str:
        """The device that is recorded from; empty: none was chosen."""
        return self._get("midi/port", "")

    @midi_port.setter
    def midi_port(self, value: str) -> None:
        self._set("midi/port", value)

    @property
    def count_in_bars(self) -> int:
        """0..4."""
        return min(max(self._get("midi/count_in_bars", 1), 0), 4)

    @count_in_bars.setter
    def count_in_bars(self, value: int) -> None:
        self._set("midi/count_in_bars", value)

    @property
    def stream_host(self) -> str:
        """The computer that is streamed to; empty: none was chosen."""
        return self._get("stream/host", "")

    @stream_host.setter
    def stream_host(self, value: str) -> None:
        self._set("stream/host", value)

    @property
    def stream_port(self) -> int:
        """0: none was chosen, or it is none."""
        value = self._get("stream/port", 0)
        return value if LEAST_PORT <= value <= MOST_PORT else 0

    @stream_port.setter
    def stream_port(self, value: int) -> None:
        self._set("stream/port", value)

    @property
    def stream_everyone(self) -> bool:
        """Every player is streamed, not only the one in front."""
        return self._get("stream/everyone", False)

    @stream_everyone.setter
    def stream_everyone(self, value: bool) -> None:
        self._set("stream/everyone", value)

    @property
    def stream_faces(self) -> str:
        """Of `app.stream.faces.FACE_NAMES`; empty: none was chosen."""
        return self._get("stream/faces", "")

    @stream_faces.setter
    def stream_faces(self, value: str) -> None:
        self._set("stream/faces", value)

    @property
    def stream_rate_hz(self) -> int:
        """Frames in a second; 0: none were chosen."""
        return self._get("stream/rate_hz", 0)

    @stream_rate_hz.setter
    def stream_rate_hz(self, value: int) -> None:
        self._set("stream/rate_hz", value)

    def midi_device(self, port: str, name: str) -> str:
        """What is remembered of a device; empty: nothing."""
        return self._get(f"midi_devices/{quote(port, safe='')}/{name}", "") if port else ""

    def set_midi_device(self, port: str, name: str, value: str) -> None:
        """Remember something of a device."""
        if port:
            self._set(f"midi_devices/{quote(port, safe='')}/{name}", value)

    @property
    def geometry(self) -> QByteArray:
        """Where the window is and how large."""
        return self._get("window/geometry", QByteArray())

    @geometry.setter
    def geometry(self, value: QByteArray) -> None:
        self._set("window/geometry", value)

    @property
    def layout(self) -> QByteArray:
        """Where the panels are."""
        return self._get("window/layout", QByteArray())

    @layout.setter
    def layout(self, value: QByteArray) -> None:
        self._set("window/layout", value)

    @property
    def timeline(self) -> str:
        """The timeline's lanes: order, heights, folds."""
        return self._get("window/timeline", "")

    @timeline.setter
    def timeline(self, value: str) -> None:
        self._set("window/timeline", value)

    @property
    def folder(self) -> str:
        """Where a file was last opened or saved."""
        return self._get("files/folder", "")

    @folder.setter
    def folder(self, value: str) -> None:
        self._set("files/folder", value)

    @property
    def export_folder(self) -> str:
        """Where players were last exported to."""
        return self._get("files/export_folder", "")

    @export_folder.setter
    def export_folder(self, value: str) -> None:
        self._set("files/export_folder", value)

    @property
    def unreal_project(self) -> str:
        """The Unreal project that players were last exported into; empty: none."""
        return self._get("files/unreal_project", "")

    @unreal_project.setter
    def unreal_project(self, value: str) -> None:
        self._set("files/unreal_project", value)

    @property
    def export_into(self) -> str:
        """Where players were last exported to: ``"folder"`` or ``"unreal"``."""
        return self._get("files/export_into", "folder")

    @export_into.setter
    def export_into(self, value: str) -> None:
        self._set("files/export_into", value)

    @property
    def recent(self) -> tuple[str, ...]:
        """Files opened lately, the newest first."""
        count = self._file.beginReadArray("recent")
        try:
            found = []
            for index in range(min(count, MOST_RECENT)):
                self._file.setArrayIndex(index)
                found.append(self._get("path", ""))
            return tuple(path for path in found if path)
        finally:
            self._file.endArray()

    def add_recent(self, path: Path) -> None:
        """This file was opened or saved just now."""
        text = str(path)
        self._write_recent((text, *(other for other in self.recent if other != text))[:MOST_RECENT])

    def remove_recent(self, path: str) -> None:
        """Forget a file."""
        self._write_recent(tuple(other for other in self.recent if other != path))

    def _write_recent(self, paths: tuple[str, ...]) -> None:
        self._file.remove("recent")
        self._file.beginWriteArray("recent", len(paths))
        for index, path in enumerate(paths):
            self._file.setArrayIndex(index)
            self._file.setValue("path", path)
        self._file.endArray()

    def shortcut(self, action_id: str) -> str | None:
        """A person's own shortcut of an action, ``;`` between several, empty for none; None: as it comes."""
        key = f"shortcuts/{action_id}"
        return self._get(key, "") if self._file.contains(key) else None

    def set_shortcut(self, action_id: str, keys: str | None) -> None:
        """Give an action a shortcut of one's own; None: as it comes."""
        key = f"shortcuts/{action_id}"
        if keys is None:
            self._file.remove(key)
        else:
            self._file.setValue(key, keys)
