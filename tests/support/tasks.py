"""A task runner that works at once, so that a test never waits."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from app.errors import AppError, Cancelled, Message, Progress, StopRequested

T = TypeVar("T")


class ImmediateTasks:
    """Runs work where it is asked for; remembers its names and its errors."""

    def __init__(self) -> None:
        self.names: list[Message] = []
        self.errors: list[AppError] = []

    @property
    def writing(self) -> tuple[Message, ...]:
        """No work is ever under way."""
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
        """Work now."""
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
