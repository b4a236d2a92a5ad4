"""`suisou evaluate` with drawn players: clips differ only in the variant."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from app.audio.decode import decode
from app.cli import main
from app.evaluation.key import read_key
from app.formats.video import video_facts, video_pictures
from tests.unit.cli.test_main import QUARTET
from tests.unit.evaluation.test_command import film_of

SMALL = ("--excerpts", "1", "--seconds", "1", "--fps", "4", "--size", "96x64", "--view", "front", "--player", "Tr*1")


def pictures(path: Path) -> np.ndarray:
    found = []
    with video_pictures(str(path), Fraction(4), (96, 64)) as film:
        while (picture := film.read()) is not None:
            found.append(picture)
    return np.array(found, np.int64)


def sound(path: Path) -> np.ndarray:
    return decode(str(path)).samples


@pytest.mark.drawn
def test_all_variants_are_seen_alike(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    film, other, folder = tmp_path / "film.mp4", tmp_path / "other.mp4", tmp_path / "made"
    film_of(film, None)
    film_of(other, None)
    options = ("--film", str(film), "--film-offset", "0", "--keyframes", str(other), "--keyframes-offset", "1")
    assert main(["evaluate", str(QUARTET), *SMALL, *options, "--draw", "3", "--to", str(folder)]) == 0
    said = capsys.readouterr()
    assert "5 clips (1 excerpt, 5 variants) and 4 pairs" in said.out
    assert said.err == ""
    key = read_key(folder / "key.json")
    assert key.aspects == ("fingers_arms", "body", "mouth")
    assert len(list((folder / "clips").iterdir())) == 5 + 4 + 1
    clips = {clip.variant: folder / "clips" / f"{clip.code}.mp4" for clip in key.clips}
    assert len({video_facts(str(path)) for path in clips.values()}) == 1
    sounds = {variant: sound(path) for variant, path in clips.items()}
    assert all(np.array_equal(heard, sounds["generated"]) for heard in sounds.values())
    assert sounds["generated"].any()
    seen = {variant: pictures(path) for variant, path in clips.items()}
    assert len({one.shape for one in seen.values()}) == 1
    # The floor and the wall are where they are in ours, whatever the players do.
    for variant in ("still", "shifted"):
        assert np.abs(seen[variant][:, :, :8] - seen["generated"][:, :, :8]).mean() < 3.0
    # The other film is that of a second earlier: five pictures.
    assert (seen["film"][:, 32, 48, 0] - seen["keyframes"][:, 32, 48, 0]).mean() == pytest.approx(10.0, abs=2.0)
    assert main(["evaluate", str(QUARTET), *SMALL, "--to", str(folder)]) == 1
    assert "already has an evaluation" in capsys.readouterr().err


@pytest.mark.drawn
def test_cancelled_it_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[bool] = []

    @contextmanager
    def stoppable() -> Iterator[Callable[[], bool]]:
        def stop_requested() -> bool:
            asked.append((tmp_path / "a" / "made").exists())
            return len([there for there in asked if there]) > 4

        yield stop_requested

    monkeypatch.setattr("app.cli.evaluation.make.stoppable", stoppable)
    assert main(["evaluate", str(QUARTET), *SMALL, "--to", str(tmp_path / "a" / "made")]) == 130
    assert any(asked)
    assert list(tmp_path.iterdir()) == []
