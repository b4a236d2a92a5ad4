"""Errors of `suisou film` before anything is drawn; tests/gui/viewport/test_film.py tests the drawing."""

from __future__ import annotations

from argparse import Namespace
from fractions import Fraction
from pathlib import Path

import pytest

from app.cli import main
from app.cli.film import Kind, caption_texts, shown_span
from app.performance.ensemble import Performance
from tests.unit.cli.test_main import QUARTET
from tests.unit.viewport.poses import quartet


@pytest.fixture(autouse=True)
def _no_display(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("app.cli.film.why_no_display", lambda **asked: "no display here")


@pytest.mark.parametrize(
    ("options", "status", "sentence"),
    [
        ("", 2, "one of the arguments --to --sheet is required"),
        ("--to a.mov", 2, "must end in .mp4"),
        ("--sheet a.jpg", 2, "must end in .png"),
        ("--to a.mp4 --every 0.1", 2, "--every is only possible with --sheet"),
        ("--to a --columns 2", 2, "--columns is only possible with --sheet"),
        ("--sheet a.png --fps 30", 2, "--fps is only possible with --to"),
        ("--to a --no-sound", 2, "--no-sound is only possible with --to OUT.mp4"),
        ("--to a.mp4 --size 101x100", 2, "even width and height"),
        ("--to a.mp4 --size 10x10", 2, "not between 64x64 and 7680x4320"),
        ("--to a.mp4 --size 99999999999", 2, "is not a size such as 1600x1000"),
        ("--to a.mp4 --camera Left", 2, "there is no camera 'Left' in this piece; known: -"),
        ("--to a.mp4 --camera Left --view top", 2, "not allowed with argument --camera"),
        ("--to a.mp4 --view bell", 2, "'hands', 'mouth', 'feet'"),
        ("--to a.mp4 --player flute", 2, "choose one of: Trumpet 1, Trumpet 2, Trombone 1, Trombone 2"),
        ("--to a.mp4 --from-bar 45", 2, "the piece has bars 1 to 44"),
        ("--sheet a.png --every 0", 2, "'0' is not a number of seconds from 1/120 to 3600"),
        ("--sheet a.png --every 0.02", 2, "choose fewer bars, a longer --every"),
        ("--to nowhere/a.mp4", 1, "nowhere is not a folder"),
        ("--to file/a", 1, "file is not a folder"),
        ("--sheet folder.png", 1, "it is a folder"),
        ("--to frames --to-bar 1", 1, "frames of another film"),
        ("--to a.mp4", 3, "no display here"),
        ("--to folder.png --view hands --player Tr*2 --to-bar 2", 3, "no display here"),
        ("--sheet a.png --every 1/2 --columns 3 --language ja", 3, "no display here"),
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
    (tmp_path / "file").write_text("")
    (tmp_path / "folder.png").mkdir()
    (tmp_path / "frames").mkdir()
    (tmp_path / "frames" / "frame_09999.png").write_bytes(b"")
    before = sorted(tmp_path.rglob("*"))
    assert main(["film", str(QUARTET), *options.split()]) == status
    captured = capsys.readouterr()
    assert sentence in captured.err
    assert captured.out == ""
    assert sorted(tmp_path.rglob("*")) == before


def test_a_caption_has_time_exported_frame_and_position() -> None:
    performance = Performance(quartet())
    assert performance.project.fps == 60
    # The pre-roll is four beats, 78 in a minute, and frame 0 is where it begins; a bar has three.
    first_s, beat_s = performance.time_frame.first_frame_s, 60.0 / 78.0
    assert first_s == pytest.approx(-4 * beat_s, abs=1e-3)
    times_s = [first_s, 0.0, 4.5 * beat_s]
    assert caption_texts(performance, times_s, "en") == [
        ("−3.08 s · frame 0", "−1.3.000"),
        ("0.00 s · frame 185", "1.1.000"),
        ("3.46 s · frame 392", "2.2.480"),
    ]
    assert caption_texts(performance, [0.0], "ja") == [("0.00 秒 · フレーム 185", "1.1.000")]


@pytest.mark.parametrize(("kind", "every"), [("sheet", "2.2"), ("sheet", "1/2"), ("mp4", None)])
def test_bars_begin_with_their_first_frame_however_far_apart_pictures_are(kind: Kind, every: str | None) -> None:
    performance = Performance(quartet())
    bar_s = 3 * 60.0 / 78.0
    every_s = None if every is None else Fraction(every)
    chosen = Namespace(from_bar=2, to_bar=3, lead_in=None, rate=None, every=every_s)
    span = shown_span(performance, chosen, kind)
    assert span.first_frame_s == pytest.approx(bar_s, abs=1 / 60)
    times_s = [span.first_frame_s + index / float(span.fps) for index in range(span.count)]
    assert times_s[-1] < 3 * bar_s <= times_s[-1] + 1 / float(span.fps) + 1 / 60
