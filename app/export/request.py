"""Request of an export, and its cast: the players that can be exported; others are excluded with a reason."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from app.errors import FileError, Message, StopRequested
from app.export.equipped_skeleton import socket_names
from app.export.face_curves import DEFAULT_FACE, FaceOptions
from app.export.few_materials import with_few_materials
from app.export.formats import FileFormat, Format, refuse_attachment, requested
from app.export.humanoid import humanoid_target
from app.export.rig import rig_of
from app.export.rig_options import DEFAULT_RIG, RigOptions
from app.export.target import SkeletonChoice, TargetSkeleton
from app.export.targets import CheckedTarget, checked_targets, spoilt
from app.formats.images import USUAL_TEXTURE_PX
from app.formats.keys import KeyChoice
from app.performance.bodies import dressed_character
from app.performance.cast import LeftOut, Performer, dancings_of, performers_of, require_players
from app.performance.dances import Dancing
from app.performance.ensemble import Performance
from app.performance.hats import hats_left_off
from app.performance.span import FrameSpan
from app.project.performers import Dancer, Player
from app.rig.characters.read_figure import read_figure
from app.rig.model import Character
from app.rig.people.dressed import without

MOST_FRAMES = 432_000
"""Greatest number of frames, two hours at 60 frames per second, since a player's motion and file are kept in memory."""


@dataclass(frozen=True)
class ExportRequest:
    """Settings of an export.

    Attributes
    ----------
    performance : Performance
        The performance to export.
    players : tuple of Player
        Players to export, each with everything the musician plays; file names are derived from all players, so that
        they do not depend on the selection.
    folder : path
        Folder to write into.
    formats : frozenset of str
        Ids of `FILE_FORMATS`.
    span : FrameSpan
        Frames to export.
    bars : (int, int) or None
        First and last requested bar, for the report.
    source, creator : str
        Name of the piece's file; program and version.
    skeleton : SkeletonChoice
        Skeleton of the characters; instruments have only one.
    rig : RigOptions
        Options of that skeleton, and attachment of instruments.
    sound : bool
        Whether to write the sound as a WAV file, from the first frame to the last.
    bvh_names : str
        Table of bone names for BVH files; empty for the skeleton's own names.
    dancers : tuple of Dancer
        Dancers to export.
    stage : bool
        Whether to write also the whole stage, as one file in each format that supports it.
    processes : int or None
        Largest number of processes; None for one per core if worthwhile.
    asset : path or None
        File of the asset that the animation is for: every player's skeleton is compared with it.
    keys : KeyChoice
        Choice of keyframes, for formats that support fewer keys.
    face : FaceOptions
        Selection and names of face curves.
    motion_only : bool
        Whether to omit meshes in formats that allow this.
    texture_px : int
        Longest side of textures; 0 for no textures; surfaces then have mean colours.
    levels : int
        Number of levels of detail of meshes, 1 to `MOST_LEVELS`.
    props : bool
        Whether to export straps and chairs.
    with_ignored : bool
        Whether problems ignored by the project are listed as warnings.
    few_materials : bool or None
        Whether small surfaces of characters share materials; None if files have textures.
    """

    performance: Performance
    players: tuple[Player, ...]
    folder: Path
    formats: frozenset[Format]
    span: FrameSpan
    bars: tuple[int, int] | None
    source: str
    creator: str
    skeleton: SkeletonChoice = "own"
    rig: RigOptions = DEFAULT_RIG
    asset: Path | None = None
    sound: bool = False
    bvh_names: str = ""
    dancers: tuple[Dancer, ...] = ()
    stage: bool = False
    processes: int | None = None
    keys: KeyChoice = "every"
    face: FaceOptions = DEFAULT_FACE
    motion_only: bool = False
    texture_px: int = USUAL_TEXTURE_PX
    levels: int = 1
    props: bool = True
    with_ignored: bool = False
    few_materials: bool | None = None

    @property
    def shares_materials(self) -> bool:
        """True if small surfaces of characters share materials."""
        return self.texture_px > 0 if self.few_materials is None else self.few_materials

    @property
    def has_plain_surfaces(self) -> bool:
        """True if no surface of a character has a texture, neither in the files nor where they are imported."""
        return not self.texture_px and self.few_materials is None

    @property
    def with_props(self) -> bool:
        """True if straps and chairs are exported; they are left out if meshes are."""
        return self.props and not self.motion_only


