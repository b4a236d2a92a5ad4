"""The reference video at the playhead: the right picture, beside or behind the players, aligned by its sound."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLineEdit, QToolButton
from pytestqt.qtbot import QtBot

from app.audio.mix import mixdown
from app.editor.session import Session, Severity
from app.editor.video import ReferenceVideo
from app.errors import Message
from app.project.edit.piece import relocate, set_audio, set_offset, set_video, set_video_offset
from app.project.video import VideoTrack
from tests.support.films import number_of, written
from tests.support.windows import child, show
from widgets.common.number_slider import NumberSlider
from widgets.viewport.panel import ViewportPanel
from widgets.viewport.video import VideoStrip, VideoView, fitted

NAME = Message("edit.set_video")
RATE = Fraction(24)
PICTURES = 120


@pytest.fixture(scope="module")
def film(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return written(tmp_path_factory.mktemp("film") / "film.mp4", RATE, PICTURES)


@pytest.fixture
def video(session: Session) -> Iterator[ReferenceVideo]:
    """Reader of the session's video."""
    reader = ReferenceVideo(session)
    yield reader
    reader.close()


def shown(session: Session) -> int | None:
    picture = session.video.picture
    return None if picture is None else number_of(picture)


def go(session: Session, qtbot: QtBot, time_s: float, number: int | None) -> None:
    session.set_playhead(time_s)
    qtbot.waitUntil(lambda: shown(session) == number)


def typed(qtbot: QtBot, slider: NumberSlider, text: str) -> None:
    slider.type_value(text)
    qtbot.keyClick(slider.findChild(QLineEdit), Qt.Key.Key_Return)


def test_the_picture_is_that_of_the_playhead(session: Session, video: ReferenceVideo, film: Path, qtbot: QtBot) -> None:
    session.attempt(NAME, lambda project: set_video_offset(set_video(project, film), 1.5))
    for number in (0, 1, 2, 100, 99, 98, 97, 119, 3, 60):
        go(session, qtbot, 1.5 + number / 24, number)
        # Until the next one begins.
        go(session, qtbot, 1.5 + (number + 0.98) / 24, number)
    for outside_s in (1.49, 1.5 + PICTURES / 24, 400.0):
        go(session, qtbot, outside_s, None)
    go(session, qtbot, 2.5, 24)
    session.attempt(NAME, lambda project: set_video_offset(project, 2.0))
    qtbot.waitUntil(lambda: shown(session) == 12)
    session.document.undo()
    qtbot.waitUntil(lambda: shown(session) == 24)


def test_playing_shows_every_picture_in_order(
    session: Session, video: ReferenceVideo, film: Path, qtbot: QtBot
) -> None:
    session.attempt(NAME, lambda project: set_video(project, film))
    seen = list[int | None]()
    session.video.pictured.connect(lambda: seen.append(shown(session)))
    for number in range(40):
        go(session, qtbot, number / 24, number)
    assert seen == list(range(40))


def test_it_stands_beside_or_behind_the_players(
    viewport: ViewportPanel, session: Session, video: ReferenceVideo, film: Path, qtbot: QtBot
) -> None:
    view = child(viewport, VideoView, "video_view")
    strip = child(viewport, VideoStrip, "video_strip")
    assert not view.isVisible()
    assert not strip.isVisible()
    session.attempt(NAME, lambda project: set_video(project, film))
    assert view.isVisible()
    assert strip.isVisible()
    canvas = viewport.canvas_widget()
    assert canvas is not None
    # The right half of 240 (bits 4 to 7) is white.
    go(session, qtbot, 112 / 24, 112)
    box = fitted(session.video.ratio, view.width(), view.height())
    image = view.grab().toImage()
    ratio = image.width() / view.width()
    lights = [
        image.pixelColor(int((box.left() + box.width() * share) * ratio), int(box.center().y() * ratio)).lightness()
        for share in (0.06, 0.3, 0.57, 0.7, 0.82, 0.95)
    ]
    assert [light > 127 for light in lights] == [False, False, True, True, True, False]

    qtbot.mouseClick(strip.findChild(QToolButton, "video_behind"), Qt.MouseButton.LeftButton)
    assert not view.isVisible()
    opacity = strip.findChild(NumberSlider, "video_opacity")
    assert opacity.isVisible()
    typed(qtbot, opacity, "1")
    assert session.video.opacity == 1.0
    qtbot.waitUntil(lambda: session.video.picture is not None)
    image = canvas.grabFramebuffer()  # type: ignore[attr-defined]
    box = fitted(session.video.ratio, image.width(), image.height())
    # Over the players' heads.
    dark, bright = (
        image.pixelColor(int(box.left() + share * box.width()), int(box.top() + 0.04 * box.height())).lightness()
        for share in (0.3, 0.7)
    )
    assert dark < 60 < 200 < bright

    qtbot.mouseClick(strip.findChild(QToolButton, "video_hide"), Qt.MouseButton.LeftButton)
    assert session.video.placement == "hidden"
    assert not strip.isVisible()
    assert session.video.picture is None


