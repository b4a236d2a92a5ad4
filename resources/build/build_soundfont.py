"""Cut the winds and the drum kit out of a General MIDI soundfont: `winds.sf2` and `drums.sf2` in `resources/soundfont`.

    python -m resources.build.build_soundfont FluidR3_GM.sf2

The source is Fluid R3 GM 3.1 (Frank Wen; MIT), as Debian's package ``fluid-soundfont-gm`` ships it. Of its 148 MB stay
the presets of wind instruments, one channel of each stereo pair (a player stands somewhere: the mixer pans), at most
`MOST_RATE_HZ`, and of a long held tone `LONGEST_S` with a loop of its own. The standard kit has a file of its own, for
the synthesiser reads all of one for every phrase; its cymbals fade out after `KIT_LONGEST_S`.

Format: SoundFont Technical Specification 2.04 (E-mu, 2006), chapters 4 to 8.
"""

from __future__ import annotations

import struct
import sys
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
import soxr

from instrument_maps.instrument_names import vocabulary

OUT = Path(__file__).parents[1] / "soundfont" / "winds.sf2"
KIT_OUT = OUT.with_name("drums.sf2")
MOST_RATE_HZ = 22050.0
KIT_RATE_HZ = 32000.0
KIT_LONGEST_S, KIT_FADE_S = 1.6, 0.8
LONGEST_S = 1.25
ATTACK_SHARE, MOST_CUT_S = 0.25, 0.08
"""Share of its loudness at which a tone begins, and greatest number of seconds that is cut before it."""
ALIASES = {62: 61, 63: 61}
"""Synthetic brass is played by the brass section."""

KIT_BANK = 128
PAN, INSTRUMENT, SAMPLE_ID, KEY_RANGE, SAMPLE_MODES = 17, 41, 53, 43, 54
OFFSETS = {0, 1, 2, 3, 4, 12, 45, 50}
"""Generators that shift a sample's ends and loop, which are applied to the samples themselves."""
RIGHT = 2
"""Type of a sample that is the right half of a pair."""
SILENCE = 46
"""Number of zeros after every sample that the specification requires."""

Generators = list[tuple[int, int]]
Audio = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Sample:
    """One recorded tone, mono, -1..1, with its loop in samples."""

    name: str
    audio: Audio
    loop: tuple[int, int]
    rate_hz: float
    pitch: int
    cents: int


@dataclass
class Zone:
    """Generators in order, and modulators as they are in the file."""

    generators: Generators
    modulators: list[bytes] = field(default_factory=list)


class Font:
    """The chunks of a soundfont and what its tables say."""

    def __init__(self, data: bytes) -> None:
        self.chunks: dict[str, bytes] = {}
        at = 12
        while at < len(data):
            size = struct.unpack_from("<I", data, at + 4)[0]
            inner = at + 12
            while inner < at + 8 + size:
                name, length = data[inner : inner + 4].decode(), struct.unpack_from("<I", data, inner + 4)[0]
                self.chunks[name] = data[inner + 8 : inner + 8 + length]
                inner += 8 + length + (length & 1)
            at += 8 + size + (size & 1)
        self.presets = list(struct.iter_unpack("<20sHHHIII", self.chunks["phdr"]))
        self.instruments = list(struct.iter_unpack("<20sH", self.chunks["inst"]))
        self.samples = list(struct.iter_unpack("<20sIIIIIBbHH", self.chunks["shdr"]))
        self.audio = np.frombuffer(self.chunks["smpl"], "<i2")

    def zones(self, kind: str, first: int, end: int) -> list[Zone]:
        """Zones of the bags ``first`` to ``end`` of presets (``"p"``) or instruments (``"i"``)."""
        bags = list(struct.iter_unpack("<HH", self.chunks[f"{kind}bag"]))
        generators = list(struct.iter_unpack("<Hh", self.chunks[f"{kind}gen"]))
        modulators = [self.chunks[f"{kind}mod"][at : at + 10] for at in range(0, len(self.chunks[f"{kind}mod"]), 10)]
        return [
            Zone(
                [(int(g), int(v)) for g, v in generators[bags[bag][0] : bags[bag + 1][0]]],
                modulators[bags[bag][1] : bags[bag + 1][1]],
            )
            for bag in range(first, end)
        ]


