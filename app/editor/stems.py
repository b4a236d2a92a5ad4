"""Renders the sound of every player and of the percussion with the synthesiser in the background."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from math import inf

from PySide6.QtCore import QObject, QTimer, Signal

from app.audio.mix import PERCUSSION, percussion_phrases, player_gains, player_phrases
from app.audio.render_process import RenderProcess
from app.audio.sound_cache import Shelved
from app.audio.synth import RenderedPhrase, Synthesiser
from app.audio.track import RATE_HZ, MixTrack
from app.editor.tasks import Tasks
from app.errors import Message, Progress, StopRequested, raise_if_stopped
from app.project.model import Project
from app.project.performers import Player

_SETTLE_MS = 120
"""Milliseconds without change after which a dragged value is rendered."""
_LOOK_MS = 250
"""Interval in milliseconds at which newly rendered sound is added to the mix."""
_MOST_BYTES = 160 * 1024 * 1024
"""Greatest size in bytes of the sound rendered in advance: four players for six minutes, fifty for half a minute. For
longer pieces this is a window that moves with the playhead.
"""
_AHEAD_S = 20.0
"""Seconds before the end of one window at which rendering of the next begins."""


@dataclass(frozen=True, eq=False)
class _Made:
    """The rendered phrases of a player or of the percussion, with the objects from which they were rendered."""

    sources: tuple[object, ...]
    phrases: tuple[RenderedPhrase, ...]

    def is_of(self, sources: tuple[object, ...]) -> bool:
        """Return whether the phrases were rendered from the same objects as ``sources``."""
        return all(one is other for one, other in zip(self.sources, sources, strict=True))


@dataclass(eq=False)
class _Job:
    """A rendering in progress of the sound of single players; written by the worker thread, read on the window's
    thread.
    """

    project: Project
    made: dict[str, _Made] = field(default_factory=dict)
    """Rendered phrases of all players and of `PERCUSSION`; the same object until all phrases are found."""
    window_s: tuple[float, float] = (-inf, inf)
    """Range in seconds that is rendered when the job has ended."""
    share: float = 0.0
    """Completed share of the job, 0..1."""
    is_cut: bool = False
    is_stopped: bool = False
    """True if the window's thread has cancelled the job."""
    has_ended: bool = False


