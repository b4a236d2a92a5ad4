"""Sound: recordings, synthesiser, offset."""

from __future__ import annotations

from typing import Final

TEMPLATES: Final[dict[str, str]] = {
    "audio.not_readable": (
        "{file} is no sound that can be read ({detail}); choose a WAV, FLAC, OGG or MP3 file, or convert it to one"
    ),
    "audio.unusable": (
        "{file} has {channels} channels at {rate_hz} Hz, which is no recording; export it as stereo at 48000 Hz"
    ),
    "audio.empty": "{file} holds no sound; choose another recording",
    "audio.too_dense": (
        "{file} holds more than {minutes} minutes of silence, far more than a file of its size has of sound; "
        "cut it to the piece"
    ),
    "audio.too_long": "{file} is longer than {most_hours} hours; cut it to the piece",
    "audio.breaks_off": "{file} breaks off after {seconds} s: the file is damaged or was not copied whole",
    "audio.no_device": "there is no device for sound: it plays silently, in time",
    "audio.nothing_to_compare": "the recording or the score is silent: there is nothing to find the offset by",
    "audio.not_recognised": (
        "the piece was not recognised in the recording (confidence {percent} %): nothing was changed; drag the "
        "waveform or type the offset"
    ),
    "audio.offset_found": "the recording begins at {offset_s:.3f} s (confidence {percent} %)",
    "audio.other_tempo": (
        "the recording begins at {offset_s:.3f} s (confidence {percent} %); its tempo differs by "
        "{tempo_percent:+.1f} %: Play > Recording > Fit the Tempo to the Recording"
    ),
    "audio.tempo_fitted": (
        "the recording begins at {offset_s:.3f} s (confidence {percent} %); the score is played {tempo_percent:+.1f} % "
        "faster"
    ),
}