def build(source: Path, to: Path = OUT) -> None:
    """Write the small soundfont."""
    font = Font(source.read_bytes())
    programs = sorted({p for item in vocabulary().instruments.values() if item.kind == "wind" for p in item.programs})
    presets: list[tuple[str, int, list[Zone]]] = []
    instruments: dict[int, list[Zone]] = {}
    samples: dict[tuple[int, ...], tuple[int, Sample]] = {}
    for program in programs:
        index = next(i for i, row in enumerate(font.presets[:-1]) if row[1:3] == (ALIASES.get(program, program), 0))
        name, zones = _name(font.presets[index][0]), []
        chosen: set[str] = set()
        for zone in font.zones("p", font.presets[index][3], font.presets[index + 1][3]):
            number = dict(zone.generators).get(INSTRUMENT)
            if number is not None:
                # The section's two halves differ by their place alone.
                half = _name(font.instruments[number][0]).removesuffix(" Left").removesuffix(" Right")
                if half != _name(font.instruments[number][0]) and half in chosen and number not in instruments:
                    continue
                chosen.add(half)
                if number not in instruments:
                    instruments[number] = _instrument(font, number, samples)
            zones.append(Zone([item for item in zone.generators if item[0] != PAN], zone.modulators))
        presets.append((name, program, zones))
    _write(to, _file(presets, instruments, font, _in_order(samples), "Winds of Fluid R3 GM"))
    for name, program, _ in presets:
        print(f"{program:3d} {name}")


def build_kit(source: Path, to: Path = KIT_OUT) -> None:
    """Write the small soundfont of the standard drum kit."""
    font = Font(source.read_bytes())
    index = next(i for i, row in enumerate(font.presets[:-1]) if row[1:3] == (0, KIT_BANK))
    instruments: dict[int, list[Zone]] = {}
    samples: dict[tuple[int, ...], tuple[int, Sample]] = {}
    zones = []
    for zone in font.zones("p", font.presets[index][3], font.presets[index + 1][3]):
        number = dict(zone.generators).get(INSTRUMENT)
        if number is not None and number not in instruments:
            instruments[number] = _instrument(font, number, samples)
        zones.append(Zone([item for item in zone.generators if item[0] != PAN], zone.modulators))
    presets = [(_name(font.presets[index][0]), 0, zones)]
    _write(to, _file(presets, instruments, font, _in_order(samples), "Drum kit of Fluid R3 GM", KIT_BANK))


def _in_order(samples: dict[tuple[int, ...], tuple[int, Sample]]) -> list[Sample]:
    return [sample for _, sample in sorted(samples.values(), key=lambda item: item[0])]


def _write(to: Path, data: bytes) -> None:
    to.parent.mkdir(exist_ok=True)
    to.write_bytes(data)
    print(f"{to.name}: {len(data) / 1e6:.1f} MB")


def _instrument(font: Font, number: int, samples: dict[tuple[int, ...], tuple[int, Sample]]) -> list[Zone]:
    """An instrument's zones with one channel of each pair; the samples they need are added to ``samples``."""
    start, end = font.instruments[number][1], font.instruments[number + 1][1]
    shared: dict[int, int] = {}
    kept = []
    for zone in font.zones("i", start, end):
        own = dict(zone.generators)
        if SAMPLE_ID not in own:
            shared = own
            kept.append(Zone([item for item in zone.generators if item[0] not in OFFSETS | {PAN}], zone.modulators))
            continue
        if font.samples[own[SAMPLE_ID]][9] == RIGHT:
            continue
        offsets = tuple({**shared, **own}.get(generator, 0) for generator in sorted(OFFSETS))
        key = (own[SAMPLE_ID], *offsets)
        if key not in samples:
            moved = dict(zip(sorted(OFFSETS), offsets, strict=True))
            held = {**shared, **own}.get(SAMPLE_MODES, 0) & 1
            samples[key] = len(samples), _sample(font, own[SAMPLE_ID], moved, held=bool(held))
        generators = [item for item in zone.generators if item[0] not in OFFSETS | {PAN, SAMPLE_ID}]
        kept.append(Zone([*generators, (SAMPLE_ID, samples[key][0])], zone.modulators))
    return kept


def _sample(font: Font, number: int, offsets: dict[int, int], *, held: bool) -> Sample:
    """A tone with its offsets applied, brought to the lower rate and shortened; one that is not held has no loop."""
    name, start, end, loop_start, loop_end, rate_hz, pitch, cents, _, _ = font.samples[number]
    start += offsets[0] + 32768 * offsets[4]
    end += offsets[1] + 32768 * offsets[12]
    loop_start += offsets[2] + 32768 * offsets[45]
    loop_end += offsets[3] + 32768 * offsets[50]
    loop_end = min(loop_end, end)
    audio = font.audio[start:end].astype(np.float64) / 32768.0
    sample = Sample(_name(name), audio, (loop_start - start, loop_end - start), float(rate_hz), pitch, cents)
    return _resampled(_shortened(_begun(sample))) if held else _struck(sample)


