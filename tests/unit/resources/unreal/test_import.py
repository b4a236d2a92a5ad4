"""Import and update in a fake editor: resulting assets, and messages to the user."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import msgspec
import pytest

from app.project.casting import StagePosition
from app.project.model import Project
from app.score.model import Marker
from tests.support.doubled import flutist
from tests.support.fake_unreal import INTERCHANGE
from tests.unit.export.unreal.conftest import quartet, renamed
from tests.unit.resources.unreal.conftest import Editor, exported

QUARTET = ("Trumpet_1", "Trumpet_2", "Trombone_1", "Trombone_2")
HELD = ("trumpet_Bb", "trumpet_Bb", "trombone_tenor_F_attachment", "trombone_tenor_F_attachment")
ROOT = "/Game/Suisou/quartet"


def description(editor: Editor, piece: str = "quartet") -> dict[str, Any]:
    path = editor.folder / "SuisouSource" / piece / "performance.json"
    content: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return content


def marked(markers: tuple[Marker, ...]) -> Project:
    project = quartet()
    return replace(project, score=msgspec.structs.replace(project.score, markers=markers))


def own_assets(editor: Editor) -> set[str]:
    """Paths of the assets named after the piece and its players, without materials and textures."""
    surfaces = ("Material", "Texture2D")
    return {path for path, asset in editor.studio.assets.items() if type(asset).__name__ not in surfaces}


def figure_assets(kind: str, name: str) -> set[str]:
    """Assets of a character's animation, without its body, which several characters may share."""
    prefixes = ("SK", "SKEL", "A") if kind == "Instruments" else ("A",)
    return {f"{ROOT}/{kind}/{name}/{prefix}_{name}" for prefix in prefixes}


def body_assets(*character_ids: str) -> set[str]:
    return {f"{ROOT}/Bodies/{id}/{prefix}_{id}" for id in character_ids for prefix in ("SK", "SKEL")}


def bindings(editor: Editor) -> dict[str, Any]:
    return {binding._display_name: binding for binding in editor.sequence()._bindings}


def transform(binding: Any) -> dict[str, float]:
    (track,) = [track for track in binding._tracks if type(track).__name__ == "MovieScene3DTransformTrack"]
    (section,) = track._sections
    assert section._bounded == (False, False)
    return {channel._name: channel._value for channel in section._channels if hasattr(channel, "_value")}


def animation(binding: Any) -> Any:
    (track,) = [track for track in binding._tracks if type(track).__name__ == "MovieSceneSkeletalAnimationTrack"]
    (section,) = track._sections
    return section


def marks(editor: Editor) -> dict[str, int]:
    return {mark.label: mark.frame_number.value for mark in editor.sequence()._marks}


def state(editor: Editor) -> dict[str, Any]:
    """Everything that an update may change, for comparison."""
    sequence = editor.sequence()
    return {
        "assets": {path: id(asset) for path, asset in editor.studio.assets.items()},
        "bindings": {
            name: (binding._id._value, transform(binding), animation(binding)._range)
            for name, binding in bindings(editor).items()
        },
        "tracks": [track._sections[0]._range for track in sequence._tracks],
        "marks": marks(editor),
        "range": (sequence._start, sequence._end, sequence._rate.numerator, sequence._rate.denominator),
        "metadata": editor.studio.metadata,
    }


def moved(project: Project, place: StagePosition) -> Project:
    first, *others = project.players
    return replace(project, players=(msgspec.structs.replace(first, stage=place), *others))


def test_the_quartet_is_imported(editor: Editor) -> None:
    reported = editor.import_performance()
    assert "is imported" in reported
    expected = {f"{ROOT}/LS_quartet", f"{ROOT}/Audio/S_quartet"}
    for player, held in zip(QUARTET, HELD, strict=True):
        expected |= figure_assets("Characters", player) | figure_assets("Instruments", f"{player}_{held}")
    bodies = {player["character_id"] for player in description(editor)["players"]}
    assert len(bodies) == len(QUARTET), "each player of a small ensemble has another body"
    expected |= body_assets(*bodies)
    assert own_assets(editor) == expected
    assert all(editor.studio.metadata[path]["SuisouPiece"] == "quartet" for path in editor.studio.assets)
    moving = [path for path in editor.studio.assets if path.rpartition("/")[2].startswith(("A_", "LS_"))]
    assert len(moving) > 2
    exported = description(editor)
    for path in moving:
        tags = editor.studio.metadata[path]
        assert tags["SuisouFirstFrame"] == str(exported["first_frame"])
        assert float(tags["SuisouFirstSecond"]) == pytest.approx(exported["first_frame_s"], abs=1e-6)
    assert editor.studio.saved == [ROOT, "/Game/Suisou/Textures"]
    assert editor.studio.opened == [f"{ROOT}/LS_quartet"]
    assert editor.studio.actors == []


