"""Build the outfits in resources/characters/wardrobe: `python resources/build/build_wardrobe.py --assets FOLDER`.

See resources/build/README.md for what has to be installed.
"""

from __future__ import annotations

import argparse
import os
import struct
from pathlib import Path

# One thread keeps the order of summation, so that a second build is identical to the bit.
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
from build_characters import CHARACTERS, CHARACTERS_FOLDER, META, Character
from character_anatomy import load_person
from character_breath import add_breath
from character_garments import measure
from character_glb import Material, write_character
from character_shoes import shoes
from character_skeleton import fit_skeleton
from character_skin import skin_layout
from character_source import Source, load_model
from pygltflib import GLTF2, Buffer
from wardrobe_atlas import CLOTH_MEAN_LINEAR, atlas_textures, write_atlas
from wardrobe_made import write_record
from wardrobe_outfits import OUTFITS, Outfit, Pieces
from wardrobe_pieces import Wearer

LEAST_BREATH_M = 5e-4
WEARERS = {"man": "man_adult", "woman": "woman_adult"}


def _materials(outfit: Outfit, folder: Path) -> dict[str, Material]:
    colour_texture, normal_texture, orm_texture = atlas_textures(folder)
    found = {
        name: Material(
            tuple(min(1.0, channel / CLOTH_MEAN_LINEAR) for channel in colour),
            1.0,
            two_sided=True,
            colour_texture=colour_texture,
            normal_texture=normal_texture,
            orm_texture=orm_texture,
        )
        for name, colour in outfit.colours.items()
    }
    return found | {"skin": Material((0.8, 0.5, 0.4), 0.6)}


def build(outfit: Outfit, pieces: Pieces, wearer: Wearer, path: Path) -> None:
    """Write one outfit as fitted to a bundled body."""
    surfaces = {surface.name: (surface, slot) for surface, slot in pieces}
    materials = _materials(outfit, path.parent)
    used = {name for surface, _ in surfaces.values() for name in surface.triangles}
    tints = {name: name.removeprefix("cloth_") for name in outfit.colours if name in used}
    about = {
        "id": outfit.id,
        "title": {"en": outfit.title[0], "ja": outfit.title[1]},
        "body": wearer.name,
        "parts": {name: slot for name, (_, slot) in surfaces.items()},
        "hides": list(outfit.hides),
        "tints": tints,
        "means": dict.fromkeys(tints, CLOTH_MEAN_LINEAR),
    }
    meta = META | {"name": f"Suisou {outfit.title[0].lower()}"}
    parts = [surface for surface, _ in surfaces.values()]
    names = [part.name for part in parts]
    write_character(path, wearer.fit, wearer.positions, parts, materials, meta, {"outfit": about}, compact=names)
    add_breath(path, LEAST_BREATH_M)


def share_buffer(paths: list[Path], shared: Path) -> None:
    """Move the files' binary data to separate files, each part once, since outfits share jackets and trousers."""
    data, starts, documents = bytearray(), dict[bytes, int](), []
    for path in paths:
        gltf = GLTF2().load(str(path))
        blob = gltf.binary_blob()
        for view in gltf.bufferViews:
            start = view.byteOffset or 0
            part = bytes(blob[start : start + view.byteLength])
            if part not in starts:
                data.extend(b"\0" * (-len(data) % 4))
                starts[part] = len(data)
                data.extend(part)
            view.byteOffset = starts[part]
        documents.append(gltf)
    for path, gltf in zip(paths, documents, strict=True):
        gltf.set_binary_blob(b"")
        for accessor in gltf.accessors:
            if accessor.bufferView is None:
                accessor.byteOffset = None
        gltf.buffers = [Buffer(uri=shared.name, byteLength=len(data))]
        text = gltf.to_json(separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        head = struct.pack("<4sII", b"glTF", 2, 20 + len(text)) + struct.pack("<I4s", len(text), b"JSON")
        path.write_bytes(head + text)
    shared.write_bytes(bytes(data))


def wearer_of(character: Character, source: Source, assets: Path) -> Wearer:
    """Prepare a bundled body for its clothes, standing on its own shoes."""
    fit = fit_skeleton(source)
    tailoring = measure(source, fit)
    soles = shoes(tailoring, fit)
    floor = float(fit.to_t_pose(soles.positions, soles.weights)[:, 1].min())
    layout = skin_layout(source.uvs, source.groups["body"].uvs)
    positions = fit.positions_t - np.array([0.0, floor, 0.0])
    return Wearer(character.name, character.shirt, source, fit, tailoring, layout, assets, positions)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--to", type=Path, default=CHARACTERS_FOLDER / "wardrobe", help="folder the files go to")
    parser.add_argument("--assets", type=Path, required=True, help="folder with MakeHuman's assets")
    arguments = parser.parse_args()
    write_atlas(arguments.assets, arguments.to)
    model = load_model()
    for character in CHARACTERS:
        wearer = wearer_of(character, load_person(model, character.phenotype), arguments.assets)
        for outfit in OUTFITS:
            for ending, pieces in outfit.pieces.items():
                if WEARERS[ending] == character.name:
                    path = arguments.to / f"{outfit.id}_{ending}.glb"
                    build(outfit, pieces(wearer), wearer, path)
        for ending in (name for name, body in WEARERS.items() if body == character.name):
            share_buffer(sorted(arguments.to.glob(f"*_{ending}.glb")), arguments.to / f"{ending}.bin")
    write_record(Path(__file__), arguments.to)
    for path in sorted(arguments.to.iterdir()):
        print(f"{path} {path.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
