"""One player's motion at a frame rate, made piece by piece so that it can be watched and stopped.

Messages: ``work.stopped`` (of `Cancelled`): "stopped; nothing was written".
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from app.errors import Cancelled
from app.motion.model import Motion
from app.motion.perform import Playing, prepare
from app.performance.cache import IdentityCache
from app.performance.ensemble import Performance
from app.performance.span import FrameSpan
from app.project.model import Player
from app.rig.character import bundled_character
from app.rig.hold import Hold
from app.rig.hold_file import hold_for
from app.rig.instrument import load_instrument
from app.rig.model import Character, InstrumentModel
from instrument_maps.load import model_path
from instrument_maps.model import InstrumentMap
from metadata.load import load_body
from metadata.model import Body

Progress = Callable[[float], None]
"""Told the share 0..1 that is done."""
StopWanted = Callable[[], bool]
"""Asked now and then; true stops the work."""

CHUNK = 16384
"""Frames made between two questions whether to stop."""

_MODELS: IdentityCache[InstrumentModel] = IdentityCache(16)
_HOLDS: IdentityCache[Hold] = IdentityCache(64)
_PLAYING: IdentityCache[Playing] = IdentityCache(8)


def character_of(player: Player) -> Character:
    """The character that plays. Raises UsageError where there is none of its id."""
    return bundled_character(player.character_id)


def body_of(player: Player) -> Body:
    """How the player's kind of body moves."""
    return load_body()


def model_of(instrument: InstrumentMap) -> InstrumentModel:
    """The model a map names; loaded once. Raises MapError or FileError."""
    return _MODELS.get((instrument,), lambda: load_instrument(model_path(instrument), instrument))


def hold_of(player: Player, instrument: InstrumentMap) -> Hold:
    """How a player's body holds an instrument; fitted once for each pair."""
    character, model, body = character_of(player), model_of(instrument), body_of(player)
    return _HOLDS.get((character, model, instrument, body), lambda: hold_for(character, model, instrument, body))


def playing_of(performance: Performance, player: Player, before: Playing | None = None) -> Playing:
    """A player's plan made ready to be seen; made once for each plan, and from what is still right of ``before``."""
    instrument = performance.instrument(player)
    character, body, plan = character_of(player), body_of(player), performance.plan(player)
    hold, beat_ticks = hold_of(player, instrument), performance.piece.beat_ticks
    keys = (plan, player.parameters, instrument, character, hold, body, performance.expressions)
    return _PLAYING.get(
        keys,
        lambda: prepare(
            plan,
            player.parameters,
            instrument,
            character,
            hold,
            body,
            beat_ticks=beat_ticks,
            expressions=performance.expressions,
            before=before,
        ),
    )


def player_motion(
    performance: Performance,
    player: Player,
    span: FrameSpan,
    stop_wanted: StopWanted = lambda: False,
    progress: Progress = lambda share: None,
) -> Motion:
    """Make one player's motion over some frames. The same frames are the same bits in every span.

    Raises
    ------
    Cancelled
        ``stop_wanted`` said so.
    """
    playing = playing_of(performance, player)
    pieces = []
    for first in range(0, span.count, CHUNK):
        if stop_wanted():
            raise Cancelled("work.stopped")
        pieces.append(playing.motion(span.fps, span.first + first, min(CHUNK, span.count - first)))
        progress(min(1.0, (first + CHUNK) / span.count))
    return _joined(pieces)


def _joined(pieces: list[Motion]) -> Motion:
    if len(pieces) == 1:
        return pieces[0]
    first = pieces[0]
    return Motion(
        fps=first.fps,
        first_frame_s=first.first_frame_s,
        rotations=np.concatenate([piece.rotations for piece in pieces]),
        hips_m=np.concatenate([piece.hips_m for piece in pieces]),
        morphs={name: np.concatenate([piece.morphs[name] for piece in pieces]) for name in first.morphs},
        controls={name: np.concatenate([piece.controls[name] for piece in pieces]) for name in first.controls},
        instrument_position_m=np.concatenate([piece.instrument_position_m for piece in pieces]),
        instrument_rotation=np.concatenate([piece.instrument_rotation for piece in pieces]),
    )
