"""Who is played now is seen as it plays, and the others as the performance has them."""

from __future__ import annotations

from time import perf_counter

from pytestqt.qtbot import QtBot

from app.performance.chunks import Pose
from app.performance.ensemble import Performance
from app.performance.motion import playing_of
from app.performance.play_along import PlayAlong
from app.score.take import Wiring
from widgets.common.session import Session
from widgets.viewport.panel import ViewportPanel
from widgets.viewport.poses import Posed


class Still(PlayAlong):
    """Asked for a pose it counts."""

    asked = 0

    def pose(self, time_s: float) -> Pose:
        self.asked += 1
        return super().pose(time_s)


def play_along(session: Session, index: int = 0) -> Still:
    performance = Performance(session.project)
    return Still(playing_of(performance, session.project.players[index]))


def shown(viewport: ViewportPanel) -> dict[str, Posed | None]:
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
    # What is heard and seen of the others is the performance.
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
    session.live_players.hear(own, perf_counter(), f"90{pitch:02x}5a", Wiring())
    assert live.asked == asked + 1
    session.live_players.hear(own, perf_counter(), "b0027f", Wiring())
    session.live_players.hear("nobody", perf_counter(), "903c5a", Wiring())
    assert live.asked == asked + 1

    def pressed() -> bool:
        pose = shown(viewport)[own]
        return pose is not None and sum(pose.controls.values()) > sum(controls.values()) + 0.9

    qtbot.waitUntil(pressed)


def test_who_stops_playing_is_the_performance_again_and_nobody_is_asked_any_more(
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
    session.live_players.end("nobody")


def test_pictures_of_the_performance_show_the_performance(
    qtbot: QtBot, session: Session, viewport: ViewportPanel
) -> None:
    plain = viewport.render_image(160, 90, 6.0)
    live = play_along(session)
    session.live_players.begin(live)
    live.note_on(0.0, 60)
    qtbot.waitUntil(lambda: live.asked > 1)
    assert (viewport.render_image(160, 90, 6.0) == plain).all()
