"""Report of an export, ``report.json``, and the bounds for its measures."""

from __future__ import annotations

import math

import msgspec

from app.contacts.bounds import Spread, allowed_mm
from app.export.check_skeleton import SkeletonDifference
from app.export.formats import Format
from app.export.joint_measures import BEYOND_DEG
from app.export.measure import PlayerMeasures
from app.export.reduced_keys import ROTATION_DEG
from app.export.rig_options import DEFAULT_RIG, RigOptions
from app.export.scene_keys import KeyCount
from app.export.target import SkeletonChoice
from app.formats.keys import KeyChoice
from app.plan.model import MuteKind
from app.project.casting import StagePosition
from app.project.performers import Dancer, Player
from app.rig.characters.dressed_characters import character_title, worn_colours

SWAY_CORRELATION = 0.9
"""Correlation of sway above which two players are reported as moving alike."""
SWAY_LEAST_S = 8.8
"""Shortest excerpt in seconds in which sway is compared: two of the longest swings, since shorter pieces of two swings
are alike by chance."""


SLIDE_BOUND_MM_S = 5.0
"""Mean slide in millimetres per second of a standing foot above which it may be visible."""
BONES_BOUND_MM = 0.1


class DancerMeasures(msgspec.Struct, frozen=True):
    """Measures of a dancer's exported file.

    Attributes
    ----------
    standing_s : float
        Total time for which each foot stands, summed over both.
    slide_mm_s : float
        Mean speed of the toe tips of standing feet.
    slide_most_mm_s : float
        Greatest speed.
    bones_mm : float
        Largest deviation of a bone's length from its rest length.
    below_mm : float
        Largest depth of a foot's lower tip below the floor.
    """

    standing_s: float
    slide_mm_s: float
    slide_most_mm_s: float
    bones_mm: float
    below_mm: float

    @property
    def kept(self) -> bool:
        """True if all measures are within their bounds."""
        return self.slide_mm_s <= SLIDE_BOUND_MM_S and self.bones_mm <= BONES_BOUND_MM


class PlaceReport(msgspec.Struct, frozen=True):
    """Place of a performer on the stage; the performer's own files are at the origin, facing +Z.

    Positions are in metres with Y up and the audience towards +Z; a positive turn is from +Z towards +X.
    """

    x_m: float
    z_m: float
    turn_deg: float


def stage_place(place: StagePosition) -> PlaceReport:
    """Convert a place on the stage to its form in the report, with rounded numbers."""
    return PlaceReport(round(place.x_m, 4), round(place.z_m, 4), round(math.degrees(place.turn_rad), 3))


class SkeletonReport(msgspec.Struct, frozen=True):
    """Skeleton of a player's character, with its differences from the asset it was compared with.

    For this program's characters, which have only the normalised skeleton, the choice is ``suisou``.
    """

    choice: SkeletonChoice
    asset: str | None = None
    """Name of the file with the skeleton; None if there is none."""
    differences: tuple[SkeletonDifference, ...] = ()
    rig: RigOptions = DEFAULT_RIG
    """Options of the skeleton besides its bones; warnings list those that a character's own skeleton does not
    support.
    """


class MutedSpan(msgspec.Struct, frozen=True):
    """A muted passage in seconds of the piece: with a mute, which animation files do not show, or ``stopped`` by the
    hand, which they do."""

    kind: MuteKind
    start_s: float
    end_s: float


class CharacterReport(msgspec.Struct, frozen=True):
    """Person that a performer is shown as, and the clothes.

    Attributes
    ----------
    title : str
        English name of a bundled character, or title of a user's own; empty if it has only an id.
    outfit : str or None
        Id of the outfit; None in the person's own clothes.
    outfit_colours : dict of str to str
        Colours of its parts (main, second, accent) as worn, ``#rrggbb``.
    left_off : tuple of str
        Meshes of hats that are not worn because an instrument would go through them.
    """

    title: str
    outfit: str | None
    outfit_colours: dict[str, str]
    left_off: tuple[str, ...] = ()


def character_report(one: Player | Dancer, left_off: tuple[str, ...] = ()) -> CharacterReport:
    """Return name and clothes of a performer's character for the report."""
    colours = worn_colours(one.character_id, one.outfit)
    worn = None if colours is None else one.outfit.id
    named: dict[str, str] = {str(tint): colour for tint, colour in (colours or {}).items()}
    return CharacterReport(character_title(one.character_id), worn, named, left_off)