class Stems(QObject):
    """Rendered sound of every player and of the percussion, one track for each.

    Parameters
    ----------
    key : str
        Task key of the rendering (`Tasks.run`).

    Signals
    -------
    changed()
        More sound has been rendered.
    """

    changed = Signal()

    def __init__(self, tasks: Tasks, parent: QObject, key: str = "synthesise") -> None:
        super().__init__(parent)
        self._tasks, self._key = tasks, key
        self._synthesiser = Synthesiser(Shelved(RenderProcess()))
        self._made: dict[str, _Made] = {}
        self._job: _Job | None = None
        self._requested: tuple[Project, float] | None = None
        self._tracks: dict[str, tuple[_Made, tuple[float, float], MixTrack]] = {}
        """By player, with what it was made from."""
        self._stale: deque[str] = deque()
        """Players whose track lacks what was rendered, or keeps what was forgotten; workers add, the window takes."""
        self.ready = 1.0
        """0..1: how much of the project that is followed is rendered."""
        self._settle_timer = QTimer(self, interval=_SETTLE_MS, singleShot=True)
        self._settle_timer.timeout.connect(self._render)
        self._look_timer = QTimer(self, interval=_LOOK_MS)
        self._look_timer.timeout.connect(self._look)

    @property
    def is_busy(self) -> bool:
        """True if something is waiting or being rendered."""
        return self._settle_timer.isActive() or self._look_timer.isActive()

    def follow(self, project: Project, from_s: float) -> None:
        """Render the missing sound of a project.

        Parameters
        ----------
        from_s : float
            Playback time from which to render first.
        """
        self._requested = (project, from_s)
        job = self._job
        if job is not None and job.project is project and (not job.has_ended or self.covers(from_s)):
            return
        if not self.covers(from_s) or any(
            (made := self._made.get(voice)) is None or not made.is_of(_sources(project, player))
            for voice, player in _voices(project).items()
        ):
            self._settle_timer.start()

    def stop(self) -> None:
        """Stop rendering."""
        self._settle_timer.stop()
        self._look_timer.stop()
        if self._job is not None:
            self._job.is_stopped = True

    def clear(self) -> None:
        """Drop the project and its tracks."""
        self.stop()
        self._job, self._requested, self._made, self._tracks, self.ready = None, None, {}, {}, 0.0

    def covers(self, at_s: float) -> bool:
        """Return whether the sound from a time on is rendered or being rendered."""
        if self._job is None:
            return True
        start_s, end_s = self._job.window_s
        return start_s <= at_s and (at_s + _AHEAD_S < end_s or end_s == inf)

    def tracks(self, project: Project, percussion: bool = True) -> list[MixTrack]:
        """Return the rendered tracks of the audible players and, if requested, of the percussion, as far as they are
        complete.

        Unchanged tracks are the same objects as before.
        """
        tracks, kept = [], {}
        for player_id, gains in player_gains(project).items():
            if player_id == PERCUSSION and not percussion:
                continue
            made = self._made.get(player_id)
            if made is None:
                continue
            known = self._tracks.get(player_id)
            if known is None or known[0] is not made or known[1] != gains:
                pieces = (self._synthesiser.ready(phrase) for phrase in made.phrases)
                known = (made, gains, MixTrack((piece for piece in pieces if piece is not None), *gains))
            kept[player_id] = known
            tracks.append(known[2])
        self._tracks = kept
        return tracks

    def _render(self) -> None:
        """Start to render the missing sound, in the order in which it is played."""
        if self._requested is None:
            return
        project, from_s = self._requested
        synthesiser, before, stale = self._synthesiser, self._made, self._stale
        job = self._job = _Job(project)

        def work(progress: Progress, stop_requested: StopRequested) -> None:
            def stopped() -> bool:
                return job.is_stopped or stop_requested()

            try:
                made = {}
                for voice, player in _voices(project).items():
                    made[voice] = _made(project, player, before.get(voice))
                    raise_if_stopped(stopped)
                everything = [(player_id, phrase) for player_id, one in made.items() for phrase in one.phrases]
                requested, job.window_s = _next_phrases(everything, from_s)
                gone = synthesiser.forget(phrase for _, phrase in requested)
                stale.extend({player_id for player_id, phrase in everything if phrase.midi in gone} if gone else ())
                missing = [item for item in requested if synthesiser.ready(item[1]) is None]
                job.made, job.is_cut = made, True
                for index, (player_id, phrase) in enumerate(missing):
                    raise_if_stopped(stopped)
                    synthesiser.render(phrase)
                    stale.append(player_id)
                    job.share = (len(requested) - len(missing) + index + 1) / len(requested)
                    progress((index + 1) / len(missing))
                job.share = 1.0
            finally:
                job.has_ended = True

        self._look_timer.start()
        self._tasks.run(Message("work.synthesise"), work, lambda _: self._look(), key=self._key)

    def _look(self) -> None:
        """Add the sound rendered since the last call to the tracks."""
        job = self._job
        if job is None:
            return
        # Read before the finished phrases: if the job ends in between, the next call notices it.
        ended = job.has_ended
        if job.is_cut:
            self._made = job.made
        while self._stale:
            self._tracks.pop(self._stale.popleft(), None)
        self.ready = job.share
        if ended:
            self._look_timer.stop()
        self.changed.emit()


def _next_phrases(
    phrases: Sequence[tuple[str, RenderedPhrase]], from_s: float
) -> tuple[tuple[tuple[str, RenderedPhrase], ...], tuple[float, float]]:
    """Choose the phrases to render next: as many as fit in memory, in the order of playback.

    Parameters
    ----------
    phrases : sequence of (str, RenderedPhrase)
        Id of the player and phrase.

    Returns
    -------
    (tuple, (float, float))
        Chosen phrases with their ids, and the time range in seconds that they complete.
    """
    ordered = sorted(phrases, key=lambda item: (item[1].end < from_s * RATE_HZ, item[1].start))
    taken = 0
    for index, (_, phrase) in enumerate(ordered):
        # Samples have two bytes.
        taken += 2 * (phrase.end - phrase.start)
        if taken > _MOST_BYTES:
            later = phrase.end >= from_s * RATE_HZ
            return tuple(ordered[:index]), (from_s, phrase.start / RATE_HZ if later else inf)
    return tuple(ordered), (-inf, inf)


def _voices(project: Project) -> dict[str, Player | None]:
    """Return all that sounds in a project, by id: the players, and None for the percussion."""
    voices: dict[str, Player | None] = {player.id: player for player in project.players}
    return voices | {PERCUSSION: None} if project.score.percussion else voices


def _sources(project: Project, player: Player | None) -> tuple[object, ...]:
    if player is None:
        return (project.score.percussion, project.score.tempo_map, None)
    return (project.part(player), project.score.tempo_map, player.instrument_id)


def _made(project: Project, player: Player | None, before: _Made | None) -> _Made:
    sources = _sources(project, player)
    if before is not None and before.is_of(sources):
        return before
    return _Made(sources, percussion_phrases(project) if player is None else player_phrases(project, player))
