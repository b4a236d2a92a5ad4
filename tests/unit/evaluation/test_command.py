"""Errors of `suisou evaluate` before anything is drawn, and accepted videos; tests/gui/evaluation/test_command.py tests
the drawing.
"""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from app.audio.mix import mixdown
from app.audio.track import RATE_HZ, Block
from app.cli import main
from app.errors import FileError
from app.evaluation.imported_videos import import_video, pictures_of
from app.export.video import video_into
from app.messages import error_text
from tests.unit.audio.pieces import quartet as played
from tests.unit.audio.test_follow import recorded, truth
from tests.unit.cli.test_main import QUARTET
from tests.unit.viewport.poses import quartet


@pytest.mark.parametrize(
    ("options", "status", "sentence"),
    [
        ("", 2, "the following arguments are required: --to"),
        ("--to a --variants film,generated", 2, "the variant 'film' needs a file: choose one with --film"),
        ("--to a --variants still", 2, "compares at least two variants"),
        ("--to a --variants ours", 2, "'ours' is not one of film, generated, still, shifted, keyframes"),
        ("--to a --film-offset 1", 2, "--film-offset is only possible with --film"),
        ("--to a --follow-film", 2, "--follow-film is only possible with --film"),
        ("--to a --film b --film-offset 1 --follow-film", 2, "--film-offset and --follow-film exclude each other"),
        ("--to a --from-bar 3 --seconds 4", 2, "--seconds and --from-bar/--to-bar exclude each other"),
        ("--to a --to-bar 45", 2, "the piece has bars 1 to 44"),
        ("--to a --size 101x100", 2, "even width and height"),
        ("--to a --excerpts 0", 2, "'0' is not a number of excerpts from 1 to 20"),
        ("--to file/a", 1, "file is not a folder"),
        ("--to a", 3, "no display here"),
    ],
)
def test_what_is_refused(
    options: str,
    status: int,
    sentence: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("app.cli.evaluation.make.why_no_display", lambda **asked: "no display here")
    (tmp_path / "file").write_text("")
    assert main(["evaluate", str(QUARTET), *options.split()]) == status
    captured = capsys.readouterr()
    assert sentence in captured.err
    assert captured.out == ""
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


LATE_S = 1.5
LENGTH_S = 24.0
FILM_FPS = Fraction(5)


def film_of(path: Path, sound: Block | None, size: tuple[int, int] = (64, 48)) -> None:
    """Film whose pictures encode their time as brightness."""
    with video_into(path, size, FILM_FPS, sound, RATE_HZ) as film:
        for index in range(round(LENGTH_S * FILM_FPS)):
            film.write(np.full((size[1], size[0], 3), 2 * index, np.uint8))


@pytest.fixture(scope="module")
def films(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Films of the quartet from some time after its beginning: with sound, without sound, and of another piece."""
    folder = tmp_path_factory.mktemp("films")
    film_of(folder / "film.mp4", mixdown(quartet(), LATE_S, LATE_S + LENGTH_S, RATE_HZ))
    film_of(folder / "silent.mp4", None)
    noise = 0.1 * np.random.default_rng(1).standard_normal((round(LENGTH_S * RATE_HZ), 2))
    film_of(folder / "other.mp4", noise.astype(np.float32))
    (folder / "text.mp4").write_text("no film")
    return folder


def nothing(share: float) -> None:
    """Replacement for drawing that shows nothing."""


def test_a_film_is_placed_by_its_sound_and_its_pictures_are_those_of_the_time(films: Path) -> None:
    video, _ = import_video(quartet(), films / "film.mp4", None, nothing, lambda: False)
    assert video.offset_s == pytest.approx(LATE_S, abs=0.03)
    assert video.confidence is not None
    assert video.confidence > 0.5
    assert video.covered_s == pytest.approx((LATE_S, LATE_S + LENGTH_S), abs=0.3)
    with pictures_of(video, 10.0, (128, 64)) as draw:
        for time_s in (10.0, 10.05, 10.5, 13.0):
            picture = draw(time_s)
            seen = int((time_s - video.offset_s) * FILM_FPS)
            assert picture.shape == (64, 128, 3)
            # Whole, in the middle, with nothing at its sides.
            assert abs(int(picture[32, 64, 0]) - 2 * seen) <= 3
            assert not picture[:, :16].any()
            assert picture[:, 28:100].all()


@pytest.mark.parametrize(
    ("name", "follow", "error", "remedy"),
    [
        ("silent.mp4", False, "silent_video", "--film-offset"),
        ("silent.mp4", True, "silent_video", "--film-offset"),
        ("other.mp4", False, "other_piece", "--follow-film"),
        ("other.mp4", True, "not_followed", "--film-offset"),
        ("text.mp4", False, "not_readable", ""),
        ("missing.mp4", False, "cannot_read", ""),
    ],
)
def test_a_video_that_is_of_no_use_is_named(films: Path, name: str, follow: bool, error: str, remedy: str) -> None:
    with pytest.raises(FileError, match=error) as raised:
        import_video(quartet(), films / name, None, nothing, lambda: False, follow)
    assert raised.value.message.arguments["file"] == str(films / name)
    assert remedy in error_text(raised.value)


def test_a_silent_video_is_placed_by_hand(films: Path) -> None:
    video, _ = import_video(quartet(), films / "silent.mp4", -2.0, nothing, lambda: False)
    assert video.samples is None
    assert video.covered_s == pytest.approx((-2.0, LENGTH_S - 2.0), abs=0.3)


def test_the_piece_follows_a_film_of_a_part_of_it(tmp_path: Path) -> None:
    """The film is played faster and slower, which no constant tempo fits."""
    path, first_s, length_s = tmp_path / "film.mp4", 30, 25
    sound = recorded()[first_s * RATE_HZ : (first_s + length_s) * RATE_HZ]
    with video_into(path, (16, 16), Fraction(1), sound, RATE_HZ) as film:
        for _ in range(length_s):
            film.write(np.zeros((16, 16, 3), np.uint8))
    project = played()
    video, followed = import_video(project, path, None, nothing, lambda: False, follow=True)
    assert followed.audio is None
    for second in (1.0, 5.0, 10.0, 20.0, 24.0):
        tick = float(truth().score.tempo_map.ticks(first_s + second))
        assert float(followed.score.tempo_map.seconds(tick)) - video.offset_s == pytest.approx(second, abs=0.05)
    assert video.covered_s[1] - video.covered_s[0] == pytest.approx(length_s, abs=0.5)