def test_meshes_have_their_morph_targets_and_animations_their_curves(editor: Editor) -> None:
    editor.import_performance()
    frames = description(editor)["frames"]
    for player, reported in zip(QUARTET, description(editor)["players"], strict=True):
        body = reported["character_id"]
        mesh = editor.studio.assets[f"{ROOT}/Bodies/{body}/SK_{body}"]
        played = editor.studio.assets[f"{ROOT}/Characters/{player}/A_{player}"]
        assert "jawOpen" in mesh._morphs
        assert mesh._skeleton is played._skeleton
        assert mesh._skeleton is editor.studio.assets[f"{ROOT}/Bodies/{body}/SKEL_{body}"]
        assert played._frames == frames
        assert {"jawOpen", "eyeBlinkLeft"} <= played._curves


def test_what_the_importer_is_asked(editor: Editor) -> None:
    editor.import_performance()
    unreal = editor.unreal
    fbx = [asked for asked in editor.studio.imports if asked["filename"].endswith(".fbx")]
    bodies = len({player["character_id"] for player in description(editor)["players"]})
    assert len(fbx) == 12 + bodies
    assert all(asked["automated"] and asked["replace_existing"] for asked in editor.studio.imports)
    for asked in fbx:
        assert isinstance(asked["factory"], unreal.FbxFactory)
        assert asked["create_physics_asset"] is False
        assert asked["automated_import_should_detect_type"] is False
        mesh = asked["mesh_type_to_import"] is unreal.FBXImportType.FBXIT_SKELETAL_MESH
        data = asked["skeletal_mesh_import_data" if mesh else "anim_sequence_import_data"]._properties
        assert (data["convert_scene"], data["convert_scene_unit"], data["force_front_x_axis"]) == (True, True, False)
        if mesh:
            assert data["import_morph_targets"] is True
            method = unreal.FBXNormalImportMethod.FBXNIM_IMPORT_NORMALS_AND_TANGENTS
            assert data["normal_import_method"] is method
            assert asked["import_animations"] is False
        else:
            assert data["use_default_sample_rate"] is False
            assert data["custom_sample_rate"] == 12
            assert data["delete_existing_morph_target_curves"] is True


def test_interchange_is_off_for_fbx_alone_and_on_again(editor: Editor) -> None:
    # The fake refuses an FBX file while it is on.
    editor.import_performance()
    assert editor.studio.variables == {INTERCHANGE: "1"}
    editor.studio.variables = {INTERCHANGE: "0"}
    editor.update_performance()
    assert editor.studio.variables == {INTERCHANGE: "0"}, "who has it off keeps it off"
    editor.studio.variables = {}
    editor.update_performance()
    assert editor.studio.variables == {}, "an older engine does not have it"


def test_interchange_is_on_again_after_an_import_that_fails(editor: Editor, monkeypatch: pytest.MonkeyPatch) -> None:
    from suisou_import.fbx_options import older_importer

    def failing() -> None:
        with older_importer():
            assert editor.studio.variables == {INTERCHANGE: "0"}
            raise RuntimeError("the importer fails")

    with pytest.raises(RuntimeError):
        failing()
    assert editor.studio.variables == {INTERCHANGE: "1"}


def test_an_older_engine_that_lacks_options_gets_the_others(editor: Editor) -> None:
    from suisou_import import fbx_options

    kind = editor.unreal.FbxSkeletalMeshImportData
    known = kind.get_editor_property

    def older(self: Any, name: str) -> Any:
        if name in ("import_vertex_attributes", "coordinate_system_policy"):
            raise Exception(f"Failed to find property {name!r}")
        return known(self, name)

    kind.get_editor_property = older
    options = fbx_options.mesh_options(None)
    found = options.get_editor_property("skeletal_mesh_import_data")._properties
    assert "import_vertex_attributes" not in found
    assert sum("import_vertex_attributes" in line for line in editor.studio.logs) == 1
    assert found["normal_import_method"] is editor.unreal.FBXNormalImportMethod.FBXNIM_IMPORT_NORMALS_AND_TANGENTS


