"""The available styles, habits, expressions, gestures and rules: bundled ones, and those in the user's folders.

Each kind has a folder of its name beside the program's other data (see `app.formats.user_folder`); the user's own
replace bundled ones of the same name, and are read again when their files change.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from functools import cache
from pathlib import Path
from typing import Any, Final, NamedTuple, TypeVar

from app.errors import Message
from app.formats.user_folder import Read, Shelf, UserFolder
from metadata.acting import Habit, Style, read_habit, read_style
from metadata.gestures import Gesture, read_gesture
from metadata.load import load_expressions, read_named_expression
from metadata.model import Expression
from metadata.rules import Rule, RuleSet, read_rules
from metadata.tables import bundled

T = TypeVar("T")


def _folder(name: str, read: Callable[[Path], T], bundled: Callable[[], Mapping[str, T]]) -> UserFolder[T, Shelf[T]]:
    return UserFolder(name, (), Shelf, bundled, lambda path: Read(read(path)))


STYLES: Final = _folder("styles", read_style, bundled("styles", read_style, Style))
HABITS: Final = _folder("habits", read_habit, bundled("habits", read_habit, Habit))
EXPRESSIONS: Final = _folder("expressions", read_named_expression, load_expressions)
_OUR_GESTURES: Final = bundled("gestures", read_gesture, Gesture)
_OUR_RULES: Final = bundled("rules", read_rules, RuleSet)
GESTURES: Final = _folder("gestures", read_gesture, _OUR_GESTURES)
RULES: Final = _folder("rules", read_rules, _OUR_RULES)
FOLDERS: Final[tuple[UserFolder[Any, Any], ...]] = (STYLES, HABITS, EXPRESSIONS, GESTURES, RULES)
"""Folders of the kinds of tables that users can add."""


READERS: Final[Mapping[str, Callable[[Path], object]]] = {
    "styles": read_style,
    "habits": read_habit,
    "expressions": read_named_expression,
    "gestures": read_gesture,
    "rules": read_rules,
}
"""Function that reads and checks a table, by folder."""


class MetadataLibrary(NamedTuple):
    """All tables of acting (styles, habits, expressions, gestures, rules) as they were last read; until the next
    reading the values stay the same objects.
    """

    styles: Shelf[Style]
    habits: Shelf[Habit]
    expressions: Shelf[Expression]
    gestures: Shelf[Gesture]
    rules: Shelf[RuleSet]

    @property
    def all_rules(self) -> tuple[Rule, ...]:
        """Return the rules of every file, the user's after bundled ones; the same object while the files are
        unchanged.
        """
        return _all_rules(self.rules.items, self.rules.files)

    @property
    def expressions_by_name(self) -> dict[str, Expression]:
        """Return every expression by name; the user's own have the names stored in them, regardless of file names."""
        own = (self.expressions.items[id] for id in self.expressions.files)
        return load_expressions() | {expression.name: expression for expression in own}

    def is_still(self, other: MetadataLibrary) -> bool:
        """Return whether another library is from the same reading of the files."""
        return all(mine is others for mine, others in zip(self, other, strict=True))

    @property
    def problems(self) -> Mapping[Path, tuple[Message, ...]]:
        """Problems found in the user's files, by file."""
        return {path: said for shelf in self for path, said in shelf.problems.items()}


def bundled_gestures() -> Mapping[str, Gesture]:
    """Return the bundled gestures by name."""
    return _OUR_GESTURES()


def bundled_rules() -> tuple[Rule, ...]:
    """All rules of acting that come with the program."""
    return _all_rules(_OUR_RULES())


@cache
def _rules_of(sets: tuple[RuleSet, ...]) -> tuple[Rule, ...]:
    return tuple({rule.name: rule for found in sets for rule in found.rules}.values())


def _all_rules(sets: Mapping[str, RuleSet], own: Collection[str] = ()) -> tuple[Rule, ...]:
    """Merge the rules of all files in the order of file names, files in ``own`` last; of two rules with the same name
    the later one replaces the earlier in its position.
    """
    return _rules_of(tuple(sets[name] for name in sorted(sets, key=lambda name: (name in own, name))))


def metadata_library() -> MetadataLibrary:
    """Return the tables of acting as they were last read; the first call reads them."""
    return MetadataLibrary(*(folder.now() for folder in FOLDERS))


def begin_metadata() -> None:
    """Use only bundled tables for now, in a program that will read the user's folders in the background."""
    for folder in FOLDERS:
        folder.begin()


def reload_metadata() -> MetadataLibrary:
    """Read the user's folders again if anything in them changed."""
    return MetadataLibrary(*(folder.reload() for folder in FOLDERS))
