"""Texts from files and file names cannot control the terminal or imitate the program's own lines."""

from __future__ import annotations

import json
import shutil
import struct
import unicodedata
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import pytest

from app.cli.progress import Progress
from app.cli.terminal import say
from app.encoding import shown
from app.project.storage import load, save
from app.rig.characters import character_library
from instrument_maps import library
from tests.gui.conftest import quartet_project
from tests.support.odd_names import odd, on_bytes
from tests.unit.cli.test_main import ROOT, Run, named_piece, run

run = run
FORGED = "suisou: all is well"
HOSTILE = f"\x1b]0;title\x07\x1b[2J\n{FORGED}\r\x9b31m\u202e\u2028\t曲 ガ\u3000é👩\u200d🎤"
"""Text with codes that set a terminal's title, clear it, begin a line, change colour and direction, and with harmless
text.
"""
KEPT = "曲 ガ\u3000é👩\u200d🎤"


def harmless(printed: str) -> str:
    """Check that a printed text has no control characters and no forged line, and return it."""
    assert not [c for c in printed if c != "\n" and unicodedata.category(c) in ("Cc", "Zl", "Zp", "Cs")]
    assert "\u202e" not in printed
    assert f"\n{FORGED}" not in printed
    return printed


def inside(printed: str) -> str:
    """Check the same, and that the harmless part of the text is contained."""
    assert KEPT in printed
    return harmless(printed)


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder of the user's own instruments and characters with a hostile name."""
    folder = tmp_path / HOSTILE
    folder.mkdir()
    monkeypatch.setenv("SUISOU_INSTRUMENTS", str(folder))
    monkeypatch.setenv("SUISOU_CHARACTERS", str(folder))
    monkeypatch.setattr(library.LIBRARY, "last", None)
    monkeypatch.setattr(character_library.LIBRARY, "last", None)
    return folder


@on_bytes
def test_names_of_files(run: Run, own: Path) -> None:
    piece = named_piece(own / f"{HOSTILE}.mid", "trumpet")
    status, out, err = run("inspect", piece)
    assert (status, err) == (0, "")
    assert inside(out).startswith("\\x1b]0;title\\x07\\x1b[2J\\nsuisou: all is well\\r\\x9b31m\\u202e\\u2028\\t曲")
    status, out, _ = run("midi", piece, "--to", own / f"{HOSTILE}.2.mid")
    assert status == 0
    assert inside(out).count("\n") == 1
    for arguments in (
        ["inspect", own / f"{HOSTILE}.none"],
        ["inspect", odd(own, f"\x1b[2J\n{FORGED}")],
        ["inspect", piece, HOSTILE],
        ["inspect", piece, "--encoding", HOSTILE],
        ["inspect", piece, "--set", f"{HOSTILE}.amplitude=1"],
        ["export", piece, "--to", own / "out", "--player", HOSTILE],
        ["export", piece, "--to", piece],
        ["midi", piece, "--to", piece],
        ["characters", "check", piece],
        ["instruments", "check", piece],
        ["instruments", "scale", HOSTILE],
        ["record", "--rescue", "--to", piece],
        ["stream", piece, "--player", HOSTILE],
    ):
        status, out, err = run(*arguments)
        assert status != 0
        assert "曲 ガ" in err or HOSTILE not in str(arguments[-1])
        harmless(out + err)


@on_bytes
def test_what_is_exported(run: Run, own: Path) -> None:
    piece = named_piece(own / f"{HOSTILE}.mid", "trumpet")
    status, out, _ = run("export", piece, "--to", own / "out", "--format", "bvh", "--to-bar", "1")
    assert status == 0
    inside(out)
    assert json.loads((own / "out" / "report.json").read_text())["source"] == shown(piece.name)


def test_texts_of_a_project(run: Run, tmp_path: Path) -> None:
    file = tmp_path / "piece.suisou"
    project = quartet_project()
    first = project.players[0]
    save(replace(project, players=(msgspec.structs.replace(first, name=HOSTILE), *project.players[1:])), file)
    assert load(file).players[0].name == HOSTILE
    inside(run("inspect", file, "--fps", "24")[1])
    status, out, _ = run("inspect", file, "--json", "--fps", "24")
    assert status == 0
    assert json.loads(inside(out))["players"][0]["name"] == HOSTILE


@on_bytes
def test_own_instruments(run: Run, own: Path) -> None:
    for name, content in {
        f"{HOSTILE}.toml": 'extends = "trumpet_Bb"\n',
        "kazoo.toml": f'extends = "trumpet_Bb"\nid = "kazoo"\nname.en = {json.dumps(HOSTILE, ensure_ascii=False)}\n',
        "hoover.toml": f'extends = "trumpet_Bb"\nid = "hoover"\n{json.dumps(HOSTILE, ensure_ascii=False)} = 1\n',
    }.items():
        (own / name).write_text(content)
    for arguments in (["instruments"], ["instruments", "scale", "kazoo"]):
        status, out, err = run(*arguments)
        assert status == 0
        harmless(out + err)
    inside(run("instruments")[1])
    inside(run("inspect", ROOT / "resources" / "examples" / "quartet.mid", "--no-contacts")[2])
    for path in own.iterdir():
        harmless("".join(run("instruments", "check", path)[1:]))


@on_bytes
def test_figures(run: Run, own: Path) -> None:
    file = own / f"{HOSTILE}.vrm"
    shutil.copy(ROOT / "tests" / "data" / "characters" / "toddler_vrm1.vrm", file)
    rename(file)
    for command in ("check", "add"):
        status, out, err = run("characters", command, file)
        harmless(out + err)
    assert status == 0
    status, out, _ = run("characters", "check", file, "--json")
    found = json.loads(inside(out))
    assert found["file"] == str(file)
    assert HOSTILE in found["meshes"]
    inside(run("characters")[1])
    status, out, _ = run("characters", "--json")
    assert json.loads(inside(out))["folder"] == str(own)


def rename(file: Path) -> None:
    """Give the mesh and a bone of a glTF binary a hostile name."""
    content = file.read_bytes()
    (length,) = struct.unpack_from("<I", content, 12)
    table: dict[str, Any] = json.loads(content[20 : 20 + length])
    table["meshes"][0]["name"] = table["nodes"][0]["name"] = HOSTILE
    text = json.dumps(table).encode()
    text += b" " * (-len(text) % 4)
    rest = content[20 + length :]
    file.write_bytes(content[:8] + struct.pack("<III", 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest)


def test_progress_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    import sys

    class Terminal:
        written = ""

        def isatty(self) -> bool:
            return True

        def write(self, text: str) -> None:
            self.written += text

        def flush(self) -> None:
            pass

    terminal = Terminal()
    Progress(terminal)(0.5, HOSTILE)
    harmless(terminal.written.removeprefix("\r"))
    say("\udcff", stream=sys.stderr)
    assert capsys.readouterr().err == "ÿ\n"


def test_what_is_only_text_stays() -> None:
    for text in ("C:\\Users\\森\\曲.mid", "naïve ﬁle “x” – 50 %", KEPT, "e\u0301 ｶﾞ \ue000"):
        assert shown(text) == text
    assert shown(shown(HOSTILE)) == shown(HOSTILE)
