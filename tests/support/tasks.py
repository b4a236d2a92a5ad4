"""A task runner that works synchronously, so that tests need not wait."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from app.errors import AppError, Cancelled, Message, Progress, StopRequested

T = TypeVar("T")


class ImmediateTasks:
    """Runs work in the call; records its names and errors."""

    def __init__(self) -> None:
        self.names: list[Message] = []
        self.errors: list[AppError] = []

    @property
    def writing(self) -> tuple[Message, ...]:
        """Always false: no work is in progress between calls."""
        return ()

    def run(
        self,
        name: Message,
        work: Callable[[Progress, StopRequested], T],
        done: Callable[[T], None],
        failed: Callable[[AppError], None] | None = None,
        key: str | None = None,
        ended: Callable[[], None] | None = None,
        *,
        writes: bool = False,
    ) -> None:
        """Run work immediately."""
        self.names.append(name)
        over = ended or (lambda: None)
        try:
            result = work(lambda share: None, lambda: False)
        except Cancelled:
            over()
            return
        except AppError as error:
            self.errors.append(error)
            over()
            if failed is not None:
                failed(error)
            return
        over()
        done(result)
