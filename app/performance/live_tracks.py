"""Performers in live playback: chunks of their motion, and the contacts that these break."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from threading import Lock

from app.arrays import FloatArray
from app.contacts.breaks import Break, by_time, contact_problems
from app.contacts.judge import ContactJudge
from app.errors import AppError, Cancelled, Message, StopRequested
from app.motion.model import Motion
from app.motion.perform import PerformanceCurves
from app.performance.cast import Performer, performers_of
from app.performance.chunks import Chunk, FrameGrid
from app.performance.dances import Dancing, dancing_of, layer_is_made
from app.performance.ensemble import Performance
from app.performance.excerpt import PerformanceExcerpt
from app.performance.motion import performance_curves
from app.plan.model import PlayerPlan, Problem, TimeFrame
from app.project.performers import Dancer, Player

ArmMeasure = Callable[[Performer, PerformanceCurves, TimeFrame, StopRequested], tuple[Problem, ...]]
"""Function that returns the problems of a player's arms in a whole performance; raises Cancelled."""


@dataclass(eq=False)
class LiveTrack:
    """Live motion of one performer.

    Attributes
    ----------
    plan : PlayerPlan
        Plan of the player; for a dancer one without events.
    known : tuple of Problem
        Problems of the performance known before its motion.
    playing : PerformanceCurves, Dancing or None
        Curves in use; None until first needed, and if the performer cannot be shown.
    chunks : dict of int to Chunk
        Chunks computed from ``playing``, or from ``prepared`` until earlier ones are checked.
    basis : PerformanceCurves, Dancing or None
        Source of ``unproven``: the curves before an edit, whose chunks may still be valid.
    unproven, outdated : dict of int to Chunk
        Chunks shown until better ones exist.
    error : Message or None
        Reason why the performer cannot be shown.
    prepared : PerformanceCurves, Dancing or None
        Curves that replace ``playing`` once earlier chunks are checked.
    performer : Performer or None
        Performer of ``prepared`` and ``playing``.
    judge : ContactJudge or None
        Judge of ``playing``'s contacts; None until contacts are checked.
    judged : set of int
        Chunks whose contacts were checked for ``playing`` (or ``basis`` while unproven).
    breaks : dict of int to tuple of Break
        Broken contacts by chunk; old ones until checked again.
    arms : tuple of Problem
        Problems of the arms; old ones until measured again.
    arms_measured : bool
        Whether ``arms`` is of ``playing``.
    problems : tuple of Problem
        Problems made from the broken contacts, and those of the arms.
    making : Lock
        Held while shared data of the track is computed.
    excerpt : PerformanceExcerpt or None
        Excerpt in use while the whole performance is being planned.
    """

    player: Player | Dancer
    plan: PlayerPlan
    known: tuple[Problem, ...] = ()
    playing: PerformanceCurves | Dancing | None = None
    chunks: dict[int, Chunk] = field(default_factory=dict)
    basis: PerformanceCurves | Dancing | None = None
    unproven: dict[int, Chunk] = field(default_factory=dict)
    outdated: dict[int, Chunk] = field(default_factory=dict)
    error: Message | None = None
    prepared: PerformanceCurves | Dancing | None = None
    performer: Performer | None = None
    judge: ContactJudge | None = None
    judged: set[int] = field(default_factory=set)
    breaks: dict[int, tuple[Break, ...]] = field(default_factory=dict)
    arms: tuple[Problem, ...] = ()
    arms_measured: bool = False
    problems: tuple[Problem, ...] = ()
    making: Lock = field(default_factory=Lock)
    excerpt: PerformanceExcerpt | None = None

    @property
    def bytes(self) -> int:
        kinds = (self.chunks, self.unproven, self.outdated)
        return sum(chunk.bytes for chunks in kinds for chunk in tuple(chunks.values()))

    def shown(self, index: int) -> Chunk | None:
        """Return the best chunk available for a chunk index, even if outdated; None if there is none."""
        return self.chunks.get(index) or self.unproven.get(index) or self.outdated.get(index)

    def fail(self, error: Message) -> None:
        """Record why the performer cannot be shown, as a problem of the whole performance."""
        self.error, frame = error, self.plan.time_frame
        self.problems = (Problem(error, None, frame.first_frame_s, frame.end_s),)

    def prepare(self, performance: Performance) -> PerformanceCurves | Dancing | None:
        """Prepare the performer's curves once; None if that is impossible, with the reason in ``error``."""
        if self.playing is not None or self.error is not None or self.prepared is not None:
            return self.playing or self.prepared
        if isinstance(self.player, Dancer):
            try:
                self.prepared = dancing_of(performance, self.player)
            except AppError as error:
                self.fail(error.message)
            return self.prepared
        if any(one.id in performance.waiting for one in performance.project.played_by(self.player)):
            self.error = Message("character.hold_waiting", {})
            return None
        performance = self.excerpt or performance
        found = performers_of(performance, (self.player,))
        if found.left_out:
            self.error = found.left_out[0].reason
        else:
            self.performer = found.made[self.player.id]
            basis = self.basis if isinstance(self.basis, PerformanceCurves) else None
            self.prepared = performance_curves(performance, self.performer, basis)
        return self.prepared

    def judge_contacts(self, index: int, motion: Motion) -> bool:
        """Check the contacts of a chunk; returns whether any are broken now or were at the last check."""
        assert isinstance(self.playing, PerformanceCurves)
        assert self.performer is not None
        if self.judge is None:
            self.judge = ContactJudge(self.playing, self.performer.character, self.performer.model)
        breaks = self.judge.breaks(motion)
        self.judged.add(index)
        if not breaks and index not in self.breaks:
            return False
        self.breaks[index] = breaks
        return True

    def measure_arms(self, measure: ArmMeasure, frame: TimeFrame, stop_requested: StopRequested) -> bool:
        """Measure the arms if they are not measured yet and it is known what is played; returns whether they were
        measured. Raises Cancelled.
        """
        curves, performer = self.playing, self.performer
        if self.arms_measured or self.basis is not None or self.error is not None:
            return False
        if performer is None or not isinstance(curves, PerformanceCurves):
            return False
        # Only what was stopped is tried again, not what failed.
        self.arms_measured = True
        try:
            self.arms = measure(performer, curves, frame, stop_requested)
        except Cancelled:
            self.arms_measured = False
            raise
        return True

    def has_picture(self, index: int) -> bool:
        """Return whether there is a motion to show for a chunk."""
        return index in self.chunks or index in self.unproven or index in self.outdated

    def reaches(self, grid: FrameGrid, index: int) -> bool:
        """Return whether a chunk may be shown; while an excerpt is in use only the middle of its span may, since its
        ends differ from the full performance.
        """
        if self.excerpt is None:
            return True
        (first, frames), (start_s, end_s) = grid.span(index), self.excerpt.shown_s
        from_s, to_s = (grid.start_s + float(frame / grid.fps) for frame in (first, first + frames))
        return start_s <= from_s and to_s <= end_s

    def found_problems(self) -> tuple[Problem, ...]:
        """Return the problems of broken contacts and of arms, or of corrections that a dance does not meet."""
        if self.playing is not None and not isinstance(self.playing, PerformanceCurves):
            return self.playing.problems
        breaks = [item for index in sorted(self.breaks) for item in self.breaks[index]]
        broken = contact_problems(breaks, self.plan.grips, self.known)
        return by_time((*broken, *self.arms)) if self.arms else broken

    def after(
        self, player: Player | Dancer, plan: PlayerPlan, known: tuple[Problem, ...], same_chunks: int
    ) -> LiveTrack:
        """Return the track for the same performer after an edit, which keeps what is still valid; chunks from the index
        ``same_chunks`` on have different frames.
        """
        proven = self.playing is not None
        # The newest chunks are shown, even those of a performance not compared yet.
        left = {index: chunk for index, chunk in self.unproven.items() if index not in self.chunks}
        return LiveTrack(
            player,
            plan,
            known,
            basis=self.playing if proven else self.basis,
            unproven=self.chunks if proven else left,
            outdated=self.outdated if proven else self.outdated | self.chunks,
            judged={index for index in tuple(self.judged) if index < same_chunks},
            breaks=dict(self.breaks),
            arms=self.arms,
            problems=self.problems,
        )


