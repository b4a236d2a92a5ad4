"""Rules while the user edits them, and the resulting files.

A changed bundled rule is stored in a file of the user's under its name; a file of the user's is rewritten only if one
of its rules changed.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple, TypeAlias

import msgspec

from app.formats.atomic import atomic_write
from app.formats.toml import header, toml
from metadata.rules import Do, Rule, RuleSet, When
from metadata.tables import Title

OWN: Final = "my_rules"
"""Name of the user's file with changed bundled rules and new ones."""


class Listed(NamedTuple):
    """A rule in the list of the rules editor, with its origin.

    Attributes
    ----------
    file : str
        Name of the user's file that contains it; empty if it is bundled.
    ours : Rule or None
        Bundled rule that it replaces.
    """

    rule: Rule
    file: str = ""
    ours: Rule | None = None


Draft: TypeAlias = tuple[Listed, ...]


def listed(sets: Mapping[str, RuleSet], own: Collection[str]) -> Draft:
    """Return the rules in effect, in the order of evaluation; those of ``sets`` named in ``own`` are the user's."""
    found: dict[str, Listed] = {}
    for name in sorted(sets, key=lambda name: (name in own, name)):
        for rule in sets[name].rules:
            before = found.get(rule.name)
            ours = None if before is None else before.rule if before.file == "" else before.ours
            found[rule.name] = Listed(rule, name, ours) if name in own else Listed(rule)
    return tuple(found.values())


def changed(draft: Draft, index: int, rule: Rule) -> Draft:
    """Return the draft with a changed rule; a bundled one becomes the user's, and one equal to the bundled one becomes
    bundled again.
    """
    one = draft[index]
    ours = one.ours if one.file else one.rule
    if ours is not None and rule == ours and one.file in ("", OWN):
        return _with(draft, index, Listed(ours))
    return _with(draft, index, Listed(rule, one.file or OWN, ours))


def added(draft: Draft, expression: str) -> Draft:
    """Return the draft with a new rule at the end, which shows an expression on loud notes."""
    return (*draft, Listed(Rule(_free("rule", draft), When(loudness_above=0.8), Do(expression=expression)), OWN))


def duplicated(draft: Draft, index: int) -> Draft:
    """Return the draft with a copy of a rule placed after it; corrections in pieces stay with the original rule."""
    rule = draft[index].rule
    copy = msgspec.structs.replace(rule, name=_free(rule.name.rstrip("0123456789_"), draft), events="")
    return (*draft[: index + 1], Listed(copy, OWN), *draft[index + 1 :])


def removed(draft: Draft, index: int) -> Draft:
    """Remove a rule: a user's rule is deleted, and the bundled rule that it replaced takes effect again; a bundled rule
    is disabled instead.
    """
    one = draft[index]
    if one.file == "":
        return changed(draft, index, msgspec.structs.replace(one.rule, enabled=False))
    if one.ours is not None:
        return _with(draft, index, Listed(one.ours))
    return (*draft[:index], *draft[index + 1 :])


def sets_of(draft: Draft, sets: Mapping[str, RuleSet], own: Collection[str]) -> dict[str, RuleSet]:
    """Convert a draft to the user's files by name; unchanged ones are the same objects, and files without rules are
    omitted.
    """
    effective = {one.rule.name: one.file for one in draft}
    before = {one.rule.name: one.file for one in listed(sets, own)}
    result: dict[str, RuleSet] = {}
    for name in sorted({*own, *(one.file for one in draft if one.file)}):
        there = sets.get(name, RuleSet(name, "", ()))
        # A rule hidden by one of a later file stays in its place.
        hidden = tuple(rule for rule in there.rules if before.get(rule.name) not in (name, None))
        kept = tuple(rule for rule in hidden if effective.get(rule.name) != name)
        rules = kept + tuple(one.rule for one in draft if one.file == name)
        result[name] = there if rules == there.rules else msgspec.structs.replace(there, rules=rules)
    return result


def write(made: Mapping[str, RuleSet], before: Mapping[str, RuleSet], folder: Path) -> list[Path]:
    """Write the changed files, and delete those that no longer have rules; returns the paths of the written files.
    Raises FileError.
    """
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for name, rules in made.items():
        path = folder / f"{name}.toml"
        if rules is before.get(name) or (not rules.rules and name not in before):
            continue
        if not rules.rules and name == OWN:
            path.unlink(missing_ok=True)
        else:
            with atomic_write(path) as stream:
                stream.write(text_of(rules).encode())
        written.append(path)
    return written


def text_of(rules: RuleSet) -> str:
    """Return the text of a file with these rules; fields at their default are omitted."""
    text = toml({"name": rules.name, "description": rules.description})
    if not rules.rules:
        text += "rules = []\n"
    for rule in rules.rules:
        text += f"\n[{header(('rules',), many=True)}]\n{toml(_said(rule), ('rules',))}"
    return text


_USUAL: Final[Mapping[type[msgspec.Struct], msgspec.Struct]] = {When: When(), Do: Do(), Title: Title("")}


def _said(value: msgspec.Struct) -> dict[str, Any]:
    """Return the fields of a rule that differ from their defaults, by name, for writing them to a file."""
    usual = _USUAL.get(type(value), Rule("", When(), Do()))
    found: dict[str, Any] = {}
    for name in value.__struct_fields__:
        one = getattr(value, name)
        if one != getattr(usual, name) or name in ("when", "do"):
            found[name] = _said(one) if isinstance(one, msgspec.Struct) else one
    return found


def _with(draft: Draft, index: int, one: Listed) -> Draft:
    return (*draft[:index], one, *draft[index + 1 :])


def _free(stem: str, draft: Draft) -> str:
    taken = {one.rule.name for one in draft}
    return next(name for number in range(1, len(taken) + 2) if (name := f"{stem}_{number}") not in taken)