def test_no_text_of_the_strip_is_cut_in_a_narrow_viewport(session: Session, film: Path, qtbot: QtBot) -> None:
    strip = VideoStrip(session)
    qtbot.addWidget(strip)
    session.attempt(NAME, lambda project: set_video(project, film))
    session.video.set(placement="behind")
    for width_px in (700, 480, 360):
        strip.resize(width_px, strip.heightForWidth(width_px))
        show(strip)
        parts = strip.findChildren(QToolButton) + strip.findChildren(NumberSlider)
        for part in parts:
            assert part.width() >= part.sizeHint().width() or part.minimumWidth() == part.width(), part.objectName()
            assert strip.rect().contains(part.geometry()), part.objectName()


def test_the_offset_is_typed_and_taken_back(
    viewport: ViewportPanel, session: Session, video: ReferenceVideo, film: Path, qtbot: QtBot
) -> None:
    session.attempt(NAME, lambda project: set_video(project, film))
    offset = child(viewport, NumberSlider, "video_offset")
    typed(qtbot, offset, "-1.25")
    assert session.project.video == VideoTrack(str(film), -1.25)
    session.document.undo()
    assert session.project.video == VideoTrack(str(film), 0.0)
    assert offset.value == 0.0


def test_its_place_is_found_by_its_sound(session: Session, video: ReferenceVideo, tmp_path: Path, qtbot: QtBot) -> None:
    notices = list[str]()
    session.noticed.connect(lambda message, severity: notices.append(message.id))
    sound = mixdown(session.project, 12.0, 27.0)
    path = written(tmp_path / "film.mp4", Fraction(8), PICTURES, sound.astype(np.float32))
    session.attempt(NAME, lambda project: set_video(project, path))
    qtbot.waitUntil(lambda: [id.removesuffix("_with_next") for id in notices] == ["video.offset_found"])
    assert session.project.video.offset_s == pytest.approx(12.0, abs=0.02)
    session.document.undo()
    assert session.project.video.offset_s == 0.0
    session.attempt(NAME, lambda project: set_video(project, None))

    noise = np.random.default_rng(4).normal(0.0, 0.1, sound.shape).astype(np.float32)
    other = written(tmp_path / "other.mp4", Fraction(8), PICTURES, noise)
    session.attempt(NAME, lambda project: set_video(project, other))
    qtbot.waitUntil(lambda: notices[1:] == ["video.not_recognised"])
    assert session.project.video == VideoTrack(str(other))


def test_what_cannot_be_read_is_reported_and_kept(
    viewport: ViewportPanel, session: Session, video: ReferenceVideo, tmp_path: Path, qtbot: QtBot
) -> None:
    broken = tmp_path / "broken.mp4"
    broken.write_bytes(b"no film")
    notices = list[tuple[Message, Severity]]()
    session.noticed.connect(lambda message, severity: notices.append((message, severity)))
    session.attempt(NAME, lambda project: set_video(project, broken))
    qtbot.waitUntil(lambda: bool(notices))
    assert [(message.id, severity) for message, severity in notices] == [("video.not_readable", Severity.ERROR)]
    assert session.project.video == VideoTrack(str(broken))
    assert session.video.fault == notices[0][0]
    assert session.video.picture is None


def test_sound_and_picture_of_one_file_keep_together(session: Session) -> None:
    project = set_offset(set_audio(session.project, "/nowhere/a.mp4"), 2.0, 0.9)
    project = set_video(project, "/nowhere/a.mp4")
    assert project.video == VideoTrack("/nowhere/a.mp4", 2.0, 0.9)
    project = set_video_offset(project, 3.0)
    assert (project.audio.offset_s, project.audio.confidence) == (3.0, None)
    project = relocate(project, "/nowhere/a.mp4", "/here/b.mp4")
    assert (project.audio.path, project.video) == ("/here/b.mp4", VideoTrack("/here/b.mp4", 3.0))
    assert relocate(project, "/here/b.mp4", None).video is None