@dataclass(frozen=True, eq=False)
class ShownTracks:
    performance: Performance
    grid: FrameGrid
    tracks: dict[str, LiveTrack]

    @property
    def is_whole(self) -> bool:
        """True if all performers are shown by their full plans; False while some are still being planned."""
        everyone = len(self.tracks) == len(self.performance.project.performers)
        return everyone and all(track.excerpt is None for track in self.tracks.values())


def motion_changed_s(playing: PerformanceCurves | Dancing, basis: PerformanceCurves | Dancing) -> FloatArray:
    """Return the K spans (K, 2) in seconds in which two motions differ."""
    if isinstance(playing, PerformanceCurves) and isinstance(basis, PerformanceCurves):
        return playing.changed_s(basis)
    assert not isinstance(playing, PerformanceCurves)
    return playing.changed_s(basis)


def soon_made(shown: ShownTracks, track: LiveTrack) -> bool:
    """Return whether a player's motion can be computed without first generating a dance."""
    if track.playing is not None or not isinstance(track.player, Player) or not track.player.parameters.choreography:
        return True
    return layer_is_made(shown.performance, track.player)


def played_before(shown: ShownTracks, player: Player) -> set[str]:
    """Return the ids of all players that were played by the same musician as a player in the performance
    shown so far.
    """
    project = shown.performance.project
    return {one.id for one in project.played_by(project.player(player.id))}


def looks_same(player: Player, before: Player | Dancer) -> bool:
    """Return whether a player looks the same as before an edit: all visible properties, apart from the plan, are
    unchanged.
    """
    if player is before:
        return True
    if not isinstance(before, Player):
        return False
    same = player.instrument_id == before.instrument_id and player.character_id == before.character_id
    same = same and player.outfit.id == before.outfit.id
    return same and player.parameters == before.parameters and player.doubles == before.doubles
