"""A glTF document with separate files: allowed names, and the data read from them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Final

import pytest

from app.errors import FileError
from app.formats.gltf.container import split
from app.formats.gltf.read import read_glb
from app.formats.gltf.self_contained import read_whole
from app.rig.characters.character_library import add_character, character_library, character_named
from app.rig.characters.read_figure import read_figure

BODY: Final = Path(__file__).parents[3] / "data" / "characters" / "woman_game_engine.glb"


def apart(folder: Path, name: str = "body parts.bin", uri: str = "body%20parts.bin") -> Path:
    """A character as ``.gltf`` with its binary data in a separate file."""
    document, binary = split(BODY.read_bytes(), "body")
    assert binary is not None
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(binary)
    document["buffers"][0]["uri"] = uri
    document.setdefault("images", []).append({"uri": "no such texture.png"})
    path = folder / "body.gltf"
    path.write_text(json.dumps(document))
    return path


@pytest.mark.parametrize(
    ("name", "uri"),
    [
        ("body parts.bin", "body%20parts.bin"),
        ("体.bin", "体.bin"),
        ("a/b.bin", "a/b.bin"),
        ("a/b.bin", "./c/../a/b.bin"),
    ],
)
def test_a_document_and_its_bytes_are_one_figure(tmp_path: Path, name: str, uri: str) -> None:
    figure, expected = read_figure(apart(tmp_path, name, uri)), read_figure(BODY)
    assert figure.bone_names == expected.bone_names
    for ours, theirs in zip(figure.meshes, expected.meshes, strict=True):
        assert (ours.positions_m == theirs.positions_m).all()
        assert (ours.weights == theirs.weights).all()


def test_content_decides_not_the_suffix(tmp_path: Path) -> None:
    path = apart(tmp_path).rename(tmp_path / "body.vrm")
    assert read_figure(path).bone_names == read_figure(BODY).bone_names


def test_a_character_of_the_library_needs_no_other_file(tmp_path: Path) -> None:
    path = apart(tmp_path)
    id = add_character(path, "Of two files")
    (tmp_path / "body parts.bin").unlink()
    kept = character_library().sources[id].path
    assert read_whole(kept) == kept.read_bytes()
    assert character_named(id).meshes


OUTSIDE: Final[dict[str, Any]] = {
    "missing": "nowhere.bin",
    "a folder above": "../secret.bin",
    "a folder above, hidden": "a/%2e%2e/%2e%2e/secret.bin",
    "the root": "/etc/hostname",
    "another drive": "C:\\secret.bin",
    "backslashes": "..\\secret.bin",
    "a web address": "https://example.org/a.bin",
    "a file address": "file:///etc/hostname",
    "a link": "link.bin",
    "nothing": "a\0.bin",
    "a folder": "a",
}


@pytest.mark.parametrize("name", OUTSIDE)
def test_a_file_elsewhere_is_not_opened(tmp_path: Path, name: str) -> None:
    folder = tmp_path / "inside"
    path = apart(folder, uri=OUTSIDE[name])
    (folder / "a").mkdir()
    (tmp_path / "secret.bin").write_bytes((folder / "body parts.bin").read_bytes())
    (folder / "link.bin").symlink_to(tmp_path / "secret.bin")
    with pytest.raises(FileError) as caught:
        read_glb(path)
    assert caught.value.message.id == "gltf.external"


def test_the_same_bytes_named_often_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = apart(tmp_path)
    document = json.loads(path.read_text())
    document["buffers"] += [dict(document["buffers"][0]) for _ in range(50)]
    path.write_text(json.dumps(document))
    size = (tmp_path / "body parts.bin").stat().st_size
    monkeypatch.setattr("app.formats.gltf.self_contained.MOST_BESIDE", 20 * size)
    with pytest.raises(FileError) as caught:
        read_glb(path)
    assert caught.value.message.id == "gltf.too_large"
