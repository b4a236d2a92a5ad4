"""The GL canvas: a vispy canvas embedded by Qt, and pictures of any size in its context."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf
from time import perf_counter
from typing import Any

import numpy as np
import numpy.typing as npt
from PySide6.QtCore import QSize
from PySide6.QtGui import QGuiApplication, QImage, QOffscreenSurface, QOpenGLContext
from PySide6.QtOpenGL import QOpenGLFramebufferObject, QOpenGLFramebufferObjectFormat
from vispy import app as vispy_app

from widgets.viewport.camera import Camera
from widgets.viewport.colours_and_lights import Emphasis, ViewportLook
from widgets.viewport.renderer import Renderer
from widgets.viewport.shape_model import LevelsOfDetail

SAMPLES = 4
NO_GL_PLATFORMS = ("offscreen", "minimal", "vnc", "linuxfb")

Picture = tuple[Camera, ViewportLook, Emphasis]


def why_no_gl() -> str | None:
    """Return the reason why GL does not work, in the driver's words; None if it works."""
    platform = QGuiApplication.platformName()
    if platform in NO_GL_PLATFORMS:
        return f"Qt platform '{platform}'"
    context = QOpenGLContext()
    if not context.create():
        return "QOpenGLContext"
    surface = QOffscreenSurface()
    surface.setFormat(context.format())
    surface.create()
    if not surface.isValid() or not context.makeCurrent(surface):
        return "QOffscreenSurface"
    version = context.format().version()
    context.doneCurrent()
    surface.destroy()
    # PySide returns the pair as a plain tuple.
    major, minor = int(version[0]), int(version[1])
    return f"OpenGL {major}.{minor} < 2.0" if (major, minor) < (2, 0) else None


class Canvas(vispy_app.Canvas):  # type: ignore[misc]
    """Widget that draws the stage with GL whenever Qt requests it.

    Parameters
    ----------
    picture : callable
        Returns camera, look and emphasis for the present picture, given its width and height in pixels.
    failed : callable
        Called once with the reason if drawing does not work.
    coarse : callable
        Called with levels of detail that were missing in the picture, after it is drawn.
    """

    def __init__(
        self,
        picture: Callable[[int, int], Picture],
        failed: Callable[[str], None],
        coarse: Callable[[Sequence[LevelsOfDetail]], None],
    ) -> None:
        # Set before the base class, which may draw at once.
        self._picture = picture
        self._failed = failed
        self._coarse = coarse
        self._renderer: Renderer | None = None
        self._broken = False
        self._prepare: Callable[[Renderer], None] | None = None
        self.drawing_s = inf
        """Time that the last picture took ..."""
        self._drawn_s = -inf
        """... and when it was drawn."""
        vispy_app.use_app("pyside6")
        super().__init__(
            config={"samples": SAMPLES, "depth_size": 24, "double_buffer": True},
            keys=None,
            autoswap=False,
            show=False,
            vsync=True,
        )

    def prepare(self, prepare: Callable[[Renderer], None]) -> None:
        """Call a function with the renderer before it draws next."""
        self._prepare = prepare
        self.update()

    def clear_stage(self) -> None:
        """Draw no performers from now on. Their figures are released immediately, since a hidden canvas draws no next
        picture.
        """
        self._prepare = None
        if self._renderer is not None:
            self._renderer.clear_stage()
        self.update()

    def on_draw(self, event: Any) -> None:
        """Draw; called by vispy when Qt paints."""
        width, height = self.physical_size
        began_s = perf_counter()
        self._draw(int(width), int(height))
        self._drawn_s = perf_counter()
        self.drawing_s = self._drawn_s - began_s

    @property
    def rested_s(self) -> float:
        """Return the time in seconds since the last picture was drawn."""
        return perf_counter() - self._drawn_s

    def draw_now(self) -> None:
        """Draw the picture immediately instead of with the next repaint."""
        self.native.repaint()

    def _draw(self, width: int, height: int) -> None:
        if self._broken:
            return
        try:
            if self._renderer is None:
                self._renderer = Renderer()
            if self._prepare is not None:
                prepare, self._prepare = self._prepare, None
                prepare(self._renderer)
            self._renderer.draw(*_sized(self._picture(width, height), width, height))
            self.context.flush_commands()
            if self._renderer.missing:
                self._coarse(self._renderer.missing)
        except Exception as error:  # noqa: BLE001  A driver fails in many ways; the rest of the editor works on.
            self._broken = True
            self._failed(f"{type(error).__name__}: {error}")

    def render_image(self, width: int, height: int) -> npt.NDArray[np.uint8] | None:
        """Return a picture of any size (height, width, 4); None if there is no context."""
        native: Any = self.native
        if self._broken:
            return None
        if native.context() is None:
            # The first picture creates the context, even that of a hidden widget.
            native.grabFramebuffer()
        if native.context() is None or not native.isValid():
            return None
        native.makeCurrent()
        self.set_current()
        # vispy binds the widget's framebuffer with its next commands, so these are flushed before ours is bound.
        self.context.flush_commands()
        kind = QOpenGLFramebufferObjectFormat()
        kind.setSamples(SAMPLES)
        kind.setAttachment(QOpenGLFramebufferObject.Attachment.CombinedDepthStencil)
        target = QOpenGLFramebufferObject(QSize(width, height), kind)
        target.bind()
        self._draw(width, height)
        target.release()
        image = target.toImage(True).convertToFormat(QImage.Format.Format_RGBA8888)
        del target
        native.doneCurrent()
        return None if self._broken else pixels(image)


def pixels(image: QImage) -> npt.NDArray[np.uint8]:
    """Return an image of the format RGBA8888 as an array (height, width, 4)."""
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    return rows[:, : 4 * image.width()].reshape(image.height(), image.width(), 4).copy()


def _sized(picture: Picture, width: int, height: int) -> tuple[Camera, tuple[int, int], ViewportLook, Emphasis]:
    camera, look, emphasis = picture
    return camera, (width, height), look, emphasis
