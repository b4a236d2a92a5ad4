"""Names of an export's files and figures."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from app.export.formats import FileContent, Format, files_of, requested
from app.performance.ensemble import Performance
from app.performance.supports import worn
from app.project.names import file_stems
from app.project.performers import Dancer, Player

REPORT = "report.json"
"""Name of the file that describes the exported files."""

Stems = dict[str, dict[FileContent, str]]
"""File names without suffix, by the id of a player or dancer and the kind of content."""


def figure_stems(performance: Performance) -> Stems:
    """Return the file name, without suffix, of every character and instrument; independent of the selection of players.

    A doubling player only has an instrument, named after the musician.
    """
    project = performance.project
    everyone: list[Player | Dancer] = [*project.players, *project.dancers]
    own = dict(zip((one.id for one in everyone), file_stems([one.name for one in everyone]), strict=True))
    held: dict[str, str] = {}
    for musician in project.bodies:
        for player in project.played_by(musician):
            stem = f"{own[musician.id]}_{player.instrument_id}"
            held[player.id] = f"{stem}_{own[player.id]}" if stem in held.values() else stem
    # A player whose name equals another player's instrument keeps its name.
    held = dict(zip(held, file_stems([*own.values(), *held.values()])[len(own) :], strict=True))
    stems: Stems = {id: {"instrument": stem} for id, stem in held.items()}
    bodies: list[Player | Dancer] = [*project.bodies, *project.dancers]
    for one in bodies:
        stems[one.id] = {"character": own[one.id], **stems.get(one.id, {})}
    taken = [stem for named in stems.values() for stem in named.values()]
    props = file_stems([*taken, *(f"{own[musician.id]}_props" for musician in project.bodies)])[len(taken) :]
    for musician, stem in zip(project.bodies, props, strict=True):
        stems[musician.id]["props"] = stem
    return stems


def file_names(performance: Performance, formats: frozenset[Format], props: bool = True) -> dict[str, dict[str, str]]:
    """Return the names of the files of every player and dancer: by id, then by their content.

    Parameters
    ----------
    props : bool
        Whether to include the files of straps and chairs.
    """
    without = {one.id for one in performance.project.bodies} - (with_props(performance) if props else frozenset())
    return {
        id: {
            kind.key(held): f"{stems[held]}{kind.suffix}"
            for kind, held in files_of(formats)
            if held in stems and not (held == "props" and id in without)
        }
        for id, stems in figure_stems(performance).items()
    }


def with_props(performance: Performance) -> frozenset[str]:
    """Return the ids of the musicians who have straps or a chair."""
    project = performance.project
    return frozenset(one.id for one in project.bodies if _has_props(performance, project.played_by(one)))


def _has_props(performance: Performance, played: Sequence[Player]) -> bool:
    """Return whether a musician sits or wears a strap for any of the instruments."""
    maps = [performance.library.maps.get(player.instrument_id) for player in played]
    if maps[0] is None:
        return False
    posture = maps[0].hold.possible(played[0].parameters.posture)
    return posture == "seated" or any(one is not None and worn(one, posture) for one in maps)


def sound_name(source: str) -> str:
    """Return the name of the sound file, made from that of the piece."""
    (stem,) = file_stems([Path(source).stem])
    return f"{stem}.wav"


def stage_names(performance: Performance, formats: frozenset[Format], source: str) -> dict[Format, str]:
    """Return the file name of the stage by format, after the piece's name and different from the figures' files."""
    figures = [stem for stems in figure_stems(performance).values() for stem in stems.values()]
    *_, stem = file_stems([*figures, f"{Path(source).stem}_stage"])
    return {kind.id: f"{stem}{kind.suffix}" for kind in requested(formats) if kind.stage}