class DoubleReport(msgspec.Struct, frozen=True):
    """Report on a further instrument of a musician, which is measured with the musician's character. While it is not
    played it lies beside the player.
    """

    name: str
    part: str
    instrument: str
    size: float
    missed: dict[str, float]
    files: dict[str, str]
    notes: int
    measures: PlayerMeasures | None
    keys: KeyCount | None = None
    """Number of keys in the instrument's files, by format."""
    socket: str | None = None
    """Bone of the character to which the instrument is attached, as in `PlayerReport.socket`."""
    mutes: tuple[MutedSpan, ...] = ()


class PlayerReport(msgspec.Struct, frozen=True):
    """Report on the exported files of one player: names, settings, files by format, numbers of keys and measures."""

    name: str
    part: str
    instrument: str
    character: str
    posture: str
    files: dict[str, str]
    stage: PlaceReport
    notes: int
    measures: PlayerMeasures | None
    """Measurements of the exported files, read back from the first of FBX, GLB and USD; None without any of these
    formats.
    """
    sway_correlation: float | None
    """Greatest correlation of the torso's sideways motion with another exported player's; None if there is no other
    player.
    """
    lean_correlation: float | None
    """Same correlation of the forward and backward motion, which common breaths and rests make similar."""
    skeleton: SkeletonReport = SkeletonReport("suisou")
    size: float = 1.0
    """Size of the instrument relative to its model; small players have smaller instruments."""
    missed: dict[str, float] = {}
    """Gaps in millimetres of touches that this body cannot close in any pose; they are not counted as broken
    contacts.
    """
    doubles: tuple[DoubleReport, ...] = ()
    """Other instruments that the player changes to."""
    keys: KeyCount | None = None
    """Number of keys in the character's and the instrument's FBX and GLB files, by format."""
    socket: str | None = None
    """Bone of the character to which the instrument's root bone is attached; None if the instrument's file contains its
    motion in the world.
    """
    mutes: tuple[MutedSpan, ...] = ()
    """Muted passages within the exported frames, in order."""
    props: tuple[str, ...] = ()
    """Kinds of straps that the player wears, and ``chair``; empty if props were excluded."""
    person: CharacterReport | None = None
    """Name and clothes of the character."""


class DancerReport(msgspec.Struct, frozen=True):
    """Files of one dancer with their measures. Foot contact, foot sliding and bone lengths are measured in the file
    read back: FBX, else GLB, else USD; None if none of these was requested.
    """

    name: str
    choreography: str
    character: str
    files: dict[str, str]
    stage: PlaceReport
    steps: int
    """Number of basic motions that begin within the exported frames."""
    skeleton: SkeletonReport
    measures: DancerMeasures | None
    keys: KeyCount | None = None
    person: CharacterReport | None = None
    """Name and clothes of the character."""


class StageFigure(msgspec.Struct, frozen=True):
    """A character or instrument in the stage file: name of its node, its performer, and the node's place on the stage.

    An instrument on a socket has no node of its own: ``node`` is its root bone, ``socket`` the character's bone that
    holds it.
    """

    node: str
    performer: str
    place: PlaceReport
    socket: str | None = None


class StageReport(msgspec.Struct, frozen=True):
    """Files of the stage by format, and the figures in them."""

    files: dict[Format, str]
    figures: tuple[StageFigure, ...]


class UnplayedPartReport(msgspec.Struct, frozen=True):
    """A part of the file without a player, with the reason."""

    name: str
    reason: str
    note_count: int


class LeftOutReport(msgspec.Struct, frozen=True):
    """A requested player or dancer that could not be exported, with the reason."""

    player: str
    reason: str


class EarlierFiles(msgspec.Struct, frozen=True):
    """Files of an earlier export that were still in the folder, with the bars (None for the whole piece) and the time
    in seconds of the first frame of that export.
    """

    bars: tuple[int, int] | None
    first_frame_s: float
    files: tuple[str, ...]


