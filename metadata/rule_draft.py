"""Rules while a user changes them: which there are, whose they are, and the files that say it.

A rule of ours that is changed is put into a file of the user's, under its name; a file of the user's is written anew
only where one of its rules is another.
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
"""The user's file for changed rules of ours and new ones."""


class Listed(NamedTuple):
    """A rule in force.

    Attributes
    ----------
    file : str
        Name of the user's file that it is in; empty: it is ours.
    ours : Rule or None
        What it takes the place of.
    """

    rule: Rule
    file: str = ""
    ours: Rule | None = None


Draft: TypeAlias = tuple[Listed, ...]


def listed(sets: Mapping[str, RuleSet], own: Collection[str]) -> Draft:
    """The rules in force, in the order in which they are asked; of ``sets`` those called ``own`` are the user's."""
    found: dict[str, Listed] = {}
    for name in sorted(sets, key=lambda name: (name in own, name)):
        for rule in sets[name].rules:
            before = found.get(rule.name)
            ours = None if before is None else before.rule if before.file == "" else before.ours
            found[rule.name] = Listed(rule, name, ours) if name in own else Listed(rule)
    return tuple(found.values())


def changed(draft: Draft, index: int, rule: Rule) -> Draft:
    """A rule says something else; one of ours becomes the user's. Back to what ours says it is ours again."""
    one = draft[index]
    ours = one.ours if one.file else one.rule
    if ours is not None and rule == ours and one.file in ("", OWN):
        return _with(draft, index, Listed(ours))
    return _with(draft, index, Listed(rule, one.file or OWN, ours))


def added(draft: Draft, expression: str) -> Draft:
    """A new rule at the end, which shows an expression to loud notes."""
    return (*draft, Listed(Rule(_free("rule", draft), When(loudness_above=0.8), Do(expression=expression)), OWN))


def duplicated(draft: Draft, index: int) -> Draft:
    """A copy of a rule, behind it, of which nothing in a piece speaks."""
    rule = draft[index].rule
    copy = msgspec.structs.replace(rule, name=_free(rule.name.rstrip("0123456789_"), draft), events="")
    return (*draft[: index + 1], Listed(copy, OWN), *draft[index + 1 :])


def removed(draft: Draft, index: int) -> Draft:
    """Remove a rule of the user's; ours that it took the place of is there again. Ours itself is switched off."""
    one = draft[index]
    if one.file == "":
        return changed(draft, index, msgspec.structs.replace(one.rule, enabled=False))
    if one.ours is not None:
        return _with(draft, index, Listed(one.ours))
    return (*draft[:index], *draft[index + 1 :])


def sets_of(draft: Draft, sets: Mapping[str, RuleSet], own: Collection[str]) -> dict[str, RuleSet]:
    """The user's files as the draft has them, by name; the very same object where nothing is another. A file whose
    rules are all gone has none."""
    effective = {one.rule.name: one.file for one in draft}
    before = {one.rule.name: one.file for one in listed(sets, own)}
    result: dict[str, RuleSet] = {}
    for name in sorted({*own, *(one.file for one in draft if one.file)}):
        there = sets.get(name, RuleSet(name, "", ()))
        # What is hidden by a rule of a later file stays where it is.
        hidden = tuple(rule for rule in there.rules if before.get(rule.name) not in (name, None))
        kept = tuple(rule for rule in hidden if effective.get(rule.name) != name)
        rules = kept + tuple(one.rule for one in draft if one.file == name)
        result[name] = there if rules == there.rules else msgspec.structs.replace(there, rules=rules)
    return result


def write(made: Mapping[str, RuleSet], before: Mapping[str, RuleSet], folder: Path) -> list[Path]:
    """Write what is another, and delete our own file where it has no rules left; the files that were written. Raises
    FileError."""
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
    """A file of rules: what is as it is by itself is left out."""
    text = toml({"name": rules.name, "description": rules.description})
    if not rules.rules:
        text += "rules = []\n"
    for rule in rules.rules:
        text += f"\n[{header(('rules',), many=True)}]\n{toml(_said(rule), ('rules',))}"
    return text


_USUAL: Final[Mapping[type[msgspec.Struct], msgspec.Struct]] = {When: When(), Do: Do(), Title: Title("")}


def _said(value: msgspec.Struct) -> dict[str, Any]:
    """The fields that are not as usual."""
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
