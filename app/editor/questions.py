"""Questions for the user, so that files need no dialog; the shell asks in dialogs, tests answer by themselves."""

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
    """Interface for asking the user; it keeps dialogs out of the editor's services."""

    def open_file(self, title: str, folder: str, filters: str) -> Path | None:
        """Ask for an existing file; None if the user cancels."""

    def save_file(self, title: str, proposal: str, filters: str, suffixes: Sequence[str]) -> Path | None:
        """A file to write, its name with one of the suffixes; whether one may be replaced was asked."""

    def unsaved(self, name: str) -> Answer:
        """Ask whether changes that are in no file are saved, discarded or kept."""

    def stop_writing(self, works: tuple[Message, ...]) -> bool:
        """Return whether the editor ends though it still writes files: the names of that work, which is stopped."""

    def import_midi(
        self, contents: PieceContents, read_again: ReadAgain, tokens: Tokens, tasks: Tasks
    ) -> ImportRequest | None:
        """Return who plays what in a MIDI file, and whether a dancer dances to it; None: it is not imported."""

    def remove_character(self, name: str, players: tuple[str, ...]) -> bool:
        """Return whether a character goes for good, which these players are."""
