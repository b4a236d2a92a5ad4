"""Fit how every bundled character holds every bundled instrument and keep the result in resources/holds.

Run it whenever a character, an instrument's model or map, the body's limits or the fit itself has changed: a test
says when.

    python -m resources.build.build_holds [CHARACTER | INSTRUMENT ...]
"""

from __future__ import annotations

import sys
import time

from app.rig.characters.character_library import bundled_characters, character_named
from app.rig.grip.fitting.fit import fit_hold
from app.rig.grip.fitting.grip_files import bundled_path, digest_of, read_hold, write_hold
from app.rig.grip.lips import fit_lips
from app.rig.instrument import load_instrument
from instrument_maps.load import bundled_maps, model_path
from metadata.load import load_body


def main(requested: list[str]) -> None:
    """Fit what is not up to date: all of it, or what is named."""
    body, maps = load_body(), bundled_maps()
    unknown = set(requested) - set(bundled_characters()) - set(maps)
    if unknown:
        sys.exit(f"no character and no instrument has this name: {', '.join(sorted(unknown))}")
    for character_id in [name for name in bundled_characters() if name in requested] or bundled_characters():
        character = character_named(character_id)
        for instrument in [maps[name] for name in maps if name in requested] or maps.values():
            model = load_instrument(model_path(instrument), instrument)
            path, digest = bundled_path(character_id, instrument.id), digest_of(character, model, instrument, body)
            if read_hold(path, digest, fit_lips(character, instrument, body)) is not None:
                continue
            start_s = time.perf_counter()
            hold = fit_hold(character, model, instrument, body)
            path.parent.mkdir(exist_ok=True)
            write_hold(path, digest, hold)
            print(f"{path.name}: {time.perf_counter() - start_s:.0f} s")
            for hand in hold.hands:
                worst = max(
                    (contact for contact in hand.contacts if contact.firm), key=lambda contact: contact.distance_m
                )
                print(
                    f"  {hand.side}: {worst.part} {worst.distance_m * 1000:.2f} mm, "
                    f"{hand.penetration_m * 1000:.1f} mm inside"
                )


if __name__ == "__main__":
    main(sys.argv[1:])