@dataclass(frozen=True, eq=False)
class CastMusician:
    """A musician to export.

    Attributes
    ----------
    performers : tuple of Performer
        The musician as player of each instrument; the first one has the body.
    checked : CheckedTarget
        Skeleton of the character.
    few_materials : bool
        Whether small surfaces of the character share materials.
    left_off : tuple of str
        Meshes of hats that are left off because an instrument would go through them.
    """

    performers: tuple[Performer, ...]
    checked: CheckedTarget
    few_materials: bool = False
    left_off: tuple[str, ...] = ()

    @property
    def player(self) -> Player:
        """The player of the musician's first instrument, whose name and character are exported."""
        return self.performers[0].player

    @property
    def character(self) -> Character:
        """The musician's body in the chosen outfit, without what is left off, and with few materials if requested."""
        worn = without(self.performers[0].dressed, self.left_off)
        return with_few_materials(worn) if self.few_materials else worn

    @property
    def target(self) -> TargetSkeleton:
        """The skeleton on which the character's files are written."""
        return self.checked.target

    def target_in(self, kind: FileFormat) -> TargetSkeleton:
        """Return the skeleton of the character's files in a format."""
        return humanoid_target(self.character, self.target.place) if kind.humanoid else self.target

    @property
    def sockets(self) -> dict[str, str]:
        """Socket bone of each instrument by player id; empty if instruments are not attached."""
        return dict(zip((one.player.id for one in self.performers), socket_names(self.target), strict=False))


@dataclass(frozen=True, eq=False)
class CastDancing:
    """A dancer with everything that an export needs: the dance and the checked target skeleton."""

    dancer: Dancer
    dancing: Dancing
    checked: CheckedTarget
    few_materials: bool = False

    @property
    def character(self) -> Character:
        """The dancer's body in the chosen outfit, with few materials if requested."""
        worn = dressed_character(self.dancer)
        return with_few_materials(worn) if self.few_materials else worn

    @property
    def target(self) -> TargetSkeleton:
        """The skeleton on which the character's files are written."""
        return self.checked.target

    def target_in(self, kind: FileFormat) -> TargetSkeleton:
        """Return the skeleton of the character's files in a format."""
        return humanoid_target(self.character, self.target.place) if kind.humanoid else self.target


@dataclass(frozen=True, eq=False)
class ExportCast:
    """Cast of an export: the performers that can be exported, and the excluded ones with reasons."""

    musicians: tuple[CastMusician, ...]
    dancers: tuple[CastDancing, ...]
    left_out: tuple[LeftOut, ...]

    @property
    def ids(self) -> tuple[str, ...]:
        """Return the ids of the exported players and dancers."""
        return (*(one.player.id for one in self.musicians), *(one.dancer.id for one in self.dancers))


def cast_of(
    request: ExportRequest, wording: Callable[[Message], str], stop_requested: StopRequested = lambda: False
) -> ExportCast:
    """Return the performers of a request that can be exported, without writing anything.

    Raises
    ------
    FileError
        There is no player, the span is too long, all players are excluded, or the asset cannot be read.
    UsageError
        The library for USD is missing, or a format cannot attach instruments as requested.
    Cancelled
        ``stop_requested`` returned true.
    """
    if request.span.count > MOST_FRAMES:
        raise FileError("export.too_long", file=request.source, frames=request.span.count, most=MOST_FRAMES)
    if not request.players and not request.dancers:
        raise FileError("export.no_players", file=request.source)
    for kind in requested(request.formats):
        kind.refuse()
    refuse_attachment(request.formats, request.rig.instrument)
    asset = None if request.asset is None else read_figure(request.asset)

    project = request.performance.project
    musicians = tuple(dict.fromkeys(project.musician(player) for player in request.players))
    found = performers_of(request.performance, musicians, stop_requested)
    dances = dancings_of(request.performance, request.dancers, stop_requested)
    further = (one for id in found.made for one in project.played_by(project.player(id))[1:])
    beside = performers_of(request.performance, further, stop_requested)
    characters = {id: performer.character for id, performer in found.made.items()}
    characters |= {id: dance.character for id, dance in dances.made.items()}
    doubles: dict[str, list[Performer]] = {}
    for made in beside.made.values():
        doubles.setdefault(made.player.doubles, []).append(made)
    rigs = {id: rig_of(request.rig, made.player.stage, (made, *doubles.get(id, ()))) for id, made in found.made.items()}
    rigs |= {one.id: rig_of(request.rig, one.stage) for one in request.dancers}
    targets = checked_targets(characters, request.skeleton, asset, rigs)
    left_out = found.left_out + dances.left_out
    if asset is not None:
        seen: tuple[Player | Dancer, ...] = (
            *(performer.player for performer in found.made.values()),
            *(dancer for dancer in request.dancers if dancer.id in dances.made),
        )
        left_out += spoilt(seen, targets, asset, wording)
    absent = {one.player.id for one in left_out}
    if absent.issuperset([*(player.id for player in musicians), *(dancer.id for dancer in request.dancers)]):
        require_players(left_out, request.source, wording)
    return ExportCast(
        tuple(
            _musician((made, *doubles.get(id, ())), targets[id], request.shares_materials)
            for id, made in found.made.items()
            if id not in absent
        ),
        tuple(
            CastDancing(one, dances.made[one.id], targets[one.id], request.shares_materials)
            for one in request.dancers
            if one.id in dances.made and one.id not in absent
        ),
        left_out + beside.left_out,
    )


def _musician(performers: tuple[Performer, ...], checked: CheckedTarget, few_materials: bool) -> CastMusician:
    posture = performers[0].player.parameters.posture
    left_off = hats_left_off([(one.player, one.instrument) for one in performers], posture)
    return CastMusician(performers, checked, few_materials, left_off)
