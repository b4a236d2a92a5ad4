"""Dances generated for a project's performance, for dancers and for players' bodies; the package used by
`app.performance.dances`.
"""

from __future__ import annotations

from app.choreography.performed.body_dance import layer_is_made, layer_of
from app.choreography.performed.choreographers import unfit_choreography
from app.choreography.performed.dancers import dancing_of

__all__ = ["dancing_of", "layer_is_made", "layer_of", "unfit_choreography"]
