"""Work in threads for the dialog that learns a choreography, independent of Qt."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from app.choreography.dancers_told_apart import reports
from app.choreography.learn import analyse, learn
from app.choreography.model import ChoreographyModel
from app.choreography.model_file import write_model
from app.choreography.raw_skeleton import BodyError
from app.choreography.read_pair import read_pair
from app.encoding import shown
from app.errors import AppError, Cancelled, Message, Progress, StopRequested
from widgets.dialogs.choreography.learn_draft import PairContents, PairDraft
from widgets.dialogs.choreography.learn_rows import PairRead, PairRow, training_pair, why_unusable
from widgets.dialogs.progress_dialog import stopping


@dataclass(frozen=True, eq=False)
class LearnedChoreography:
    """A choreography that was learned and saved, with its pairs, and messages about what its music predicts."""

    path: Path
    model: ChoreographyModel
    rows: tuple[PairRow, ...]
    pairing: tuple[Message, ...]


def reading(number: int, motion: Path, music: Path, draft: PairDraft) -> Callable[[Progress, StopRequested], PairRead]:
    """Return a function that reads a pair's files; errors are part of its result."""

    def work(progress: Progress, stop_requested: StopRequested) -> PairRead:
        try:
            read = read_pair(
                motion, music, fps=draft.fps, credits=draft.credits, joints=draft.joints, figure=draft.figure
            )
            return PairRead(number, PairContents(read, analyse(read.pair), skeleton=read.motion.skeleton))
        except Cancelled:
            raise
        except AppError as error:
            skeleton = error.skeleton if isinstance(error, BodyError) else None
            return PairRead(number, PairContents(error=error.message, skeleton=skeleton))

    return work


def learning(
    path: Path, rows: tuple[PairRow, ...], states: int | None, seed: int, stop: threading.Event, share: list[float]
) -> Callable[[Progress, StopRequested], LearnedChoreography]:
    """Return a function that learns from the pairs in their present state and saves the result.

    Parameters
    ----------
    states : int or None
        Number of basic motions; None to choose it automatically.
    seed : int
        Seed of the random choices in learning.
    share : list of float
        List whose only number is set to the completed share, 0..1.
    """
    rows = tuple(row for row in rows if why_unusable(row) is None)
    pairs = [pair for row in rows if (pair := training_pair(row)) is not None]

    def work(progress: Progress, stop_requested: StopRequested) -> LearnedChoreography:
        asked = stopping(stop, stop_requested)

        def went(done: float, label: str) -> None:
            if asked():
                raise Cancelled("work.stopped")
            share[0] = done
            progress(done)

        model = learn(pairs, states=states, seed=seed, name=shown(path.stem), progress=went)
        went(1.0, "")
        write_model(path, model)
        return LearnedChoreography(path, model, rows, reports(model))

    return work
