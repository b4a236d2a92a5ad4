"""State of the reference video's display and its current frame; not stored in files."""

from __future__ import annotations

from typing import Final, Literal, get_args

from PySide6.QtCore import Signal

from app.editor.state import State
from app.errors import Message
from app.formats.video import Picture

Placement = Literal["beside", "behind", "hidden"]
PLACEMENTS: Final[tuple[Placement, ...]] = get_args(Placement)
DEFAULT_OPACITY: Final = 0.6


class VideoState(State):
    """State shared by viewport, commands and video reader.

    Attributes
    ----------
    placement : str
        Where the video is shown: ``"beside"`` the players, behind them, or hidden.
    opacity : float
        Opacity 0..1 behind the players.
    picture : uint8 array, shape (height, width, 3), or None
        Current frame; None before and after the video, and while it is not read yet.
    ratio : float
        Width divided by height; 0.0 until known.
    fault : Message or None
        Reason why the video cannot be shown; None if it can.

    Signals
    -------
    changed()
        Placement, opacity, ratio or fault has changed.
    pictured()
        `picture` has changed.
    """

    pictured = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.placement: Placement = "beside"
        self.opacity = DEFAULT_OPACITY
        self.picture: Picture | None = None
        self.ratio = 0.0
        self.fault: Message | None = None

    def set_picture(self, picture: Picture | None) -> None:
        """Set the decoded picture of the reference video at the playhead; emit ``pictured`` if it is another one."""
        if picture is not self.picture:
            self.picture = picture
            self.pictured.emit()
