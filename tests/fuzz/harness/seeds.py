"""Good files of every format, small, from which mutants are made; and every file that ever broke a reader.

A found file lies in ``tests/data/hostile/<kind>/``. One that is better made than kept (long, but regular) is a row of
`MADE`.
"""

from __future__ import annotations

import io
import json
import re
import tempfile
from collections.abc import Callable
from fractions import Fraction
from functools import cache, partial
from pathlib import Path
from typing import Any, Final

import numpy as np
import soundfile

from app.formats.scene import Scene
from tests.fuzz.harness.costly import costly
from tests.fuzz.harness.costly_midi import COSTLY, WORST
from tests.fuzz.harness.costly_projects import DANCES, base, costly_metadata
from tests.fuzz.harness.costly_projects import encoded as encoded_project
from tests.support import encoded
from tests.support.media import ffmpeg

ROOT: Final = Path(__file__).parents[3]
DATA: Final = ROOT / "tests" / "data"
HOSTILE: Final = DATA / "hostile"
MOST_BYTES: Final = 20_000
"""Usual greatest size of a seed in bytes, since damage to small files reaches more of the readers' code."""


def found_files(kind: str) -> tuple[Path, ...]:
    """Every file that once broke a reader of this kind."""
    folder = HOSTILE / kind
    return tuple(sorted(path for path in folder.iterdir() if path.is_file())) if folder.is_dir() else ()


def _files(pattern: str, most_bytes: int = MOST_BYTES) -> list[bytes]:
    return [path.read_bytes() for path in sorted(ROOT.glob(pattern)) if path.stat().st_size <= most_bytes]


def midi() -> list[bytes]:
    """Small files of ensembles, odd ones, corrupt ones."""
    return [*_files("tests/data/midi/*/*.mid", 6000), *_files("resources/examples/*.mid")]


def project() -> list[bytes]:
    """One of every version of the format."""
    return _files("tests/data/projects/*.suisou")


def performed() -> list[bytes]:
    """A trumpet's few notes."""
    return [encoded_project(base())]


def danced() -> list[bytes]:
    """A dancer to a trumpet's few notes."""
    return [encoded_project(DANCES["dancers"](1))]


def piece_metadata() -> list[bytes]:
    """The acting of a piece, of two players."""
    return [costly_metadata(900)]


def inspected() -> list[bytes]:
    """Small files of ensembles."""
    return _files("tests/data/midi/*/*.mid", 1000)[:12]


def autosave() -> list[bytes]:
    """Unsaved work as it is written now, and as it was."""
    from app.project import storage

    path = DATA / "projects" / "version_5.suisou"
    facts = storage.Autosaved("work", 3, "0123456789abcdef", "/music/work.suisou", "0" * 64)
    return [storage.encode_autosave(storage.load(path), path, facts), *project()]


def journal() -> list[bytes]:
    """A take of two passes, with a gap; one torn off."""
    header = {
        "project": "/music/work.suisou", "player": "p1", "port": "EWI USB", "controller": "ewi_usb",
        "latency_s": 0.01, "started": "2025-01-01T12:00:00+00:00", "version": 1,
    }  # fmt: skip
    rows = [json.dumps(header), "s 1000000000 0.000000 0"]
    for number in range(12):
        begin = 1_100_000_000 + number * 250_000_000
        rows += [f"e {begin} 90{60 + number % 5:02x}50", f"e {begin + 10_000_000} b002{40 + number:02x}"]
        rows.append(f"e {begin + 200_000_000} 80{60 + number % 5:02x}00")
        if number == 5:
            rows += [f"lost {begin + 210_000_000}", f"back {begin + 220_000_000}", f"s {begin + 230_000_000} 0.5 1"]
    whole = "\n".join([*rows, "s 5000000000 2.5 1", "end 5100000000"]) + "\n"
    return [whole.encode(), "\n".join(rows).encode()]


def presence() -> list[bytes]:
    """Return files in which an editor records its open document and autosave; ``@`` stands for the folder."""
    return [
        json.dumps({"pid": 1, "document": document, "autosave": autosave}).encode()
        for document, autosave in (("", ""), ("@/work.suisou", "@/work.suisou.autosave"), ("", "@/token.suisou"))
    ]


def clip() -> list[bytes]:
    """Notes on the clipboard."""
    notes = [{"offset_tick": tick, "duration_tick": 240, "pitch": 60, "velocity": 80} for tick in (0, 480, 960)]
    lines = [{"part_id": "1.1.1", "notes": notes}, {"part_id": "x", "notes": notes[:1]}]
    return [json.dumps({"ticks_per_quarter": 480, "lines": lines[:count]}).encode() for count in (1, 2)]


