"""The generated performances for comparison: normal, without acting, and with late fingers as a control."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Final

import msgspec

from app.evaluation.key import Variant
from app.performance.ensemble import Performance
from app.plan.model import FingeringEvent, PlayerPlan
from app.project.model import Project
from app.project.performers import Player

LATE_S: Final = 0.2
"""Delay of the fingers in the control in seconds, noticeable to every viewer (ITU-R BT.1359: 45 ms early, 125 ms
late).
"""
OURS: Final[tuple[Variant, ...]] = ("generated", "still", "shifted")
"""Variants that are generated from a project."""


class LateFingers(Performance):
    """A performance with late valves, slides and keys; arms and fingers are late too, everything else is in time."""

    @cached_property
    def plans(self) -> dict[str, PlayerPlan]:
        """Return every player's plan with late fingers, by player id."""
        return {player_id: _late(plan) for player_id, plan in super().plans.items()}

    def plan(self, player: Player) -> PlayerPlan:
        """Return a player's plan with late fingers."""
        return self.plans[player.id]


def performance_of(project: Project, variant: Variant) -> Performance:
    """Return the performance of a project as the given variant shows it."""
    if variant == "still":
        return Performance(_without_acting(project))
    return (LateFingers if variant == "shifted" else Performance)(project)


def _without_acting(project: Project) -> Project:
    players = tuple(
        msgspec.structs.replace(player, parameters=msgspec.structs.replace(player.parameters, amplitude=0.0))
        for player in project.players
    )
    return replace(project, players=players)


def _late(plan: PlayerPlan) -> PlayerPlan:
    return msgspec.structs.replace(plan, fingerings=tuple(_later(event) for event in plan.fingerings))


def _later(event: FingeringEvent) -> FingeringEvent:
    vent = event.vent
    if vent is not None:
        vent = msgspec.structs.replace(vent, end_s=vent.end_s + LATE_S)
    return msgspec.structs.replace(event, start_s=event.start_s + LATE_S, end_s=event.end_s + LATE_S, vent=vent)
