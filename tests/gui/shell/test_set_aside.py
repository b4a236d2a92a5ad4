"""Despite invalid files of every kind among the user's own, the editor starts, reports them and uses bundled ones."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from app.editor.settings import Settings, settings_path
from app.encoding import shown
from app.errors import Message
from app.project.autosave import Autosave
from app.project.presets import expression_folder, preset_folder
from app.project.running_editors import Presence
from app.rig.characters import character_library
from app.rig.characters.character_library import bundled_characters, character_named
from app.shell.app import Program
from instrument_maps import library as instrument_library
from instrument_maps.load import bundled_maps
from tests.gui.conftest import QUARTET
from tests.gui.shell.conftest import Answers
from tests.support.tasks import ImmediateTasks

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="pipes, devices and links of POSIX")

BAD: dict[str, Callable[[Path], object]] = {
    "digits": lambda path: path.write_text("a = " + "1" * 5000),
    "nested": lambda path: path.write_text("a = " + "[" * 100_000),
    "dotted": lambda path: path.write_text(".".join("a" * 100_000) + " = 1"),
    "infinite": lambda path: path.write_text("[midi]\ncount_in_bars = inf\n"),
    "bytes": lambda path: path.write_bytes(b"\xff\xfe\x00a"),
    "nul": lambda path: path.write_bytes(b"name = 'a'\0"),
    "folder": Path.mkdir,
    "pipe": os.mkfifo,
    "circle": lambda path: path.symlink_to(path),
    "device": lambda path: path.symlink_to("/dev/zero"),
    "large": lambda path: (path.touch(), os.truncate(path, 100 * 2**20)),
    "types": lambda path: path.write_text("id = []\nname = 3\nfile = {}\nweights = 'x'\nextends = 1.0\n"),
    "escape": lambda path: path.write_text(
        "id = '../../x'\nname = '<img src=\"file:///dev/zero\">'\nfile = '/dev/zero'\n"
    ),
    "unseen": lambda path: path.with_name("u\udcff\n.toml").write_text("file = 'a.vrm'"),
}


@pytest.fixture
def homes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's folders, with libraries not read yet."""
    for name in ("XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME"):
        monkeypatch.setenv(name, str(tmp_path / name.lower()))
    for module in (instrument_library, character_library):
        monkeypatch.setenv(module.FOLDER_VARIABLE, str(tmp_path / module.__name__))
        monkeypatch.setattr(module.LIBRARY, "last", None)
    return tmp_path


def fill(folder: Path) -> set[str]:
    """Put a file of each kind into a folder and return their names."""
    folder.mkdir(parents=True)
    for name, make in BAD.items():
        make(folder / f"{name}.toml")
    return {path.name for path in folder.iterdir()}


def content(folder: Path) -> dict[str, tuple[int, int]]:
    return {path.name: (path.lstat().st_mtime_ns, path.lstat().st_size) for path in folder.iterdir()}


def test_everything_bad_at_once(homes: Path, qtbot: QtBot, qt_app: object) -> None:
    folders = [instrument_library.own_folder(), character_library.own_folder(), preset_folder(), expression_folder()]
    names = {folder: fill(folder) for folder in folders}
    # Models, characters and a recording that are none, beside tables that name them.
    (folders[0] / "kazoo.toml").write_text('extends = "trumpet_Bb"\nid = "kazoo"\nmodel = "kazoo.glb"\n')
    os.mkfifo(folders[0] / "kazoo.glb")
    (folders[1] / "piped.toml").write_text('file = "piped.vrm"\n')
    os.mkfifo(folders[1] / "piped.vrm")
    # No file can be called so.
    (folders[0] / "long.toml").write_text(f'extends = "trumpet_Bb"\nid = "long"\nmodel = "{"m" * 5000}.glb"\n')
    (folders[1] / "long.toml").write_text(f'file = "{"m" * 5000}.vrm"\n')
    settings_path().parent.mkdir(exist_ok=True)
    BAD["infinite"](settings_path())
    recovery = homes / "recovery"
    recovery.mkdir()
    for name, make in BAD.items():
        make(recovery / f"{name}.json")
        make(recovery / f"{name}.suisou")
        make(recovery / f"{name}.lock")
        make(recovery / f"{name}.suisou.1.take-journal")
    before = {folder: content(folder) for folder in folders}

    settings = Settings(settings_path())
    reported: list[Message] = []
    program = Program(settings, ImmediateTasks(), Answers(), Autosave(Presence(recovery)), audible=False)
    program.session.noticed.connect(lambda message, severity: reported.append(message))
    program.window.show()
    qtbot.waitUntil(lambda: len({file_of(message) for message in reported}) >= 2 * len(BAD) + 4)
    try:
        said = {file_of(message) for message in reported}
        assert str(settings_path()) in said
        for folder in folders[:2]:
            missing = {name for name in names[folder] if shown(folder / name) not in said}
            assert missing == set()
        assert {str(folders[0] / "kazoo.toml"), *(str(folder / "long.toml") for folder in folders[:2])} <= said
        # Presets and expressions say theirs where they are chosen.
        assert content(folders[0]) == before[folders[0]]
        assert all(content(folder) == before[folder] for folder in folders)
        assert settings.count_in_bars == 1
        program.editor.files.open(QUARTET, ask=False)
        assert len(program.session.project.players) == 4
        assert set(bundled_maps()) <= set(instrument_library.all_maps())
        assert character_named(next(iter(bundled_characters()))).meshes
    finally:
        program.window.hide()
        program.end()
        program.editor.files.end()


def file_of(message: Message) -> str:
    return str(message.arguments.get("file", ""))
