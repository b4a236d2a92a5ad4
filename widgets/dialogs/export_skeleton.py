"""Choice of the export skeleton and of an asset file, with the differences between the two."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Final, TypeAlias

from PySide6.QtCore import QSize, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QWidget,
)

from app.editor.session import Session
from app.errors import AppError, Message, Progress, StopRequested
from app.export.check_skeleton import reported
from app.export.target import SkeletonChoice
from app.export.targets import CheckedTarget, checked_targets
from app.performance.bodies import character_of
from app.performance.cast import attempt
from app.project.performers import Player
from app.rig.characters.read_figure import SUFFIXES, read_figure
from widgets.common.controls import Button, Retranslated, named, wrapped
from widgets.common.layouts import in_column, in_row
from widgets.common.paths import PathEdit, ask_for_file
from widgets.common.plain import ComboBox, Label
from widgets.common.text import sentence
from widgets.dialogs.export_destination import Destination

Requested: TypeAlias = tuple[SkeletonChoice, Path | None, tuple[str, ...]]
"""Choice, asset, and the characters of the players."""
Found: TypeAlias = tuple[Requested, dict[str, CheckedTarget], AppError | None]
CHOICES: tuple[SkeletonChoice, ...] = ("own", "ue5", "suisou")
MOST_LINES = 5
_KEY = "compare_skeleton"

_CHOICES: Final[dict[SkeletonChoice, str]] = {
    "own": "skeleton_chooser.from_character_file",
    "ue5": "skeleton_chooser.unreal_engine_5_mannequin",
    "suisou": "skeleton_chooser.suisou_vrm_1_0",
}


class SkeletonChooser(Retranslated, QWidget):
    """Choice of skeleton and optional asset file; compares them in the background.

    Parameters
    ----------
    session : Session
        Session with the piece.
    players : callable
        Function that returns the players to export.
    parent : QWidget, optional
    """

    changed = Signal()

    def __init__(
        self, session: Session, players: Callable[[], tuple[Player, ...]], parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._session, self._players = session, players
        self._requested: Requested | None = None
        """Input of the last comparison: results for any other input are out of date."""
        self._checked: dict[str, CheckedTarget] = {}
        self._error: AppError | None = None
        self._comparing = False
        self._destination: Destination = "folder"
        self._chosen = False
        """True if the skeleton was chosen by hand: it then stays, wherever files go."""
        self._box = named(ComboBox(), "export_skeleton")
        for choice in CHOICES:
            self._box.addItem("", choice)
        self.texted(self._box, items=[_CHOICES[choice] for choice in CHOICES])
        self._asset = self.texted(
            named(PathEdit(), "export_asset"), placeholder="skeleton_chooser.fbx_of_asset_to_compare"
        )
        self._asset.setClearButtonEnabled(True)
        self._choose = Button("skeleton_chooser.choose", self._choose_asset)
        self._reported = wrapped(named(Label(), "export_differences"))
        asset = in_row((self._asset, 1), self._choose)
        in_column(self._box, asset, self._reported, of=self, margins=0)
        self._box.currentIndexChanged.connect(self.compare)
        self._box.activated.connect(self._keep_choice)
        self._asset.textChanged.connect(self.compare)
        self.retranslate()

    @property
    def choice(self) -> SkeletonChoice:
        """The skeleton chosen for the export."""
        return CHOICES[self._box.currentIndex()]

    def set_destination(self, destination: Destination) -> None:
        """Choose the usual skeleton of a destination (the mannequin for Unreal), unless the user has chosen one."""
        if destination != self._destination and not self._chosen:
            self._box.setCurrentIndex(CHOICES.index("ue5" if destination == "unreal" else "own"))
        self._destination = destination

    def _keep_choice(self) -> None:
        self._chosen = True

    @property
    def asset(self) -> Path | None:
        """Path of the asset file; None if there is none."""
        return self._asset.path

    @property
    def problem(self) -> str:
        """Return the reason why the export cannot start; empty if it can."""
        if self._comparing:
            return self.tr("skeleton_chooser.skeletons_are_being_compared")
        if self._error is not None:
            return sentence(self._error.message)
        if self.asset is not None and not os.path.isfile(self.asset):
            return self.tr("skeleton_chooser.file_missing")
        if self._checked and not any(map(_fits, self._checked.values())):
            return self.tr("skeleton_chooser.asset_has_another_skeleton_its")
        return ""

    def compare(self) -> None:
        """Compare the skeleton with the asset file in the background."""
        players, choice, asset = self._players(), self.choice, self.asset
        # Typing a path produces many incomplete ones; a request already made is not repeated.
        requested = (choice, asset, tuple(player.character_id for player in players))
        if requested == self._requested:
            return
        self._requested, self._checked, self._error = requested, {}, None
        self._comparing = asset is not None and os.path.isfile(asset)
        if self._comparing and asset is not None:
            name = Message("work.compare_skeleton", {"file": asset.name})
            self._session.tasks.run(name, _comparison(requested, players, choice, asset), self._found, key=_KEY)
        self._show()

    def _found(self, found: Found) -> None:
        requested, checked, error = found
        if requested == self._requested:  # the choice may have changed meanwhile
            self._checked, self._error, self._comparing = checked, error, False
            self._show()

    def _show(self) -> None:
        lines: list[str] = []
        if self._comparing:
            lines = [self.tr("skeleton_chooser.comparing")]
        elif self.asset is not None and self._checked:
            lines = self._differences() or [self.tr("skeleton_chooser.all_match")]
        elif self.asset is None and self.choice == "ue5":
            lines = [self.tr("skeleton_chooser.mannequin_tip")]
        if len(lines) > MOST_LINES:
            lines = [
                *lines[: MOST_LINES - 1],
                self.tr("skeleton_chooser.and_more").format(count=len(lines) - MOST_LINES + 1),
            ]
        self._reported.setText("\n".join(lines))
        self._reported.setVisible(bool(lines))
        self._fit()
        self.changed.emit()

    def _fit(self) -> None:
        """Set the height of the wrapped text, so that a low window does not squeeze it."""
        self._reported.setMinimumHeight(max(self._reported.heightForWidth(self.width()), 0))

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit()

    def _differences(self) -> list[str]:
        """Return a line of text per difference; players with the same character have the same differences."""
        names = {player.id: player.name for player in self._players()}
        said: dict[str, list[str]] = {}
        spoilt = not all(map(_fits, self._checked.values()))
        for player, checked in self._checked.items():
            # Severe differences are shown alone.
            severe = reported([difference for difference in checked.differences if difference.severe])
            for message in severe if spoilt else checked.messages:
                said.setdefault(sentence(message), []).append(names.get(player, ""))
        everyone = len(self._checked)
        return [f"⚠ {text}" if len(who) == everyone else f"⚠ {', '.join(who)}: {text}" for text, who in said.items()]

    def _choose_asset(self) -> None:
        patterns = " ".join(f"*{suffix}" for suffix in SUFFIXES)
        kinds = self.tr("skeleton_chooser.characters") + f" ({patterns})"
        chosen = ask_for_file(self, self.tr("skeleton_chooser.file_of_asset"), self.asset and self.asset.parent, kinds)
        if chosen is not None:
            self._asset.set_path(chosen)

    def retranslate(self) -> None:
        self._show()

    def sizeHint(self) -> QSize:
        return QSize(360, super().sizeHint().height())


def _fits(checked: CheckedTarget) -> bool:
    """Return whether a player can be exported for the asset without loss of animation."""
    return not any(difference.severe for difference in checked.differences)


def _comparison(
    requested: Requested, players: tuple[Player, ...], choice: SkeletonChoice, asset: Path
) -> Callable[[Progress, StopRequested], Found]:
    """Return a function for a background thread that compares the players' skeletons with that of the asset file; it
    does not use Qt.
    """

    def work(progress: Progress, stop_requested: StopRequested) -> Found:
        try:
            # A player without a character is excluded from the export and listed among the problems.
            characters = attempt(players, character_of).made
            return requested, checked_targets(characters, choice, read_figure(asset)), None
        except AppError as error:
            return requested, {}, error

    return work
