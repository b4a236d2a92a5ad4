"""Random values and seeds by name equal stored values, since a seed must give the same performance in every version."""

from __future__ import annotations

from app.chance import chance, next_seed, partial_digest, performed_seed, seed_of, share_of


def test_the_numbers_are_those_of_every_version() -> None:
    assert chance("sway", 0, "1.1.1", 480) == 0.8344034927042527
    assert seed_of("player", 0, "1.1.1") == 505246374
    assert next_seed("1.1.1", 5) == 1405056749


def test_a_begun_chance_goes_on_as_the_whole() -> None:
    digest = partial_digest(("a", 7, "b")).copy()
    digest.update(b"%d" % 480)
    assert share_of(digest.digest()) == chance("a", 7, "b", 480)


def test_dice_go_on_and_on() -> None:
    seeds = [0]
    for _ in range(200):
        seeds.append(next_seed("1.1.1", seeds[-1]))
    assert len(set(seeds)) == len(seeds)
    assert all(0 <= seed < 2**31 for seed in seeds)
    assert next_seed("1.1.1", 3) != next_seed("2.1.1", 3)


def test_a_seed_stays_within_what_a_project_may_hold() -> None:
    assert performed_seed(2**63 - 1, 2**63 - 1) == 2**63 - 2
