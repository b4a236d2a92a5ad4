"""Sound of a MIDI channel on a sound module, as it follows from banks, programs and modes in the order of time."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final, Literal, NamedTuple, TypeAlias

import msgspec

Use: TypeAlias = Literal["melodic", "rhythm", "effect"]
System: TypeAlias = Literal["", "gm", "gs", "xg", "gm2"]
DRUM_CHANNEL: Final = 9
"""Index of channel 10, the percussion channel of General MIDI."""
EFFECT_PROGRAMS: Final = range(120, 128)
"""General MIDI programs of sound effects, from guitar fret noise to gunshot."""
KIT_PROGRAMS: Final = frozenset((0, 1, 2, 3, 4, 8, 16, 24, 25, 26, 27, 28, 29, 30, 31, 32, 40, 48, 49, 50))
"""Program numbers of drum kits in GS, XG and GM2, except for effect kits."""
_EFFECT_KITS: Final = (56, 57)
_DRUM_BANKS: Final = frozenset((120, 126, 127))
_PERCUSSION_BANK, _MELODY_BANK, _EFFECT_KIT_BANK, _KIT_BANK, _EFFECT_BANK = 120, 121, 126, 127, 64
_ORCHESTRA, _BRUSH = 48, 40


class ChannelSound(msgspec.Struct, frozen=True, gc=False):
    """Sound of a channel from a tick on.

    Attributes
    ----------
    certain : bool
        Whether an unambiguous message sets the sound; otherwise the track's name has priority.
    program : int or None
        Program number; None if no message sets one.
    kit : {"", "gs", "xg"}
        System whose numbers for drum sounds a rhythm part uses; empty: General MIDI's.
    """

    use: Use
    certain: bool
    program: int | None
    kit: Literal["", "gs", "xg"] = ""

    def struck(self, pitch: int) -> int:
        """Return the General MIDI 2 number of the drum sound that a pitch of a rhythm part stands for; the pitch itself
        if the kit has no numbers of its own.
        """
        if self.kit == "xg":
            return _XG_SOUNDS.get(pitch, pitch)
        if self.program == _ORCHESTRA:
            return _ORCHESTRA_SOUNDS.get(pitch, pitch)
        if self.kit == "gs":
            found = _GS_SOUNDS.get(pitch, pitch)
            return 38 if self.program == _BRUSH and pitch == 39 else found
        return pitch


# Below 35 the standard kit of XG has sounds of its own. Yamaha XG data lists, "drum map": 13 and 14 surdo, 15 high Q,
# 16 whip slap, 17 and 18 scratch, 19 finger snap, 20 click noise, 21 and 22 metronome, 23 and 24 sequencer click, 25 to
# 28 brush on the snare drum, 29 snare roll, 30 castanet, 31 soft snare, 32 sticks, 33 soft bass drum, 34 rim shot.
_XG_SOUNDS: Final[Mapping[int, int]] = {
    13: 86, 14: 87, 15: 27, 16: 28, 17: 29, 18: 30, 19: 39, 20: 32, 21: 33, 22: 34, 23: 32, 24: 32, 25: 38, 26: 38,
    27: 38, 28: 38, 29: 38, 30: 85, 31: 38, 32: 31, 33: 35, 34: 38,
}  # fmt: skip
# Roland SC-88Pro owner's manual, "drum set table": 23 and 24 beeps, 25 snare roll, 26 finger snap.
_GS_SOUNDS: Final[Mapping[int, int]] = {22: 33, 23: 34, 24: 38, 25: 38, 26: 39}
# The orchestra sets of GS and GM2: 27 to 30 hi-hats and ride cymbal, 39 castanets, 41 to 53 timpani, which are tuned
# toms to a dancer.
_ORCHESTRA_SOUNDS: Final[Mapping[int, int]] = {
    25: 38, 26: 39, 27: 42, 28: 44, 29: 46, 30: 51, 39: 85,
    **dict.fromkeys(range(41, 47), 41), **dict.fromkeys(range(47, 54), 43),
}  # fmt: skip


class SoundChange(NamedTuple):
    """A change of the sound (such as program or bank) of one channel; changes are applied in sorted order."""

    tick: int
    rank: int
    track: int
    number: int
    kind: Literal["reset", "mode", "bank", "program"]
    value: int | str | bool | None


class _ChannelState:
    """State of one MIDI channel while its messages are read in order."""

    def __init__(self, channel: int) -> None:
        self.channel = channel
        self.system: System = ""
        self.mode: bool | None = None
        self.bank: int | None = None
        self.coming: int | None = None
        """The bank that the next program change takes."""
        self.program: int | None = None

    @property
    def is_said(self) -> bool:
        """Return whether any message set program, mode or bank of the channel itself."""
        return self.program is not None or self.mode is not None or self.bank is not None

    def take(self, step: SoundChange) -> None:
        if step.kind == "reset":
            self.system = step.value  # type: ignore[assignment]
            self.mode = self.bank = self.coming = None
        elif step.kind == "mode":
            self.mode = step.value  # type: ignore[assignment]
        elif step.kind == "bank":
            self.coming = step.value  # type: ignore[assignment]
        else:
            self.program = step.value  # type: ignore[assignment]
            self.settle()

    def settle(self) -> None:
        """Apply the pending bank; a bank that decides between drums and melody overrides an earlier mode."""
        if self.coming is not None:
            self.bank = self.coming
            if self.system != "gs" and (self.bank in _DRUM_BANKS or self.bank == _MELODY_BANK):
                self.mode = None

    def sound(self) -> ChannelSound:
        use, certain = self._use()
        if use == "rhythm" and self._is_effect_kit():
            use = "effect"
        elif use == "melodic" and self.program in EFFECT_PROGRAMS:
            use, certain = "effect", False
        kit: Literal["", "gs", "xg"] = ""
        if self.system == "xg" or (self.system not in ("gs", "gm2") and self.bank == _KIT_BANK):
            kit = "xg"
        elif self.system == "gs":
            kit = "gs"
        return ChannelSound(use, certain, self.program, kit if use == "rhythm" else "")

    def _use(self) -> tuple[Use, bool]:
        if self.mode is not None:
            return ("rhythm" if self.mode else "melodic"), True
        if self.bank is None or self.system == "gs":
            return ("rhythm" if self.channel == DRUM_CHANNEL else "melodic"), False
        if self.bank in _DRUM_BANKS:
            certain = self.system == "gm2" if self.bank == _PERCUSSION_BANK else self.system == "xg"
            return ("effect" if self.bank == _EFFECT_KIT_BANK else "rhythm"), certain
        if self.system == "xg" and self.bank == _EFFECT_BANK:
            return "effect", True
        melody = self.bank == _MELODY_BANK or (self.system == "xg" and self.program not in KIT_PROGRAMS)
        if self.channel == DRUM_CHANNEL and not melody:
            return "rhythm", False
        return "melodic", True

    def _is_effect_kit(self) -> bool:
        by_number = self.system in ("gs", "gm2") or self.bank == _PERCUSSION_BANK
        return by_number and self.program in _EFFECT_KITS


def timeline(steps: Iterable[SoundChange], channel: int, onset: int, late: int) -> list[tuple[int, ChannelSound]]:
    """Return the sounds of a channel over time, as (tick, sound); ``onset`` is the tick of its first note.

    Parameters
    ----------
    late : int
        The first message that defines the channel's sound may come this many ticks after the first note.
    """
    state = _ChannelState(channel)
    found: list[tuple[int, ChannelSound]] = []
    for step in steps:
        if step.tick > onset and not found:
            state.settle()
            if state.is_said or step.tick > onset + late:
                found.append((0, state.sound()))
        state.take(step)
        if found and step.kind != "bank" and found[-1][1] != (sound := state.sound()):
            found.append((step.tick, sound))
    if not found:
        state.settle()
        found.append((0, state.sound()))
    return found
