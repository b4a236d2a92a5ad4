"""What commands may ask of the timeline, so that the shell need not know its widgets."""

from __future__ import annotations

from enum import Enum
from typing import Protocol


class Tool(Enum):
    """What the left button does to notes."""

    SELECT = "select"
    DRAW = "draw"
    ERASE = "erase"
    SPLIT = "split"


class Ghosts(Enum):
    """How the players behind the one in front are seen."""

    GHOSTS = "ghosts"
    ALL = "all"
    ALONE = "alone"


class TimelineView(Protocol):
    """A timeline that is there: `Session.timeline_view`, None while there is none."""

    @property
    def tool(self) -> Tool: ...
    def set_tool(self, tool: Tool) -> None: ...
    @property
    def ghosts(self) -> Ghosts: ...
    def set_ghosts(self, ghosts: Ghosts) -> None: ...
    def zoom_in(self) -> None: ...
    def zoom_out(self) -> None: ...
    def fit(self) -> None: ...
    def zoom_to_selection(self) -> None: ...
    def ask_quantise(self) -> None: ...
    def ask_take_name(self) -> None: ...
    def step_take(self, by: int) -> None: ...
