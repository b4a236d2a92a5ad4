"""The body: what it lacks, and what touches the instrument."""

from __future__ import annotations

from typing import Final

WORDINGS: Final[dict[str, tuple[str, str]]] = {
    # The body: what it lacks
    "character.instrument_size": (
        "the instrument is scaled to {percent} % so that hands and arms can reach it",
        "手と腕が届くように、楽器の大きさを {percent} % にします",
    ),
    "character.no_fingers": (
        (
            "the fingers of the {side} hand do not bend: the whole hand rests on the instrument, and keys and "
            "valves move without fingers"
        ),
        "{side}手の指は曲がりません。手全体を楽器に添え、キーやピストンは指なしで動きます",
    ),
    "character.no_hand": (
        "the {side} hand has no mesh and hangs down while the other hand plays",
        "{side}手にはメッシュがありません。下ろしたまま、もう一方の手で演奏します",
    ),
    "character.no_lips": (
        "the head has no mesh to find the mouth on; the instrument is held at the assumed lip position",
        "頭に口を検出できるメッシュがありません。想定される唇の位置に楽器を構えます",
    ),
    "character.lips_still": (
        "no morph opens the mouth: breaths are not visible and the lips stay closed",
        "口を開くモーフがありません。ブレスは口に表れず、唇は閉じたままです",
    ),
    "character.hold_failed": (
        ("{character} cannot hold {instrument} ({detail}); correct the instrument map, or choose another character"),
        (
            "{character} は {instrument} を持てません（{detail}）。インストゥルメントマップを修正するか、"
            "別のキャラクターを選んでください"
        ),
    ),
    "character.hold_waiting": (
        "the instrument hold is still being calculated; the player appears when it is finished",
        "楽器の持ち方を計算中です。終わり次第、奏者が表示されます",
    ),
    "character.touches_missed": (
        (
            "{count} {count:contact does|contacts do} not reach this instrument; the {touch} misses by {gap_mm} "
            "mm: the hands and the instrument do not match in size or shape"
        ),
        (
            "{count} か所の接触点がこの楽器に届きません（{touch}が {gap_mm} mm 外れます）。"
            "手と楽器の大きさや形が合っていません"
        ),
    ),
    # The motion: contacts
    "contact.hand_off": (
        (
            "the {side} hand is {gap_mm} mm off its position on the instrument; reduce the pose correction or "
            "gesture here, or choose a character of another size"
        ),
        (
            "{side}手が楽器上の位置から {gap_mm} mm 離れています。ここのポーズ修正やジェスチャーを弱めるか、"
            "体格の違うキャラクターを選んでください"
        ),
    ),
    "contact.stops_short": (
        (
            "{control} stops {gap_mm} mm short of its position because the {side} hand cannot reach further; "
            "reduce the pose correction or gesture here, or choose a character with longer arms"
        ),
        (
            "{side}手がこれ以上届かず、{control}が本来の位置の {gap_mm} mm 手前で止まります。"
            "ここのポーズ修正やジェスチャーを弱めるか、腕の長いキャラクターを選んでください"
        ),
    ),
    "contact.finger_off": (
        (
            "the {touch} misses {control} by {gap_mm} mm; reduce the pose correction here, or choose a character "
            "of another size"
        ),
        (
            "{touch}が{control}から {gap_mm} mm 外れています。ここのポーズ修正を弱めるか、"
            "体格の違うキャラクターを選んでください"
        ),
    ),
    "contact.grip_off": (
        (
            "the {touch} is {gap_mm} mm off the instrument; reduce the pose correction here, or choose a character "
            "of another size"
        ),
        (
            "{touch}が楽器から {gap_mm} mm 離れています。ここのポーズ修正を弱めるか、"
            "体格の違うキャラクターを選んでください"
        ),
    ),
    "contact.lips_off": (
        (
            "the lips are {gap_mm} mm off the mouthpiece while a note sounds; move or remove the gesture that "
            "lowers the instrument here"
        ),
        (
            "音が鳴っている間に唇がマウスピースから {gap_mm} mm 離れています。"
            "ここで楽器を下ろすジェスチャーを移動するか削除してください"
        ),
    ),
    "contact.foot_off": (
        "the {side} foot slides {gap_mm} mm on the floor; reduce sway, weight shift or the pose correction",
        "{side}足が床の位置から {gap_mm} mm ずれています。揺れ・重心移動・ポーズ修正のいずれかを弱めてください",
    ),
}

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
