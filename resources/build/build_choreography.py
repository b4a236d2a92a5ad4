"""Learns the bundled choreography again from the captures and rhythms that it was made of::

    python -m resources.build.build_choreography FOLDER

``FOLDER`` holds the files that `PAIRS` names, anywhere below it (`resources/choreographies/README.md` says where they
are from). No one danced to these rhythms: an offset is as arbitrary as another, and they are kept so that the dances
of existing projects stay.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Final

from app.choreography.learn import learn
from app.choreography.model import ChoreographyModel
from app.choreography.model_file import write_model
from app.choreography.read_motion import guesses
from app.choreography.read_pair import ReadPair, read_pair
from app.messages import text

TARGET: Final = Path(__file__).parents[1] / "choreographies/salsa.choreography"
CREDITS: Final = TARGET.with_name("credits.txt")
FPS: Final = Fraction(60)
"""Frame rate in frames per second of the captures; the files wrongly state 120."""
PAIRS: Final = {
    "cmu_salsa_01.bvh": ("gmd_drummer5_session1_14_latin-brazilian-songo_112_beat_4-4.mid", 15.93),
    "cmu_salsa_03.bvh": ("gmd_drummer5_session2_24_latin-brazilian-songo_120_beat_4-4.mid", -125.9),
    "cmu_salsa_05.bvh": ("gmd_drummer5_session2_8_neworleans-chacha_124_beat_4-4.mid", -72.42),
    "cmu_salsa_16.bvh": ("gmd_drummer1_session1_38_latin-samba_116_beat_4-4.mid", 8.145),
    "cmu_salsa_18.bvh": ("gmd_drummer5_session2_24_latin-brazilian-songo_120_beat_4-4.mid", -49.79),
}
"""Capture, rhythm, and the time in seconds of what is learned of the capture at which the rhythm begins."""


def read(folder: Path) -> Iterator[ReadPair]:
    """Read the pairs. Raises FileNotFoundError if one is not in the folder."""
    for motion_name, (music_name, offset_s) in PAIRS.items():
        motion, music = (next(folder.rglob(name), None) for name in (motion_name, music_name))
        if motion is None or music is None:
            raise FileNotFoundError(f"{folder} lacks {motion_name} or {music_name}")
        one = read_pair(motion, music, fps=FPS, credits=CREDITS)
        yield replace(one, pair=replace(one.pair, offset_s=offset_s))


def learned(folder: Path) -> ChoreographyModel:
    """Learn the model from the files of a folder."""
    return learn([one.pair for one in read(folder)], states=None, seed=0, name=TARGET.stem)


def main() -> None:
    parser = argparse.ArgumentParser(description="Learns the bundled choreography again.")
    parser.add_argument("folder", type=Path, help="with the captures and the rhythms, anywhere below it")
    folder = parser.parse_args().folder
    write_model(TARGET, learned(folder))
    for one in read(folder):
        print(f"{one.pair.motion_name}: {'; '.join(map(text, guesses(one.motion)))}")


if __name__ == "__main__":
    main()
