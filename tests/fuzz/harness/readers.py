"""Targets of attacks: one function for each kind of file, which reads it as the program does and checks the result.

A reader may raise `AppError`, which is a refusal. `Broken` says that a promise was broken after the file was accepted;
any other exception has escaped. Imports are inside, so that a process loads only what it attacks.
"""

from __future__ import annotations

import hashlib
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from app.errors import AppError
from tests.fuzz.harness import mutators, own_files, scores, seeds
from tests.fuzz.harness.costly_projects import base
from tests.fuzz.harness.mutators import Mutator
from tests.fuzz.harness.own_readers import answers, cuts, evaluation_key, exported, keyframes


class Broken(AssertionError):
    """An accepted file whose result is unusable."""


class Refused(Exception):
    """A refusal other than `AppError`, for example by the plug-in for Unreal."""


@contextmanager
def accepted(step: str) -> Iterator[None]:
    """Fail if a step after the reading refuses the data: the refusal comes too late."""
    try:
        yield
    except AppError as error:
        raise Broken(f"{step}: {error}") from error


def require(holds: bool, what: str) -> None:
    """Raise `Broken` if a condition does not hold."""
    if not holds:
        raise Broken(what)


# Music


def notation(path: Path, folder: Path) -> None:
    """Do with a score what is done with a MIDI file."""
    midi(path, folder)


def midi(path: Path, folder: Path) -> None:
    """Import, save, load, plan; write as MIDI; or read again into a piece that is open."""
    from app.project.importing import import_project, usual_rows
    from app.project.midi_out import export_midi
    from app.project.reimport import reimported
    from app.score.read import read_contents
    from instrument_maps.load import bundled_maps
    from tests.fuzz.test_score_bytes import check

    maps = bundled_maps()
    contents = read_contents(path)
    project = import_project(contents, usual_rows(contents, maps), maps, str(path))
    check(project.score)
    _saves_and_plays(project, folder)
    with accepted("write as MIDI"):
        export_midi(project, folder / "out.mid", maps)
    with accepted("read again"):
        assert reimported(project, path, maps).project is project
        again = reimported(_quartet(), path, maps).project
    with accepted("save what was read again"):
        _saved(again, folder)


def _quartet() -> Any:
    from app.project.model import map_choices, project_from_score
    from app.score.read import read_midi
    from instrument_maps.load import bundled_maps

    global _QUARTET
    if _QUARTET is None:
        maps = bundled_maps()
        score = read_midi(seeds.ROOT / "resources/examples/quartet.mid", maps=map_choices(maps.values()))
        _QUARTET = project_from_score(score, maps)
    return _QUARTET


_QUARTET: Any = None


def project(path: Path, folder: Path) -> None:
    """Load, save, load, plan."""
    from app.project import storage

    _saves_and_plays(storage.load(path), folder)


def _saves_and_plays(project: Any, folder: Path) -> None:
    from app.performance.ensemble import Performance

    with accepted("save and load"):
        _saved(project, folder)
    Performance(project).prepare()


