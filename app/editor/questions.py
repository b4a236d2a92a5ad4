"""Questions to the user, independent of dialogs; the shell shows dialogs, tests answer directly."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal, Protocol, TypeAlias

from app.editor.design_tokens import Tokens
from app.editor.tasks import Tasks
from app.errors import Message
from app.project.importing import ImportRequest
from app.score.contents import PieceContents

Answer = Literal["save", "discard", "cancel"]
ReadAgain: TypeAlias = Callable[[str | None], PieceContents]
"""Function that reads a file again with its texts in the given encoding; None to detect the encoding."""


class Questions(Protocol):
    """Interface by which the editor's services ask the user, without depending on dialogs."""

    def open_file(self, title: str, folder: str, filters: str) -> Path | None:
        """Ask for an existing file, and return its path; None if the user cancels."""

    def save_file(self, title: str, proposal: str, filters: str, suffixes: Sequence[str]) -> Path | None:
        """Ask for a file to write, and for confirmation before one is replaced; return its path with one of the
        suffixes.

        None if the user cancels.
        """

    def unsaved(self, name: str) -> Answer:
        """Ask whether to save unsaved changes, to discard them or to cancel, and return the answer."""

    def stop_writing(self, works: tuple[Message, ...]) -> bool:
        """Ask whether to quit although the listed tasks are still writing files; return True to stop them and quit."""

    def import_midi(
        self, contents: PieceContents, read_again: ReadAgain, tokens: Tokens, tasks: Tasks
    ) -> ImportRequest | None:
        """Ask for the players of a MIDI file, and whether to add a dancer, and return the decisions; None if the user
        cancels.
        """

    def remove_character(self, name: str, players: tuple[str, ...]) -> bool:
        """Ask whether to delete a character that the named players have; return True to delete it."""
