"""Find how small people carry what they would hold with bent wrists as is usual, and write it into their files.

    python -m resources.build.fit_carriages [PERSON | INSTRUMENT ...]

Tried is what a person is not cast for, anywhere within the ranges of the instrument's map. `check_cast --write` then
judges the motion, and keeps what helps.
"""

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

# One thread: with many small sums several threads only wait for each other.
os.environ.setdefault("OMP_NUM_THREADS", "1")

from app.rig.characters.character_library import character_named
from app.rig.grip.carriage import carried_by
from app.rig.grip.fitting.grip_files import hold_for
from app.rig.grip.fitting.same_hands import arms_cost
from app.rig.instrument import load_instrument
from app.rig.people.bundled_people import bundled_people, bundled_person, not_cast_for
from instrument_maps.load import bundled_maps, model_path
from instrument_maps.model import InstrumentMap
from metadata.load import load_body

Shares = tuple[float, float, float]

USUAL: Shares = (0.0, 0.0, 0.0)
STEPS = (0.0, 0.4, -0.4, 0.8, -0.8)
"""Tried positions as shares of a range; the remainder is left for motion."""
OFF = 0.15
"""Cost of a carriage at an end of its range, relative to the arms' cost."""
ROUNDS = 2
LINE = re.compile(r"^carriages = .*\n", re.MULTILINE)
AFTER = re.compile(r"^not_cast_for = .*\n", re.MULTILINE)


def straightest(person_id: str, instrument: InstrumentMap) -> Shares:
    """Find the carriage in which a person's arms are as natural as possible."""
    person, model, body = character_named(person_id), load_instrument(model_path(instrument), instrument), load_body()
    finished = person.hands_of
    assert finished is not None
    hold = hold_for(finished, model, instrument, body)

    def cost(shares: Shares) -> float:
        carried = carried_by(instrument, shares)
        return arms_cost(hold, person, carried, body) + OFF * sum(map(abs, shares))

    return descended(cost)


def descended(cost: Callable[[Shares], float]) -> Shares:
    """Shares of least cost, found one range after another."""
    best, least = USUAL, cost(USUAL)
    for _ in range(ROUNDS):
        for axis in range(3):
            for step in STEPS:
                tried = (*best[:axis], step, *best[axis + 1 :])
                found = cost(tried) if tried != best else least
                if found < least:
                    best, least = tried, found
    return best


def write_carriages(path: Path, carriages: Mapping[str, Shares]) -> None:
    """Write the carriages of a person into its file."""
    text = LINE.sub("", path.read_text(encoding="utf-8"))
    if carriages:
        rows = (f"{name} = {json.dumps(list(carriages[name]))}" for name in sorted(carriages))
        text = AFTER.sub(lambda line: f"{line.group()}carriages = {{ {', '.join(rows)} }}\n", text)
    path.write_text(text, encoding="utf-8")


def main(requested: Sequence[str]) -> None:
    """Try all persons with the instruments for which they are not cast, or the named ones."""
    maps = bundled_maps()
    unknown = set(requested) - set(bundled_people()) - set(maps)
    if unknown:
        sys.exit(f"no person and no instrument has this name: {', '.join(sorted(unknown))}")
    for id, path in bundled_people().items():
        names = [name for name in sorted(not_cast_for(id)) if name in requested or not set(requested) & set(maps)]
        if not names or (set(requested) & set(bundled_people()) and id not in requested):
            continue
        carriages = dict(bundled_person(id).carriages)
        for name in names:
            carriages[name] = straightest(id, maps[name])
            print(f"{id} {name}: {carriages[name]}", flush=True)
        write_carriages(path, {name: shares for name, shares in carriages.items() if shares != USUAL})


if __name__ == "__main__":
    main(sys.argv[1:])
