"""State shared by panels: the document, its plans, and everything not stored in files.

Panels read it, listen to its signals and edit through `Session.apply`; they do not know each other.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import Enum
from operator import is_
from typing import TYPE_CHECKING, Literal

from PySide6.QtCore import QObject, Signal

from app.contacts.breaks import by_time
from app.editor.design_tokens import DARK
from app.editor.listening import Listening
from app.editor.live_players import LivePlayers
from app.editor.problem_filter import ProblemFilter
from app.editor.recording import RecordingState
from app.editor.selection import Selection
from app.editor.state import State, Watched
from app.editor.streaming import Streaming
from app.editor.tasks import Tasks
from app.editor.timeline_view import TimelineView
from app.editor.video_state import VideoState
from app.editor.viewport_state import ViewportState
from app.errors import AppError, Message, UsageError
from app.messages.pitches import PitchNames
from app.performance.ensemble import Performance
from app.plan.model import PlayerPlan, Problem
from app.project.ignored_problems import split_by_ignored
from app.project.model import Project
from app.project.performers import Dancer, Player
from app.project.snap_grid import Grid
from app.project.undoable_document import Change, Document

if TYPE_CHECKING:
    from app.audio.playback import Playback

TimeDisplay = Literal["bars", "seconds", "frames"]


class Severity(Enum):
    """Severity of a notice to the user: information, warning or error."""

    INFORMATION = "information"
    WARNING = "warning"
    ERROR = "error"


class PitchDisplay(State):
    """Display of pitches: concert or written, octave of middle C, note names."""

    def __init__(self) -> None:
        super().__init__()
        self.written = False
        self.middle_c_octave = 4
        self.names: PitchNames = "letters"


class Session(QObject):
    """The editor's shared state.

    Signals
    -------
    changed(Change)
        The document's project has changed.
    performance_changed()
        `performance` has changed: there are new plans. It may lag behind the project by a moment.
    problems_changed()
        `problems` of some players have changed, the plans have not: the motion was made and judged.
    Signals named after a property, such as selection_changed(), players_changed(), playhead_changed(float),
    playing_changed(bool), loop_changed(), grid_changed(), theme_changed(), time_display_changed(), follow_changed(),
    language_changed()
        The property of this name has changed.
    problem_changed()
        Another problem is on display, or none.
    dancer_changed()
        Another dancer is selected, in the same project.
    folded_changed(), groups_players_changed()
        A part of a panel was folded or unfolded; the list of players was divided into sections or joined.
    preview_changed()
        The morphs that preview an expression on the active player's face have changed.
    noticed(object, object)
        A notice for the user: a `Message` and a `Severity`.
    revealed(float)
        Request to scroll the timeline to this time in seconds.
    instruments_changed()
        An instrument was changed or removed (`instrument_maps.library`).
    instruments_saved()
        An instrument was written into the user's own folder.
    characters_changed()
        A character was changed or removed (`app.rig.characters.character_library`).
    characters_saved()
        A character was written into the user's own folder, or removed from it.
    choreographies_changed()
        The file of a choreography was written, so that dancers can use it.
    media_agreed()
        The user allowed reading the project's media files on other computers.
    metadata_changed()
        A style, habit, expression or other table was changed or removed (`metadata.library`).
    metadata_saved()
        Such a table was written into the user's own folder, or removed from it.
    """

    changed = Signal(object)
    performance_changed = Signal()
    problems_changed = Signal()
    problem_changed = Signal()
    selection_changed = Signal()
    players_changed = Signal()
    dancer_changed = Signal()
    playhead_changed = Signal(float)
    playing_changed = Signal(bool)
    loop_changed = Signal()
    grid_changed = Signal()
    theme_changed = Signal()
    time_display_changed = Signal()
    follow_changed = Signal()
    language_changed = Signal()
    folded_changed = Signal()
    groups_players_changed = Signal()
    preview_changed = Signal()
    noticed = Signal(object, object)
    revealed = Signal(float)
    instruments_changed = Signal()
    instruments_saved = Signal()
    characters_changed = Signal()
    characters_saved = Signal()
    choreographies_changed = Signal()
    media_agreed = Signal()
    metadata_changed = Signal()
    metadata_saved = Signal()

    def __init__(self, project: Project, tasks: Tasks) -> None:
        super().__init__()
        self.document = Document(project)
        self.tasks = tasks
        self.pitch_display = PitchDisplay()
        self.viewport = ViewportState()
        self.video = VideoState()
        self.listening = Listening()
        self.live_players = LivePlayers()
        self.recording = RecordingState()
        self.streaming = Streaming()
        self.playback: Playback | None = None
        """Plays the performance; None without sound, as in a picture made without a window."""
        self.timeline_view: TimelineView | None = None
        """The timeline, for commands that mean it; the panel sets it."""
        self._performance = Performance(project)
        self._broken: Mapping[str, tuple[Problem, ...]] = {}
        self.problem_filter = ProblemFilter()
        """The problems that commands step through; the list of problems sets it while it is in sight."""
        self._problems: dict[str, tuple[tuple[object, ...], tuple[Problem, ...], tuple[Problem, ...]]] = {}
        """By player: what they were made from, those that count, and those that are ignored."""
        self._selection = Selection()
        self._players: tuple[str, ...] = tuple(player.id for player in project.players[:1])
        self._dancer_id = project.dancers[-1].id if project.dancers else ""
        self._folded: dict[str, bool] = {}
        self.variety = 0.3
        """Spread of the players after `randomise`, 0..1."""
        self.document.observe(self._document_changed)

    # Project and plans

    @property
    def project(self) -> Project:
        """Return the project being edited, after the last edit."""
        return self.document.project

    @property
    def performance(self) -> Performance:
        """Return the newest planned performance: of `project`, or of a slightly older version (compare
        ``performance.project``).
        """
        return self._performance

    def set_performance(self, performance: Performance) -> None:
        """Replace the planned performance, which everything displayed and heard depends on; emit
        ``performance_changed`` if it is another one.
        """
        if performance is not self._performance:
            self._performance = performance
            self.performance_changed.emit()
            if performance.planned and performance.project is self.project:
                self.select(self._selection.planned(performance.plans))

    @property
    def plans(self) -> Mapping[str, PlayerPlan]:
        """Return the current plan of every player by id; empty before planning."""
        return self._performance.plans if self._performance.planned else {}

    @property
    def plan(self) -> PlayerPlan | None:
        """Return the plan of the active player; None if there is none."""
        return self.plans.get(self._players[0]) if self._players else None

    def problems(self, player_id: str) -> tuple[Problem, ...]:
        """Return the problems of a player or dancer in the order of time, without ignored ones.

        They include broken contacts in the motion computed so far. The same tuple is returned until they change; it is
        empty before planning.
        """
        return self._split_problems(player_id)[0]

    def ignored_problems(self, player_id: str) -> tuple[Problem, ...]:
        """Problems of a performer that the user has marked as ignored."""
        return self._split_problems(player_id)[1]

    def _split_problems(self, player_id: str) -> tuple[tuple[Problem, ...], tuple[Problem, ...]]:
        performance, broken = self._performance, self._broken.get(player_id, ())
        planned = performance.problems(player_id) if performance.planned else ()
        ignored = self.project.ignored_problems.get(player_id, ())
        if not broken and not ignored:
            return planned, ()
        if broken and (not performance.planned or player_id not in performance.plans):
            # For a dancer all problems come from the motion; a player that is being planned has none yet.
            planned, broken = broken if player_id in performance.project.dancer_ids else planned, ()
        known, sources = self._problems.get(player_id), (planned, broken, ignored)
        if known is None or not all(map(is_, known[0], sources)):
            every = by_time(planned + broken) if broken else planned
            clock = performance.project.score.tempo_map
            known = self._problems[player_id] = (sources, *split_by_ignored(every, ignored, clock))
        return known[1], known[2]

    def set_broken(self, broken: Mapping[str, tuple[Problem, ...]]) -> None:
        """Set the broken contacts found in the motion, as problems by player id."""
        if broken != self._broken:
            self._broken = broken
            self.problems_changed.emit()

    def apply(
        self, name: Message, project: Project, gesture: object | None = None, origin: object | None = None
    ) -> bool:
        """Edit the document (see `Document.apply`); return whether it succeeded, and show the reason if not."""
        try:
            self.document.apply(name, project, gesture, origin)
        except UsageError as error:
            self.notice(error.message, Severity.ERROR)
            return False
        return True

    def attempt(
        self,
        name: Message,
        edit: Callable[[Project], Project],
        gesture: object | None = None,
        origin: object | None = None,
    ) -> bool:
        """Edit the document with a function that may raise an AppError, which is shown; return whether it succeeded."""
        try:
            project = edit(self.project)
        except AppError as error:
            self.notice(error.message, Severity.ERROR)
            return False
        return self.apply(name, project, gesture, origin)

    def _document_changed(self, change: Change) -> None:
        known = {player.id for player in change.after.players}
        kept = tuple(player_id for player_id in self._players if player_id in known)
        if not kept:
            kept = tuple(player.id for player in change.after.players[:1])
        moved = kept != self._players
        self._players = kept
        dancers = [dancer.id for dancer in change.after.dancers]
        other_dancer = bool(self._dancer_id or dancers) and self._dancer_id not in dancers
        if other_dancer:
            self._dancer_id = dancers[-1] if dancers else ""
        selected = self._selection
        self._selection = Selection() if change.opened else selected.within(change.after)
        if change.opened:
            Session.loop_s.put(self, None)
        self.changed.emit(change)
        if moved:
            self.players_changed.emit()
        if other_dancer and not change.opened:
            self.dancer_changed.emit()
        if change.opened or self._selection is not selected:
            self.selection_changed.emit()
        if change.opened:
            self.loop_changed.emit()
        if change.before.ignored_problems is not change.after.ignored_problems:
            self.problems_changed.emit()

    # Player in front

    @property
    def players(self) -> tuple[str, ...]:
        """Return the ids of the selected players; the first is the active player, the one that panels show."""
        return self._players

    @property
    def player(self) -> Player | None:
        """Return the active player, the first of the selected ones, which panels show; None if there are no players."""
        return self.project.player(self._players[0]) if self._players else None

    @property
    def in_front(self) -> tuple[str, ...]:
        """Return the ids of the selected players, the active one first; if there are no players, that of the selected
        dancer.
        """
        return self._players or ((self._dancer_id,) if self._dancer_id else ())

    def set_players(self, players: tuple[str, ...]) -> None:
        """Select players; the first one becomes the active player."""
        if players != self._players:
            self._players = players
            self.players_changed.emit()

    @property
    def dancer(self) -> Dancer | None:
        """Return the selected dancer; None if no dancer exists."""
        return self.project.dancer(self._dancer_id) if self._dancer_id else None

    def set_dancer(self, dancer_id: str) -> None:
        """Select the dancer with an id, who is then shown in the dancers' section."""
        if dancer_id != self._dancer_id:
            self._dancer_id = dancer_id
            self.dancer_changed.emit()

    def colour(self, player: Player | Dancer) -> str:
        """Return the colour of a player or dancer, ``#rrggbb``: their own, else the theme's for their index."""
        if player.colour:
            return player.colour
        players = self.project.players
        number = players.index(player) if isinstance(player, Player) else self.project.dancers.index(player)
        return self.tokens.player(number if isinstance(player, Player) else len(players) + number)

    # Other state

    @property
    def selection(self) -> Selection:
        """Return all that is selected (notes, events, marks, time range), always within the current project."""
        return self._selection

    def select(self, selection: Selection) -> None:
        """Select notes, events and the like, leaving out those that no longer exist in the project."""
        selection = selection.within(self.project)
        if selection != self._selection:
            self._selection = selection
            self.selection_changed.emit()

    playhead_s = Watched("playhead_changed", 0.0, is_sent=True)
    """Displayed position in seconds of the performance."""
    set_playhead = playhead_s.setter
    """Display another position. During playback only the transport calls this; other code calls the action `seek`."""

    playing = Watched("playing_changed", False, is_sent=True)
    """True while the performance plays."""
    set_playing = playing.setter
    """Set by the transport."""

    loop_s = Watched[tuple[float, float] | None]("loop_changed", None)
    """Range that is repeated in playback, in seconds of the performance; None without a loop."""
    set_loop = loop_s.setter

    grid = Watched("grid_changed", Grid())
    """Grid that edits snap to."""
    set_grid = grid.setter

    tokens = Watched("theme_changed", DARK)
    """Colours and sizes of the current theme."""
    set_tokens = tokens.setter

    problem = Watched[tuple[str, Problem] | None]("problem_changed", None)
    """Problem that the user navigated to, with its performer's id; None once it is solved or something else is
    selected.
    """
    set_problem = problem.setter

    time_display = Watched[TimeDisplay]("time_display_changed", "bars")
    """Format of times."""
    set_time_display = time_display.setter

    follow = Watched("follow_changed", True)
    """True if the timeline follows the playhead."""
    set_follow = follow.setter

    groups_players = Watched("groups_players_changed", True)
    """True if the list of players is grouped by section where there are enough players."""
    set_groups_players = groups_players.setter

    preview_morphs = Watched[dict[str, float] | None]("preview_changed", None)
    """Morph weights that the first selected player shows instead of the performance's while an expression is being
    edited; None otherwise.
    """
    set_preview_morphs = preview_morphs.setter

    @property
    def folded(self) -> Mapping[str, bool]:
        """Return whether each foldable part of the panels is folded, by name; parts the user never folded or unfolded
        are missing.
        """
        return self._folded

    def set_folded(self, name: str, folded: bool) -> None:
        """Fold or unfold a part of a panel, given by name."""
        if self._folded.get(name) is not folded:
            self._folded[name] = folded
            self.folded_changed.emit()

    def notice(self, message: Message, severity: Severity = Severity.INFORMATION) -> None:
        """Show a message in the status line."""
        self.noticed.emit(message, severity)

    def reveal(self, time_s: float) -> None:
        """Scroll the timeline until a time in seconds is visible."""
        self.revealed.emit(time_s)
