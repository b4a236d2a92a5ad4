"""The project: a score, its performers and all corrections, as one immutable value."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from typing import Final

import msgspec

from app.errors import UsageError
from app.plan.by_hand.corrections import Correction
from app.plan.generate import PREROLL_BEATS, usual_preroll
from app.plan.parameters import Parameter, PlayerParameters, declared
from app.project.band_in_title import years_in_title
from app.project.camera_bookmarks import CameraBookmark
from app.project.casting import ConductorPlace, amplitude, player_seed, stage_seats, usual_posture
from app.project.character_choice import characters_for
from app.project.dance_corrections import DanceCorrection
from app.project.doubling import common_postures, doubled_parts, embodied
from app.project.footprint import footprint, together
from app.project.frame_rate import USUAL_RATE
from app.project.ignored_problems import IgnoredProblem
from app.project.import_decisions import ImportDecisions, ReadTiming
from app.project.names import unique_names
from app.project.parameters import ParameterSetting
from app.project.parameters import with_settings as parameters_with
from app.project.performers import Dancer, Player
from app.project.recording import AudioTrack
from app.project.video import VideoTrack
from app.score.instrument_choice import MapChoice
from app.score.metre_map import MetreMap
from app.score.model import ControllerCurve, Note, Part, Score
from app.score.take import Take
from instrument_maps.model import InstrumentMap
from metadata.model import Expression

DANCER_PARAMETERS: Final[Mapping[str, Parameter]] = declared(Dancer, "dancer_parameter")
"""All parameters of a dancer by name."""


class CompSpan(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A span of a part that came from a take.

    Attributes
    ----------
    start_tick, end_tick : int
        Half-open span; selects notes by onset.
    """

    start_tick: int
    end_tick: int
    take_id: str


