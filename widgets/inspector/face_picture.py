"""Front view of an expression on the active player's character."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Final

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QImage, QPixmap
from PySide6.QtWidgets import QWidget

from app.editor.session import Session
from app.errors import Message, Progress, StopRequested
from app.rig.characters.dressed_characters import character_in
from app.rig.model import Character
from app.rig.people.wardrobe import OutfitChoice
from widgets.common.character_picture import Seen, picture, seen
from widgets.common.plain import Label

SIZE_PX: Final = 200
WAITS_MS: Final = 120
"""Delay in milliseconds before a changed face is drawn; the viewport follows immediately."""


class FacePicture(Label):
    """Draws a face in the background whenever its weights change."""

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent=parent)
        self._session = session
        self._weights: dict[str, float] | None = None
        self._drawn: tuple[str, OutfitChoice, dict[str, float]] | None = None
        self._wait = QTimer(self, singleShot=True, interval=WAITS_MS)
        self._wait.timeout.connect(self._draw)
        self.setObjectName("expression_picture")
        self.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.setFixedHeight(SIZE_PX)

    @property
    def weights(self) -> Mapping[str, float] | None:
        """Weights of the face drawn last, by morph; None before."""
        return self._weights

    def show_face(self, weights: Mapping[str, float] | None) -> None:
        """Show a face after a delay; None to hide it."""
        self._weights = None if weights is None else dict(weights)
        if weights is None:
            self._wait.stop()
        else:
            self._wait.start()

    def _draw(self) -> None:
        session, weights = self._session, self._weights
        players = session.project.players
        if weights is None or not players:
            return
        chosen = next((one for one in players if one.id in session.players), players[0])
        asked = (chosen.character_id, chosen.outfit, weights)
        if asked == self._drawn:
            return
        ratio = self.devicePixelRatioF()
        size_px = round(SIZE_PX * ratio)

        def work(progress: Progress, stop_requested: StopRequested) -> QImage:
            return picture(_seen(character_in(*asked[:2])), size_px, size_px, "head", weights)

        def done(image: QImage) -> None:
            self._drawn = asked
            image.setDevicePixelRatio(ratio)
            self.setPixmap(QPixmap.fromImage(image))

        session.tasks.run(Message("work.portraits"), work, done, key="expression_picture")


@lru_cache(maxsize=2)
def _seen(character: Character) -> Seen:
    return seen(character)
