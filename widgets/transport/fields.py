"""Fields with the playhead's position in three notations, for typing, dragging and copying."""

from __future__ import annotations

import math
import re
import unicodedata

from app.editor.session import Session
from widgets.common.number_slider import NumberSlider

_CLOCK = re.compile(r"^\s*(-?)(?:(?:(\d+)\s*:\s*)?(\d+)\s*:\s*)?(\d+(?:\.\d*)?|\.\d+)\s*$")
MOST_S = 12 * 3600.0
"""Limit in seconds for typed times, beyond any performance."""


def clock_text(time_s: float) -> str:
    """Return a time as ``"00:19.250"``: minutes and seconds, hours if necessary."""
    milliseconds = round(abs(time_s) * 1000)
    minutes, rest = divmod(milliseconds, 60_000)
    hours, minutes = divmod(minutes, 60)
    sign = "−" if time_s < 0 and milliseconds else ""
    hour_text = f"{hours}:" if hours else ""
    return f"{sign}{hour_text}{minutes:02d}:{rest / 1000:06.3f}"


def clock_seconds(text: str) -> float | None:
    """Return the seconds of a clock text or plain number; None if it is neither."""
    plain = unicodedata.normalize("NFKC", text).replace("−", "-").replace(",", ".").strip().removesuffix("s")
    match = _CLOCK.match(plain)
    if match is None:
        return None
    sign, hours, minutes, seconds = match.groups()
    time_s = int(hours or 0) * 3600 + int(minutes or 0) * 60 + float(seconds)
    if not math.isfinite(time_s) or time_s > MOST_S:
        return None
    return -time_s if sign else time_s


class BarsField(NumberSlider):
    """Field that shows and sets the playhead's position as bar, beat and ticks; a drag steps by the grid."""

    def __init__(self, session: Session) -> None:
        super().__init__(session, -1e7, 1e9, default=0.0, step=1.0, decimals=0, slides=False)
        self.setObjectName("bars_field")
        self.show_as_place()


class ClockField(NumberSlider):
    """Field that shows and sets the playhead's position as minutes and seconds."""

    def __init__(self, session: Session) -> None:
        super().__init__(session, -MOST_S, MOST_S, default=0.0, step=0.1, decimals=3, slides=False)
        self.setObjectName("clock_field")
        self.set_wording(clock_text, clock_seconds)


class FramesField(NumberSlider):
    """Field that shows and sets the playhead's position as a frame number."""

    def __init__(self, session: Session) -> None:
        super().__init__(session, -1e7, 1e8, default=0.0, step=1.0, decimals=0, slides=False)
        self.setObjectName("frames_field")
