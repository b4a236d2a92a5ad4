"""Typed settings stored in a TOML file."""

from __future__ import annotations

import base64
import binascii
import os
from pathlib import Path
from typing import Any, Final, Generic, TypeVar, overload

from PySide6.QtCore import QByteArray, QCoreApplication, QObject, QTimer, Signal

from app import encoding
from app.editor.setting_bindings import SettingBinding
from app.errors import AppError, FileError, MapError, Message
from app.formats.atomic import atomic_write
from app.formats.files import cannot_write
from app.formats.toml import read_toml, shaped, toml

T = TypeVar("T")
WRITE_MS: Final = 300
"""Interval in milliseconds at which settings are written, since a dragged value changes many times a second."""


class Setting(Generic[T]):
    """Declaration of one setting, an attribute of `StoredSettings`: default, label and options.

    It defines how the setting is restored, stored and shown in the preferences.

    Parameters
    ----------
    key : str
        Place of the setting in the file: ``section/name``, or a whole section.
    kind : type, optional
        Type by which msgspec checks the value; by default that of the default value.
    held : SettingBinding, optional
        Binding to the value of the session that the setting stores and restores.
    label : str
        Text id of the label in the preferences; empty if they do not show the setting.
    options : tuple of (value, word)
        Allowed values with their text ids, if limited to these.
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
        """Return the ids of all texts of a setting: its label, then its options."""
        return (self.label, *(word for _, word in self.options))

    @overload
    def __get__(self, settings: None, owner: type) -> Setting[T]: ...
    @overload
    def __get__(self, settings: StoredSettings, owner: type) -> T: ...
    def __get__(self, settings: StoredSettings | None, owner: type) -> T | Setting[T]:
        if settings is None:
            return self
        stored = settings.stored(self.keys)
        return self.default if stored is None else self.read(stored, "")

    def __set__(self, settings: StoredSettings, value: T) -> None:
        settings.store(self.keys, self.written(value))

    def read(self, stored: object, file: str) -> T:
        """Decode a stored value.

        Raises
        ------
        MapError
            If the value is invalid; the error names ``file``.
        """
        value: T = shaped(stored, self._kind, file)
        possible = [one for one, _ in self.options]
        if possible and value not in possible:
            raise MapError("table.invalid", file=file, place="", detail=f"possible: {', '.join(map(str, possible))}")
        return value

    def written(self, value: T) -> object:
        """Return a value of the setting as it is stored in TOML."""
        return value


class BytesSetting(Setting[QByteArray]):
    """A setting whose value is bytes of Qt, stored as base64."""

    def __init__(self, key: str) -> None:
        super().__init__(key, QByteArray(), str)

    def read(self, stored: object, file: str) -> QByteArray:
        try:
            return QByteArray(base64.b64decode(shaped(stored, str, file), validate=True))
        except (binascii.Error, ValueError):
            return self.default

    def written(self, value: QByteArray) -> object:
        return base64.b64encode(value.data()).decode()


class FilePathSetting(Setting[str]):
    """A setting whose value is a path, including names that are not valid UTF-8."""

    def read(self, stored: object, file: str) -> str:
        return encoding.restored(super().read(stored, file))

    def written(self, value: str) -> object:
        return encoding.stored(value)


class StoredSettings(QObject):
    """Settings in a file; each change is written soon afterwards, merged with changes of other editors.

    Parameters
    ----------
    path : Path
        Path of the file, which need not exist.

    Signals
    -------
    failed(Message)
        The file cannot be read or written; emitted once.
    """

    failed = Signal(object)

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

    @classmethod
    def declared(cls) -> tuple[Setting[Any], ...]:
        """Return all settings that the class declares as attributes."""
        return tuple(value for value in vars(cls).values() if isinstance(value, Setting))

    def stored(self, keys: tuple[str, str]) -> object:
        """Return the stored value of a setting by its section and name (``keys``); None if none is stored."""
        section, name = keys
        values = self._table.get(section)
        return values if not name else values.get(name) if isinstance(values, dict) else None

    def store(self, keys: tuple[str, str], value: object) -> None:
        """Store a value by section and name, and write the file soon."""
        if self.stored(keys) == value:
            return
        _put(self._table, keys, value)
        self._changes[keys] = value
        if not self._timer.isActive() and QCoreApplication.instance() is not None:
            self._timer.start()

    def sync(self) -> None:
        """Write changes to disk now, merged with those of other editors.

        A file that cannot be read is not replaced; the changes are written later.
        """
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
        """Return the table of stored settings without invalid values, each of which is reported once."""
        self._table = table
        file = os.fspath(self.path)
        for value in self.declared():
            if (stored := self.stored(value.keys)) is not None:
                try:
                    value.read(stored, file)
                except AppError as error:
                    place, detail = ".".join(filter(None, value.keys)), str(error.message.arguments["detail"])
                    self.problems += (Message("settings.value", {"file": file, "place": place, "detail": detail}),)
                    _put(table, value.keys, None)
        return table


def _put(table: dict[str, Any], keys: tuple[str, str], value: object) -> None:
    """Put a value into a table by section and name; None removes the value."""
    section, name = keys
    if not name:
        table[section] = value
        return
    if not isinstance(table.get(section), dict):
        table[section] = {}
    table[section][name] = value
