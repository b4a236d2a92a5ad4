"""A player controlled live moves as played, the others as in the performance."""

from __future__ import annotations

from itertools import pairwise
from time import perf_counter

import numpy as np
import pytest
from pytestqt.qtbot import QtBot

from app.editor.session import Session
from app.performance.chunks import Pose
from app.performance.ensemble import Performance
from app.performance.play_along import PlayAlong
from app.plan.by_hand.corrections import PoseCorrection
from app.project.edit.corrections import with_corrections
from app.score.take import ControllerMapping
from tests.support.performed import performance_curves
from widgets.viewport.panel import ViewportPanel


class Still(PlayAlong):
    """A constant pose that counts its requests."""

    asked = 0

    def pose(self, time_s: float, at_s: float | None = None) -> Pose:
        self.asked += 1
        return super().pose(time_s, at_s)


def play_along(session: Session, index: int = 0) -> Still:
    performance = Performance(session.project)
    return Still(performance_curves(performance, session.project.players[index]))


def shown(viewport: ViewportPanel) -> dict[str, Pose | None]:
    return viewport.scene.poses()


def test_who_is_played_moves_while_the_playhead_rests(qtbot: QtBot, session: Session, viewport: ViewportPanel) -> None:
    live, before = play_along(session), shown(viewport)
    own, *others = before
    session.live_players.begin(live)
    qtbot.waitUntil(lambda: live.asked > 3)
    now = shown(viewport)
    assert now[own] is not before[own]
    assert all(now[other] is not None for other in others)
    first = now[own]
    qtbot.waitUntil(lambda: shown(viewport)[own] is not first)
    # The other players are heard and seen in the performance.
    session.set_playhead(3.0)
    assert all(shown(viewport)[other] is not before[other] for other in others)


def test_a_key_that_goes_down_is_seen_at_once(qtbot: QtBot, session: Session, viewport: ViewportPanel) -> None:
    live = play_along(session)
    session.live_players.begin(live)
    controls = live.pose(perf_counter()).controls
    pitch = next(
        pitch
        for pitch in range(40, 90)
        if (limits := session.performance.instrument(session.project.players[0]).range).low <= pitch <= limits.high
        and len(session.performance.instrument(session.project.players[0]).fingerings_for(pitch)[0].controls) > 1
    )
    own = live.player_id
    asked = live.asked
    session.live_players.receive(own, perf_counter(), f"90{pitch:02x}5a", ControllerMapping())
    assert live.asked == asked + 1
    session.live_players.receive(own, perf_counter(), "b0027f", ControllerMapping())
    session.live_players.receive("unknown", perf_counter(), "903c5a", ControllerMapping())
    assert live.asked == asked + 1

    def pressed() -> bool:
        pose = shown(viewport)[own]
        return pose is not None and sum(pose.controls.values()) > sum(controls.values()) + 0.9

    qtbot.waitUntil(pressed)


def test_who_stops_playing_is_the_performance_again_and_no_one_is_asked_any_more(
    qtbot: QtBot, session: Session, viewport: ViewportPanel
) -> None:
    live = play_along(session)
    session.live_players.begin(live)
    qtbot.waitUntil(lambda: live.asked > 1)
    session.live_players.end(live.player_id)
    asked = live.asked
    qtbot.wait(60)
    assert live.asked == asked
    assert dict(session.live_players.playing) == {}
    performed = viewport.scene.poses()[live.player_id]
    session.set_playhead(3.0)
    assert viewport.scene.poses()[live.player_id] is not performed
    assert live.asked == asked
    session.live_players.end("unknown")


def test_pictures_of_the_performance_show_the_performance(
    qtbot: QtBot, session: Session, viewport: ViewportPanel
) -> None:
    plain = viewport.render_image(160, 90, 6.0)
    live = play_along(session)
    session.live_players.begin(live)
    live.note_on(0.0, 60)
    qtbot.waitUntil(lambda: live.asked > 1)
    assert (viewport.render_image(160, 90, 6.0) == plain).all()


def test_who_begins_and_ends_goes_there_and_back_without_a_jump(
    session: Session, viewport: ViewportPanel, monkeypatch: pytest.MonkeyPatch
) -> None:
    now_s = [100.0]
    monkeypatch.setattr("app.editor.live_players.perf_counter", lambda: now_s[0])
    live, players = play_along(session), session.live_players
    lowest = session.performance.instrument(session.project.players[0]).range.low
    live.breath(99.0, 1.0)
    live.note_on(99.0, lowest + 9)
    for frame in range(60):
        live.pose(99.0 + frame / 60)
    performed = shown(viewport)[live.player_id]
    assert performed is not None
    far = away(live.pose(100.0), performed)
    assert far > 0.05

    def steps(count: int) -> list[float]:
        """Distance from the performance's pose in each of some frames, relative to the live pose's distance from it."""
        found = []
        for _ in range(count):
            now_s[0] += 1 / 60
            viewport.refresh()
            pose = shown(viewport)[live.player_id]
            assert pose is not None
            found.append(away(pose, performed) / far)
        return found

    players.begin(live)
    there = steps(16)
    assert there[0] < 0.1
    assert there[5] == pytest.approx(0.5, abs=0.15)
    assert min(there[12:]) > 0.9
    players.end(live.player_id)
    assert players.is_shown
    back = steps(16)
    assert back[0] > 0.9 * there[-1]
    assert back[5] == pytest.approx(0.5, abs=0.15)
    assert max(back[12:]) < 0.01
    assert not players.is_shown
    pose = shown(viewport)[live.player_id]
    assert pose is not None
    assert away(pose, performed) < 0.01 * far
    for course in ([0.0, *there], [there[-1], *back]):
        assert max(abs(a - b) for a, b in pairwise(course)) < 0.2
    # A player who returns before the transition has ended continues from there.
    players.begin(live)
    steps(16)
    players.end(live.player_id)
    left = steps(5)[-1]
    players.begin(live)
    assert steps(1)[0] == pytest.approx(left, abs=0.1)


def away(one: Pose, other: Pose) -> float:
    """Greatest rotation of any joint in quaternions."""
    # Stored numbers of single precision are of length 1 to 3e-7, whose root would be a hundredth of what is compared.
    first, second = (
        pose.rotations / np.linalg.norm(pose.rotations.astype(float), axis=1)[:, None] for pose in (one, other)
    )
    return float(np.max(np.abs(np.abs(np.einsum("ji,ji->j", first, second)) - 1.0)) ** 0.5)


def test_what_an_animator_holds_differently_is_held_so_by_who_plays(session: Session) -> None:
    player = session.project.players[0]
    lift = PoseCorrection("own-1", "head", 960, 3840, up_deg=-10.0)
    project = with_corrections(session.project, player.id, (lift,))
    clock, performance = project.score.tempo_map, Performance(project)
    inside, outside = clock.seconds(2400.0), clock.seconds(9600.0)
    plain, held = play_along(session), PlayAlong(performance_curves(performance, project.players[0]))
    head = held._curves.player.skeleton.names.index("head")

    def angle(one: PlayAlong, at_s: float) -> float:
        turned = abs(float(np.dot(one.pose(1.0, at_s).rotations[head], plain.pose(1.0, at_s).rotations[head])))
        return float(np.degrees(2.0 * np.arccos(min(turned, 1.0))))

    assert angle(held, outside) == pytest.approx(0.0, abs=0.1)
    assert angle(held, inside) > 3.0
    held.hold(())
    assert angle(held, inside) == pytest.approx(0.0, abs=0.1)
    held.hold(performance.plans[player.id].poses)
    assert angle(held, inside) > 3.0
