"""The reference video in the viewport: its picture beside the players, and the strip with its controls."""

from __future__ import annotations

from functools import partial
from typing import Final

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPaintEvent, QShowEvent
from PySide6.QtWidgets import QButtonGroup, QSizePolicy, QSplitter, QToolButton, QWidget

from app.editor.design_tokens import LEAST_TARGET_PX
from app.editor.session import Session
from app.editor.video_state import DEFAULT_OPACITY, Placement
from app.errors import Message
from app.formats.video import Picture
from app.project.edit.piece import set_video_offset
from app.project.limits import OFFSET_S
from app.project.undoable_document import Change
from widgets.common.actions import actions
from widgets.common.clicks import on_click
from widgets.common.controls import Retranslated, named
from widgets.common.flow import FlowLayout
from widgets.common.icons import icon
from widgets.common.layouts import in_row
from widgets.common.number_slider import NumberSlider
from widgets.common.plain import Label
from widgets.common.text import sentence

DECIMALS: Final = 3
LEAST_SIZE: Final = QSize(160, 90)
SPLITTER_PX: Final = 8
_BUTTONS: Final[dict[Placement, tuple[str, str]]] = {
    "beside": ("video_strip.beside", "video_strip.beside_the_players"),
    "behind": ("video_strip.behind", "video_strip.behind_the_players"),
}


def fitted(ratio: float, width: float, height: float) -> QRectF:
    """Return the largest centred rectangle of an aspect ratio (width / height) in an area of a size."""
    shown_width = min(width, height * ratio)
    shown_height = shown_width / ratio
    return QRectF((width - shown_width) / 2.0, (height - shown_height) / 2.0, shown_width, shown_height)


class VideoView(Retranslated, QWidget):
    """Shows the video's frame at the playhead, or the reason why there is none.

    Parameters
    ----------
    session : Session
        Session with the video.
    """

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("video_view")
        self.setMinimumSize(LEAST_SIZE)
        self._session = session
        session.video.pictured.connect(self.update)
        session.video.changed.connect(self.update)
        session.theme_changed.connect(self.update)
        self.texted(self, name="video_view.reference_video")
        self.retranslate()

    def retranslate(self) -> None:
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the video's frame or the reason."""
        state, tokens = self._session.video, self._session.tokens
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(tokens.sunken))
        if state.fault is not None:
            painter.setPen(QColor(tokens.text_dim))
            inner = self.rect().adjusted(12, 12, -12, -12)
            painter.drawText(inner, int(Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap), sentence(state.fault))
        elif state.ratio > 0.0:
            box = fitted(state.ratio, float(self.width()), float(self.height()))
            painter.fillRect(box, QColor("black"))
            if state.picture is not None:
                painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
                painter.drawImage(box, _image(state.picture))
        painter.end()