class PlayerTakes(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Takes of a player's part.

    Attributes
    ----------
    takes : tuple of Take
        Takes in the order of their lanes.
    comp : tuple of CompSpan
        The take used in each span, in order without overlap; elsewhere the previous content.
    before_notes, before_curves : tuple
        Content of the part before the first take, which can be restored like a take.
    """

    takes: tuple[Take, ...]
    comp: tuple[CompSpan, ...] = ()
    before_notes: tuple[Note, ...] = ()
    before_curves: tuple[ControllerCurve, ...] = ()

    def take(self, take_id: str) -> Take:
        """Return the take with an id; KeyError if it does not exist."""
        for take in self.takes:
            if take.id == take_id:
                return take
        raise KeyError(take_id)


@dataclass(frozen=True)
class Project:
    """Everything needed to make a performance.

    Attributes
    ----------
    players : tuple of Player
        Players in the order of the score. Players of one musician have equal character, parameters and place.
    corrections : mapping of str to tuple of Correction
        Corrections by player id.
    seed : int
        Random seed of the performance.
    preroll_beats : float
        Time before the first note, in felt beats.
    section_intensity : float
        Factor of the acting of all players; 1 leaves it unchanged.
    conductor : ConductorPlace or None
        Place of a conductor; if it is None or empty, players give the entries.
    felt_beat_quarters : float or None
        Felt beat of the whole piece in quarters, for example 1.5 for a fast 6/8 in two. None to derive it from metre
        and tempo.
    fps : Fraction
        Frames per second, for the ruler, for frame steps and as default of an export.
    audio : AudioTrack or None
        Recording to play with the piece; None if the built-in synthesiser plays the score.
    video : VideoTrack or None
        Reference video.
    expressions : tuple of Expression
        Expressions added by the animator, by name, in addition to bundled ones.
    source : str
        Absolute path of the MIDI file that the score came from; empty for a piece created in the editor.
    read_notes : mapping of str to mapping of str to Note
        Notes of the MIDI file when it was last read, by part and note id, without later edits. Parts are missing if
        they were not read from a file, or by a version that did not store this.
    read_curves : mapping of str to tuple of ControllerCurve
        Controllers in the file, by ids of the same parts.
    read_timing : ReadTiming or None
        Tempo and metres in the file; None if there is no file, or if they were not stored.
    imported : ImportDecisions or None
        Decisions at the import of the MIDI file; None if unknown or without a file.
    takes : mapping of str to PlayerTakes
        Takes by player id; players without takes are missing.
    dancers : tuple of Dancer
        Dancers in list order.
    dance_corrections : mapping of str to tuple of DanceCorrection
        Corrections of dances by dancer id.
    ignored_problems : mapping of str to tuple of IgnoredProblem
        Problems ignored by the user, by player or dancer id.
    cameras : tuple of CameraBookmark
        The viewport's bookmarks, in the order of their menu.
    """

    score: Score
    players: tuple[Player, ...]
    corrections: Mapping[str, tuple[Correction, ...]] = field(default_factory=dict)
    seed: int = 0
    preroll_beats: float = PREROLL_BEATS
    felt_beat_quarters: float | None = None
    fps: Fraction = USUAL_RATE
    audio: AudioTrack | None = None
    expressions: tuple[Expression, ...] = ()
    source: str = ""
    read_notes: Mapping[str, Mapping[str, Note]] = field(default_factory=dict)
    takes: Mapping[str, PlayerTakes] = field(default_factory=dict)
    dancers: tuple[Dancer, ...] = ()
    dance_corrections: Mapping[str, tuple[DanceCorrection, ...]] = field(default_factory=dict)
    ignored_problems: Mapping[str, tuple[IgnoredProblem, ...]] = field(default_factory=dict)
    cameras: tuple[CameraBookmark, ...] = ()
    section_intensity: float = 1.0
    conductor: ConductorPlace | None = None
    video: VideoTrack | None = None
    read_curves: Mapping[str, tuple[ControllerCurve, ...]] = field(default_factory=dict)
    read_timing: ReadTiming | None = None
    imported: ImportDecisions | None = None

    def __post_init__(self) -> None:
        players = embodied(self.players)
        if players is not self.players:
            object.__setattr__(self, "players", players)

    @cached_property
    def bodies(self) -> tuple[Player, ...]:
        """The players who have a body: the first player of each musician."""
        return tuple(player for player in self.players if self.musician(player) is player)

    def musician(self, player: Player) -> Player:
        """Return the player whose body plays a part: the player itself unless it doubles another."""
        return self._players.get(player.doubles, player) if player.doubles else player

    def played_by(self, player: Player) -> tuple[Player, ...]:
        """Return all players of a player's musician: first the one with the body, then doubling ones, in order."""
        return self._musicians[self.musician(player).id]

    @cached_property
    def _musicians(self) -> dict[str, tuple[Player, ...]]:
        found = {player.id: [player] for player in self.bodies}
        for player in self.players:
            musician = self.musician(player)
            if musician is not player:
                found[musician.id].append(player)
        return {id: tuple(players) for id, players in found.items()}

    @cached_property
    def metre_map(self) -> MetreMap:
        """Metre map of the score, including the felt beat."""
        score = self.score
        if self.felt_beat_quarters is None:
            return score.felt_metre_map
        beat_ticks = max(round(self.felt_beat_quarters * score.ticks_per_quarter), 1)
        return msgspec.structs.replace(score.metre_map, felt=((0, beat_ticks),))

    def part(self, player: Player) -> Part:
        """Return the part that a player plays."""
        return self._parts[player.part_id]

    def player(self, player_id: str) -> Player:
        """Return the player with an id; KeyError if it does not exist."""
        return self._players[player_id]

    def dancer(self, dancer_id: str) -> Dancer:
        """Return the dancer with an id; KeyError if it does not exist."""
        return self._dancers[dancer_id]

    @property
    def conducting(self) -> ConductorPlace | None:
        """Place of a conductor who gives the entries; None if there is none or the place is empty."""
        return self.conductor if self.conductor is not None and self.conductor.on_stage else None

    def performer_names(self, but: str = "") -> list[str]:
        """Return the names of players and dancers, without the one with id ``but``; unique ignoring case."""
        return [performer.name for performer in self.performers if performer.id != but]

    @cached_property
    def performers(self) -> tuple[Player | Dancer, ...]:
        """All players, then all dancers."""
        return (*self.players, *self.dancers)

    @cached_property
    def seen(self) -> tuple[Player | Dancer, ...]:
        """All performers with a body on stage: one player for each musician, then the dancers."""
        return (*self.bodies, *self.dancers)

    @property
    def dancer_ids(self) -> Collection[str]:
        """Ids of all dancers of the project."""
        return self._dancers.keys()

    @cached_property
    def _dancers(self) -> dict[str, Dancer]:
        return {dancer.id: dancer for dancer in self.dancers}

    @cached_property
    def _players(self) -> dict[str, Player]:
        return {player.id: player for player in self.players}

    @cached_property
    def _parts(self) -> dict[str, Part]:
        return {part.id: part for part in self.score.parts}


def project_from_score(score: Score, maps: Mapping[str, InstrumentMap], *, seed: int = 0) -> Project:
    """Create a project from a score: a player for every part, with name, character, place and amplitude. Parts of one
    musician share character and place.

    Parameters
    ----------
    maps : mapping of str to InstrumentMap
        Maps by id, including the map of every part.
    """
    parts = score.parts
    instruments = [maps[part.map_id] for part in parts]
    names = unique_names(part.name for part in parts)
    doubled = doubled_parts(parts, maps, score.tempo_map)
    musicians = [part for part in parts if part.id not in doubled]
    played = {part.id: [part] for part in musicians}
    for part in parts:
        if part.id in doubled:
            played[doubled[part.id]].append(part)
    mapped = [[maps[one.map_id] for one in played[part.id]] for part in musicians]
    places = stage_seats([together(footprint(one) for one in each) for each in mapped])
    cast = characters_for(mapped, places, years_in_title(score.title))
    bodies = {part.id: (body, place) for part, body, place in zip(musicians, cast, places, strict=True)}
    players = []
    for part, name, instrument in zip(parts, names, instruments, strict=True):
        musician = doubled.get(part.id, part.id)
        character, place = bodies[musician]
        possible = common_postures([maps[one.map_id] for one in played[musician]])
        usual = usual_posture(len(musicians))
        players.append(
            Player(
                id=part.id,
                name=name,
                part_id=part.id,
                instrument_id=instrument.id,
                character_id=character,
                parameters=PlayerParameters(
                    amplitude=amplitude(seed, musician),
                    seed=player_seed(seed, musician),
                    posture=usual if usual in possible else possible[0],
                ),
                stage=place,
                doubles="" if musician == part.id else musician,
            )
        )
    project = Project(
        score,
        tuple(players),
        seed=seed,
        read_notes={part.id: {note.id: note for note in part.notes} for part in parts},
        read_curves={part.id: part.curves for part in parts},
        read_timing=ReadTiming(score.tempo_map, score.metres, score.pickup_ticks),
    )
    return replace(project, preroll_beats=preroll_of_new(project))


def preroll_of_new(project: Project) -> float:
    """Return the length of the pre-roll of a new piece in felt beats, by the tempo at its first note."""
    clock = project.score.tempo_map
    first = min((part.notes[0].onset_tick for part in project.score.parts if part.notes), default=0)
    beat = project.metre_map.felt_ticks_at(first)
    return usual_preroll(clock.seconds(float(first + beat)) - clock.seconds(float(first)))


def map_choices(maps: Iterable[InstrumentMap]) -> tuple[MapChoice, ...]:
    """Return the facts about instrument maps (names, range, transposition) by which reading a score chooses
    among them.
    """
    return tuple(
        MapChoice(
            map_id=instrument.id,
            plays=instrument.plays,
            substitutes_for=instrument.substitutes_for,
            concert_low=instrument.range.low,
            concert_high=instrument.range.high,
            transposition_semitones=instrument.transposition_semitones,
            usual=instrument.range.usual,
        )
        for instrument in maps
    )


def with_settings(project: Project, settings: Sequence[ParameterSetting], maps: Mapping[str, InstrumentMap]) -> Project:
    """Apply the user's settings to players; None as instrument or character keeps the automatic choice.

    Raises
    ------
    UsageError
        An instrument cannot be played in the requested posture.
    """
    players = list(project.players)
    places = {player.id: index for index, player in enumerate(players)}
    musicians = [places[project.musician(player).id] for player in players]
    for index in range(len(players)):
        # Except for the instrument, a setting of one player applies to the musician.
        own = [
            setting
            for setting in settings
            if (setting.player if setting.parameter == "instrument" else musicians[setting.player]) == index
        ]
        chosen = {setting.parameter: setting.value for setting in own}
        player = msgspec.structs.replace(players[index], parameters=parameters_with(players[index].parameters, own))
        instrument, character = chosen.get("instrument"), chosen.get("character")
        if isinstance(instrument, str):
            player = msgspec.structs.replace(player, instrument_id=instrument)
        if isinstance(character, str):
            player = msgspec.structs.replace(player, character_id=character)
        if "posture" in chosen:
            others = [one for one in project.played_by(player) if one.id != player.id]
            for one in (player, *others):
                if one.instrument_id in maps:
                    _require_posture(player, maps[one.instrument_id])
        players[index] = player
    return replace(project, players=tuple(players))


def _require_posture(player: Player, instrument: InstrumentMap) -> None:
    possible = instrument.hold.postures
    if player.parameters.posture not in possible:
        raise UsageError(
            "set.posture_impossible",
            player=player.name,
            instrument=instrument.id,
            value=player.parameters.posture,
            possible=", ".join(possible),
        )
