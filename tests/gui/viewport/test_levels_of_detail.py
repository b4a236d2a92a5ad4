"""Finer figures of a large band, made when they are seen near."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from tests.gui.viewport.conftest import AT_S, SIZE, MadeNow
from tests.support.windows import show
from widgets.viewport import geometry, renderer, shapes
from widgets.viewport.camera import Camera
from widgets.viewport.panel import ViewportPanel
from widgets.viewport.shape_model import LevelsOfDetail

pytestmark = pytest.mark.drawn


@pytest.fixture
def panel(qtbot: QtBot, session: Session, poses: MadeNow, monkeypatch: pytest.MonkeyPatch) -> ViewportPanel:
    """A viewport that treats the quartet like a large band."""
    monkeypatch.setattr(shapes, "MOST_NEAR", 0)
    geometry.character_levels.cache_clear()
    geometry.instrument_levels.cache_clear()
    session.set_playhead(AT_S)
    panel = ViewportPanel(session, poses)
    qtbot.addWidget(panel)
    panel.resize(*SIZE)
    return panel


def people(panel: ViewportPanel) -> list[LevelsOfDetail]:
    assert panel.scene.loaded is not None
    return [*panel.scene.loaded.shapes.characters.values()]


def test_a_still_picture_has_all_details_at_once(panel: ViewportPanel) -> None:
    assert not any(levels.is_complete for levels in people(panel))
    first = panel.render_image(320, 180, AT_S, "mouth")
    assert any(levels.is_complete for levels in people(panel))
    for levels in people(panel):
        levels.complete()
    assert (panel.render_image(320, 180, AT_S, "mouth") == first).all()


def test_performers_outside_the_picture_take_no_place_of_near_ones() -> None:
    drawn: Any = object.__new__(renderer.Renderer)
    drawn._middles_m = np.array([[-5.0, 1.0, 6.0], [5.0, 1.0, 6.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [2.0, 1.0, 0.0]])
    camera = Camera(distance_m=8.0)
    stage = SimpleNamespace(shown=np.ones(5, bool))
    level = drawn._levels(stage, camera, camera.clip_from_world(1.6), 800.0, 2)
    assert level.tolist() == [-1, -1, 1, 1, 2]


def test_more_performers_have_details_in_a_picture_that_stays(
    panel: ViewportPanel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The nearest ones first."""
    monkeypatch.setattr(renderer, "MOST_NEAR", 1)
    # In the small picture of a test nobody would be near without a graphics card.
    monkeypatch.setattr(renderer, "HASTY_FACTOR", 0.05)
    seen, levels_of = list[list[int]](), renderer.Renderer._levels

    def counted(drawn: renderer.Renderer, *given: Any) -> Any:
        level = levels_of(drawn, *given)
        seen.append([int(one) for one in level])
        return level

    monkeypatch.setattr(renderer.Renderer, "_levels", counted)
    panel.render_image(640, 360, AT_S, "mouth")
    show(panel)
    panel._session.viewport.set_view("ensemble")
    panel._session.set_playing(True)
    panel.canvas_widget().grabFramebuffer()
    assert sum(0 <= one < 2 for one in seen[0]) > 1
    assert sum(0 <= one < 2 for one in seen[-1]) <= 1


def test_the_window_draws_coarse_figures_until_finer_ones_are_made(
    qtbot: QtBot, panel: ViewportPanel, session: Session
) -> None:
    made = list[tuple[LevelsOfDetail, ...]]()
    panel.scene.refined.connect(lambda: made.append(tuple(one for one in people(panel) if one.is_complete)))
    show(panel)
    QApplication.processEvents()
    session.viewport.set_view("mouth")
    qtbot.waitUntil(lambda: bool(made))
    assert made[-1]
    assert np.ptp(panel.render_image(320, 180, AT_S)) > 100
    assert panel.has_gl, panel.message()
