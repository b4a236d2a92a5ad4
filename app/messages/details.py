"""Details of what is wrong with a file, a table or a project, and the system's reasons, in Japanese; kinds of
corrections in words. What a library says and is not known here stays as it is."""

from __future__ import annotations

import errno
import os
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
        (r"must be one of (.*)", r"使える値: \1"),
        (r"is needed by (.*)", r"\1 に必要です"),
        (r"changes must be ordered by tick", "変更はティック順に並べる必要があります"),
        (r"must be a kind of mute", "ミュートの種類を指定してください"),
        (r"is not used by (.*)", r"\1 では使いません"),
        (
            r"must be the path of a (\S+) file or the name of a bundled choreography",
            r"\1 ファイルのパスか、付属の振り付けの名前にしてください",
        ),
        (r"must be like (.*) or (.*)", r"\1 や \2 のように書いてください"),
        (r"must be like (.*)", r"\1 のように書いてください"),
        (r"must be a fraction of whole numbers of at most nine digits", "9 桁までの整数の分数にしてください"),
        (r"must be a table", "テーブルにしてください"),
        (r"must not be empty", "空にはできません"),
        (r"must not be before the start", "始まりより後にしてください"),
        (r"must be as many as the (?:ticks|times)", "時刻と同じ個数にしてください"),
        (r"must ascend|ticks and seconds must rise", "昇順にしてください"),
        (r"must be in order and apart|spans must be in order and apart", "順に並べ、重ならないようにしてください"),
        (r"(?:markers|hits|notes|spans) must be ordered by .*", "時刻の順に並べてください"),
        (r"differs from the score's", "スコアの値と異なります"),
        (r"no metre begins after the pickup", "アウフタクトの後に始まる拍子がありません"),
        (r"(.*) is no MIDI message in hexadecimal", r"\1 は 16 進数の MIDI メッセージではありません"),
        (r"(.*) is not about acting", r"\1 は演技の項目ではありません"),
        (r"not a parameter of presets", "プリセットの項目ではありません"),
        (r"(\d+) MB; a project's file is at most (\d+) MB", r"\1 MB です。プロジェクトファイルは \2 MB までです"),
        (r"no (\w+)", r"\1 がありません"),
        (r"must be the name of a file in this folder \((.*)\)", r"このフォルダーのファイル名にしてください（\1）"),
        (
            r"(.*) must be the name of a file in this folder \((.*)\)",
            r"\1 はこのフォルダーのファイル名ではありません（\2）",
        ),
        (r"nested in more than (\d+) others", r"入れ子が \1 段を超えています"),
        (r"not a finite number", "有限の数にしてください"),
        (r"a number that is too large", "数が大きすぎます"),
        (r"two clips have the same code", "同じコードの映像が 2 つあります"),
        (r"status (-?\d+)", r"終了コード \1"),
        (r"its reader ended with (.*)", r"読み込みプロセスが終了しました（\1）"),
        (r"it has no FileVersion", "FileVersion がありません"),
        (r"EngineAssociation is no text", "EngineAssociation が文字列ではありません"),
        (r"(.*) is not made of finite (\S+)s", r"\1 に \2 型の有限の数でない値があります"),
        (r"(.*) is not a matrix", r"\1 が行列ではありません"),
        (r"UVIndex beyond UV", "UVIndex が UV の範囲外です"),
        (r"(.*) is its own ancestor", r"\1 が自分自身の子孫になっています"),
        (r"weights of (.*)", r"\1 のウェイト"),
        (r"two different curves of (.*)", r"\1 に異なるカーブが 2 つあります"),
        (r"times and values of (.*)", r"\1 の時刻と値"),
        (r"a bone's transform is not finite", "ボーンの変換に有限でない数があります"),
        (r"no node named (.*)", r"\1 という名前のノードがありません"),
        (r"damaged: (.*)", r"壊れています: \1"),
        (r"(.*) is not the id of a map", r"\1 という id のマップはありません"),
        (r"'(.*)' extends itself", r"'\1' が自分自身を継承しています"),
        (r"more than (\d+) maps extend one another", r"マップの継承が \1 段を超えています"),
        (r"there is no map named (.*)", r"\1 というマップはありません"),
        (r"(.*) is not the file's name, (.*)", r"\1 がファイル名 \2 と一致しません"),
        (r"no such model", "モデルがありません"),
        (r"program (\d+) belongs to two instruments", r"プログラム \1 が 2 つの楽器に使われています"),
        (r"(.*) belongs to two instruments", r"\1 が 2 つの楽器に使われています"),
        (
            r"an ensemble of (.*) has a part without instrument, range or pitch",
            r"編成 \1 に楽器・音域・音高のないパートがあります",
        ),
        (r"(.*) has no place in the seating", r"\1 の席順がありません"),
        (r"the seating and the score order have different families", "席順とスコア順で楽器群が異なります"),
        (r"(.*) is a form that the table does not have", r"\1 という形は表にありません"),
        (r"(.*) is a sort of (.*), which is no other instrument", r"\1 の親 \2 は別の楽器ではありません"),
        (r"the take had ended before", "テイクの終わりより後です"),
        (r"(.*) is no word of a journal", r"\1 という語は使えません"),
        (r"(.*) is no moment", r"\1 は時刻ではありません"),
        (r"(.*) is no message of a MIDI channel", r"\1 は MIDI のチャンネルメッセージではありません"),
        (r"(.*) is no place of a piece", r"\1 は曲の位置ではありません"),
        (r"time goes back", "時刻が戻っています"),
        (r"the device is back and was never lost", "切断されていないデバイスの再接続です"),
        (r"too few or too many values", "値の個数が違います"),
        (r"not ASCII", "ASCII の文字ではありません"),
        (r"Input data was truncated", "途中で終わっています"),
        (r"JSON is malformed: (.*) \(byte (\d+)\)", r"JSON の書式が正しくありません（\2 バイト目）"),
        (r"lists or objects nested too deeply", "入れ子が深すぎます"),
        (r"'utf-8' codec can't decode .*", "UTF-8 の文字ではありません"),
        (r"(Expected .*|Object .*|Invalid .*) - at `(.*)`", r"\2: \1"),
    )
)
_SYSTEM: Final = {
    os.strerror(number): wording
    for number, wording in (
        (errno.ENOSPC, "空き容量がありません"),
        (errno.EDQUOT if hasattr(errno, "EDQUOT") else errno.ENOSPC, "ディスクの割り当てを超えています"),
        (errno.EACCES, "アクセスが許可されていません"),
        (errno.EPERM, "操作が許可されていません"),
        (errno.ENOENT, "ファイルまたはフォルダーがありません"),
        (errno.EEXIST, "すでに存在します"),
        (errno.EISDIR, "フォルダーです"),
        (errno.ENOTDIR, "フォルダーではありません"),
        (errno.EROFS, "書き込み禁止のディスクです"),
        (errno.EIO, "ディスクの読み書きでエラーが起きました"),
        (errno.ENAMETOOLONG, "名前が長すぎます"),
        (errno.EBUSY, "使用中です"),
        (errno.EMFILE, "開いているファイルが多すぎます"),
        (errno.ETIMEDOUT, "応答がありません"),
        (errno.ECONNREFUSED, "接続を拒否されました"),
        (errno.ENETUNREACH, "ネットワークに接続できません"),
        (errno.EHOSTUNREACH, "相手のコンピューターに接続できません"),
    )
}
"""Reasons of the system."""
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
    if detail in _SYSTEM:
        return _SYSTEM[detail]
    for pattern, wording in _JAPANESE:
        found = pattern.fullmatch(detail)
        if found is not None:
            return found.expand(wording)
    return detail


def _labelled(quoted: str, label: Callable[[str], str]) -> str:
    """A quoted name with what the user knows it by, in the same quotes."""
    return f"{quoted[0]}{label(quoted[1:-1])}{quoted[-1]}"