def instrument_map() -> list[bytes]:
    """Small maps, and one that extends another."""
    own = b'extends = "trumpet_Bb"\nid = "trumpet_Bb"\nfingerings = [\n  [60, "0"],\n]\n[name]\nen = "Mine"\nja = "X"\n'
    return [own, *_files("instrument_maps/recorder_*.toml"), *_files("instrument_maps/trumpet_Bb.toml", 30_000)]


def metadata() -> list[bytes]:
    """Tables of every kind."""
    return _files("metadata/*/*.toml")


def expression() -> list[bytes]:
    """Expressions as a user saves them."""
    return _files("metadata/expressions/*.toml")


def preset() -> list[bytes]:
    """Presets of players' parameters."""
    return [b'name = "Calm"\namplitude = 0.5\n', b'name = "Lively"\namplitude = 1.5\nposture = "standing"\n']


def character_entry() -> list[bytes]:
    """Return files that describe a user's own character."""
    return [
        b'file = "figure.glb"\n',
        b'file = "figure.glb"\ntitle = "Another figure"\n\n[joints]\nhips = "Hips"\nleftHand = ""\n\n'
        b"[morphs.jawOpen]\nopen = 1.0\nwide = -0.5\n",
    ]


def settings() -> list[bytes]:
    """The editor's settings."""
    return [
        b'[interface]\nlanguage = "ja"\ntheme = "dark"\ntime_display = "bars"\n\n[interface.folded]\nnotes = true\n\n'
        b'[sound]\nvolume = 0.5\nclick = true\nsource = "both"\n\n[midi]\nport = "EWI USB"\ncount_in_bars = 2\n\n'
        b'[stream]\nhost = "127.0.0.1"\nport = 39539\neveryone = false\nrate_hz = 60\n\n'
        b'[window]\ngeometry = "AdnQywADAAA="\nlayout = "AAAA/wAA"\ntimeline = "{\\"order\\": [\\"roll\\"]}"\n\n'
        b'[files]\nfolder = "/tmp"\nrecent = ["/tmp/a.suisou", "file:///tmp/%FF.mid"]\n\n'
        b'[shortcuts]\n"edit.undo" = "Ctrl+Z"\n\n[midi_devices."EWI USB"]\nlatency_s = "0.01"\n\n'
        b"[pitch]\nwritten = true\nmiddle_c_octave = 3\nnames = 'german'\n",
    ]


@cache
def gltf() -> list[bytes]:
    """A skinned figure with morphs, and as text with its data inside; a small whole character."""
    from tests.unit.formats.gltf.test_read import character

    return [character().glb(), *_files("tests/data/characters/*.glb", 200_000)]


@cache
def fbx() -> list[bytes]:
    """An instrument and a character as they are exported."""
    from tests.support.encoded import encode_scene
    from tests.unit.formats import scenes

    return [
        encode_scene(scenes.instrument(Fraction(24), frames=5)),
        encode_scene(scenes.character(Fraction(24), frames=3)),
    ]


@cache
def foreign_fbx() -> list[bytes]:
    """FBX files as other programs write them: here too as ours, which that reader takes; and one in ASCII."""
    ascii_file = (
        b"; FBX 7.3.0 project file\nFBXHeaderExtension:  {\n\tFBXVersion: 7300\n}\nObjects:  {\n"
        b'\tModel: 10, "Model::Hips", "LimbNode" {\n\t\tProperties70:  {\n'
        b'\t\t\tP: "Lcl Translation", "Lcl Translation", "", "A",0,100,0\n\t\t}\n\t}\n'
        b'\tGeometry: 11, "Geometry::", "Mesh" {\n\t\tVertices: *9 {\n\t\t\ta: 0,0,0,1,0,0,0,1,0\n\t\t}\n'
        b'\t\tPolygonVertexIndex: *3 {\n\t\t\ta: 0,1,-3\n\t\t}\n\t}\n}\nConnections:  {\n\tC: "OO",10,0\n}\n'
    )
    return [ascii_file, *fbx()]


@cache
def bvh() -> list[bytes]:
    """A short clip."""
    from tests.support.encoded import encode_bvh
    from tests.unit.formats.test_bvh import clip

    return [encode_bvh(clip(frames=3))]


@cache
def motion() -> list[bytes]:
    """A whole body."""
    from tests.unit.choreography.test_read_motion import bvh as body

    return [body(np.eye(3), 0.01).encode()]


@cache
def gltf_motion() -> list[bytes]:
    """A whole body in glTF."""
    return [encoded.encode_glb(_dance())]


