"""All commands accept file names that are not UTF-8, and locales that are not."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from app.encoding import restored
from app.project.storage import load, save
from app.rig.characters import character_library
from instrument_maps import library
from tests.support.odd_names import NAME, odd, on_bytes
from tests.unit.cli.test_main import QUARTET, ROOT, named_piece, run, suisou

pytestmark = on_bytes
Run = Callable[..., tuple[int, str, str]]
run = run
CHARACTERS = ROOT / "tests" / "data" / "characters"


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Path]:
    """Folder with such a name that contains a piece with such a name; the user's own files are in such folders too."""
    result = odd(tmp_path)
    result.mkdir()
    shutil.copy(QUARTET, odd(result, ".mid"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SUISOU_CHARACTERS", str(odd(tmp_path, ".characters")))
        patch.setenv("SUISOU_INSTRUMENTS", str(result))
        _reload()
        yield result
    _reload()


def _reload() -> None:
    library.reload()
    character_library.reload_characters()


def readable(printed: str) -> str:
    """Check that a printed text can be encoded and that no name is escaped, and return it."""
    printed.encode()
    assert "\\udc" not in printed
    return printed


def test_pieces(run: Run, folder: Path) -> None:
    piece = odd(folder, ".mid")
    status, out, _ = run("inspect", piece, "--fps", "24")
    assert status == 0
    assert readable(out).startswith(f"{NAME}.mid: ")
    status, out, _ = run("midi", piece, "--to", odd(folder, ".out.mid"))
    assert status == 0
    assert f"{NAME}/{NAME}.out.mid: 4 tracks" in readable(out)
    assert odd(folder, ".out.mid").is_file()
    status, _, err = run("inspect", odd(folder, ".none"))
    assert status == 1
    assert f"{NAME}/{NAME}.none" in readable(err)
    status, _, err = run("midi", piece, "--to", odd(folder, ".none") / "x.mid")
    assert status == 1
    assert f"{NAME}/{NAME}.none/x.mid" in readable(err)


def test_a_project_that_is_exported(run: Run, folder: Path) -> None:
    from tests.gui.conftest import quartet_project

    project = odd(folder, ".suisou")
    save(quartet_project(), project)
    assert load(project) == quartet_project()
    target = odd(folder, ".out")
    requested = ("--to-bar", "1", "--player", "Trumpet 1", "--format", "bvh,fbx,glb,usd", "--sound")
    status, out, _ = run("export", project, "--to", target, *requested)
    assert status == 0
    assert f"{NAME}/{NAME}.out: " in readable(out)
    written = {path.name for path in target.iterdir() if path.is_file()}
    assert f"{NAME}.wav" in written
    assert {Path(name).suffix for name in written} == {".bvh", ".fbx", ".glb", ".usdc", ".wav", ".json"}
    assert json.loads((target / "report.json").read_text())["source"] == f"{NAME}.suisou"


@pytest.mark.parametrize("file", ["toddler_vrm1.vrm", "child_mixamo.fbx"])
def test_characters(run: Run, folder: Path, file: str) -> None:
    path = odd(folder, Path(file).suffix)
    shutil.copy(CHARACTERS / file, path)
    status, out, _ = run("characters", "check", path)
    assert status == 0
    assert readable(out).startswith(f"{folder.parent}/{NAME}/{NAME}{path.suffix}: ")
    status, out, _ = run("characters", "check", path, "--json")
    assert restored(json.loads(readable(out))["file"]) == str(path)
    status, id, _ = run("characters", "add", path)
    assert status == 0
    status, out, _ = run("characters", "--json")
    found = json.loads(readable(out))
    (own,) = [row for row in found["characters"] if row["own"]]
    assert (own["id"], own["title"]) == (id.strip(), NAME)
    assert Path(restored(own["file"])).is_file()
    assert f"{NAME}.characters" in readable(run("characters")[1])


def test_instruments(run: Run, folder: Path) -> None:
    path = odd(folder, ".toml")
    shutil.copy(ROOT / "instrument_maps" / "trumpet_Bb.toml", path)
    status, out, _ = run("instruments", "check", path)
    assert (status, readable(out)) == (0, f"{NAME}.toml: valid\n")
    library.reload()
    status, out, _ = run("instruments")
    assert status == 0
    assert f"{folder.parent}/{NAME}/{NAME}.toml" in readable(out), "it is called otherwise than its id"


def test_recording(run: Run, folder: Path) -> None:
    status, _, err = run("record", "--rescue", "--to", odd(folder, ".mid"))
    assert status == 1
    assert f"{NAME}/{NAME}.mid" in readable(err)


@pytest.mark.parametrize(
    "arguments",
    [
        ("inspect", "{name}.mid"),
        ("inspect", "{name}.suisou"),
        ("midi", QUARTET, "--to", "{name}.mid"),
        ("export", QUARTET, "--to", "{name}/out"),
        ("export", QUARTET, "--unreal", "{name}.uproject"),
        ("characters", "check", "{name}.vrm"),
        ("instruments", "check", "{name}.toml"),
        ("record", "--rescue", "--to", "{name}.mid"),
        ("record", "--port", "x", "--to", "{name}.mid"),
    ],
)
def test_names_longer_than_the_system_takes(run: Run, tmp_path: Path, arguments: tuple[str | Path, ...]) -> None:
    name = "長" * 300
    status, out, err = run(*(str(each).replace("{name}", str(tmp_path / name)) for each in arguments))
    assert status == 1
    assert name in out + err


def test_a_locale_that_is_not_utf8(tmp_path: Path) -> None:
    """Names are stored correctly on the disk although Python misinterprets the locale."""
    environment = {**os.environ, "LC_ALL": "POSIX", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    named_piece(tmp_path / f"{NAME}.mid", "ホルン")
    shutil.copy(tmp_path / f"{NAME}.mid", odd(tmp_path, ".mid"))
    for piece in (tmp_path / f"{NAME}.mid", odd(tmp_path, ".mid")):
        done = suisou("inspect", piece, env=environment)
        assert done.returncode == 0, done.stderr
        assert done.stdout.decode().startswith(f"{NAME}.mid: ")
        assert done.stderr == b""
    requested = ("--format", "bvh", "--fps", "24", "--to-bar", "1")
    done = suisou("export", odd(tmp_path, ".mid"), "--to", tmp_path / "ファイル", *requested, env=environment)
    assert done.returncode == 0, done.stderr
    assert {path.name for path in (tmp_path / "ファイル").iterdir()} == {"report.json", "ホルン.bvh"}
    assert done.stderr == b""
