"""Decoding of valid and invalid recordings."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest
import soundfile

from app.audio.decode import MOST_HOURS, decode
from app.audio.track import RATE_HZ
from app.errors import Cancelled, FileError
from app.messages import error_text, text
from tests.fuzz.harness.costly_sound import flac, opus_silence
from tests.support.media import clicks, ffmpeg, heard_s, with_gap


def tone(rate_hz: int, seconds: float = 1.0, channels: int = 2) -> np.ndarray:
    times_s = np.arange(round(rate_hz * seconds)) / rate_hz
    return np.repeat(0.5 * np.sin(2 * np.pi * 440.0 * times_s)[:, None], channels, axis=1).astype(np.float32)


@pytest.mark.parametrize(
    ("suffix", "subtype"), [("wav", "PCM_16"), ("wav", "FLOAT"), ("flac", "PCM_24"), ("ogg", "VORBIS"), ("mp3", None)]
)
@pytest.mark.parametrize("rate_hz", [22050, 44100, 48000])
def test_every_kind_at_every_rate_is_the_same_tone(
    tmp_path: Path, suffix: str, subtype: str | None, rate_hz: int
) -> None:
    path = tmp_path / f"録音 a.{suffix}"
    soundfile.write(path, tone(rate_hz), rate_hz, subtype=subtype)
    shares: list[float] = []
    recording = decode(str(path), shares.append)
    assert recording.samples.dtype == np.int16
    assert recording.samples.shape[1] == 2
    # MP3 pads its ends.
    assert recording.duration_s == pytest.approx(1.0, abs=0.06 if suffix == "mp3" else 0.001)
    assert not recording.warnings
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    middle = recording.samples[RATE_HZ // 4 : 3 * RATE_HZ // 4, 0] / 32767
    spectrum = np.abs(np.fft.rfft(middle * np.hanning(len(middle))))
    assert spectrum.argmax() * RATE_HZ / len(middle) == pytest.approx(440.0, abs=2.0)
    assert np.sqrt((middle**2).mean()) == pytest.approx(0.5 / np.sqrt(2), rel=0.03)


KINDS = {
    "wav": (), "flac": (), "ogg": (), "opus": ("-ar", "48000"), "m4a": (), "mp4": (), "aac": (), "mp2": (),
    "mp3": (), "mp3 without a header": ("-write_xing", "0"),
    "mp3 of many rates without a header": ("-write_xing", "0", "-q:a", "4"),
}  # fmt: skip


@pytest.mark.parametrize("named", ["mp3", "wav", "m4a", "xyz"])
def test_the_content_decides_and_no_codec_delays_the_sound(tmp_path: Path, named: str) -> None:
    source = clicks(tmp_path / "source.wav", 44100)
    for number, (kind, options) in enumerate(KINDS.items()):
        made, path = tmp_path / f"made.{kind.split()[0]}", tmp_path / f"{number}.{named}"
        ffmpeg("-i", str(source), *options, str(made))
        made.rename(path)
        recording = decode(str(path))
        assert not recording.warnings, kind
        assert recording.duration_s == pytest.approx(4.0, abs=0.06), kind
        for second in (1.0, 3.0):
            assert heard_s(recording.samples, second, RATE_HZ) == pytest.approx(second, abs=0.005), kind


@pytest.mark.parametrize("options", [("-b:a", "128k"), ("-q:a", "2")])
def test_an_mp3_without_a_header_that_breaks_off_is_reported(tmp_path: Path, options: tuple[str, str]) -> None:
    """Loud sound followed by soft sound, so that the first frames do not reveal the length, and the reverse."""
    rng = np.random.default_rng(1)
    for name, levels in (("falls", (0.5, 0.0)), ("rises", (0.0, 0.5))):
        sound = np.concatenate([level * rng.normal(size=(4 * 44100, 2)).clip(-1.0, 1.0) for level in levels])
        soundfile.write(tmp_path / f"{name}.wav", sound, 44100)
        path = tmp_path / f"{name}.mp3"
        ffmpeg("-i", str(tmp_path / f"{name}.wav"), "-c:a", "libmp3lame", *options, "-write_xing", "0", str(path))
        whole = decode(str(path))
        assert not whole.warnings
        assert whole.duration_s == pytest.approx(8.0, abs=0.06)
        path.write_bytes(path.read_bytes()[:-300])
        (warning,) = decode(str(path)).warnings
        assert warning.id == "audio.breaks_off"


def test_a_gap_of_an_hour_is_refused_and_costs_nothing(tmp_path: Path) -> None:
    path = with_gap(tmp_path / "gap.m4a", 3600.0)
    with pytest.raises(FileError, match=r"audio\.too_dense"):
        decode(str(path))


def test_time_stamps_that_would_lose_the_sound_are_refused(tmp_path: Path) -> None:
    """MP4 counts samples in 32 bits: after a gap of 28 hours all blocks are at the same time."""
    path = with_gap(tmp_path / "gap.m4a", 100_000.0)
    with pytest.raises(FileError, match=r"video\.sound_times"):
        decode(str(path))


@pytest.mark.parametrize("suffix", ["mkv", "webm", "flv"])
def test_a_gap_of_days_is_refused_too(tmp_path: Path, suffix: str) -> None:
    """ffmpeg considers gaps of more than thirty hours an error and would omit them silently."""
    codec = "libopus" if suffix == "webm" else "aac"
    for seconds in (200_000.0, 1_000_000.0):
        path = with_gap(tmp_path / f"gap.{suffix}", seconds, codec=codec)
        with pytest.raises(FileError, match=r"audio\.too_long"):
            decode(str(path))


def test_silence_of_many_channels_and_a_high_rate_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "wide.flac"
    path.write_bytes(flac(20_000, rate_hz=655_350, channels=8))
    with pytest.raises(FileError, match=r"audio\.too_many_samples") as error:
        decode(str(path))
    assert "8 channels at 655350 Hz" in error_text(error.value)


def test_ten_hours_of_silence_are_refused_before_they_are_read(tmp_path: Path) -> None:
    path = tmp_path / "long.opus"
    path.write_bytes(opus_silence(36_000.0))
    shares: list[float] = []
    with pytest.raises(FileError, match=r"audio\.too_long"):
        decode(str(path), shares.append)
    assert not shares
    path.write_bytes(opus_silence(60.0))
    assert decode(str(path)).duration_s == pytest.approx(60.0, abs=0.05)


def test_many_streams_in_one_file_are_read_although_their_length_is_unknown(tmp_path: Path) -> None:
    path = tmp_path / "chain.opus"
    path.write_bytes(b"".join(opus_silence(0.12, serial) for serial in range(800)))
    assert decode(str(path)).duration_s == pytest.approx(0.12, abs=0.01)


def test_resampling_keeps_the_moment(tmp_path: Path) -> None:
    sound = np.zeros((44100, 1), np.float32)
    sound[22050] = 1.0
    soundfile.write(tmp_path / "click.wav", sound, 44100)
    samples = decode(str(tmp_path / "click.wav")).samples[:, 0].astype(np.int32)
    assert int(np.abs(samples).argmax()) == pytest.approx(RATE_HZ // 2, abs=1)


def test_one_channel_and_many(tmp_path: Path) -> None:
    soundfile.write(tmp_path / "mono.wav", tone(RATE_HZ, channels=1), RATE_HZ)
    mono = decode(str(tmp_path / "mono.wav")).samples
    assert (mono[:, 0] == mono[:, 1]).all()
    surround = np.zeros((RATE_HZ, 6), np.float32)
    surround[:, 2] = 0.6
    soundfile.write(tmp_path / "surround.wav", surround, RATE_HZ)
    assert (decode(str(tmp_path / "surround.wav")).samples > 1000).all()


def test_not_a_number_is_silence(tmp_path: Path) -> None:
    sound = tone(RATE_HZ)
    sound[100:200] = np.nan
    sound[300] = np.inf
    soundfile.write(tmp_path / "nan.wav", sound, RATE_HZ, subtype="FLOAT")
    samples = decode(str(tmp_path / "nan.wav")).samples
    assert (samples[100:200] == 0).all()
    assert samples[300, 0] == 32767


@pytest.mark.parametrize("content", [b"", b"RIFF", b"not sound at all" * 50, b"MThd\0\0\0\6\0\1\0\1\1\xe0"])
def test_what_is_no_sound_is_refused_by_name(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "thing.wav"
    path.write_bytes(content)
    with pytest.raises(FileError) as error:
        decode(str(path))
    assert error.value.message.arguments["file"] == str(path)
    assert "thing.wav" in error_text(error.value)


def test_a_missing_file_and_a_folder(tmp_path: Path) -> None:
    for path in (tmp_path / "none.wav", tmp_path):
        with pytest.raises(FileError, match=r"file\.(cannot_read|not_regular)"):
            decode(str(path))
    with pytest.raises(FileError):
        decode("nul\0byte.wav")


def test_no_samples(tmp_path: Path) -> None:
    soundfile.write(tmp_path / "empty.wav", np.zeros((0, 2), np.float32), RATE_HZ)
    with pytest.raises(FileError, match=r"audio\.empty"):
        decode(str(tmp_path / "empty.wav"))


def test_a_truncated_file_gives_what_there_is(tmp_path: Path) -> None:
    for suffix in ("wav", "flac", "ogg", "mp3"):
        path = tmp_path / f"cut.{suffix}"
        soundfile.write(path, tone(RATE_HZ, 6.0), RATE_HZ)
        whole = path.read_bytes()
        path.write_bytes(whole[: len(whole) * 2 // 3])
        try:
            recording = decode(str(path))
        except FileError:
            continue
        assert 0.5 < recording.duration_s < 5.5
        assert all("cut" in text(warning) for warning in recording.warnings)


def test_a_header_that_lies_about_its_length_fills_no_memory(tmp_path: Path) -> None:
    path = tmp_path / "lies.wav"
    soundfile.write(path, tone(RATE_HZ, 0.5), RATE_HZ)
    data = bytearray(path.read_bytes())
    at = data.index(b"data")
    data[4:8] = struct.pack("<I", 0xFFFFFFF0)
    data[at + 4 : at + 8] = struct.pack("<I", 0xFFFFFF00)
    path.write_bytes(data)
    assert decode(str(path)).duration_s < 1.0


def test_impossible_rates_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "slow.wav"
    soundfile.write(path, tone(RATE_HZ, 0.1), 10)
    with pytest.raises(FileError, match=r"audio\.unusable"):
        decode(str(path))


def test_too_long_is_refused_before_it_is_read_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.audio.decode.MOST_HOURS", 1 / 3600)
    soundfile.write(tmp_path / "long.wav", tone(RATE_HZ, 3.0), RATE_HZ)
    with pytest.raises(FileError, match=r"audio\.too_long"):
        decode(str(tmp_path / "long.wav"))
    assert MOST_HOURS >= 1


def test_it_can_be_stopped(tmp_path: Path) -> None:
    soundfile.write(tmp_path / "long.wav", tone(RATE_HZ, 5.0), RATE_HZ)
    asked: list[bool] = []

    def stop_requested() -> bool:
        asked.append(True)
        return len(asked) > 1

    with pytest.raises(Cancelled):
        decode(str(tmp_path / "long.wav"), stop_requested=stop_requested)
    assert len(asked) == 2