def test_a_newer_engine_that_takes_an_option_otherwise_gets_the_others(editor: Editor) -> None:
    from suisou_import import fbx_options

    kind = editor.unreal.FbxSkeletalMeshImportData
    known = kind.set_editor_property

    def newer(self: Any, name: str, value: Any) -> None:
        if name == "use_t0_as_ref_pose":
            raise TypeError(f"{name}: cannot convert {value!r}")
        known(self, name, value)

    kind.set_editor_property = newer
    options = fbx_options.mesh_options(None)
    found = options.get_editor_property("skeletal_mesh_import_data")._properties
    assert "use_t0_as_ref_pose" not in found
    assert found["import_morph_targets"] is True
    assert sum("use_t0_as_ref_pose" in line for line in editor.studio.logs) == 1


def test_performers_stand_at_their_places(editor: Editor) -> None:
    editor.import_performance()
    there = bindings(editor)
    assert len(there) == 8
    for player in description(editor)["players"]:
        place = player["place"]
        for name in (player["name"], f"{player['name']} ({player['instrument_id']})"):
            assert transform(there[name]) == {
                "Location.X": place["x_cm"],
                "Location.Y": place["y_cm"],
                "Location.Z": 0.0,
                "Rotation.X": 0.0,
                "Rotation.Y": 0.0,
                "Rotation.Z": place["yaw_deg"],
                "Scale.X": 1.0,
                "Scale.Y": 1.0,
                "Scale.Z": 1.0,
            }
    # A player on the left of the audience's view looks to its middle: from +Y towards +X is a negative yaw.
    first = description(editor)["players"][0]
    assert first["stage"]["x_m"] < 0
    assert first["place"]["yaw_deg"] < 0


def test_all_play_from_the_first_frame_to_the_last(editor: Editor) -> None:
    editor.import_performance()
    reported, sequence = description(editor), editor.sequence()
    last = reported["frames"] - 1
    assert (sequence._start, sequence._end) == (0, last)
    assert (sequence._rate.numerator, sequence._rate.denominator) == (12, 1)
    for player, held in zip(reported["players"], HELD, strict=True):
        for name, figure in (
            (player["name"], player["character"]),
            (f"{player['name']} ({held})", player["instrument"]),
        ):
            section = animation(bindings(editor)[name])
            assert section._range == ("frames", 0, last)
            assert section._animation is editor.studio.assets[figure["animation"]]
            assert bindings(editor)[name]._mesh is editor.studio.assets[figure["mesh"]]


def test_the_sound_is_at_its_offset_and_the_bars_are_marked(editor: Editor) -> None:
    path = editor.folder / "SuisouSource/quartet/performance.json"
    reported = description(editor)
    reported["sound"]["offset_s"] = 0.5
    path.write_text(json.dumps(reported), encoding="utf-8")
    editor.import_performance()
    (track,) = editor.sequence()._tracks
    (section,) = track._sections
    sound = editor.studio.assets[f"{ROOT}/Audio/S_quartet"]
    assert section._sound is sound
    assert section._range == ("seconds", 0.5, 0.5 + sound._duration_s)
    assert section._looping is False
    assert marks(editor) == {f"Bar {bar['number']}": bar["frame"] for bar in reported["bars"]}
    assert list(marks(editor)) == ["Bar 1", "Bar 2"]
    assert 0 == marks(editor)["Bar 1"] < marks(editor)["Bar 2"]


def test_rehearsal_markers_are_marked_with_their_bars_and_an_artists_letters_stay(two: Editor) -> None:
    unreal, sequence = two.unreal, two.sequence()
    sequence.add_marked_frame_to_sequence(unreal.MovieSceneMarkedFrame(unreal.FrameNumber(3), "A"))
    one, two_at, three = (quartet().score.metre_map.tick_of_bar(bar) for bar in (1, 2, 3))
    within = (one + two_at) // 2
    named = (
        Marker(one, "A"),
        Marker(within, "{rit.}"),
        Marker(two_at, "B"),
        Marker(two_at, "速く"),
        Marker(three, "C"),
    )
    exported(two.folder, marked(named), last_bar=2)
    two.update_performance()
    reported = description(two)
    # Markers after the exported bars are not part of this performance.
    assert [(marker["text"], marker["bar"]) for marker in reported["markers"]] == [
        ("A", 1), ("{rit.}", 1), ("B", 2), ("速く", 2),
    ]  # fmt: skip
    first, second = (row["frame"] for row in reported["bars"])
    rit = reported["markers"][1]["frame"]
    assert first < rit < second
    assert marks(two) == {"A": 3, "Bar 1: A": first, "Bar 1: {rit.}": rit, "Bar 2: B, 速く": second}
    before = marks(two)
    assert "up to date" in two.update_performance()
    assert marks(two) == before
    exported(two.folder, marked(()), last_bar=2)
    two.update_performance()
    assert marks(two) == {"A": 3, "Bar 1": first, "Bar 2": second}


