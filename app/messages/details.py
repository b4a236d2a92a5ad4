"""Details of what is wrong with a table or a project: kinds of corrections in words, and details of schemas and of the
checks of `metadata` and `app.project` in Japanese; any other stays as it is."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from typing import Final, TypeAlias

from app.messages import corrections

LANGUAGES: Final = ("en", "ja")
_AT: Final = ("{what} ({where})", "{what}（{where}）")
_COMMA: Final = (", ", "、")

_JAPANESE: Final = tuple(
    (re.compile(pattern), wording)
    for pattern, wording in (
        (r"Object contains unknown field `(.*)`", r"`\1` という項目はありません"),
        (r"Object missing required field `(.*)`", r"項目 `\1` がありません"),
        (r"Invalid enum value (.*)", r"\1 は使えない値です"),
        (r"Expected `(.*)`, got `(.*)`", r"`\1` が必要ですが、`\2` です"),
        (r"Expected `(?:.*)` <= (.*)", r"\1 以下でなければなりません"),
        (r"Expected `(?:.*)` >= (.*)", r"\1 以上でなければなりません"),
        (r"Expected `(?:.*)` > (.*)", r"\1 より大きくなければなりません"),
        (r"Expected `(?:.*)` < (.*)", r"\1 より小さくなければなりません"),
        (r"Expected `array` of (?:at most )?length (?:<= )?(.*)", r"要素は \1 個までです"),
        (r"(.*) is not the file's name (.*)", r"\1 がファイル名 \2 と一致しません"),
        (r"(.*) must be letters, digits and underscores", r"\1 は英数字と下線だけにしてください"),
        (r"(.*) appears twice", r"\1 が重複しています"),
        (r"(.*) needs when\.(.*)", r"\1 には when.\2 が必要です"),
        (r"must be (\d+) to (\d+)", r"\1～\2 個必要です"),
        (r"at most (\d+)", r"最大 \1 個です"),
        (
            r"must be (\S+): a gesture begins at 0 and ends at 1",
            r"\1 にしてください。ジェスチャーは 0 に始まり 1 に終わります",
        ),
        (
            r"must be 0 and level: the body goes on from where it is",
            "0 で傾きなしにしてください。元の姿勢に戻ります",
        ),
        (r"must be 0: the instrument is lowered before and after", "0 にしてください。前後では楽器を下ろしています"),
        (r"must be on the grip: the hand goes back to where it was", "grip にしてください。手は元の位置に戻ります"),
        (r"must be at least (\S+) after the key before", r"前のキーから \1 以上離してください"),
        (r"must be a name on one line", "1 行の名前にしてください"),
        (r"must be after the start", "start より後にしてください"),
        (r"must be printable and without commas", "表示できる文字で、コンマなしにしてください"),
        (r"must have an expression or a gesture, and not both", "expression か gesture のどちらか一方が必要です"),
        (r"must have at least one factor other than 1", "1 以外の係数が 1 つ以上必要です"),
        (r"must not fall, and be at most 3", "減らない値で、3 以下にしてください"),
        (r"must say when", "条件を 1 つ以上書いてください"),
        (r"not one of the 52 ARKit morph targets", "ARKit の 52 個のモーフターゲットにありません"),
        (r'an elbow has only "up"', '肘にあるのは "up" だけです'),
        (
            r'must be "lowered" where a hand leaves the instrument, or it comes up',
            '手が楽器を離れるか楽器が上がる場合は "lowered" にしてください',
        ),
        (r"a gesture ends when it is done", "ジェスチャーは終わると消えます"),
        (r"a gesture has its fades in its keys", "ジェスチャーのフェードはキーで表します"),
        (r"has nothing to grow with at a moment", "この時点には強さの基準がありません"),
        (
            r"is for expressions; say of a gesture where the note is",
            "表情だけに使えます。ジェスチャーには音符の位置を指定してください",
        ),
        (r"the mouth belongs to the embouchure", "口はアンブシュアが動かします"),
        (r"must be from (\S+) to (\S+)", r"\1～\2 の範囲にしてください"),
        (r"at most (\d+) characters", r"最大 \1 文字です"),
        (r"at most (\d+) (?:numbers|tracks)", r"最大 \1 個です"),
        (r"must be the name of a text encoding", "文字コードの名前にしてください"),
        (r"must have from (\d+) to (\d+) characters", r"\1～\2 文字にしてください"),
        (r"must be Unicode text", "Unicode の文字にしてください"),
        (r"must be the path of a file", "ファイルのパスにしてください"),
        (r"must be (\S+)", r"\1 にしてください"),
        (r"must be at most (\S+)", r"\1 以下にしてください"),
        (r"must be more than 0 and at most (\S+)", r"0 より大きく、\1 以下にしてください"),
        (r'must be empty or like "#3366cc"', '空にするか、"#3366cc" のように書いてください'),
        (r"possible: (.*)", r"使える値: \1"),
        (r"there is no channel (.*); possible: (.*)", r"チャンネル \1 はありません。使えるもの: \2"),
        (r"there is no (part|take|player) (.*)", r"\2 はありません（\1）"),
        (r"there is no player of this id", "この id の奏者はいません"),
        (r"there is no dancer of this id", "この id のダンサーはいません"),
        (r"ticks must ascend", "ティックは昇順にしてください"),
        (r"must be before the end", "終わりより前にしてください"),
        (r"would come back from the file as another value", "ファイルから読むと別の値になります"),
        (r"unknown key", "この項目はありません"),
    )
)
_NAME: Final = r"""('.*?'|".*?")"""
_KIND: Final = "|".join(id.removeprefix(corrections.PREFIX) for id in corrections.WORDINGS)
_WHERE: Final = re.compile(
    rf"(.*) \((?:(player|dancer) {_NAME})?(?:, )?(?:bar (-?\d+))?(?:, )?(?:\b({_KIND})(?: {_NAME})?)?\)"
)
_PLACES: Final = {
    "player": ("player {value}", "奏者 {value}"),
    "dancer": ("dancer {value}", "ダンサー {value}"),
    "bar": ("bar {value}", "{value} 小節"),
}
Label: TypeAlias = Callable[[str, str], str]


def detail_text(detail: str, language: str, label: Label = lambda kind, name: name) -> str:
    """The detail of a message in a language.

    Parameters
    ----------
    label : callable
        The name of a correction as the user knows it, by its kind and its name in the file.
    """
    index = LANGUAGES.index(language)
    place = _WHERE.fullmatch(detail)
    if place is not None and any(place.groups()[1:]):
        what, who, name, bar, kind, correction = place.groups()
        said = [_PLACES[who][index].format(value=name)] if who else []
        said += [_PLACES["bar"][index].format(value=bar)] if bar else []
        if kind:
            word = corrections.WORDINGS[f"{corrections.PREFIX}{kind}"][index]
            said.append(f"{word} {_labelled(correction, partial(label, kind))}" if correction else word)
        return _AT[index].format(what=detail_text(what, language), where=_COMMA[index].join(said))
    if language != "ja":
        return detail
    for pattern, wording in _JAPANESE:
        found = pattern.fullmatch(detail)
        if found is not None:
            return found.expand(wording)
    return detail


def _labelled(quoted: str, label: Callable[[str], str]) -> str:
    """A quoted name with what the user knows it by, in the same quotes."""
    return f"{quoted[0]}{label(quoted[1:-1])}{quoted[-1]}"
