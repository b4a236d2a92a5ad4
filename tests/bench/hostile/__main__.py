"""Attacks at length, as tables: what was tried, what escaped or was lost, what the costliest files cost.

``xvfb-run -a -s "-screen 0 1920x1200x24" python -m tests.bench.hostile MINUTES [SEED]``. Half of the time goes to the
readers, half to the random user; the costliest files of every size are opened in the window at the end.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Final

from tests.fuzz.harness.campaign import SIZES, Child, Tally, attack, keep
from tests.fuzz.harness.readers import GROUPS, KINDS
from tests.fuzz.harness.seeds import hostile
from tests.support.random_user import Journey, travel

DEEDS, KILLS = 300, 6
"""Numbers of deeds and kills in one run."""
SHOWN: Final = ("midi", "project", "audio", "gltf", "foreign_fbx")
"""Kinds of files that are opened in the window."""
WINDOW: Final = "tests.bench.hostile.window"


def main(minutes: float, seed: int) -> int:
    """Print the tables; the number of what failed."""
    tallies: dict[str, Tally] = {}
    with ThreadPoolExecutor(2) as pool:
        seconds = minutes * 60.0 / len(GROUPS)
        groups = [[name for name, kind in KINDS.items() if kind.group == group] for group in GROUPS]
        for found in pool.map(lambda kinds: attack(kinds, seconds, seed), groups):
            tallies |= found
    failed = _tell_attacks(tallies)
    failed += _tell_costs(tallies)
    return failed + _tell_journeys(minutes * 30.0, seed)


def _tell_attacks(tallies: Mapping[str, Tally]) -> int:
    print(f"{'kind':>18} {'files':>8} {'read':>8} {'refused':>8} {'failed':>8}")
    failures = 0
    for kind, tally in tallies.items():
        failed = sum(count for count, _, _ in tally.failures.values())
        failures += failed
        print(f"{kind:>18} {tally.tries:8} {tally.accepted:8} {tally.refused:8} {failed:8}")
        for failure, (count, data, _) in tally.failures.items():
            print(f"{'':>18} {count} x {failure}; {keep(kind, data)}")
    print(f"{'all':>18} {sum(tally.tries for tally in tallies.values()):8}", flush=True)
    return failures


def _tell_costs(tallies: Mapping[str, Tally]) -> int:
    print("\nthe costliest files: CPU and memory of the reader alone; longest stall of the window's thread, its memory")
    slow = 0
    with Child(SHOWN, WINDOW) as window:
        for kind, tally in tallies.items():
            for size in SIZES:
                rows = tally.worst.get(size)
                if not rows:
                    continue
                cells = [
                    f"{rows[what][0]:7.{digits}f} {unit}" if what in rows else f"{'-':>7} {unit}"
                    for what, digits, unit in (("cpu_s", 2, "s"), ("peak_mb", 0, "MB"))
                ]
                if kind in SHOWN:
                    shown = [window.run(kind, data) for _, data in rows.values()]
                    stall_s = max(result.cpu_s for result in shown)
                    slow += stall_s > 0.5
                    cells += [f"{stall_s:7.3f} s", f"{max(result.peak_mb for result in shown):7.0f} MB"]
                print(f"{kind:>18} {size // 1000:4} KB {' '.join(cells)}", flush=True)
        for kind in SHOWN:
            stalls = [(window.run(kind, make()).cpu_s, name) for name, make in hostile(kind).items()]
            if stalls:
                print(
                    f"{kind:>18} found: {len(stalls)} files, longest stall {max(stalls)[0]:.3f} s in {max(stalls)[1]}"
                )
                slow += max(stalls)[0] > 0.5
    return slow


def _tell_journeys(seconds: float, seed: int) -> int:
    whole, number, end_s = Journey(), 0, time.monotonic() + seconds
    while time.monotonic() < end_s:
        with tempfile.TemporaryDirectory() as folder:
            journey = travel(Path(folder), seed + number, DEEDS, KILLS)
        number += 1
        whole.deeds += journey.deeds
        whole.kills += journey.kills
        whole.faults += journey.faults
        for fault in journey.faults:
            print(f"journey {seed + number - 1}: {fault}", flush=True)
    print(f"\n{number} journeys: {whole.deeds} deeds, {whole.kills} kills, {len(whole.faults)} faults")
    return len(whole.faults)


if __name__ == "__main__":
    sys.exit(min(main(float(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1), 1))
