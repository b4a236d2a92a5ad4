"""Fit how every bundled character holds every bundled instrument and keep the result in resources/holds.

Run it whenever a character, an instrument's model or map, the body's limits or the fit itself has changed: a test
says when.

    python -m resources.build.build_holds [--people] [CHARACTER | INSTRUMENT ...]

People hold what they hold as the finished body does that they are made from, or have a file of their own. With
``--people`` one is also fitted for what they are not cast for; `check_cast --write` then keeps those that help.
"""

from __future__ import annotations

import os
import sys
import time

# One thread: with many small sums several threads only wait for each other.
os.environ.setdefault("OMP_NUM_THREADS", "1")

from app.rig.characters.character_library import character_named
from app.rig.grip.fitting.fit import fit_hold
from app.rig.grip.fitting.grip_files import bundled_path, digest_of, read_hold, write_hold
from app.rig.grip.lips import fit_lips
from app.rig.instrument import load_instrument
from app.rig.people.bundled_people import bundled_people, finished_character, not_cast_for
from app.rig.people.person import originals
from instrument_maps.load import bundled_maps, model_path
from instrument_maps.model import InstrumentMap
from metadata.load import load_body

PEOPLE = "--people"


def main(requested: list[str]) -> None:
    """Fit all outdated grips, or the named ones."""
    maps, names = bundled_maps(), [name for name in requested if name != PEOPLE]
    unknown = set(names) - set(originals()) - set(bundled_people()) - set(maps)
    if unknown:
        sys.exit(f"no character and no instrument has this name: {', '.join(sorted(unknown))}")
    chosen = [maps[name] for name in maps if name in names] or list(maps.values())
    ids = [*originals(), *bundled_people()]
    for id in [name for name in ids if name in names] or ids:
        for instrument in chosen:
            tried = PEOPLE in requested and instrument.id in not_cast_for(id)
            if id in originals() or is_own(id, instrument.id) or tried:
                refresh(id, instrument)


def is_own(person_id: str, instrument_id: str) -> bool:
    """Return whether a person holds an instrument differently from the bundled body that the person is made from."""
    return bundled_path(person_id, instrument_id).is_file()


def refresh(character_id: str, instrument: InstrumentMap) -> None:
    """Fit a grip again if it is outdated."""
    body, model = load_body(), load_instrument(model_path(instrument), instrument)
    is_person = character_id in bundled_people()
    character = character_named(character_id) if is_person else finished_character(character_id, character_named)
    path, digest = bundled_path(character_id, instrument.id), digest_of(character, model, instrument, body)
    if read_hold(path, digest, fit_lips(character, instrument, body)) is not None:
        return
    start_s = time.perf_counter()
    hold = fit_hold(character, model, instrument, body)
    path.parent.mkdir(exist_ok=True)
    write_hold(path, digest, hold)
    print(f"{path.name}: {time.perf_counter() - start_s:.0f} s", flush=True)
    for hand in hold.hands:
        worst = max((contact for contact in hand.contacts if contact.firm), key=lambda contact: contact.distance_m)
        print(
            f"  {hand.side}: {worst.part} {worst.distance_m * 1000:.2f} mm, {hand.penetration_m * 1000:.1f} mm inside"
        )


if __name__ == "__main__":
    main(sys.argv[1:])
