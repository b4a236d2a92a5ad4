"""Dances, as far as a performance, its exports and its streams know them; `app.optional_features` names who makes them.

Without a maker of dances, dancers are excluded and players who were to dance move as generated, both with the reason.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Protocol, cast

from app.arrays import BoolArray, FloatArray
from app.errors import AppError
from app.motion.gestures.dance_layer import BodyLayer
from app.motion.gestures.danced_feet import DancedFeet
from app.motion.model import Motion
from app.optional_features import modules
from app.performance.ensemble import Performance
from app.plan.model import Problem
from app.project.performers import Dancer, Player
from app.rig.model import Character


class Dancing(Protocol):
    """One dancer's dance, generated when frames of it are requested; the interface keeps its maker out of the core."""

    dancer: Dancer
    character: Character

    @property
    def choreography_name(self) -> str:
        """The name that the choreography bears."""

    @property
    def problems(self) -> tuple[Problem, ...]:
        """Problems of the dance, once it is generated."""

    def motion(self, fps: Fraction, first: int, count: int) -> Motion:
        """Motion of some frames of the performance; the same frames are identical to the bit whichever span they are
        asked for in."""

    def changed_s(self, before: object) -> FloatArray:
        """Spans (K, 2) in which the motion differs from that of another dance."""

    def standing(self, fps: Fraction, first: int, count: int) -> BoolArray:
        """(count, 2) in which frames the left and the right foot stand."""

    def starts_s(self, fps: Fraction) -> tuple[float, ...]:
        """Seconds at which basic motions begin."""


class MakerOfDances(Protocol):
    """Functions of the module that the table of features names; the core may not import it."""

    def dancing_of(self, performance: Performance, dancer: Dancer) -> Dancing:
        """A dancer's dance. Raises AppError where the dancer lacks something."""

    def layer_of(self, performance: Performance, player: Player) -> BodyLayer | None:
        """Dance of a player while playing; None: none."""

    def layer_is_made(self, performance: Performance, player: Player) -> bool:
        """Return whether asking for a player's layer takes no time."""


def maker_of_dances() -> MakerOfDances | None:
    """Return the feature that makes dances, loaded; ask only for pieces with dances, for it takes time. None: there is
    none."""
    return next((cast(MakerOfDances, module) for _, module in modules("dances")), None)


def dancing_of(performance: Performance, dancer: Dancer) -> Dancing:
    """A dancer's dance. Raises AppError where the dancer lacks something."""
    maker = maker_of_dances()
    if maker is None:
        raise AppError("project.no_dances", dancer=dancer.name)
    return maker.dancing_of(performance, dancer)


def layer_of(performance: Performance, player: Player) -> BodyLayer | None:
    """Dance of a player while playing; None: none. Making it may take seconds."""
    maker = maker_of_dances()
    return None if maker is None else maker.layer_of(performance, player)


def danced_feet(performance: Performance, player: Player) -> DancedFeet:
    """Moves of the feet of a player who dances, without those that give way to the animator's."""
    layer = layer_of(performance, player) if player.parameters.choreography else None
    return DancedFeet.none() if layer is None else layer.feet.giving_way(performance.plan(player).gestures)


def layer_is_made(performance: Performance, player: Player) -> bool:
    """Return whether asking for a player's layer takes no time."""
    maker = maker_of_dances()
    return maker is None or maker.layer_is_made(performance, player)
