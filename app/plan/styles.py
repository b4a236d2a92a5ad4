"""Spans in which a player plays in another style: amount of each layer over time.

A span has the amounts of its style throughout; they are blended at its edges.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, overload

import msgspec
import numpy as np

from app.arrays import FloatArray
from app.errors import Message
from app.identity_cache import IdentityCache
from app.plan.acting import Acting
from app.plan.by_hand.corrections import BY_HAND, Correction, PlayStyle
from app.plan.events_by_hand import StyleEvent
from app.plan.kinds import GESTURE_KINDS, GESTURES
from app.plan.model import CueEvent, GestureEvent, Planned, PlayerPlan, Problem
from app.score.tempo import TempoMap


def plan_styles(
    corrections: tuple[Correction, ...],
    actings: tuple[tuple[str, Acting], ...],
    usual: Acting,
    known: str,
    player: str,
    clock: TempoMap,
) -> Planned[StyleEvent]:
    """Convert the corrections for spans in another style to events, ordered by start, with a problem for each unknown
    style.

    Parameters
    ----------
    actings : tuple of (str, Acting)
        The player's acting in each style.
    usual : Acting
        The player's acting elsewhere.
    known, player : str
        Names of the available styles and of the player, for messages.
    """
    by_name = dict(actings)
    events, problems = [], []
    for item in corrections:
        if not isinstance(item, PlayStyle):
            continue
        start_s, end_s = clock.seconds(float(item.start_tick)), clock.seconds(float(item.end_tick))
        acting = by_name.get(item.style)
        if acting is None:
            message = Message("project.style_missing", {"player": player, "name": item.style, "known": known})
            problems.append(Problem(message, None, start_s, end_s))
        events.append(
            StyleEvent(
                id=f"style:{item.name}",
                style=item.style,
                start_tick=item.start_tick,
                end_tick=item.end_tick,
                start_s=start_s,
                end_s=end_s,
                fade_in_s=max(clock.seconds(float(item.start_tick + item.fade_in_ticks)) - start_s, 0.0),
                fade_out_s=max(end_s - clock.seconds(float(item.end_tick - item.fade_out_ticks)), 0.0),
                acting=usual if acting is None else acting,
                usual=usual,
                reason=BY_HAND,
            )
        )
    return Planned(tuple(sorted(events, key=lambda event: (event.start_s, event.id))), tuple(problems))


@overload
def amount_at(styles: Sequence[StyleEvent], layer: str, usual: float, times_s: float) -> float: ...
@overload
def amount_at(styles: Sequence[StyleEvent], layer: str, usual: float, times_s: FloatArray) -> FloatArray | float: ...
def amount_at(
    styles: Sequence[StyleEvent], layer: str, usual: float, times_s: FloatArray | float
) -> FloatArray | float:
    """Return the amount of a layer (a field of `Acting`) at some times; ``usual`` outside the spans.

    Where spans overlap, the later one has priority.
    """
    shown: FloatArray | float = usual
    for event in styles:
        shown = shown + (getattr(event.acting, layer) - shown) * _presence(event, times_s)
    return shown


def most_shown(styles: Sequence[StyleEvent], usual: Acting) -> Acting:
    """Return for each layer of acting the largest amount that any style in the piece gives it."""
    if not styles:
        return usual
    shown = (usual, *(event.acting for event in styles))
    return Acting(**{name: max(getattr(one, name) for one in shown) for name in Acting.__struct_fields__})


def share_at(styles: Sequence[StyleEvent], layer: str, times_s: FloatArray) -> FloatArray | float:
    """Return the amount (N,) of a layer of acting at given times relative to `most_shown`; 1.0 if there are no style
    spans."""
    if not styles:
        return 1.0
    usual = styles[0].usual
    most = getattr(most_shown(styles, usual), layer)
    return amount_at(styles, layer, getattr(usual, layer), times_s) / most if most > 0.0 else 1.0


def shown_in_style(plan: PlayerPlan) -> PlayerPlan:
    """The plan with cues and gestures scaled by style spans, relative to `most_shown`; the same plan if it has no style
    spans. Unchanged cues and gestures give the same objects as before.
    """
    if not plan.styles:
        return plan
    return msgspec.structs.replace(
        plan,
        gestures=_SHOWN_GESTURES.step(_shown_gestures, plan.gestures, plan.styles),
        cues=_SHOWN_CUES.step(_shown_cues, plan.cues, plan.styles),
    )


def differing_s(styles: Sequence[StyleEvent], others: Sequence[StyleEvent]) -> FloatArray:
    """Return the K spans (K, 2) in seconds in which the styles of two plans with equal `most_shown` may differ."""
    if tuple(styles) == tuple(others):
        return np.zeros((0, 2))
    different = [event for event in (*styles, *others) if event not in styles or event not in others]
    return np.array([(event.start_s, event.end_s) for event in different]).reshape(-1, 2)


def styles_at(styles: Sequence[StyleEvent], usual: str, times_s: FloatArray) -> list[str]:
    """Return the name of the style in force at each time; ``usual`` outside the style spans."""
    found = [usual] * len(times_s)
    for event in styles:
        for place in np.flatnonzero((times_s >= event.start_s) & (times_s < event.end_s)).tolist():
            found[place] = event.style
    return found


def _shown_gestures(gestures: tuple[GestureEvent, ...], styles: tuple[StyleEvent, ...]) -> tuple[GestureEvent, ...]:
    middles_s = np.array([0.5 * (event.start_s + event.end_s) for event in gestures])
    shares = {layer: np.broadcast_to(share_at(styles, layer, middles_s), len(gestures)) for layer in _LAYERS}
    return tuple(
        msgspec.structs.replace(event, amount=event.amount * float(shares[layer][place]))
        if (layer := GESTURE_KINDS[event.kind].layer)
        else event
        for place, event in enumerate(gestures)
    )


def _shown_cues(cues: tuple[CueEvent, ...], styles: tuple[StyleEvent, ...]) -> tuple[CueEvent, ...]:
    shares = np.broadcast_to(share_at(styles, "cue", np.array([cue.end_s for cue in cues])), len(cues))
    return tuple(
        msgspec.structs.replace(cue, amount=cue.amount * float(share)) for cue, share in zip(cues, shares, strict=True)
    )


def _presence(event: StyleEvent, times_s: FloatArray | float) -> FloatArray | float:
    """Return the weight of a style at given times, 0..1, with its smooth fade-in and fade-out."""
    rising = _eased((times_s - event.start_s) / max(event.fade_in_s, 1e-9))
    falling = _eased((event.end_s - times_s) / max(event.fade_out_s, 1e-9))
    return np.minimum(rising, falling)


def _eased(phase: FloatArray | float) -> FloatArray | float:
    """Return a smooth step (minimum jerk) from 0 to 1 for phases, which are limited to 0..1."""
    u = np.clip(phase, 0.0, 1.0)
    eased: FloatArray | float = u * u * u * (10.0 + u * (6.0 * u - 15.0))
    return eased


_LAYERS: Final = tuple(dict.fromkeys(kind.layer for kind in GESTURES if kind.layer))
_SHOWN_GESTURES: Final[IdentityCache[tuple[GestureEvent, ...]]] = IdentityCache(64)
_SHOWN_CUES: Final[IdentityCache[tuple[CueEvent, ...]]] = IdentityCache(64)
