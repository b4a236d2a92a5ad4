"""Paths of a piece in an Unreal project: source files in a folder next to the content, assets under
``/Game/Suisou``.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Final

from app.export.formats import FILE_FORMATS
from app.export.unreal.names import asset_name
from app.formats.unique_names import numbered
from app.project.model import Project
from app.project.performers import Dancer, Player
from app.rig.characters.dressed_characters import dressed_as

SOURCES: Final = "SuisouSource"
"""Folder of the exported source files; outside of ``Content``, which Unreal may watch and import from automatically."""
CONTENT: Final = "/Game/Suisou"
PLUGIN: Final = "Plugins/Suisou"
IMPORTED: Final = "fbx"
"""Format that the plug-in imports."""
DESCRIPTION, REPORT, MANIFEST = "performance.json", "report.json", "manifest.json"


@dataclass(frozen=True)
class FigurePlace:
    """Paths of a character or an instrument.

    Attributes
    ----------
    file : path
        File, relative to the folder of the piece's sources.
    mesh, skeleton, animation : str
        Asset paths without extension; for a character's mesh and skeleton, shared by all with the same body, see
        `Layout.body`.
    """

    file: PurePosixPath
    mesh: str
    skeleton: str
    animation: str


@dataclass(frozen=True)
class Layout:
    """Paths of a piece.

    Attributes
    ----------
    piece : str
        Name of its folders.
    characters : mapping of str to FigurePlace
        Paths by player or dancer id; for all of them, so that names do not depend on the selection.
    instruments : mapping of str to FigurePlace
        Paths by player id.
    props : mapping of str to FigurePlace
        Paths of straps and chair by the musician's id, also of musicians without any.
    sound_file : path
        Sound file, relative to the folder of the piece's sources.
    sound, sequence : str
        Asset paths of the sound and of the level sequence.
    doubles : mapping of str to tuple of str
        Ids of a musician's other players, by the musician's id.
    bodies : mapping of str to str
        Names of the bodies by character id.
    """

    piece: str
    characters: dict[str, FigurePlace]
    instruments: dict[str, FigurePlace]
    props: dict[str, FigurePlace]
    sound_file: PurePosixPath
    sound: str
    sequence: str
    doubles: dict[str, tuple[str, ...]]
    bodies: dict[str, str]

    def body(self, one: Player | Dancer, added: Sequence[str], left_off: Sequence[str] = ()) -> tuple[str, str]:
        """Return the asset paths of mesh and skeleton for a performer's body without garments that are left off and
        with some added bones.
        """
        worn = dressed_as(one.character_id, one.outfit)
        without = (asset_name(f"without_{mesh}", "Bare") for mesh in left_off)
        name = "_".join((self.bodies[worn], *without, *(asset_name(bone, "Bone") for bone in added)))
        return f"{self.content}/Bodies/{name}/SK_{name}", f"{self.content}/Bodies/{name}/SKEL_{name}"

    @property
    def sources(self) -> PurePosixPath:
        """Folder of the piece's sources, relative to the project's folder."""
        return PurePosixPath(SOURCES, self.piece)

    @property
    def content(self) -> str:
        """Asset folder of the piece."""
        return f"{CONTENT}/{self.piece}"

    def files(
        self,
        performer_ids: tuple[str, ...],
        left_out: tuple[str, ...] = (),
        with_props: Collection[str] = (),
    ) -> tuple[PurePosixPath, ...]:
        """Return the sorted paths of all files that an export of the given performers writes, relative to the piece's
        sources; the instruments of those left out are excluded, and straps and chairs of those not in
        ``with_props``."""
        own = (PurePosixPath(name) for name in (DESCRIPTION, REPORT, MANIFEST))
        without = {self.instruments[one].file for one in left_out if one in self.instruments}
        without |= {place.file for id, place in self.props.items() if id not in with_props}
        places = (place.file for performer_id in performer_ids for place in self.figures(performer_id))
        figures = (file for file in places if file not in without)
        return tuple(sorted([*figures, self.sound_file, *own]))

    def figures(self, performer_id: str) -> tuple[FigurePlace, ...]:
        """Return the places of a performer's files: the character and, for a player, the instruments, straps and
        chair.
        """
        kinds = (self.characters, self.instruments, self.props)
        own = (places[performer_id] for places in kinds if performer_id in places)
        return (*own, *(self.instruments[double] for double in self.doubles.get(performer_id, ())))


def piece_name(source: str, folder: Path) -> str:
    """Return the name of a piece's folders.

    Parameters
    ----------
    source : str
        Name of the piece's file.
    folder : path
        Folder of the project; an existing piece whose name differs only in case is reused.
    """
    name = asset_name(Path(source).stem, "Piece")
    sources = folder / SOURCES
    there = sorted(path.name for path in sources.iterdir()) if os.path.isdir(sources) else []
    return next((other for other in there if other.casefold() == name.casefold()), name)


def layout_of(project: Project, piece: str) -> Layout:
    """Return the paths of everything in a project's piece."""
    players, dancers = project.players, project.dancers
    count = len(players)
    own = numbered(asset_name(player.name, "Player") for player in players)
    named = dict(zip((player.id for player in players), own, strict=True))
    held = [f"{named[project.musician(player).id]}_{asset_name(player.instrument_id, 'held')}" for player in players]
    # Dancers come last, so that a new player does not change their names.
    names = numbered(
        [
            *own,
            *held,
            *(asset_name(dancer.name, "Dancer") for dancer in dancers),
            *(f"{named[musician.id]}_props" for musician in project.bodies),
        ]
    )
    props = 2 * count + len(dancers)
    content = f"{CONTENT}/{piece}"
    characters = sorted({dressed_as(one.character_id, one.outfit) for one in project.performers})
    doubling = {player.id for player in players} - {musician.id for musician in project.bodies}

    def places(
        kind: str, performers: Sequence[Player | Dancer], names: tuple[str, ...], own: bool = True
    ) -> dict[str, FigurePlace]:
        return {
            performer.id: FigurePlace(
                file=PurePosixPath(kind, f"SK_{name}{FILE_FORMATS[IMPORTED].suffix}"),
                mesh=f"{content}/{kind}/{name}/SK_{name}" if own else "",
                skeleton=f"{content}/{kind}/{name}/SKEL_{name}" if own else "",
                animation=f"{content}/{kind}/{name}/A_{name}",
            )
            for performer, name in zip(performers, names, strict=True)
        }

    return Layout(
        piece=piece,
        characters={
            id: place
            for id, place in places(
                "Characters", [*players, *dancers], names[:count] + names[2 * count : props], own=False
            ).items()
            if id not in doubling
        },
        instruments=places("Instruments", players, names[count : 2 * count]),
        props=places("Props", project.bodies, names[props:]),
        sound_file=PurePosixPath("Audio", f"S_{piece}.wav"),
        sound=f"{content}/Audio/S_{piece}",
        sequence=f"{content}/LS_{piece}",
        doubles={
            musician.id: tuple(player.id for player in played[1:])
            for musician in project.bodies
            if len(played := project.played_by(musician)) > 1
        },
        bodies=dict(zip(characters, numbered(asset_name(one, "Body") for one in characters), strict=True)),
    )
