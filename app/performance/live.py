"""Motion of all players for the viewport: visible frames first, then the rest, within bounded memory.

The performance is divided into chunks of frames. The worker thread calls `LiveMotion.work` repeatedly; the viewport
calls `LiveMotion.pose`, which never waits. After an edit only chunks with changed curves are computed again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from threading import Lock

from app.errors import Cancelled, Message, StopRequested
from app.motion.model import Motion
from app.motion.perform import PerformanceCurves
from app.performance.chunks import Chunk, FrameGrid, Pose, poses_of
from app.performance.dances import Dancing
from app.performance.ensemble import Performance
from app.performance.excerpt import PerformanceExcerpt
from app.performance.live_tracks import (
    ArmMeasure,
    LiveTrack,
    ShownTracks,
    looks_same,
    motion_changed_s,
    played_before,
    soon_made,
)
from app.plan.model import Problem, no_events
from app.project.performers import Dancer, Player

BUDGET_BYTES = 128 * 1024 * 1024
"""Memory in bytes for computed motion: four players for thirteen minutes, fifty for a minute around the playhead.
Motion is computed twenty times as fast as it is played.
"""
SEEN_S = 4.0
"""Default length in seconds of the visible range."""
MOST_UNJUDGED = 256
"""Greatest number of chunks whose motion is kept until its contacts are judged, while other chunks are computed."""
BEHIND_COSTS = 3
"""Cost of a moment before the playhead, as a multiple of one at the same distance after it."""


class PlayerFault(Exception):
    """A bug in the computation of one player's motion, with the exception as cause; only the motion of that player is
    stopped.
    """


class LiveMotion:
    """Poses of all players of the current performance.

    One thread computes (`work`); any thread may read (`pose`), set the visible span, and compute a frame immediately
    (`make_now`).

    Parameters
    ----------
    budget_bytes : int
        Largest memory of all chunks; those farthest from the playhead are dropped first.
    arm_problems : callable, optional
        Function that measures a player's arms, for `measure_arms`.
    """

    def __init__(
        self, performance: Performance, budget_bytes: int = BUDGET_BYTES, arm_problems: ArmMeasure | None = None
    ) -> None:
        self._budget_bytes, self._arm_problems = budget_bytes, arm_problems
        self._lock = Lock()
        self._requested: tuple[float, float, tuple[str, ...]] = (0.0, SEEN_S, ())
        self._todo: Iterator[tuple[str, int]] | None = None
        self._unjudged: Iterator[tuple[LiveTrack, int]] | None = None
        self._broken: dict[str, tuple[Problem, ...]] = {}
        self._made: list[tuple[str, int, Chunk, Motion]] = []
        """Last results by player and place, until their contacts are judged."""
        self._chunk_bytes = 0
        self._made_chunks = 0
        self._seen = 0
        self._shown = ShownTracks(performance, FrameGrid.of(performance.time_frame, performance.project.fps), {})
        self.show(performance)

    @property
    def performance(self) -> Performance:
        """The performance whose motion is shown at present."""
        return self._shown.performance

    def show_first(self, performance: Performance, player_ids: Sequence[str]) -> None:
        """Show some players of a new performance while its other players are still being planned. Repeated calls add
        players; the first call replaces the performance shown before.
        """

        def begun(player: Player, old: LiveTrack | None, grid: FrameGrid) -> LiveTrack:
            plan, known = performance.plan(player), performance.problems(player.id)
            return LiveTrack(player, plan, known) if old is None else old.after(player, plan, known, grid.chunks)

        self._show_more(performance, map(performance.project.player, player_ids), begun)

    def show_excerpt(self, performance: Performance, excerpt: PerformanceExcerpt) -> None:
        """Show a performance by its excerpt while it is being planned; already planned players stay."""

        def begun(player: Player, old: LiveTrack | None, grid: FrameGrid) -> LiveTrack:
            return old or LiveTrack(player, excerpt.plan(player), excerpt=excerpt)

        self._show_more(performance, excerpt.shown_players, begun)

    def _show_more(
        self,
        performance: Performance,
        players: Iterable[Player],
        begun: Callable[[Player, LiveTrack | None, FrameGrid], LiveTrack],
    ) -> None:
        grid = FrameGrid.of(performance.time_frame, performance.project.fps)
        with self._lock:
            before = self._shown
            tracks = before.tracks if before.performance is performance else {}
            more = {
                player.id: begun(player, old, grid)
                for player in players
                if (old := tracks.get(player.id)) is None or old.excerpt is not None
            }
            self._shown = ShownTracks(performance, grid, tracks | more)
            self._todo = self._unjudged = None
            self._report(self._shown)

    def show(self, performance: Performance) -> None:
        """Change to another performance, such as after an edit. Unchanged motion is kept; changed motion is shown in
        its old state until it is computed.
        """
        grid = FrameGrid.of(performance.time_frame, performance.project.fps)
        with self._lock:
            before = self._shown
            same_frames = grid.same_frames(before.grid)
            same_faces = performance.expressions is before.performance.expressions
            same_chunks = min(grid.frames, before.grid.frames) // grid.length
            if grid.frames == before.grid.frames:
                same_chunks = grid.chunks
            revisions, before_it = performance.characters.revisions, before.performance.characters.revisions

            def same_body(player: Player) -> bool:
                return revisions.get(player.character_id) == before_it.get(player.character_id)

            def same_acting(player: Player, old: Player | Dancer) -> bool:
                if not isinstance(old, Player):
                    return False
                return performance.parameters(player) == before.performance.parameters(old)

            def same_playing(player: Player) -> bool:
                old = before.tracks.get(player.id)
                return (
                    old is not None
                    and performance.plan(player) is old.plan
                    and performance.problems(player.id) is old.known
                    and looks_same(player, old.player)
                    and same_acting(player, old.player)
                    and same_body(player)
                    and not player.parameters.choreography
                )

            project = performance.project
            unchanged = {player.id for player in project.players if same_playing(player)}
            tracks: dict[str, LiveTrack] = {}
            for player in project.players:
                plan, known = performance.plan(player), performance.problems(player.id)
                old = before.tracks.get(player.id)
                # The motion of a musician with several instruments depends on all of them.
                whole = {one.id for one in project.played_by(player)}
                waited = not whole.isdisjoint(before.performance.waiting)
                if old is None or not same_frames or waited:
                    tracks[player.id] = LiveTrack(player, plan, known)
                elif same_faces and whole <= unchanged and whole == played_before(before, player):
                    tracks[player.id] = old
                else:
                    tracks[player.id] = old.after(player, plan, known, same_chunks)
            for dancer in performance.project.dancers:
                old = before.tracks.get(dancer.id)
                plan = no_events(dancer.id, performance.time_frame)
                # A change of the dance is noticed only when it is prepared.
                kept = old is not None and same_frames and isinstance(old.player, Dancer)
                tracks[dancer.id] = (
                    old.after(dancer, plan, (), same_chunks) if old and kept else LiveTrack(dancer, plan)
                )
            self._shown = ShownTracks(performance, grid, tracks)
            self._todo = self._unjudged = None
            self._report(self._shown)

    def request(self, time_s: float, span_s: float = SEEN_S, player_ids: tuple[str, ...] = ()) -> None:
        """Set the visible span, ``span_s`` seconds from ``time_s`` on, and the players to compute first
        (empty: all).
        """
        grid, (last_s, last_span_s, last_ids) = self._shown.grid, self._requested
        self._requested = (time_s, span_s, player_ids)
        moved = grid.place(time_s)[0] // grid.length != grid.place(last_s)[0] // grid.length
        if moved or span_s != last_span_s or player_ids != last_ids:
            with self._lock:
                self._todo = None

    def pose(self, player_id: str, time_s: float) -> Pose | None:
        """A player's pose at a time, interpolated between frames; None if not computed yet. Never waits.

        After an edit it is the previous pose until the new one is computed.
        """
        return self.poses((player_id,), time_s)[0]

    def poses(self, player_ids: Sequence[str], time_s: float) -> list[Pose | None]:
        """Poses of several players in order; see `pose`."""
        shown = self._shown
        frame, share = shown.grid.place(time_s)
        index, inner = divmod(frame, shown.grid.length)
        result: list[Pose | None] = [None] * len(player_ids)
        places, chunks = list[int](), list[Chunk]()
        for place, player_id in enumerate(player_ids):
            track = shown.tracks.get(player_id)
            chunk = track.shown(index) if track is not None else None
            if chunk is not None and inner < chunk.frames:
                places.append(place)
                chunks.append(chunk)
        for place, pose in zip(places, poses_of(chunks, inner, share), strict=True):
            result[place] = pose
        return result

    def pose_now(self, player_id: str, time_s: float) -> Pose | None:
        """Return a player's pose at a time in the current performance, computed immediately if it is missing. If that
        needs a dance not generated yet, return the pose shown so far.

        None for a player that cannot be shown (see `error`).
        """
        shown = self._shown
        track = shown.tracks.get(player_id)
        if track is None:
            return None
        frame, share = shown.grid.place(time_s)
        index, inner = divmod(frame, shown.grid.length)
        chunk = track.chunks.get(index)
        if chunk is not None and inner < chunk.frames:
            return poses_of([chunk], inner, share)[0]
        if not soon_made(shown, track) or not track.reaches(shown.grid, index):
            return self.pose(player_id, time_s)
        with self._own_fault(track):
            curves = self._playing(shown, track)
            if curves is None or track.error is not None:
                return None
            made = Chunk.of(curves.motion(shown.grid.fps, frame, 2 if share > 0.0 else 1))
            return poses_of([made], 0, share)[0]

    def error(self, player_id: str) -> Message | None:
        """Reason why a player cannot be shown; None if none is known."""
        track = self._shown.tracks.get(player_id)
        return None if track is None else track.error

    def work(self, stop_requested: StopRequested = lambda: False) -> bool:
        """Compute the most urgent missing chunk; returns whether there was one. Raises PlayerFault once per player."""
        if self.is_moving or len(self._made) >= MOST_UNJUDGED:
            self._judge_made()
        more = self._make_missing(stop_requested)
        if not more:
            self._judge_made()
        return more

    def _make_missing(self, stop_requested: StopRequested) -> bool:
        if stop_requested():
            return True
        with self._lock:
            shown = self._shown
            if self._todo is None:
                self._todo = self._missing(shown)
            todo = self._todo
        for player_id, index in todo:
            if stop_requested():
                return True
            track = shown.tracks[player_id]
            with track.making:
                made = self._make(shown, track, index)
            if made is not None:
                return made
        return False

    def make_now(self, player_id: str, time_s: float) -> None:
        """Compute the frames of a player around a time immediately; may be called in any thread.

        Does nothing for players never shown, for dances not generated yet, and while the worker computes the same
        player. Reuse of unchanged frames of the previous performance is left to the worker, since comparing takes as
        long as computing. Raises PlayerFault.
        """
        shown = self._shown
        track = shown.tracks.get(player_id)
        if track is None or not track.making.acquire(blocking=False):
            return
        try:
            if (track.playing or track.basis) is not None and soon_made(shown, track):
                index = shown.grid.place(time_s)[0] // shown.grid.length
                self._make(shown, track, index, prove=isinstance(track.player, Dancer))
        finally:
            track.making.release()

    def _make(self, shown: ShownTracks, track: LiveTrack, index: int, *, prove: bool = True) -> bool | None:
        """Compute chunk ``index`` of a player's motion. Returns None if it is not needed or not possible, False if
        there is no room for it."""
        if not track.reaches(shown.grid, index):
            return None
        with self._own_fault(track):
            if prove and (track.playing is None or track.basis is not None):
                self._prove(shown, track)
            curves = self._playing(shown, track)
            if curves is None or track.error is not None or index in track.chunks:
                return None
            if not self._make_room(shown, track, index):
                return False
            motion = curves.motion(shown.grid.fps, *shown.grid.span(index))
            chunk = Chunk.of(motion)
            if isinstance(track.player, Dancer):
                self._name_problems(track)
        with self._lock:
            track.chunks[index] = chunk
            track.outdated.pop(index, None)
            self._chunk_bytes = chunk.bytes
            self._made_chunks += 1
            # A caller that needs a chunk at once shows it too.
            self._seen += prove and index == self._in_sight(shown.grid)[0]
            # Until it is compared, an earlier judgement may be out of date.
            if isinstance(track.player, Player) and (index not in track.judged or not prove):
                self._made.append((track.player.id, index, chunk, motion))
        return True

    def _judge_made(self) -> None:
        """Check contacts in chunks that were computed recently; a separate step, so that showing the poses does not
        wait for it.
        """
        with self._lock:
            shown, made = self._shown, self._made
            # Motion made from an excerpt is judged after it proved equal to that of the whole piece.
            waiting = {player_id for player_id, track in shown.tracks.items() if track.excerpt is not None}
            self._made = [row for row in made if row[0] in waiting]
        for player_id, index, chunk, motion in made:
            track = shown.tracks.get(player_id)
            if track is None or player_id in waiting:
                continue
            with track.making, self._own_fault(track):
                if track.playing is None or track.basis is not None:
                    self._prove(shown, track)
                if track.chunks.get(index) is chunk and index not in track.judged and track.error is None:
                    self._judge(track, index, motion)

    def judge(self, stop_requested: StopRequested = lambda: False) -> bool:
        """Check the contacts of some frames for which there is no memory, after `work` has finished; returns whether
        there were any such frames.

        Must be called on the thread of `work`. Raises PlayerFault.
        """
        with self._lock:
            shown = self._shown
            if not shown.is_whole:
                return False
            if self._unjudged is None:
                tracks = tuple(shown.tracks.values())
                self._unjudged = ((track, index) for track in tracks for index in range(shown.grid.chunks))
            unjudged = self._unjudged
        for track, index in unjudged:
            if stop_requested():
                with self._lock:
                    self._unjudged = None
                return True
            with track.making, self._own_fault(track):
                if track.playing is None or track.basis is not None:
                    self._prove(shown, track)
                if not isinstance(track.playing, PerformanceCurves) or track.error is not None or index in track.judged:
                    continue
                self._judge(track, index, track.playing.motion(shown.grid.fps, *shown.grid.span(index)))
            return True
        return False

    def measure_arms(self, stop_requested: StopRequested) -> bool:
        """Measure the arms of a player, after `judge` has finished; returns whether others may be left.

        Must be called on the thread of `work`. An edit does not wait for it: only ``stop_requested`` ends it early.
        """
        shown = self._shown
        if self._arm_problems is None or not shown.is_whole:
            return False
        for track in shown.tracks.values():
            try:
                if track.measure_arms(self._arm_problems, shown.performance.time_frame, stop_requested):
                    self._name_problems(track)
                    return True
            except Cancelled:
                return True
        return False

    @property
    def seen(self) -> int:
        """Counter that increases when `work` has computed poses around the requested time, so that the view must be
        redrawn.
        """
        return self._seen

    @property
    def made(self) -> int:
        """Return the number of chunks computed so far."""
        return self._made_chunks

    @property
    def is_seen(self) -> bool:
        """True if all chunks in the visible span are computed."""
        shown = self._shown
        places = self._in_sight(shown.grid)
        return shown.is_whole and all(
            track.error is not None or (track.basis is None and all(index in track.chunks for index in places))
            for track in shown.tracks.values()
        )

    @property
    def is_moving(self) -> bool:
        """True if each player that can be shown has a motion at the playhead."""
        shown = self._shown
        here = self._in_sight(shown.grid)[0]
        return all(
            track.error is not None or track.has_picture(here) or not track.reaches(shown.grid, here)
            for track in shown.tracks.values()
        )

    @property
    def broken(self) -> dict[str, tuple[Problem, ...]]:
        """Problems of broken contacts and of arms by player id, in all that was computed so far; a new dict whenever it
        changes.
        """
        return self._broken

    @contextmanager
    def _own_fault(self, track: LiveTrack) -> Iterator[None]:
        """Context manager that turns an exception in the block into a fault of this player alone, whose motion then
        stops.
        """
        try:
            yield
        except Exception as fault:
            detail = f"{type(fault).__name__}: {fault}"
            track.fail(Message("player.fault", {"player": track.player.name, "detail": detail}))
            with self._lock:
                self._report(self._shown)
            raise PlayerFault(f"{track.player.name}: {detail}") from fault

    def _judge(self, track: LiveTrack, index: int, motion: Motion) -> None:
        if track.judge_contacts(index, motion):
            self._name_problems(track)

    def _name_problems(self, track: LiveTrack) -> None:
        """Update a player's problems: broken contacts and arms, or corrections that its dance does not follow."""
        problems = track.found_problems()
        if problems != track.problems:
            track.problems = problems
            with self._lock:
                self._report(self._shown)

    def _report(self, shown: ShownTracks) -> None:
        broken = {player_id: track.problems for player_id, track in shown.tracks.items() if track.problems}
        if broken != self._broken:
            self._broken = broken

    @property
    def ready_share(self) -> float:
        """Return the share of storable frames that is computed, 0..1."""
        shown = self._shown
        ready = sum(len(track.chunks) for track in shown.tracks.values())
        performers = len(shown.performance.project.performers)
        requested = shown.grid.chunks * (performers - sum(track.error is not None for track in shown.tracks.values()))
        if self._chunk_bytes:
            requested = min(requested, self._budget_bytes // self._chunk_bytes)
        return min(ready / requested, 1.0) if requested else 1.0

    @property
    def bytes(self) -> int:
        """Memory of all chunks in bytes."""
        return sum(track.bytes for track in tuple(self._shown.tracks.values()))

    def _playing(self, shown: ShownTracks, track: LiveTrack) -> PerformanceCurves | Dancing | None:
        known = track.error
        playing = track.prepare(shown.performance)
        if track.error is not known:
            with self._lock:
                self._report(shown)
        return playing

    def _prove(self, shown: ShownTracks, track: LiveTrack) -> None:
        """Find out which chunks computed for the performance before an edit are still valid, and keep them."""
        curves = self._playing(shown, track)
        if curves is None:
            track.unproven, track.outdated, track.basis = {}, {}, None
            track.breaks = {}
            if isinstance(track.player, Player):
                self._name_problems(track)
            return
        kept: dict[int, Chunk] = {}
        if track.basis is not None:
            touched = shown.grid.touched(motion_changed_s(curves, track.basis))
            for index, chunk in track.unproven.items():
                right = index < len(touched) and not touched[index] and chunk.frames == shown.grid.span(index)[1]
                (kept if right else track.outdated)[index] = chunk
            track.judged -= {index for index in track.judged if index >= len(touched) or touched[index]}
            track.breaks = {index: breaks for index, breaks in track.breaks.items() if index < shown.grid.chunks}
        with self._lock:
            # The chunks that exist were made from equal curves.
            track.playing, track.chunks, track.basis, track.unproven = curves, kept | track.chunks, None, {}
        if track.breaks or track.problems:
            self._name_problems(track)

    def _missing(self, shown: ShownTracks) -> Iterator[tuple[str, int]]:
        """Yield the missing chunks as (player id, chunk index), most urgent first: visible ones, then by distance in
        time.
        """
        grid, player_ids = shown.grid, self._requested[2]
        asked = [player_id for player_id in player_ids if player_id in shown.tracks]
        everyone = asked + [player_id for player_id in shown.tracks if player_id not in asked]
        # The active player first, then all players at the playhead, then the chunks that follow.
        for index in (places := self._in_sight(grid)):
            yield from ((player_id, index) for player_id in everyone)
        if not shown.is_whole:
            # Making further chunks would delay the plans of the other players.
            return
        for index in sorted(range(grid.chunks), key=lambda index: _distance(index, places[0])):
            yield from ((player_id, index) for player_id in everyone)

    def _in_sight(self, grid: FrameGrid) -> range:
        """The visible chunks; the first one contains the playhead."""
        time_s, span_s, _ = self._requested
        return range(grid.place(time_s)[0] // grid.length, grid.place(time_s + span_s)[0] // grid.length + 1)

    def _make_room(self, shown: ShownTracks, track: LiveTrack, index: int) -> bool:
        """Drop chunks that are farther from the playhead than the chunk ``index``, until that chunk has room; returns
        False if that is impossible.
        """
        player_ids, places = self._requested[2], self._in_sight(shown.grid)
        here = places[0]

        def rank(of: LiveTrack, place: int) -> tuple[int, int]:
            in_front = not player_ids or of.player.id in player_ids
            return (0 if place == here and in_front else 1 if place in places else 2, _distance(place, here))

        over = self.bytes + self._chunk_bytes - self._budget_bytes
        if over <= 0:
            return True
        held = [
            (rank(other, place), place, chunks)
            for other in tuple(shown.tracks.values())
            for chunks in (other.chunks, other.unproven, other.outdated)
            for place in tuple(chunks)
        ]
        held.sort(key=lambda row: row[0], reverse=True)
        own = rank(track, index)
        with self._lock:
            for far, place, chunks in held:
                if far <= own:
                    return False
                chunk = chunks.pop(place, None)
                over -= chunk.bytes if chunk is not None else 0
                if over <= 0:
                    return True
        return False


def _distance(index: int, here: int) -> int:
    return index - here if index >= here else BEHIND_COSTS * (here - index)
