"""What the parts of hands that touch an instrument are called."""

from __future__ import annotations

from typing import Final

_SIDES: Final = {"left": ("left", "左手"), "right": ("right", "右手")}
_PARTS: Final = {
    "thumb": ("thumb", "親指"),
    "index": ("index finger", "人差し指"),
    "middle": ("middle finger", "中指"),
    "ring": ("ring finger", "薬指"),
    "little": ("little finger", "小指"),
    "palm": ("palm", "手のひら"),
    "thumb_web": ("web of the thumb", "親指と人差し指の間"),
}
_PLACES: Final = {
    "pad": ("{}", "{}"),
    "side": ("side of the {}", "{}の側面"),
    "pad_middle": ("middle phalanx of the {}", "{}の中節"),
    "side_middle": ("side of the middle phalanx of the {}", "{}の中節の側面"),
    "pad_proximal": ("proximal phalanx of the {}", "{}の基節"),
    "side_proximal": ("side of the proximal phalanx of the {}", "{}の基節の側面"),
}


def touch_name(part: str, language: str) -> str:
    """The words for a part of a hand such as ``left.index.side``, as maps name it; what is unknown stays as it is."""
    side, _, rest = part.partition(".")
    name, _, place = rest.partition(".")
    if side not in _SIDES or name not in _PARTS or (place and place not in _PLACES):
        return part
    if language == "ja":
        return _PLACES[place or "pad"][1].format(f"{_SIDES[side][1]}の{_PARTS[name][1]}")
    return _PLACES[place or "pad"][0].format(f"{_SIDES[side][0]} {_PARTS[name][0]}")
