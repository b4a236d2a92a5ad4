"""Players whose motion is limited: by an instrument that lies still, or by a dance that takes its place."""

from __future__ import annotations

import msgspec

from app.motion.contacts.carried_instrument import freedom
from app.plan.acting import Acting
from app.plan.parameters import PlayerParameters
from instrument_maps.model import Carriage

SETTLED = 0.6
"""Part of their amplitude, and of their sway once more, that players keep whose instrument lies on the lap."""


def settled(parameters: PlayerParameters, carriage: Carriage) -> PlayerParameters:
    """Parameters with the motion of the instrument limited as its carriage says: the lips must stay with it."""
    share = _settling(carriage)
    if share == 1.0:
        return parameters
    return msgspec.structs.replace(
        parameters,
        amplitude=share * parameters.amplitude,
        dance_amount=share * share * parameters.dance_amount,
    )


def _settling(carriage: Carriage) -> float:
    """Share of their amplitude that players keep with an instrument that is carried so."""
    return SETTLED + (1.0 - SETTLED) * freedom(carriage)


def shown_by(parameters: PlayerParameters, carriage: Carriage, acting: Acting, *, dancing: bool) -> Acting:
    """What is left of what a player shows: less of the trunk with an instrument that lies still, and of all that moves
    the body as far as a dance takes its place."""
    share = _settling(carriage)
    left = 1.0 - share * share * parameters.dance_amount if dancing else 1.0
    return msgspec.structs.replace(
        acting,
        sway=left * share * acting.sway,
        weight_shift=left * share * acting.weight_shift,
        phrase=left * share * acting.phrase,
        footwork=left * acting.footwork,
    )
