"""Figures of a project's stage, loaded in the background."""

from __future__ import annotations

from dataclasses import dataclass, replace

from app.errors import Progress, StopRequested, raise_if_stopped
from app.performance.bodies import hold_of, is_held, suited_to
from app.performance.cast import LeftOut, attempt
from app.performance.hats import hats_left_off
from app.performance.supports import HeldInstrument, supports_of
from app.project.model import Project
from app.project.performers import Dancer, Player
from app.rig.characters.character_library import character_revision
from app.rig.characters.dressed_characters import dressed_as
from app.rig.people.dressed import id_without
from app.rig.supports.model import Supports
from instrument_maps.library import library
from widgets.viewport.cast import (
    Member,
    RenderAssets,
    Stage,
    dancer_kit,
    dances,
    dancing_member,
    kit_of,
    member_of,
    stand_of,
)
from widgets.viewport.geometry import Crowd
from widgets.viewport.shapes import Shapes, crowd_of, shapes_of

CastKey = tuple[tuple[str, str, str, str, str, int, int, bool, float, float, float, bool], ...]


@dataclass(frozen=True, eq=False)
class DrawableFigures:
    """Figures of the performers that can be drawn, and the reasons why others cannot.

    ``crowd`` is set to None once the graphics card has its data, since it is large.
    """

    key: CastKey
    stage: Stage
    shapes: Shapes
    left_out: tuple[LeftOut, ...]
    crowd: Crowd | None


def cast_key(project: Project) -> CastKey:
    """Return the key of the data to load for the stage; while it is the same, nothing is loaded."""
    instruments = library()
    return tuple(
        (
            player.id,
            project.musician(player).id,
            dressed_as(player.character_id, player.outfit),
            player.instrument_id,
            player.parameters.posture,
            instruments.revisions.get(player.instrument_id, 0),
            character_revision(player.character_id),
            is_known(player),
            player.stage.x_m,
            player.stage.z_m,
            player.stage.turn_rad,
            dances(player),
        )
        for player in project.players
    ) + tuple(
        (
            *(
                dancer.id,
                dancer.id,
                dressed_as(dancer.character_id, dancer.outfit),
                "",
                "",
                0,
                character_revision(dancer.character_id),
                False,
            ),
            *(dancer.stage.x_m, dancer.stage.z_m, dancer.stage.turn_rad, True),
        )
        for dancer in project.dancers
    )


def is_known(player: Player) -> bool:
    """Return whether the player's grip on the instrument is known, which decides its place on a stand and on
    a strap.
    """
    instrument = library().maps.get(player.instrument_id)
    return instrument is not None and is_held(player, instrument)


def _supports(project: Project, musician: Player, assets: RenderAssets) -> Supports | None:
    """Return the straps and chair of a musician, as far as the grips on the instruments are known."""
    held = []
    for player in project.played_by(musician):
        instrument = suited_to(player, library().maps[player.instrument_id]).instrument
        # Only straps, and seats that are as high as a pin requires, need the hold, which takes as long as all else of a
        # figure.
        needed = (bool(instrument.hold.supports) or instrument.endpin is not None) and is_known(player)
        held.append(HeldInstrument(player, instrument, hold_of(player, instrument) if needed else None))
    return supports_of(assets.character, held)


def _left_off(project: Project, player: Player) -> tuple[str, ...]:
    """Return the meshes of hats that a player's musician leaves off, as far as grips on the instruments are known."""
    played = [one for one in project.played_by(player) if is_known(one)]
    held = [(one, suited_to(one, library().maps[one.instrument_id]).instrument) for one in played]
    return hats_left_off(held, project.musician(player).parameters.posture)


def same_figures(one: CastKey, other: CastKey) -> bool:
    """Return whether the figures for two stages differ only in their places, so that nothing must be loaded."""
    return [row[:8] for row in one] == [row[:8] for row in other]


def is_part_of(part: CastKey, whole: CastKey) -> bool:
    """Return whether all figures of one stage are on another, possibly at other places."""
    return {row[:8] for row in part} <= {row[:8] for row in whole}


def only(project: Project, player: Player) -> Project:
    """Return the project with a player's musician as the only performer."""
    return replace(project, players=project.played_by(player), dancers=())


def load(project: Project, before: Shapes | None, progress: Progress, stop_requested: StopRequested) -> DrawableFigures:
    """Load the figures of all performers. A player with something missing is excluded. Raises Cancelled."""
    assets: dict[tuple[str, str], RenderAssets] = {}
    musicians: dict[str, str] = {}
    done = 0

    def make(player: Player) -> Member:
        nonlocal done
        raise_if_stopped(stop_requested)
        progress(0.5 * done / len(project.players))
        done += 1
        left_off = _left_off(project, player)
        pair = (id_without(dressed_as(player.character_id, player.outfit), left_off), player.instrument_id)
        if pair not in assets:
            assets[pair] = kit_of(player, left_off)
        # If the musician's first instrument cannot be shown, the next one has the body.
        musician = musicians.setdefault(project.musician(player).id, player.id)
        played = project.played_by(player)
        stand_m = stand_of(player, assets[pair], played.index(player)) if len(played) > 1 else None
        supports = _supports(project, player, assets[pair]) if musician == player.id else None
        return member_of(player, assets[pair], musician, stand_m, supports)

    def make_dancer(dancer: Dancer) -> Member:
        raise_if_stopped(stop_requested)
        pair = (dressed_as(dancer.character_id, dancer.outfit), "")
        if pair not in assets:
            assets[pair] = dancer_kit(dancer)
        return dancing_member(dancer, assets[pair])

    all_players = [player for musician in project.bodies for player in project.played_by(musician)]
    found, dancers = attempt(all_players, make), attempt(project.dancers, make_dancer)
    members = [*found.made.values(), *dancers.made.values()]
    stage = Stage(members)
    shapes = shapes_of(stage, before)
    progress(0.9)
    everyone = crowd_of(stage, shapes) if members else None
    progress(1.0)
    return DrawableFigures(cast_key(project), stage, shapes, found.left_out + dancers.left_out, everyone)


def moved(project: Project, loaded: DrawableFigures) -> DrawableFigures:
    """Return the loaded figures, keeping their poses, at the places in a changed project."""
    players: dict[str, Player] = {player.id: player for player in project.players}
    dancers: dict[str, Dancer] = {dancer.id: dancer for dancer in project.dancers}
    members = [
        dancing_member(dancers[member.player_id], member.assets)
        if member.player_id in dancers
        else member_of(players[member.player_id], member.assets, member.musician_id, member.stand_m, member.supports)
        for member in loaded.stage.members
    ]
    stage = Stage(members)
    stage.pose({member.player_id: pose for member, pose in zip(members, loaded.stage.poses, strict=True)})
    return replace(loaded, key=cast_key(project), stage=stage)