def _struck(sample: Sample) -> Sample:
    """A sound that decays by itself: at most `KIT_RATE_HZ`, and faded out if it is long."""
    longest, fade = round(KIT_LONGEST_S * sample.rate_hz), round(KIT_FADE_S * sample.rate_hz)
    audio = sample.audio[:longest].copy()
    if len(sample.audio) > longest:
        audio[-fade:] *= np.linspace(1.0, 0.0, fade) ** 2
    rate_hz = min(sample.rate_hz, KIT_RATE_HZ)
    audio = soxr.resample(audio, sample.rate_hz, rate_hz, quality="VHQ")
    return replace(sample, audio=audio, loop=(0, len(audio)), rate_hz=rate_hz)


def _begun(sample: Sample) -> Sample:
    """A tone without the sound before its attack, so that it is in time with the picture."""
    window = max(round(0.006 * sample.rate_hz), 1)
    power = np.convolve(sample.audio[: round(0.6 * sample.rate_hz)] ** 2, np.ones(window) / window)
    steady = np.median(power[round(0.2 * sample.rate_hz) :]) if len(power) > 0.3 * sample.rate_hz else power.max()
    rises = np.flatnonzero(power >= ATTACK_SHARE**2 * steady)
    cut = max(int(rises[0]) - window, 0) if len(rises) else 0
    cut = min(cut, round(MOST_CUT_S * sample.rate_hz), max(sample.loop[0] - 1, 0))
    if cut == 0:
        return sample
    audio = sample.audio[cut:].copy()
    fade = round(0.003 * sample.rate_hz)
    audio[:fade] *= np.linspace(0.0, 1.0, fade)
    return replace(sample, audio=audio, loop=(sample.loop[0] - cut, sample.loop[1] - cut))


