"""Films, frames and contact sheets from the command line equal the viewport's pictures."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import pytest
from PIL import Image

from app.choreography.model_file import write_model
from app.cli import main
from app.cli.status import BAD_INPUT, BAD_USE, DONE, PARTIAL
from app.editor.session import Session
from app.project.edit.dancers import add_dancer
from app.project.storage import save
from tests.gui.conftest import QUARTET
from tests.support.bad_players import with_character
from tests.support.dances import model
from tests.unit.project.pieces import small_project
from widgets.viewport import scene
from widgets.viewport.offscreen import captions
from widgets.viewport.panel import ViewportPanel

ROOT = Path(__file__).parents[3]


def film(capsys: pytest.CaptureFixture[str], *options: str | Path) -> str:
    """Text printed by the command ``film``."""
    assert main(["film", str(QUARTET), *map(str, options)]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    return captured.out


def test_frames_are_the_pictures_of_the_window(
    viewport: ViewportPanel, session: Session, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "frames"
    options = ("--view", "hands", "--player", "Trombone 1", "--from-bar", "3", "--to-bar", "3", "--outfit", "own")
    said = film(capsys, "--to", folder, "--fps", "1", "--size", "160x90", *options)
    names = sorted(path.name for path in folder.iterdir())
    assert said.startswith(f"{folder}: {len(names)} frames of 160x90 from ")
    first_s = float(said.split(" from ")[1].split(" s to ")[0])
    session.set_players((session.project.players[2].id,))
    draw = viewport.film(160, 90, (first_s, first_s + len(names)), "hands")
    for index, name in enumerate(names):
        with Image.open(folder / name) as picture:
            off = np.abs(np.asarray(picture).astype(int) - draw(first_s + index)[..., :3])
        # The pictures differ in their printed times.
        assert off.mean() < 0.5, name


def test_a_large_piece_is_seen_whole(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], qt_app: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The camera shows all performers, not only the one whose figure was loaded first."""
    pictures = []
    for number, few in enumerate((12, 3)):
        monkeypatch.setattr(scene, "FEW", few)
        film(capsys, "--sheet", tmp_path / f"{number}.png", "--every", "9", "--to-bar", "1", "--size", "128x72")
        with Image.open(tmp_path / f"{number}.png") as image:
            pictures.append(np.asarray(image).astype(int))
    assert np.abs(pictures[0] - pictures[1]).mean() < 0.5


def test_any_player_of_a_large_piece_is_filmed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], qt_app: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scene, "FEW", 3)
    options = ("--player", "Trombone 1", "--every", "9", "--to-bar", "1", "--size", "128x72")
    film(capsys, "--sheet", tmp_path / "one.png", *options)
    assert (tmp_path / "one.png").exists()


def test_a_contact_sheet_has_a_row_for_each_second(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], qt_app: object
) -> None:
    sheet = tmp_path / "sheet.png"
    said = film(capsys, "--sheet", sheet, "--every", "0.25", "--to-bar", "1", "--size", "128x72", "--language", "ja")
    assert "128x72、22 フレーム" in said
    with Image.open(sheet) as image:
        found = np.asarray(image)
    assert found.shape[1] == 4 + 4 * (128 + 4)
    tile = (found.shape[0] - 4) // 6
    frames = [found[4 + row * tile :][:72, 4 + column * 132 :][:, :128] for row in range(5) for column in range(4)]
    words = [found[4 + row * tile + 72 :][: tile - 76, 4 : 4 + 128] for row in range(5)]
    for pictures in (frames, words):
        assert all(len(np.unique(picture)) > 20 for picture in pictures)
        assert all((one != other).any() for one, other in pairwise(pictures))


def test_a_film_has_sound(tmp_path: Path, capsys: pytest.CaptureFixture[str], qt_app: object) -> None:
    path = tmp_path / "film.mp4"
    film(capsys, "--to", path, "--to-bar", "1", "--size", "64x64", "--fps", "5", "--view", "top")
    assert list(tmp_path.iterdir()) == [path]
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-i", str(path)]
    found = subprocess.run(command, capture_output=True, text=True, check=False).stderr
    assert "64x64" in found
    assert "5 fps" in found
    assert "Audio: aac" in found


def small(path: Path, *options: str) -> int:
    """Make a small contact sheet of a project and return the exit status."""
    return main(["film", str(path), "--sheet", f"{path}.png", "--every", "1", "--size", "64x64", *options])


def test_who_cannot_be_drawn_is_named_and_the_others_are_drawn(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], qt_app: object
) -> None:
    path = tmp_path / "piece.suisou"
    save(with_character(small_project(), 0, "nobody"), path)
    assert small(path) == PARTIAL
    assert "trumpet is excluded: the character 'nobody' of trumpet is not installed" in capsys.readouterr().err
    (tmp_path / "piece.suisou.png").unlink()
    assert small(path, "--view", "hands", "--player", "trumpet") == BAD_INPUT
    assert "no player can be displayed: trumpet: the character 'nobody'" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == [path]


def test_dancers_are_filmed_but_have_no_hands_on_an_instrument(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], qt_app: object
) -> None:
    write_model(tmp_path / "steps.choreography", model())
    project, _ = add_dancer(small_project(), tmp_path / "steps.choreography", "Dancer")
    save(project, tmp_path / "piece.suisou")
    assert small(tmp_path / "piece.suisou", "--player", "Dancer") == DONE
    assert small(tmp_path / "piece.suisou", "--player", "Dancer", "--view", "hands") == BAD_USE
    assert "Dancer plays no instrument" in capsys.readouterr().err


@pytest.mark.skipif(sys.platform == "win32", reason="signals to a child are another thing there")
@pytest.mark.parametrize("target", [("--to", "film.mp4"), ("--to", "frames"), ("--sheet", "sheet.png")])
def test_stopped_it_leaves_nothing(target: tuple[str, str], tmp_path: Path) -> None:
    command = [sys.executable, "-m", "app", "film", str(QUARTET), *target, "--size", "64x64", "--to-bar", "8"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(command, cwd=tmp_path, env=environment, stderr=subprocess.PIPE, text=True) as process:
        deadline_s = time.monotonic() + 300.0
        while not list(tmp_path.iterdir()) and process.poll() is None and time.monotonic() < deadline_s:
            time.sleep(0.05)
        assert list(tmp_path.iterdir()) != []
        process.send_signal(signal.SIGINT)
        said = process.stderr.read()
    assert (process.returncode, said) == (130, "suisou: stopped; nothing was written\n")
    assert list(tmp_path.iterdir()) == []


def test_without_gl_it_says_what_helps(tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "QT_QPA_PLATFORM": "offscreen"}
    command = [sys.executable, "-m", "app", "film", str(QUARTET), "--to", "film.mp4", "--to-bar", "1"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 3
    assert "OpenGL 2 is not available (Qt platform 'offscreen')" in done.stderr
    assert "xvfb-run" in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("width", [64, 96, 320])
def test_captions_are_whole_however_narrow_their_pictures_are(width: int) -> None:
    short, long = captions([("0.5 s · frame 1", "1.1"), ("133.50 秒 · フレーム 12810", "106.1.000")], width, "dark")
    assert short.shape == long.shape
    assert short.shape[1] == width
    ground = long[-1, -1]
    assert np.all(long[:, -1] == ground), "cut at the right edge"
    assert np.any(long[:, : width // 2] != ground)
