"""Rules during editing: bundled or the user's, written and read again."""

from __future__ import annotations

from pathlib import Path

import pytest
from msgspec.structs import replace

from metadata.library import RULES, bundled_rules
from metadata.rule_draft import OWN, Draft, added, changed, duplicated, listed, removed, sets_of, text_of, write
from metadata.rules import Do, Rule, RuleSet, When, read_rules

OURS = {rules.name: rules for rules in RULES.begin().items.values()}
LOUD = Rule("loud", When(loudness_above=0.9, place=("climax", "last")), Do(expression="fierce", grows_with="loudness"))
MINE = RuleSet("mine", "What I like.", (LOUD, replace(LOUD, name="other", enabled=False)))


@pytest.fixture
def draft() -> Draft:
    return listed(OURS, ())


def index_of(draft: Draft, name: str) -> int:
    return [one.rule.name for one in draft].index(name)


def test_all_rules_are_listed_as_they_are_asked(draft: Draft) -> None:
    assert tuple(one.rule for one in draft) == bundled_rules()
    assert not any(one.file for one in draft)
    assert sets_of(draft, OURS, ()) == {}


def test_a_changed_rule_of_ours_is_written_under_its_name_and_read_again(draft: Draft, tmp_path: Path) -> None:
    at = index_of(draft, "strained")
    softer = replace(draft[at].rule, do=replace(draft[at].rule.do, strength=0.5))
    made = changed(draft, at, softer)
    assert (made[at].file, made[at].ours) == (OWN, draft[at].rule)
    (path,) = write(sets_of(made, OURS, ()), OURS, tmp_path)
    assert read_rules(path).rules == (softer,)
    assert "loudness_above" not in path.read_text(encoding="utf-8"), "what is not said is left out"
    sets = OURS | {OWN: read_rules(path)}
    again = listed(sets, {OWN})
    assert again == made
    assert changed(made, at, draft[at].rule)[at] == draft[at], "as ours it is ours again"
    back = removed(again, at)
    assert back == draft
    write(sets_of(back, sets, {OWN}), sets, tmp_path)
    assert not path.exists()


@pytest.mark.parametrize("rule", [rule for rules in OURS.values() for rule in rules.rules] + list(MINE.rules))
def test_every_rule_is_written_as_it_is(rule: Rule, tmp_path: Path) -> None:
    path = tmp_path / "x.toml"
    path.write_text(text_of(RuleSet("x", "", (rule,))), encoding="utf-8")
    assert read_rules(path) == RuleSet("x", "", (rule,))


def test_rules_are_added_duplicated_and_removed(draft: Draft) -> None:
    more = added(draft, "smile")
    assert (more[-1].rule.name, more[-1].rule.do.expression, more[-1].file) == ("rule_1", "smile", OWN)
    assert added(more, "smile")[-1].rule.name == "rule_2"
    at = index_of(more, "puffed")
    twice = duplicated(more, at)
    copy = twice[at + 1].rule
    assert (copy.name, copy.events, copy.do) == ("puffed_1", "", twice[at].rule.do)
    assert removed(twice, at + 1) == more
    off = removed(draft, at)
    assert (off[at].rule.enabled, off[at].file) == (False, OWN)


def test_a_file_of_the_users_keeps_its_other_rules_and_is_written_only_if_it_changes(tmp_path: Path) -> None:
    sets = OURS | {"mine": MINE}
    draft = listed(sets, {"mine"})
    assert sets_of(draft, sets, {"mine"})["mine"] is MINE
    assert write(sets_of(draft, sets, {"mine"}), sets, tmp_path) == []
    gone = removed(draft, index_of(draft, "loud"))
    made = sets_of(gone, sets, {"mine"})
    assert made["mine"] == replace(MINE, rules=MINE.rules[1:])
    (path,) = write(made, sets, tmp_path)
    assert read_rules(path) == made["mine"]
    none = sets_of(removed(gone, index_of(gone, "other")), sets, {"mine"})
    (path,) = write(none, sets, tmp_path)
    assert read_rules(path).rules == ()


def test_what_a_later_file_hides_stays_in_its_own() -> None:
    later = RuleSet("zz", "", (replace(LOUD, do=Do(expression="proud")),))
    sets = OURS | {"mine": MINE, "zz": later}
    draft = listed(sets, {"mine", "zz"})
    assert draft[index_of(draft, "loud")].file == "zz"
    assert sets_of(draft, sets, {"mine", "zz"}) == {"mine": MINE, "zz": later}
    assert sets_of(draft, sets, {"mine", "zz"})["mine"].rules == MINE.rules