def _shortened(sample: Sample) -> Sample:
    """The beginning of a long tone, with a new loop where it repeats best, cross-faded."""
    longest = round(LONGEST_S * sample.rate_hz)
    if sample.loop[1] <= longest * 1.15:
        return sample
    audio = sample.audio
    window = round(0.04 * sample.rate_hz)
    fade = round(0.06 * sample.rate_hz)
    best = (-2.0, 0, 0)
    for end in range(longest - round(0.25 * sample.rate_hz), longest, max(window // 3, 1)):
        pattern = audio[end - window : end]
        low, high = round(0.35 * sample.rate_hz) + fade, end - round(0.45 * sample.rate_hz)
        field_ = audio[low - window : high]
        products = np.correlate(field_, pattern, "valid")
        energies = np.convolve(field_**2, np.ones(window), "valid")
        likeness = products / np.sqrt(np.maximum(energies, 1e-9) * max(float((pattern**2).sum()), 1e-9))
        # Loudness must match too: a swell in a loop sounds as a throb.
        ratio = np.sqrt(np.maximum(energies, 1e-9) / max(float((pattern**2).sum()), 1e-9))
        score = likeness - np.abs(np.log(ratio))
        at = int(score.argmax())
        if score[at] > best[0]:
            best = (float(score[at]), low + at, end)
    _, loop_start, loop_end = best
    blend = np.linspace(0.0, 1.0, fade)
    out = audio[: loop_end + fade].copy()
    # Towards the loop's end the tone is blended with the sound before the loop's start, so that the jump is inaudible.
    out[loop_end - fade : loop_end] = (
        audio[loop_end - fade : loop_end] * (1 - blend) + audio[loop_start - fade : loop_start] * blend
    )
    return replace(sample, audio=out[:loop_end], loop=(loop_start, loop_end))


def _resampled(sample: Sample) -> Sample:
    """At most `MOST_RATE_HZ`, by a ratio that makes the loop a whole number of samples."""
    loop_start, loop_end = sample.loop
    length = loop_end - loop_start
    if sample.rate_hz <= MOST_RATE_HZ * 1.02 or length < 8:
        tail = np.resize(sample.audio[loop_start:loop_end], 16) if length else np.zeros(0)
        return replace(sample, audio=np.concatenate([sample.audio[:loop_end], tail]))
    new_length = max(round(length * MOST_RATE_HZ / sample.rate_hz), 4)
    # A loop of one period would be coarse: several of them are one loop.
    times = max(1, -(-512 // new_length))
    new_length = max(round(times * length * MOST_RATE_HZ / sample.rate_hz), 4)
    ratio = new_length / (times * length)
    rolled = np.concatenate(
        [sample.audio[:loop_end], np.resize(sample.audio[loop_start:loop_end], times * length + 4096)]
    )
    audio = soxr.resample(rolled, 1.0, ratio, quality="VHQ")
    start = round(loop_start * ratio)
    return replace(
        sample, audio=audio[: start + new_length + 16], loop=(start, start + new_length), rate_hz=sample.rate_hz * ratio
    )


def _file(
    presets: list[tuple[str, int, list[Zone]]],
    instruments: dict[int, list[Zone]],
    font: Font,
    tones: list[Sample],
    title: str,
    bank: int = 0,
) -> bytes:
    order = {number: index for index, number in enumerate(instruments)}
    smpl, shdr, at = bytearray(), bytearray(), 0
    for tone in tones:
        data = np.clip(np.round(tone.audio * 32768.0), -32768, 32767).astype("<i2")
        rate_hz = round(tone.rate_hz)
        # The error in pitch from rounding the rate (under a tenth of a cent) is not corrected.
        shdr += struct.pack(
            "<20sIIIIIBbHH", tone.name.encode()[:19], at, at + len(data), at + tone.loop[0], at + tone.loop[1],
            rate_hz, tone.pitch, tone.cents, 0, 1,
        )  # fmt: skip
        smpl += data.tobytes() + bytes(2 * SILENCE)
        at += len(data) + SILENCE
    shdr += struct.pack("<20sIIIIIBbHH", b"EOS", 0, 0, 0, 0, 0, 0, 0, 0, 0)

    phdr, pzones = bytearray(), []
    for name, program, zones in presets:
        phdr += struct.pack("<20sHHHIII", name.encode()[:19], program, bank, len(pzones), 0, 0, 0)
        pzones += [
            Zone([(g, order[v] if g == INSTRUMENT else v) for g, v in zone.generators], zone.modulators)
            for zone in zones
        ]
    phdr += struct.pack("<20sHHHIII", b"EOP", 0, 0, len(pzones), 0, 0, 0)
    inst, izones = bytearray(), []
    for number, zones in instruments.items():
        inst += struct.pack("<20sH", font.instruments[number][0], len(izones))
        izones += zones
    inst += struct.pack("<20sH", b"EOI", len(izones))

    info = _list(
        b"INFO",
        _chunk(b"ifil", struct.pack("<HH", 2, 1))
        + _chunk(b"isng", b"EMU8000\0")
        + _chunk(b"INAM", title.encode() + bytes(2 - len(title) % 2))
        + _chunk(b"ICOP", font.chunks["ICOP"])
        + _chunk(b"ICMT", font.chunks["ICMT"]),
    )
    pdta = _list(
        b"pdta",
        _chunk(b"phdr", phdr)
        + _tables("p", pzones)
        + _chunk(b"inst", inst)
        + _tables("i", izones)
        + _chunk(b"shdr", shdr),
    )
    body = b"sfbk" + info + _list(b"sdta", _chunk(b"smpl", smpl)) + pdta
    return b"RIFF" + struct.pack("<I", len(body)) + body


def _tables(kind: str, zones: list[Zone]) -> bytes:
    bag, gen, mod = bytearray(), bytearray(), bytearray()
    for zone in zones:
        bag += struct.pack("<HH", len(gen) // 4, len(mod) // 10)
        gen += b"".join(struct.pack("<Hh", *item) for item in zone.generators)
        mod += b"".join(zone.modulators)
    bag += struct.pack("<HH", len(gen) // 4, len(mod) // 10)
    names = [f"{kind}{table}".encode() for table in ("bag", "mod", "gen")]
    return _chunk(names[0], bag) + _chunk(names[1], mod + bytes(10)) + _chunk(names[2], gen + bytes(4))


def _chunk(name: bytes, data: bytes | bytearray) -> bytes:
    return name + struct.pack("<I", len(data)) + bytes(data) + bytes(len(data) & 1)


def _list(name: bytes, data: bytes) -> bytes:
    return _chunk(b"LIST", name + data)


def _name(raw: bytes) -> str:
    return raw.split(b"\0")[0].decode("latin-1")


if __name__ == "__main__":
    build(Path(sys.argv[1]))
    build_kit(Path(sys.argv[1]))
