"""What all players of a project do: plans from a snapshot of the project, made once and shared by everyone who asks.

Messages: ``piece.too_long`` (hours, most_hours): "the piece lasts {hours} hours; at most {most_hours} can be played".
"""

from __future__ import annotations

from functools import cached_property

from app.errors import AppError
from app.performance.loudness import note_loudness
from app.plan.generate import Line, Piece, make_plans, time_frame
from app.plan.model import PlayerPlan, TimeFrame
from app.project.model import Player, Project
from instrument_maps.load import find_map
from instrument_maps.model import InstrumentMap
from metadata.load import load_expressions
from metadata.model import Expression

MOST_HOURS = 12
"""Longer than any concert."""


class Performance:
    """A project, played.

    Parameters
    ----------
    project : Project
        A value: what is made from it once stays right.

    Raises
    ------
    AppError
        ``piece.too_long``: a few wrong bytes can make a piece of months, whose bars alone would fill the memory.
    """

    def __init__(self, project: Project) -> None:
        hours = project.score.tempo_map.seconds(float(project.score.end_tick)) / 3600.0
        if hours > MOST_HOURS:
            raise AppError("piece.too_long", hours=round(hours, 1), most_hours=MOST_HOURS)
        self.project = project

    @cached_property
    def piece(self) -> Piece:
        """What all players share."""
        score = self.project.score
        return Piece(
            clock=score.tempo_map,
            metres=score.metres,
            felt_beat_ticks=self.project.felt_beat_ticks,
            bar_ticks=tuple(score.bar_starts.tolist()),
        )

    @cached_property
    def lines(self) -> tuple[Line, ...]:
        """What each player plays, in the order of the project's players."""
        return tuple(
            Line(
                player_id=player.id,
                notes=self.project.part(player).notes,
                instrument_map=self.instrument(player),
                parameters=player.parameters,
                corrections=self.project.corrections.get(player.id, ()),
                loudness=note_loudness(self.project.part(player)),
            )
            for player in self.project.players
        )

    @cached_property
    def time_frame(self) -> TimeFrame:
        """The span that every player's motion covers."""
        return time_frame(self.lines, self.piece.clock, self.project.preroll_beats, self.piece.beat_ticks)

    @cached_property
    def plans(self) -> dict[str, PlayerPlan]:
        """Every player's plan by player id."""
        return make_plans(self.piece, self.lines, self.time_frame, self.project.seed, self.expressions)

    @cached_property
    def expressions(self) -> dict[str, Expression]:
        """Every expression by name; the project's own win over the bundled ones."""
        return load_expressions() | {expression.name: expression for expression in self.project.expressions}

    @property
    def planned(self) -> bool:
        """Whether the plans are made already: asking for them then costs nothing."""
        return "plans" in self.__dict__

    def plan(self, player: Player) -> PlayerPlan:
        """One player's plan."""
        return self.plans[player.id]

    def instrument(self, player: Player) -> InstrumentMap:
        """The map of what a player plays. Raises MapError where there is none of its id."""
        return find_map(player.instrument_id)
