"""A lane's session of one player replaces the whole session, which the type checker cannot verify."""

from __future__ import annotations

from typing import Any, get_type_hints

import pytest
from PySide6.QtCore import SignalInstance

from app.editor.session import Session
from widgets.timeline.player_session import PlayerSession

OWN = {name for name in vars(PlayerSession) if not name.startswith("_")}


def getter(kind: type, name: str) -> Any:
    found = vars(kind)[name]
    return found.fget if isinstance(found, property) else found


@pytest.mark.parametrize("name", sorted(OWN & {*dir(Session)}))
def test_what_it_answers_itself_has_the_type_that_the_session_gives(name: str) -> None:
    owner = next(kind for kind in Session.__mro__ if name in vars(kind))
    assert isinstance(vars(PlayerSession)[name], property) is isinstance(vars(owner)[name], property)
    assert get_type_hints(getter(PlayerSession, name)) == get_type_hints(getter(owner, name))


def test_everything_else_is_the_session_s(session: Session) -> None:
    shown = PlayerSession(session).of_lanes
    own = {*OWN, "players_changed"}
    names = [name for name in dir(session) if not name.startswith("_") and name not in own]
    assert {"document", "project", "plans", "selection", "attempt", "set_players"} <= {*names}
    for name in names:
        one, other = getattr(shown, name), getattr(session, name)
        # Signals and methods are bound again at each look.
        assert one is other or one == other or isinstance(other, SignalInstance), name
    assert isinstance(shown.players_changed, SignalInstance)


def test_a_lane_s_player_comes_first_and_the_selected_ones_stay(session: Session) -> None:
    ids = [player.id for player in session.project.players]
    session.set_players((ids[0], ids[2]))
    lane = PlayerSession(session)
    told: list[str] = []
    lane.players_changed.connect(lambda: told.append(lane.player_id))
    assert (lane.player, lane.players, lane.plan) == (None, (), None)
    lane.show(ids[2])
    lane.show(ids[2])
    assert told == [ids[2]]
    assert lane.players == (ids[2], ids[0])
    assert lane.player is session.project.players[2]
    assert lane.plan is session.plans.get(ids[2])
    assert not lane.is_in_front
    lane.bring_forward()
    assert session.players == (ids[2], ids[0])
    assert lane.is_in_front