class Report(msgspec.Struct, frozen=True):
    """Contents of ``report.json``. Frame n is at ``first_frame_s + n / fps`` of the piece, so its sound starts at
    ``-first_frame_s`` of the animation. ``fps_exact`` is the rate as a fraction (``30000/1001``).
    """

    version: str
    source: str
    first_frame_s: float
    fps: float
    fps_exact: str
    frames: int
    end_s: float
    bars: tuple[int, int] | None
    seed: int
    players: tuple[PlayerReport, ...]
    warnings: tuple[str, ...]
    unplayed: tuple[UnplayedPartReport, ...]
    sound: str | None = None
    """Sound file that starts at frame 0; None if none was requested."""
    left_out: tuple[LeftOutReport, ...] = ()
    dancers: tuple[DancerReport, ...] = ()
    stage: StageReport | None = None
    """Stage file; None if none was requested."""
    incomplete: tuple[str, ...] = ()
    """Warnings about missing content of an incompletely readable piece; also contained in the general warnings."""
    keys: KeyChoice = "every"
    """Choice of the frames with keys; their numbers are reported for each performer."""
    textures: tuple[str, ...] = ()
    """Image files used by FBX and USD files, with their folder."""
    ignored_problems: int = 0
    """Number of problems that the project ignores and that are not among the warnings."""
    earlier: tuple[EarlierFiles, ...] = ()
    """Files of earlier exports in the same folder that this export did not write."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the files written, with their folder for textures, without the report."""
        files = [
            *(player.files for player in self.players),
            *(double.files for player in self.players for double in player.doubles),
            *(dancer.files for dancer in self.dancers),
        ]
        stage = () if self.stage is None else tuple(self.stage.files.values())
        sound = () if self.sound is None else (self.sound,)
        return (*(name for one in files for name in one.values()), *stage, *self.textures, *sound)

    @property
    def file_count(self) -> int:
        """Number of files written, including the report."""
        return len(self.names) + 1


def encode_report(report: Report) -> bytes:
    """Return the report as indented JSON in UTF-8. Raises an error for numbers that are not finite."""
    builtins = msgspec.to_builtins(report)
    _check_finite(builtins)
    return msgspec.json.format(msgspec.json.encode(builtins), indent=2) + b"\n"


def _check_finite(value: object) -> None:
    if isinstance(value, dict):
        for item in value.values():
            _check_finite(item)
    elif isinstance(value, list | tuple):
        for item in value:
            _check_finite(item)
    elif isinstance(value, float) and not math.isfinite(value):
        raise ValueError("a report holds finite numbers only")


def _allowed_beyond_deg(keys: KeyCount | None) -> float:
    """Degrees by which a joint may be beyond its limit: `BEYOND_DEG`, and with reduced keys those that a bone's
    rotation may be off.

    A finger that rests at its limit plays to either side of it between fitted keys.
    """
    return BEYOND_DEG if keys is None or keys.written >= keys.every else ROTATION_DEG


def failures(player: PlayerReport | DoubleReport) -> tuple[str, ...]:
    """Return the names of those measures in a player's report that exceed their bounds; empty if all are met."""
    measures = player.measures
    if measures is None:
        return ()
    spreads: dict[str, Spread] = {
        **measures.contacts,
        **{f"{finger} hovering": spread for finger, spread in measures.hovering.items()},
        "lips": measures.lips,
        "upper lip in breaths": measures.upper_lip_in_breaths,
        "bones": measures.bones,
        "penetration": measures.penetration,
        **measures.feet,
    }
    failed = [
        name for name, spread in spreads.items() if spread.max_mm > allowed_mm(name, spread.bound_mm, player.missed)
    ]
    # A finger closes a hole itself: if the hold misses it, that is reported already.
    unmet = {part for touch in player.missed for part in touch.rpartition(" on ")[2].split("+")}
    controls = {name: control for name, control in measures.controls.items() if name not in unmet}
    failed += [
        f"{name} at onsets"
        for name, control in controls.items()
        if control.right + control.stopped_short < control.judged
    ]
    failed += [f"{name} out of reach" for name, control in controls.items() if control.held_stopped_short]
    failed += [f"{name} held" for name, control in controls.items() if control.held_wrong]
    if measures.limits.beyond and measures.limits.value > _allowed_beyond_deg(player.keys):
        failed.append(f"limits of {measures.limits.joint}")
    if measures.acceleration.beyond:
        failed.append(f"acceleration of {measures.acceleration.joint}")
    if measures.breaths.shown < measures.breaths.planned:
        failed.append("breaths")
    if (
        isinstance(player, PlayerReport)
        and player.sway_correlation is not None
        and player.sway_correlation >= SWAY_CORRELATION
    ):
        failed.append("sway")
    return tuple(failed)


def missed_by_hold(player: PlayerReport | DoubleReport) -> tuple[str, ...]:
    """Return the names of those distances that exceed their bounds because the player's hold does, and that `failures`
    therefore does not list.
    """
    measures = player.measures
    if measures is None:
        return ()
    spreads = {**measures.contacts, "penetration": measures.penetration}
    return tuple(
        name
        for name, spread in spreads.items()
        if not spread.kept and spread.max_mm <= allowed_mm(name, spread.bound_mm, player.missed)
    )
