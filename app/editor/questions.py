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
"""Reads a file with its texts in another encoding; None: guessed."""


class Questions(Protocol):
    """Interface for asking the user, which keeps dialogs out of the editor's services."""

    def open_file(self, title: str, folder: str, filters: str) -> Path | None:
        """Ask for an existing file; None if the user cancels."""

    def save_file(self, title: str, proposal: str, filters: str, suffixes: Sequence[str]) -> Path | None:
        """Ask for a file to write, with one of the suffixes and confirmation before replacing; None if the user
        cancels.
        """

    def unsaved(self, name: str) -> Answer:
        """Ask whether unsaved changes should be saved, discarded or kept."""

    def stop_writing(self, works: tuple[Message, ...]) -> bool:
        """Ask whether to quit while files are still being written (by these tasks), which would stop that."""

    def import_midi(
        self, contents: PieceContents, read_again: ReadAgain, tokens: Tokens, tasks: Tasks
    ) -> ImportRequest | None:
        """Ask for the players of a MIDI file, and whether to add a dancer; None if the user cancels."""

    def remove_character(self, name: str, players: tuple[str, ...]) -> bool:
        """Ask whether to delete a character used by these players."""