@cache
def fbx_motion() -> list[bytes]:
    """A whole body in FBX."""
    return [encoded.encode_scene(_dance())]


def _dance() -> Scene:
    from tests.support.dances import moving
    from tests.unit.rig.test_node_motion import scene_of

    return scene_of(moving(20), 1)


@cache
def choreography() -> list[bytes]:
    """Return the file of a choreography model learned from two short clips."""
    from tests.unit.choreography.test_model_file import CONTENT

    return [CONTENT]


@cache
def audio() -> list[bytes]:
    """A tenth of a second in every format that is read."""
    samples = 0.3 * np.sin(np.arange(2205) * 0.1)
    found = []
    for format_, subtype in (
        *(("WAV", subtype) for subtype in ("PCM_16", "PCM_24", "FLOAT", "PCM_U8", "IMA_ADPCM")),
        *(("FLAC", "PCM_16"), ("OGG", "VORBIS"), ("OGG", "OPUS"), ("AIFF", "PCM_16"), ("MP3", "MPEG_LAYER_III")),
    ):
        stream = io.BytesIO()
        rate_hz = 24_000 if subtype == "OPUS" else 22_050
        soundfile.write(stream, np.stack([samples, -samples], axis=1), rate_hz, format=format_, subtype=subtype)
        found.append(stream.getvalue())
    return [*found, *_media("m4a", "aac", "mkv"), *_media("mp3", options=("-write_xing", "0"))]


@cache
def film() -> list[bytes]:
    """Some pictures with sound in every container that is read."""
    pictures = ("-f", "lavfi", "-i", "testsrc=s=32x32:r=25:d=0.4")
    return _media("mp4", "mkv", "webm", "avi", "mpg", "wmv", options=pictures)


def _media(*kinds: str, options: tuple[str, ...] = ()) -> list[bytes]:
    """Half a second of a tone, as ffmpeg writes it with such suffixes."""
    with tempfile.TemporaryDirectory(prefix="suisou-fuzz-") as folder:
        paths = [Path(folder) / f"a.{kind}" for kind in kinds]
        for path in paths:
            ffmpeg("-f", "lavfi", "-i", "sine=440:d=0.5", *options, "-fflags", "+bitexact", str(path))
        return [path.read_bytes() for path in paths]


def unreal_description() -> list[bytes]:
    """Return the description that an export for Unreal Engine writes."""
    root, place = "/Game/Suisou/Piece", {"x_cm": 0.0, "y_cm": 1.5, "z_cm": 0.0, "yaw_deg": 90.0}

    def figure(kind: str, name: str) -> dict[str, Any]:
        assets = {key: f"{root}/{kind}/{name}/{prefix}_{name}" for key, prefix in _ASSETS.items()}
        return {"file": f"{kind}/{name}.fbx", "bones": ["root", "hips"], **assets}

    content = {
        "schema": 3, "piece": "Piece", "title": "A piece", "content": root, "sequence": f"{root}/LS_Piece",
        "rate": {"numerator": 60, "denominator": 1}, "frames": 100,
        "sound": {"file": "Audio/S_Piece.wav", "asset": f"{root}/Audio/S_Piece", "offset_s": 0.0, "duration_s": 1.6},
        "players": [{
            "name": "Trumpet 1", "instrument_id": "trumpet_Bb", "place": place,
            "character": figure("Characters", "Trumpet_1"), "instrument": figure("Instruments", "Trumpet_1"),
            "doubles": [{
                "name": "Flugelhorn", "instrument_id": "flugelhorn_Bb",
                "instrument": figure("Instruments", "Flugelhorn"),
            }],
        }],
        "dancers": [{"name": "Dancer 1", "place": place, "character": figure("Characters", "Dancer_1")}],
        "bars": [{"number": 1, "frame": 0}, {"number": 2, "frame": 60}],
        "markers": [{"text": "A", "bar": 2, "frame": 60}],
        "files": {
            name: {"bytes": 10, "sha256": "0" * 64}
            for name in (
                "Characters/Trumpet_1.fbx", "Instruments/Trumpet_1.fbx", "Instruments/Flugelhorn.fbx",
                "Characters/Dancer_1.fbx", "Audio/S_Piece.wav",
            )
        },
    }  # fmt: skip
    return [json.dumps(content, indent=1).encode()]


_ASSETS = {"mesh": "SK", "skeleton": "SKEL", "animation": "A"}


def unreal_manifest() -> list[bytes]:
    """The list of the files that are ours in an Unreal project."""
    from app.export.unreal.manifest import OwnFile, encode_manifest

    return [encode_manifest({"Audio/S_Piece.wav": OwnFile(10, "0" * 64)}, "Suisou")]


