"""Display of the reference video and its current picture: state of the editor that no file keeps."""

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
    """State that the viewport, the commands and the reader of the video share.

    Attributes
    ----------
    placement : str
        Beside the players, behind them, or hidden.
    opacity : float
        0..1, behind the players.
    picture : uint8 array, shape (height, width, 3), or None
        Of now; None before and after the video, and while it is not read yet.
    ratio : float
        Width by height; 0.0 as long as the video is not known.
    fault : Message or None
        Why it cannot be shown.

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
        """Show another picture."""
        if picture is not self.picture:
            self.picture = picture
            self.pictured.emit()
