"""Projects with files on another computer."""

from __future__ import annotations

from dataclasses import replace

import msgspec

from app.project.edit.dancers import add_dancer
from app.project.model import Project
from app.project.recording import AudioTrack
from app.project.video import VideoTrack

SHARES = ("\\\\host\\share\\", "//host/share/", "\\\\?\\UNC\\host\\share\\")
"""Spellings in files of one folder on another computer."""


def paths_on(share: str) -> tuple[str, ...]:
    """Paths of a recording, a video, two choreographies and a MIDI file in a folder."""
    return tuple(f"{share}{name}" for name in ("take.wav", "take.mp4", "a.choreography", "b.choreography", "piece.mid"))


def on_share(project: Project, share: str) -> Project:
    """Project that uses these files for its first player and a dancer."""
    recording, video, moves, dance, source = paths_on(share)
    first, *others = project.players
    first = msgspec.structs.replace(first, parameters=msgspec.structs.replace(first.parameters, choreography=moves))
    project = replace(
        project,
        players=(first, *others),
        audio=AudioTrack(path=recording),
        video=VideoTrack(path=video),
        source=source,
    )
    project, dancer_id = add_dancer(project, "salsa", "Dancer")
    dancers = tuple(
        msgspec.structs.replace(dancer, choreography=dance) if dancer.id == dancer_id else dancer
        for dancer in project.dancers
    )
    return replace(project, dancers=dancers)