def test_a_description_without_markers_is_of_an_earlier_suisou(editor: Editor) -> None:
    path = editor.folder / "SuisouSource/quartet/performance.json"
    reported = description(editor)
    del reported["markers"]
    path.write_text(json.dumps(reported), encoding="utf-8")
    editor.import_performance()
    assert list(marks(editor)) == ["Bar 1", "Bar 2"]


def test_an_update_of_the_same_changes_nothing(editor: Editor) -> None:
    editor.import_performance()
    before = json.dumps(state(editor), sort_keys=True)
    for _ in range(3):
        assert "up to date" in editor.update_performance()
    assert json.dumps(state(editor), sort_keys=True) == before
    assert editor.studio.deleted == []


@pytest.fixture(scope="module")
def two_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two players, one bar."""
    folder = tmp_path_factory.mktemp("exported") / "Game"
    exported(folder, quartet())
    return folder


@pytest.fixture
def two(plugin: None, two_folder: Path, tmp_path: Path) -> Editor:
    """Two players, imported."""
    shutil.copytree(two_folder, tmp_path / "Game")
    editor = Editor(tmp_path / "Game")
    editor.import_performance()
    return editor


def test_length_rate_and_places_follow(two: Editor) -> None:
    before = state(two)
    place = StagePosition(2.0, 1.0, 0.5)
    exported(two.folder, moved(quartet(), place), last_bar=2, fps=Fraction(30000, 1001))
    two.update_performance()
    after, reported = state(two), description(two)
    assert after["assets"] == before["assets"]
    assert {name: value[0] for name, value in after["bindings"].items()} == {
        name: value[0] for name, value in before["bindings"].items()
    }
    assert after["range"] == (0, reported["frames"] - 1, 30000, 1001)
    assert {value[2] for value in after["bindings"].values()} == {("frames", 0, reported["frames"] - 1)}
    assert after["bindings"]["Trumpet 1"][1]["Location.X"] == 200.0
    assert after["marks"] == {"Bar 1": reported["bars"][0]["frame"], "Bar 2": reported["bars"][1]["frame"]}
    # Frames are whole ticks of the sequence.
    ticks = two.sequence()._ticks
    assert Fraction(ticks.numerator, ticks.denominator) / Fraction(30000, 1001) % 1 == 0
    assert two.studio.imports[-2]["anim_sequence_import_data"]._properties["custom_sample_rate"] == 0


def test_who_plays_no_more_goes_and_who_is_used_stays(two: Editor) -> None:
    gone = figure_assets("Characters", "Trombone_1") | figure_assets(
        "Instruments", "Trombone_1_trombone_tenor_F_attachment"
    )
    held = "Trombone_1_trombone_tenor_F_attachment"
    used = f"{ROOT}/Instruments/{held}/SK_{held}"
    two.studio.referencers[used] = ["/Game/Maps/Stage", f"{ROOT}/LS_quartet"]
    exported(two.folder, quartet(), ("Trumpet 1",))
    reported = two.update_performance()
    assert set(bindings(two)) == {"Trumpet 1", "Trumpet 1 (trumpet_Bb)"}
    assert not own_assets(two) & (gone - {used})
    assert used in two.studio.assets
    assert f"/Game/Maps/Stage uses it: {used}" in reported
    assert all(
        "Trombone" not in path for path in two.studio.assets if path.rpartition("/")[0] != used.rpartition("/")[0]
    )


def test_what_the_artist_added_stays(two: Editor) -> None:
    unreal, sequence = two.unreal, two.sequence()
    mine = two.studio.add(f"{ROOT}/Characters/Trumpet_1/M_Mine", unreal.SkeletalMesh())
    music = two.studio.add("/Game/Music/S_Crowd", unreal.SoundWave())
    track = sequence.add_track(unreal.MovieSceneAudioTrack)
    section = track.add_section()
    section.set_sound(music)
    section.set_range(3, 7)
    sequence.add_marked_frame_to_sequence(unreal.MovieSceneMarkedFrame(unreal.FrameNumber(3), "Camera 2"))
    actors = unreal.get_editor_subsystem(unreal.EditorActorSubsystem)
    actor = actors.spawn_actor_from_object(mine, unreal.Vector())
    own = sequence.add_spawnable_from_instance(actor)
    own.set_display_name("Conductor")
    own.add_track(unreal.MovieScene3DTransformTrack).add_section()
    bindings(two)["Trumpet 1"].add_track(unreal.MovieSceneAudioTrack)
    exported(two.folder, quartet(), ("Trumpet 1",), last_bar=2)
    two.update_performance()
    assert two.studio.assets[f"{ROOT}/Characters/Trumpet_1/M_Mine"] is mine
    assert section._range == ("frames", 3, 7)
    assert len(sequence._tracks) == 2
    assert marks(two)["Camera 2"] == 3
    assert set(bindings(two)) == {"Trumpet 1", "Trumpet 1 (trumpet_Bb)", "Conductor"}
    assert len(bindings(two)["Trumpet 1"]._tracks) == 3
    assert two.studio.actors == [actor]


def test_who_was_moved_in_unreal_stays_there(two: Editor) -> None:
    (track,) = [
        track for track in bindings(two)["Trumpet 1"]._tracks if type(track).__name__ == "MovieScene3DTransformTrack"
    ]
    track._sections[0]._channels[0].set_default(333.0)
    exported(two.folder, moved(quartet(), StagePosition(2.0, 1.0, 0.5)))
    reported = two.update_performance()
    assert transform(bindings(two)["Trumpet 1"])["Location.X"] == 333.0
    assert transform(bindings(two)["Trumpet 1 (trumpet_Bb)"])["Location.X"] == 200.0
    assert "Left where you put it: Trumpet 1" in reported


def test_channels_of_other_names_are_reported(two: Editor) -> None:
    for binding in bindings(two).values():
        (track,) = [track for track in binding._tracks if type(track).__name__ == "MovieScene3DTransformTrack"]
        for channel in track._sections[0]._channels:
            channel._name = channel._name.replace("Location", "Translation")
    assert "no channels that Suisou knows" not in two.update_performance()
    exported(two.folder, moved(quartet(), StagePosition(2.0, 1.0, 0.5)))
    reported = two.update_performance()
    assert reported.count("no channels that Suisou knows") == 2


def test_other_bones_make_a_figure_anew(two: Editor) -> None:
    """Another instrument model may have other moving parts with the same name."""
    skeleton = f"{ROOT}/Instruments/Trumpet_1_trumpet_Bb/SKEL_Trumpet_1_trumpet_Bb"
    two.studio.metadata[skeleton]["SuisouBones"] = "of before"
    before = dict(two.studio.assets)
    reported = two.update_performance()
    changed = {path for path, asset in two.studio.assets.items() if before[path] is not asset}
    assert changed == figure_assets("Instruments", "Trumpet_1_trumpet_Bb")
    assert "bones are others now" in reported
    binding = bindings(two)["Trumpet 1 (trumpet_Bb)"]
    assert binding._mesh is two.studio.assets[skeleton.replace("SKEL_", "SK_")]
    assert animation(binding)._animation is two.studio.assets[skeleton.replace("SKEL_", "A_")]
    assert len(bindings(two)) == 4


def test_names_never_become_code_or_paths(plugin: None, tmp_path: Path) -> None:
    names = ["'); import os; os.abort() #", "{0.__class__}{folder}", "../../x" * 40, "🎺 トランペット"]
    exported(tmp_path / "Game", renamed(quartet(), names), tuple(names[:2]), source="'; raise SystemExit.mid")
    editor = Editor(tmp_path / "Game")
    editor.import_performance()
    (piece,) = editor.pieces()
    assert all(part.replace("_", "").isalnum() for path in own_assets(editor) for part in path.split("/")[1:])
    shown = {binding._display_name for binding in editor.sequence(piece)._bindings}
    assert {names[0], names[1]} <= shown
    assert set(editor.studio.commands.values()) == {
        "from suisou_import import menu; menu.import_performance()",
        "from suisou_import import menu; menu.update_performance()",
    }


def test_who_changes_instruments_is_one_character_with_an_actor_for_each(plugin: None, tmp_path: Path) -> None:
    exported(tmp_path / "Game", flutist(), ("Flute",), source="quartet.mid")
    editor = Editor(tmp_path / "Game")
    editor.import_performance()
    found = bindings(editor)
    assert set(found) == {"Flute", "Flute (flute)", "Flute (piccolo)"}
    # All actors are where the player is: the instruments move in the player's own space.
    assert transform(found["Flute"]) == transform(found["Flute (flute)"]) == transform(found["Flute (piccolo)"])
