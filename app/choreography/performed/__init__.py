"""Dances of a project, generated for its performance, for dancers and for the bodies of players: what
`app.performance.dances` asks of whoever makes dances."""

from __future__ import annotations

from app.choreography.performed.body_dance import layer_is_made, layer_of
from app.choreography.performed.choreographers import unfit_choreography
from app.choreography.performed.dancers import dancing_of

__all__ = ["dancing_of", "layer_is_made", "layer_of", "unfit_choreography"]
