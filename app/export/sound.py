"""Writing of the sound of an export as a WAV file, from the first frame to the last, as heard in the editor."""

from __future__ import annotations

from pathlib import Path

import soundfile

from app.audio.mix import mixdown
from app.audio.track import RATE_HZ
from app.errors import FileError, Progress, StopRequested
from app.performance.span import FrameSpan
from app.project.model import Project


def write_sound(
    path: Path,
    project: Project,
    span: FrameSpan,
    progress: Progress = lambda share: None,
    stop_requested: StopRequested = lambda: False,
) -> None:
    """Write the recording, or else the synthesiser, as 16-bit PCM; its first sample coincides with the first frame.

    Raises
    ------
    FileError
        The recording cannot be read, or the file cannot be written.
    Cancelled
        ``stop_requested`` returned True.
    """
    block = mixdown(project, span.first_frame_s, span.end_s, RATE_HZ, progress, stop_requested)
    try:
        with path.open("wb") as stream:
            soundfile.write(stream, block, RATE_HZ, format="WAV", subtype="PCM_16")
    except (OSError, soundfile.SoundFileError) as error:
        raise FileError("file.cannot_write", file=str(path), reason=str(error)) from error
