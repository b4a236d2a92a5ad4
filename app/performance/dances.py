"""Interface to dances for performances, exports and streams; `app.optional_features` names the implementation.

Without an implementation, dancers are excluded and players with a choreography move as generated; both are reported.
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
    """Protocol of a dancer's dance, which is generated when frames are requested."""

    dancer: Dancer
    character: Character

    @property
    def choreography_name(self) -> str:
        """Name of the choreography."""

    @property
    def problems(self) -> tuple[Problem, ...]:
        """Problems of the dance; empty until it is generated."""

    def motion(self, fps: Fraction, first: int, count: int) -> Motion:
        """Return the motion of some frames of the performance; a frame is bit-identical whatever span is requested."""

    def changed_s(self, before: object) -> FloatArray:
        """Return the K spans (K, 2) in seconds in which the motion differs from that of another dance."""

    def standing(self, fps: Fraction, first: int, count: int) -> BoolArray:
        """Mask (count, 2) of the frames in which the left and the right foot stand on the floor."""

    def starts_s(self, fps: Fraction) -> tuple[float, ...]:
        """Seconds at which each basic motion of the dance begins."""


class MakerOfDances(Protocol):
    """Protocol of the module that implements dances, which is optional, so the core does not import it."""

    def dancing_of(self, performance: Performance, dancer: Dancer) -> Dancing:
        """Return the dance of a dancer. Raises AppError if its character or choreography is missing."""

    def layer_of(self, performance: Performance, player: Player) -> BodyLayer | None:
        """Return the dance that a player performs while playing, as a layer of body motion; None without a
        choreography.
        """

    def layer_is_made(self, performance: Performance, player: Player) -> bool:
        """Return whether a player's dance layer is available without computing it."""


def maker_of_dances() -> MakerOfDances | None:
    """Return the module that implements dances, loading it, which takes time; None if there is none."""
    return next((cast(MakerOfDances, module) for _, module in modules("dances")), None)


def dancing_of(performance: Performance, dancer: Dancer) -> Dancing:
    """Return the dance of a dancer. Raises AppError if its character or choreography is missing."""
    maker = maker_of_dances()
    if maker is None:
        raise AppError("project.no_dances", dancer=dancer.name)
    return maker.dancing_of(performance, dancer)


def layer_of(performance: Performance, player: Player) -> BodyLayer | None:
    """Return the dance that a player performs while playing, as a layer of body motion; None without a choreography.
    Generating it may take seconds.
    """
    maker = maker_of_dances()
    return None if maker is None else maker.layer_of(performance, player)


def danced_feet(performance: Performance, player: Player) -> DancedFeet:
    """Foot movements of a dancing player, without those that the animator replaced by hand."""
    layer = layer_of(performance, player) if player.parameters.choreography else None
    return DancedFeet.none() if layer is None else layer.feet.giving_way(performance.plan(player).gestures)


def layer_is_made(performance: Performance, player: Player) -> bool:
    """Return whether a player's dance layer is available without computing it."""
    maker = maker_of_dances()
    return maker is None or maker.layer_is_made(performance, player)