def unreal_project() -> list[bytes]:
    """Unreal's own project file."""
    content = {
        "FileVersion": 3,
        "EngineAssociation": "5.6",
        "Plugins": [{"Name": "PythonScriptPlugin", "Enabled": True}],
    }
    text = json.dumps(content)
    return [text.encode(), text.encode("utf-16")]


# Hostile files that are better made than kept


def _nested_gltf() -> bytes:
    nodes = [{"children": [number + 1]} for number in range(5000)] + [{"name": "last"}]
    return json.dumps({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": nodes}).encode()


def _huge_tick(content: bytes) -> bytes:
    return re.sub(rb'"(start_tick|tick)": *\d+', rb'"\1": ' + b"9" * 400, content, count=1)


_TABLES: dict[str, Callable[[], bytes]] = {
    "deep": lambda: b"a = " + b"[" * 50_000,
    "digits": lambda: b"a = " + b"9" * 6000,
    "dotted": lambda: b"a" + b".a" * 20_000 + b" = 1",
}

MADE: Final[dict[str, dict[str, Callable[[], bytes]]]] = {
    "midi": {name: partial(make, WORST.get(name, 3000)) for name, make in COSTLY.items()},
    "notation": costly("notation", 4000),
    "project": {
        "huge_tick": lambda: _huge_tick(project()[-1]),
        "deep": lambda: b"[" * 100_000,
        "deep_object": lambda: b'{"a":' * 60_000,
    },
    "performed": costly("performed", 4000),
    "danced": {name: costly("danced", 2000)[name] for name in ("dancers of hours", "forbidden motions")},
    "piece_metadata": {name: costly("piece_metadata")[name] for name in ("curves far", "variations at once")},
    "instrument_map": _TABLES,
    "expression": _TABLES,
    "preset": _TABLES,
    "character_entry": _TABLES,
    "metadata": _TABLES,
    "settings": {
        **_TABLES,
        "time": lambda: b"a = 07:32:00\nb = 1979-05-27\nc = 1979-05-27T07:32:00Z\nd = [{e = 1}]\n",
        "infinite": lambda: b"[midi]\ncount_in_bars = inf\n[sound]\nvolume = nan\n[stream]\nport = -inf\n",
        "digits_of_a_number": lambda: b"[midi]\ncount_in_bars = " + b"9" * 6000,
    },
    "gltf": {"deep": lambda: b'{"a":' * 60_000, "nested_nodes": _nested_gltf, **costly("gltf")},
    "instrument_model": costly("instrument_model"),
    "foreign_fbx": costly("foreign_fbx"),
    "fbx": costly("fbx"),
    "bvh": costly("bvh", 100_000),
    "motion": costly("motion", 30_000),
    "gltf_motion": costly("gltf_motion", 2000),
    "fbx_motion": {
        "fbx_half_an_hour": costly("fbx_motion")["fbx_half_an_hour"],
        "fbx_polygon": costly("fbx_motion", 100_000)["fbx_polygon"],
    },
    "audio": costly("audio"),
    "film": costly("film"),
    "unreal_description": {
        "deep": lambda: b"[" * 100_000,
        "infinite_bytes": lambda: unreal_description()[0].replace(b'"bytes": 10', b'"bytes": 1e999', 1),
        "infinite_frame": lambda: unreal_description()[0].replace(b'"frame": 60', b'"frame": 1e999', 1),
    },
    "unreal_manifest": {"deep": lambda: b"[" * 100_000},
    "unreal_project": {"deep": lambda: b"[" * 100_000},
    "autosave": {"huge_tick": lambda: _huge_tick(autosave()[0])},
    "journal": {"long_name": lambda: journal()[0].replace(b"EWI USB", b"E" * 20_000)},
    "clip": {
        "deep": lambda: b'{"x":' * 60_000,
        "no_resolution": lambda: clip()[0].replace(b": 480,", b": 0,", 1),
        "no_utf8": lambda: clip()[1].replace(b'"x"', b'"\xff"'),
    },
    "presence": {
        "no_file": lambda: presence()[1].replace(b"@/work.suisou", b"/"),
        "nul": lambda: presence()[1].replace(b"work", b"\\u0000"),
        "no_utf8": lambda: presence()[1].replace(b"work", b"\xff"),
        "deep": lambda: b"[" * 100_000,
    },
}
"""Functions that make seeds, by kind and name."""


def hostile(kind: str) -> dict[str, Callable[[], bytes]]:
    """Every file of a kind that ever broke a reader, by name: what returns its bytes."""
    return {**{path.name: path.read_bytes for path in found_files(kind)}, **MADE.get(kind, {})}