def performed(path: Path, folder: Path) -> None:
    """Load, save, load and plan a project, and see its first performers at its beginning, middle and end."""
    from app.performance.cast import performers_of
    from app.performance.ensemble import Performance
    from app.performance.motion import performance_curves
    from app.performance.span import whole_span
    from app.project import storage

    project = storage.load(path)
    with accepted("save and load"):
        _saved(project, folder)
    performance = Performance(project)
    performance.prepare()
    fps = project.fps
    count = whole_span(performance.time_frame, fps).count
    # The others are made later, each when it is seen.
    for performer in performers_of(performance, project.bodies[:_SEEN_PERFORMERS]).made.values():
        playing = performance_curves(performance, performer)
        for first in (0, count // 2, count - 1):
            playing.motion(fps, first, min(_SEEN_FRAMES, count - first))


_SEEN_FRAMES, _SEEN_PERFORMERS, _SEEN_DANCERS = 30, 3, 1


def danced(path: Path, folder: Path) -> None:
    """Load a project with dancers, and see the first of them for a moment."""
    from app.choreography.performed.dancers import dancing_of
    from app.performance.ensemble import Performance
    from app.project import storage

    performance = Performance(storage.load(path))
    for dancer in performance.project.dancers[:_SEEN_DANCERS]:
        dancing = dancing_of(performance, dancer)
        dancing.motion(performance.project.fps, 0, _SEEN_FRAMES)


def piece_metadata(path: Path, folder: Path) -> None:
    """Load metadata of another piece into a project, plan the project and save it."""
    from app.performance.ensemble import Performance
    from app.project.piece_metadata import load_metadata, with_metadata

    project = with_metadata(base(), load_metadata(path)).project
    Performance(project).prepare()
    with accepted("save what was loaded"):
        _saved(project, folder)


def inspected(path: Path, folder: Path) -> None:
    """The whole report of a MIDI file, contacts included."""
    from app.cli.inspect import inspection
    from app.cli.inspect_tables import tables
    from app.performance.ensemble import Performance
    from app.project.model import map_choices, project_from_score
    from app.score.read import read_midi
    from instrument_maps.load import bundled_maps

    maps = bundled_maps()
    score = read_midi(path, maps=map_choices(maps.values()))
    tables("file", inspection(Performance(project_from_score(score, maps))))


def _saved(project: Any, folder: Path) -> None:
    from app.project import storage

    storage.save(project, folder / "saved.suisou")
    require(storage.load(folder / "saved.suisou") == project, "a saved project is another one when it is loaded")


def autosave(path: Path, folder: Path) -> None:
    """Search and describe unsaved work of ended editors, whatever its content."""
    from app.project import storage
    from app.project.recovery import recoverable, recoverable_of

    document = folder / "work.suisou"
    if not document.exists():
        document.write_bytes(seeds.project()[-1])
    (folder / f"work.suisou{storage.AUTOSAVE}").write_bytes(path.read_bytes())
    (folder / "0123456789abcdef.suisou").write_bytes(path.read_bytes())
    with accepted("look for unsaved work"):
        recoverable_of(document, folder)
        recoverable(folder)


def presence(path: Path, folder: Path) -> None:
    """Search traces of ended editors, whatever their content."""
    from app.project.recovery import recoverable
    from app.project.running_editors import LOCK, NOTE

    token = "0123456789abcdef"
    (folder / "work.suisou").write_bytes(seeds.project()[-1])
    (folder / f"{token}{LOCK}").write_bytes(b"")
    (folder / f"{token}{NOTE}").write_bytes(path.read_bytes().replace(b"@", str(folder).encode()))
    with accepted("look for unsaved work"):
        recoverable(folder)


def journal(path: Path, folder: Path) -> None:
    """A journal becomes takes, which are cleaned, brought into the part and saved."""
    from app.capture.journal import read_journal
    from app.capture.journal_to_takes import takes_of
    from app.capture.loop_passes import passes
    from app.project.edit.takes import add_takes, comp_whole
    from app.score.take import ControllerMapping

    read = read_journal(path)
    passes(read)
    project = _quartet()
    player = project.players[0].id
    takes = takes_of(read, project.score.tempo_map, ControllerMapping(), "Take {number}")
    project, ids = add_takes(project, player, takes)
    for id_ in ids[:2]:
        project = comp_whole(project, player, id_)
    with accepted("save the takes"):
        _saved(project, folder)


def clip(path: Path, folder: Path) -> None:
    """Paste notes from another program's clipboard into a project and save it."""
    from app.project.edit.notes import paste, read_clip

    notes = read_clip(path.read_bytes())
    if notes is None:
        raise Refused("no notes")
    project, _ = paste(_quartet(), _quartet().players[0].part_id, notes, 960)
    with accepted("save what was pasted"):
        _saved(project, folder)


# Tables


def instrument_map(path: Path, folder: Path) -> None:
    """Read a map in a user's folder or set it aside; other maps are unaffected."""
    from instrument_maps.library import LIBRARY
    from instrument_maps.load import bundled_maps, check_map

    own = folder / "own"
    own.mkdir(exist_ok=True)
    for name in ("trumpet_Bb", "recorder_soprano_C"):
        (own / f"{name}.toml").write_bytes(path.read_bytes())
    with accepted("read the folder"):
        library = LIBRARY.read(own)
    require(set(bundled_maps()) <= set(library.maps), "a bundled instrument is gone")
    check_map(own / "trumpet_Bb.toml")


def metadata(path: Path, folder: Path) -> None:
    """Every reader of a table of metadata; the refusal is that of the last."""
    from metadata import load

    readers = (
        *(load.read_controller, load.read_expression, load.read_skeleton, load.read_bone_names),
        *(load.read_face_names, load.read_body),
    )
    refusal: AppError | None = None
    for read in readers:
        try:
            read(path)
        except AppError as error:
            refusal = error
    if refusal is not None:
        raise refusal


def expression(path: Path, folder: Path) -> None:
    """A user's expressions: a bad one is reported and the others stay."""
    from app.project.presets import expressions

    _one_of_folder(expressions, path, folder, seeds.expression()[0])


def preset(path: Path, folder: Path) -> None:
    """A user's presets: a bad one is reported and the others stay."""
    from app.project.presets import presets

    _one_of_folder(presets, path, folder, b'name = "Another"\namplitude = 1.0\n')


def _one_of_folder(read: Callable[[Path], Any], path: Path, folder: Path, good: bytes) -> None:
    own = folder / "own"
    own.mkdir(exist_ok=True)
    (own / "a.toml").write_bytes(path.read_bytes())
    (own / "b.toml").write_bytes(good)
    with accepted("read the folder"):
        found = read(own)
    require(len(found.items) >= 1, "a good file beside a bad one is not read")


def character_entry(path: Path, folder: Path) -> None:
    """A user's characters: a bad entry is reported and the others stay."""
    from app.rig.characters.character_library import LIBRARY, bundled_characters

    own = folder / "own"
    own.mkdir(exist_ok=True)
    (own / "figure.glb").write_bytes(b"glTF")
    (own / "another.toml").write_bytes(path.read_bytes())
    (own / "other.toml").write_bytes(b'file = "figure.glb"\n')
    with accepted("read the folder"):
        library = LIBRARY.read(own)
    require(set(bundled_characters()) | {"other"} <= set(library.sources), "a character is gone")


def settings(path: Path, folder: Path) -> None:
    """Every setting has a value, whatever the file says."""
    from app.editor.settings import Settings

    found = Settings(path)
    for name, member in vars(Settings).items():
        if hasattr(member, "__get__"):
            getattr(found, name)
    found.shortcut("edit.undo")
    found.midi_device("EWI USB", "latency_s")
    found.add_recent(Path("/tmp/x.suisou"))
    found.sync()


# Figures


def gltf(path: Path, folder: Path) -> None:
    """Read a character's file and convert it to a character, or refuse it."""
    from app.rig.characters.load_character import load_character

    load_character(path)


def instrument_model(path: Path, folder: Path) -> None:
    """The model of a user's own map."""
    from instrument_maps.check_model import model_problems
    from instrument_maps.load import bundled_maps

    list(model_problems(bundled_maps()["recorder_soprano_C"], path))


def fbx(path: Path, folder: Path) -> None:
    """Our own reader of FBX."""
    from app.formats.fbx.read import read_scene

    read_scene(path)


def foreign_fbx(path: Path, folder: Path) -> None:
    """The reader of other programs' FBX, up to a character."""
    from app.rig.characters.load_character import load_character

    load_character(path)


def bvh(path: Path, folder: Path) -> None:
    """BVH clips."""
    from app.formats.bvh.read import read_bvh

    read_bvh(path)


def motion(path: Path, folder: Path) -> None:
    """Read BVH clips of a body, up to learning from them."""
    import numpy as np

    from app.choreography.cuts import segment
    from app.choreography.features import features
    from app.choreography.learn import FPS
    from app.choreography.read_motion import guesses, read_motion
    from app.choreography.resample import resampled

    read = read_motion(path)
    guesses(read)
    clip = resampled(read.clip, FPS)
    require(bool(np.isfinite(features(clip, segment(clip).cuts)).all()), "a feature is not finite")


def gltf_motion(path: Path, folder: Path) -> None:
    """The same of an animated glTF file."""
    motion(path, folder)


def fbx_motion(path: Path, folder: Path) -> None:
    """The same of an animated FBX file."""
    motion(path, folder)


def choreography(path: Path, folder: Path) -> None:
    """A learned choreography."""
    from app.choreography.model_file import read_model

    read_model(path)


def audio(path: Path, folder: Path) -> None:
    """A recording in memory."""
    from app.audio.decode import decode

    recording = decode(str(path))
    require(recording.samples.ndim == 2 and recording.samples.shape[1] == 2, "samples are not in two channels")


def followed(path: Path, folder: Path) -> None:
    """Listen to a recording for all that it can say of a piece."""
    from app.audio.decode import decode
    from app.audio.followed_recording import FollowOptions, listen

    listen(_quartet(), decode(str(path)).samples, path, FollowOptions(notes=True, dynamics=True))


def film(path: Path, folder: Path) -> None:
    """Look at a film, see pictures at its beginning, middle and end, and hear its sound."""
    from app.audio.decode import decode
    from app.formats.video import video_facts, video_pictures

    facts = video_facts(str(path))
    size = facts.fitted(96, 96)
    count = max(round(facts.duration_s * facts.rate), 1)
    for first in (0, count // 2, count - 1):
        with video_pictures(str(path), facts.rate, size, first) as pictures:
            for _ in range(_SEEN_FRAMES):
                picture = pictures.read()
                require(picture is None or picture.shape == (size[1], size[0], 3), "a picture has another size")
    if facts.has_sound:
        decode(str(path))


# Unreal


def unreal_description(path: Path, folder: Path) -> None:
    """The plug-in's reader, as it runs in Unreal's own Python."""
    from tests.support.fake_unreal import fake_unreal

    if "unreal" not in sys.modules:
        sys.modules["unreal"] = fake_unreal(folder)
    plugin = str(seeds.ROOT / "resources/unreal/Suisou/Content/Python")
    if plugin not in sys.path:
        sys.path.append(plugin)
    from suisou_import import performance
    from suisou_import.problem import Problem

    (folder / performance.DESCRIPTION).write_bytes(path.read_bytes())
    try:
        performance.read(folder)
    except Problem as problem:
        raise Refused(str(problem)) from problem


def unreal_manifest(path: Path, folder: Path) -> None:
    """The list of our files in an Unreal project, and what becomes of them."""
    from app.export.unreal.layout import MANIFEST
    from app.export.unreal.manifest import changes

    (folder / MANIFEST).write_bytes(path.read_bytes())
    changes(folder, [])


def unreal_project(path: Path, folder: Path) -> None:
    """Unreal's project file."""
    from app.export.unreal.project import find_project

    find_project(path)


# The table


@dataclass(frozen=True)
class Kind:
    """A kind of file.

    Attributes
    ----------
    group : str
        Kinds of a group are attacked by one process.
    read : callable
        Takes the file and a folder of its own.
    seeds : callable
        Good files.
    structured : tuple of Mutator
    suffix : str
    share : float
        Of the group's time, beside the others'.
    """

    group: str
    read: Callable[[Path, Path], None]
    seeds: Callable[[], list[bytes]]
    structured: tuple[Mutator, ...]
    suffix: str
    share: float = 1.0

    @property
    def name(self) -> str:
        """Name of the kind and of the folder of its found files."""
        return self.read.__name__


_TEXT, _JSON = tuple(mutators.TEXT), tuple(mutators.JSON)
KINDS: Final[dict[str, Kind]] = {
    kind.name: kind
    for kind in (
        Kind("midi", midi, seeds.midi, tuple(mutators.MIDI), ".mid", 2.0),
        Kind("midi", notation, scores.seeds, _TEXT, ".musicxml", 2.0),
        Kind("midi", inspected, seeds.inspected, tuple(mutators.MIDI), ".mid"),
        Kind("project", project, seeds.project, _JSON, ".suisou", 3.0),
        Kind("project", performed, seeds.performed, _JSON, ".suisou"),
        Kind("project", danced, seeds.danced, _JSON, ".suisou", 0.5),
        Kind("project", piece_metadata, seeds.piece_metadata, _TEXT, ".toml"),
        Kind("project", autosave, seeds.autosave, _JSON, ".suisou"),
        Kind("project", presence, seeds.presence, _JSON, ".json"),
        Kind("project", journal, seeds.journal, _TEXT, ".take-journal"),
        Kind("project", clip, seeds.clip, _JSON, ".json"),
        Kind("project", choreography, seeds.choreography, _JSON, ".choreography"),
        Kind("tables", instrument_map, seeds.instrument_map, _TEXT, ".toml", 2.0),
        Kind("tables", metadata, seeds.metadata, _TEXT, ".toml"),
        Kind("tables", expression, seeds.expression, _TEXT, ".toml"),
        Kind("tables", preset, seeds.preset, _TEXT, ".toml"),
        Kind("tables", character_entry, seeds.character_entry, _TEXT, ".toml"),
        Kind("tables", settings, seeds.settings, _TEXT, ".toml"),
        Kind("figures", gltf, seeds.gltf, tuple(mutators.GLB), ".glb", 2.0),
        Kind("figures", instrument_model, seeds.gltf, tuple(mutators.GLB), ".glb"),
        Kind("figures", fbx, seeds.fbx, tuple(mutators.FBX), ".fbx", 2.0),
        Kind("figures", foreign_fbx, seeds.foreign_fbx, (*mutators.FBX, *mutators.TEXT), ".fbx"),
        Kind("motion", bvh, seeds.bvh, _TEXT, ".bvh"),
        Kind("motion", motion, seeds.motion, _TEXT, ".bvh", 2.0),
        Kind("motion", gltf_motion, seeds.gltf_motion, tuple(mutators.GLB), ".glb"),
        Kind("motion", fbx_motion, seeds.fbx_motion, tuple(mutators.FBX), ".fbx"),
        Kind("motion", keyframes, own_files.keyframes, _TEXT, ".bvh"),
        Kind("motion", cuts, own_files.cuts, _TEXT, ".txt", 0.5),
        Kind("exchange", evaluation_key, own_files.evaluation_key, _JSON, ".json"),
        Kind("exchange", answers, own_files.answers, _TEXT, ".csv"),
        Kind("exchange", exported, own_files.exported, _JSON, ".json", 0.5),
        Kind("exchange", audio, seeds.audio, (), ".wav", 2.0),
        Kind("exchange", followed, seeds.audio, (), ".wav", 0.5),
        Kind("exchange", film, seeds.film, (), ".mp4"),
        Kind("exchange", unreal_description, seeds.unreal_description, _JSON, ".json"),
        Kind("exchange", unreal_manifest, seeds.unreal_manifest, _JSON, ".json"),
        Kind("exchange", unreal_project, seeds.unreal_project, _JSON, ".uproject"),
    )
}
GROUPS: Final = tuple(dict.fromkeys(kind.group for kind in KINDS.values()))


def digest(data: bytes) -> str:
    """A short name of a content."""
    return hashlib.blake2b(data, digest_size=5).hexdigest()


@contextmanager
def scratch() -> Iterator[Path]:
    """A folder for one file and whatever its reader leaves."""
    with tempfile.TemporaryDirectory(prefix="suisou-fuzz-") as name:
        yield Path(name)