class BesideVideo(QSplitter):
    """Splitter with the players and, if shown, the video beside them.

    Parameters
    ----------
    session : Session
        Session with the video.
    players : QWidget
        The view of the players.
    """

    def __init__(self, session: Session, players: QWidget, parent: QWidget | None = None) -> None:
        super().__init__(Qt.Orientation.Horizontal, parent)
        self.setObjectName("viewport_splitter")
        self.setHandleWidth(SPLITTER_PX)
        self.setChildrenCollapsible(False)
        self._session = session
        self._halves = False
        """The video was just shown."""
        self._view = VideoView(session, self)
        for place, widget in enumerate((players, self._view)):
            self.addWidget(widget)
            self.setStretchFactor(place, 1)
        session.changed.connect(self._refresh)
        session.video.changed.connect(self._refresh)
        self._refresh()

    def _refresh(self, change: Change | None = None) -> None:
        shown = self._session.project.video is not None and self._session.video.placement == "beside"
        if shown != self._view.isVisibleTo(self):
            self._view.setVisible(shown)
            self._halves = shown
            self._share()

    def _share(self) -> None:
        """Divide the width equally as soon as it is known."""
        if self._halves and self.isVisible():
            self._halves = False
            self.setSizes([self.width() // 2] * 2)

    def showEvent(self, event: QShowEvent) -> None:
        """Divide the width between video and stage when first shown."""
        super().showEvent(event)
        self._share()


class VideoStrip(Retranslated, QWidget):
    """Controls of the video: display, start time, and alignment by sound.

    Parameters
    ----------
    session : Session
        Session with the video.
    """

    def __init__(self, session: Session, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("video_strip")
        self._session = session
        self._title = self.texted(Label(parent=self), text="video_view.reference_video")
        self._placements = QButtonGroup(self)
        self._buttons: dict[Placement, QToolButton] = {}
        for placement in _BUTTONS:
            button = self._button(f"video_{placement}")
            button.setCheckable(True)
            on_click(button, partial(session.video.set, placement=placement))
            self._placements.addButton(button)
            text_id, tip_id = _BUTTONS[placement]
            self._buttons[placement] = self.texted(button, text=text_id, tip=tip_id)
        self._opacity = self.texted(
            named(NumberSlider(session, default=DEFAULT_OPACITY, parent=self), "video_opacity"),
            words=("video_strip.opacity", "", "video_strip.opacity_behind"),
        )
        self._opacity.changed.connect(lambda value, _: session.video.set(opacity=value))
        self._offset = self.texted(
            named(
                NumberSlider(session, *OFFSET_S, step=0.01, decimals=DECIMALS, slides=False, resets=False, parent=self),
                "video_offset",
            ),
            words=("video_strip.offset", "s", "video_strip.offset_tip"),
        )
        self._offset.changed.connect(self._move)
        self._offset.released.connect(session.document.end_gesture)
        for slider in (self._opacity, self._offset):
            slider.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
            slider.setFixedWidth(150)
        self._estimate = self.texted(
            self._button("video_estimate"), text="video_strip.estimate_offset", tip="video_strip.estimate_offset_tip"
        )
        on_click(self._estimate, lambda: actions(session)["video.estimate_offset"].trigger())
        self._hide = self.texted(self._button("video_hide"), tip="video_strip.hide", name="video_strip.hide")
        on_click(self._hide, partial(session.video.set, placement="hidden"))
        # Controls that do not fit move to a second line, with their whole text.
        parts = FlowLayout()
        for part in (self._title, *self._buttons.values(), self._opacity, self._offset, self._estimate):
            part.setMinimumHeight(LEAST_TARGET_PX + 2)
            parts.addWidget(part)
        in_row((parts, 1), self._hide, of=self, margins=(6, 2, 6, 2), spacing=4)
        session.changed.connect(self.refresh)
        session.video.changed.connect(self.refresh)
        session.theme_changed.connect(self._apply_theme)
        self._apply_theme()
        self.retranslate()
        self.refresh()

    def refresh(self, change: Change | None = None) -> None:
        """Show or hide the strip and update its controls, depending on the project's reference video."""
        video, state = self._session.project.video, self._session.video
        self.setVisible(video is not None and state.placement != "hidden")
        if video is None:
            return
        for placement, button in self._buttons.items():
            button.setChecked(placement == state.placement)
        self._opacity.setVisible(state.placement == "behind")
        self._opacity.show_value(state.opacity)
        self._offset.show_value(video.offset_s)

    def _move(self, offset_s: float, token: object) -> None:
        offset_s = round(offset_s, DECIMALS)
        self._session.attempt(
            Message("edit.set_video_offset"), lambda project: set_video_offset(project, offset_s), token
        )

    def _button(self, name: str) -> QToolButton:
        button = named(QToolButton(self), name)
        button.setAutoRaise(True)
        button.setMinimumSize(LEAST_TARGET_PX + 2, LEAST_TARGET_PX + 2)
        button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        return button

    def _apply_theme(self) -> None:
        self._hide.setIcon(icon("close", self._session.tokens))
        self._title.setStyleSheet(f"color: {self._session.tokens.text_dim};")


def _image(picture: Picture) -> QImage:
    height, width = picture.shape[:2]
    return QImage(picture.data, width, height, 3 * width, QImage.Format.Format_RGB888)
