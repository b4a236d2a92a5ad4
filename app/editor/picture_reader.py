"""Reads video frames around the playhead in a background thread, and caches them."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import ExitStack
from typing import Final

from app.errors import AppError
from app.formats.video import Picture, VideoFacts, VideoPictures, video_pictures

KEPT_BYTES: Final = 96 << 20
AHEAD: Final = 12
"""Number of pictures read in advance."""
BACK: Final = 24
"""Number of pictures before the requested one from which reading starts after a jump back, so that stepping back is
quick.
"""
PASSED: Final = 60
"""Number of pictures up to which later pictures are reached by reading on; farther ones are reached by seeking."""


class PictureReader:
    """Reads frames of a video by number.

    Parameters
    ----------
    path : str
        Path of the video file.
    facts : VideoFacts
        Frame rate, duration and size of the video.
    size : (int, int)
        Width and height of the frames in pixels.
    arrived : callable
        Called on the thread when the last requested frame has been read.
    failed : callable
        Called on the thread when the video cannot be read.
    """

    def __init__(
        self,
        path: str,
        facts: VideoFacts,
        size: tuple[int, int],
        arrived: Callable[[], None],
        failed: Callable[[AppError], None],
    ) -> None:
        self._path, self._facts, self._size = path, facts, size
        self._arrived, self._failed = arrived, failed
        self._most = max(KEPT_BYTES // (3 * size[0] * size[1]), AHEAD + BACK)
        self._condition = threading.Condition()
        self._kept: dict[int, Picture] = {}
        self._sought = 0
        self._from = 0
        """Picture at which reading begins again if the one that is sought is not found."""
        self._end: int | None = None
        """One more than the last picture's number, once that is known."""
        self._stream: VideoPictures | None = None
        self._closed = False
        self._thread = threading.Thread(target=self._run, name="video pictures", daemon=True)
        self._thread.start()

    def request(self, number: int) -> Picture | None:
        """Return a frame if it is cached; otherwise request it, so that `arrived` is called later, and return None.

        None is returned for frames after the end of the video too.
        """
        with self._condition:
            if number != self._sought:
                back = number < self._sought
                self._sought = number
                self._from = max(number - BACK if back else number, 0)
                self._condition.notify()
            return self._kept.get(number)

    def is_beyond(self, number: int) -> bool:
        """Return whether the video is known to end before this frame."""
        with self._condition:
            return self._end is not None and number >= self._end

    def close(self) -> None:
        """End the thread, even while it reads."""
        with self._condition:
            self._closed = True
            if self._stream is not None:
                self._stream.stop()
            self._condition.notify()
        self._thread.join()

    # Thread

    def _run(self) -> None:
        try:
            with ExitStack() as open_stream:
                while (number := self._awaited()) is not None:
                    self._read(number, open_stream)
        except AppError as error:
            self._failed(error)

    def _awaited(self) -> int | None:
        """Wait for a request, and return the number of the next frame to read; None when the thread should end."""
        with self._condition:
            while not self._closed:
                first = max(self._sought, 0)
                end = first + AHEAD if self._end is None else min(first + AHEAD, self._end)
                missing = next((number for number in range(first, end) if number not in self._kept), None)
                if missing is not None:
                    return missing
                self._condition.wait()
        return None

    def _read(self, number: int, open_stream: ExitStack) -> None:
        stream = self._stream
        if stream is None or not 0 <= number - stream.next <= PASSED:
            open_stream.close()
            with self._condition:
                first = self._from if number == max(self._sought, 0) else number
            stream = open_stream.enter_context(video_pictures(self._path, self._facts.rate, self._size, first))
            with self._condition:
                self._stream = stream
                if self._closed:
                    stream.stop()
        at = stream.next
        picture = stream.read()
        with self._condition:
            if picture is None:
                self._end = at
                is_sought = self._sought >= at
            else:
                self._keep(at, picture)
                is_sought = self._sought == at
        if is_sought:
            self._arrived()

    def _keep(self, number: int, picture: Picture) -> None:
        self._kept[number] = picture
        while len(self._kept) > self._most:
            del self._kept[max(self._kept, key=lambda kept: abs(kept - self._sought))]
