"""The level sequence: who stands where and plays what, the sound, the bars and rehearsal markers.

What was put there is remembered in the sequence's metadata, so that an update changes that and nothing else: tracks,
actors and marks of the artist's stay, and so does a place where the artist has moved someone.
"""

from __future__ import annotations

import json
from typing import Any

import unreal

from suisou_import import assets
from suisou_import.performance import Figure, Performance, Place
from suisou_import.problem import problem, text

STATE_TAG = "SuisouSequence"
_NEAR = 1e-3
"""Distance in centimetres or degrees within which a place counts as unchanged."""


def build(performance: Performance, anew: set[str]) -> list[str]:
    """Make the sequence of a performance, or bring it up to date.

    Parameters
    ----------
    anew : set of str
        Meshes that were made anew: what showed them before shows nothing now.

    Returns
    -------
    list of str
        What is reported to the user.
    """
    sequence = _sequence(performance)
    state = _state(sequence)
    _set_time(sequence, performance)
    reported: list[str] = []
    known: dict[str, Any] = state["figures"]
    figures: dict[str, Any] = {}
    there: dict[str, unreal.MovieSceneBindingProxy] = {}
    for figure in performance.figures:
        before = None if figure.mesh in anew else known.get(figure.animation)
        binding = None if before is None else _binding(sequence, before["id"])
        if binding is not None and before is not None and before["mesh"] != figure.mesh:
            binding = binding if _show(binding, figure.mesh) else None
        if binding is None:
            _remove(sequence, known.get(figure.animation))
            binding, before = _new_binding(sequence, figure), None
        there[figure.animation] = binding
        hung = "" if before is None else str(before.get("socket", ""))
        _hang(sequence, binding, there.get(figure.holder), figure.socket, hung)
        # On another socket the place is another one, wherever it was put before.
        stayed = before is not None and hung == figure.socket
        reported += _put(binding, figure, Place(*before["place"]) if before is not None and stayed else None)
        _play(binding, figure, performance)
        figures[figure.animation] = {
            "id": binding.get_id().to_string(),
            "mesh": figure.mesh,
            "skeleton": figure.skeleton,
            "place": list(figure.place),
            "socket": figure.socket,
        }
    for animation, before in known.items():
        if animation in performance.staying:
            figures.setdefault(animation, before)
        elif animation not in figures:
            _remove(sequence, before)
    _sound(sequence, performance)
    marks = _mark(sequence, performance, set(state["marks"]))
    _remember(sequence, {"figures": figures, "marks": marks})
    assets.tag(sequence, performance)
    return reported


def shown_with(performance: Performance) -> set[str]:
    """Paths of the meshes and skeletons of excluded performers."""
    known = _state(_sequence(performance))["figures"]
    staying = [known[animation] for animation in performance.staying if animation in known]
    return {str(one[what]) for one in staying for what in ("mesh", "skeleton")}


def last_frame(performance: Performance) -> int:
    """Return the frame at which every section ends: an animation of n keys lasts n - 1 frames and would start again in
    a longer section."""
    return max(performance.frames - 1, 1)


def _sequence(performance: Performance) -> unreal.LevelSequence:
    sequence = assets.existing(performance.sequence)
    if sequence is None:
        folder, _, name = performance.sequence.rpartition("/")
        sequence = unreal.AssetToolsHelpers.get_asset_tools().create_asset(
            name, folder, unreal.LevelSequence, unreal.LevelSequenceFactoryNew()
        )
    if not isinstance(sequence, unreal.LevelSequence):
        raise problem("not_changed", asset=performance.sequence)
    return sequence


def _set_time(sequence: unreal.LevelSequence, performance: Performance) -> None:
    numerator, denominator = performance.rate
    sequence.set_display_rate(unreal.FrameRate(numerator, denominator))
    ticks = sequence.get_tick_resolution()
    # Frames are to be whole ticks: 24000 in a second do for most rates, not for 30000/1001.
    if ticks.numerator * denominator % (ticks.denominator * numerator):
        sequence.set_tick_resolution(unreal.FrameRate(numerator * -(-24000 // numerator), 1))
    end = last_frame(performance)
    sequence.set_playback_start(0)
    sequence.set_playback_end(end)
    end_s = end * denominator / numerator
    margin_s = 0.05 * end_s
    sequence.set_work_range_start(-margin_s)
    sequence.set_work_range_end(end_s + margin_s)
    sequence.set_view_range_start(-margin_s)
    sequence.set_view_range_end(end_s + margin_s)


# Actors


def _binding(sequence: unreal.LevelSequence, id: str) -> unreal.MovieSceneBindingProxy | None:
    for binding in sequence.get_bindings():
        if binding.get_id().to_string() == id:
            return binding
    return None


def _remove(sequence: unreal.LevelSequence, before: dict[str, Any] | None) -> None:
    binding = None if before is None else _binding(sequence, before["id"])
    if binding is not None:
        binding.remove()


def _new_binding(sequence: unreal.LevelSequence, figure: Figure) -> unreal.MovieSceneBindingProxy:
    """An actor that the sequence itself brings into whatever level it is played in."""
    actors = unreal.get_editor_subsystem(unreal.EditorActorSubsystem)
    mesh = assets.existing(figure.mesh)
    if actors is None or mesh is None:
        raise problem("no_actor", asset=figure.mesh)
    place = figure.place
    location = unreal.Vector(place.x_cm, place.y_cm, place.z_cm)
    actor = actors.spawn_actor_from_object(mesh, location, unreal.Rotator(0.0, 0.0, place.yaw_deg))
    if actor is None:
        raise problem("no_actor", asset=figure.mesh)
    try:
        actor.set_actor_label(figure.name)
        editor = unreal.get_editor_subsystem(unreal.LevelSequenceEditorSubsystem)
        if editor is not None and hasattr(editor, "add_spawnable_from_instance"):
            binding = editor.add_spawnable_from_instance(sequence, actor)
        else:
            binding = sequence.add_spawnable_from_instance(actor)
    finally:
        # The sequence has a copy.
        actors.destroy_actor(actor)
    binding.set_display_name(figure.name)
    return binding


def _show(binding: unreal.MovieSceneBindingProxy, mesh: str) -> bool:
    """Let an actor show another mesh; return whether that is possible."""
    template, asset = binding.get_object_template(), assets.existing(mesh)
    if not isinstance(template, unreal.Actor) or not isinstance(asset, unreal.SkeletalMesh):
        return False
    component = template.get_component_by_class(unreal.SkeletalMeshComponent)
    if not isinstance(component, unreal.SkeletalMeshComponent):
        return False
    component.set_skinned_asset_and_update(asset)
    return True


def _hang(
    sequence: unreal.LevelSequence,
    binding: unreal.MovieSceneBindingProxy,
    holder: unreal.MovieSceneBindingProxy | None,
    socket: str,
    before: str,
) -> None:
    """Attach an actor to a bone of another one, or detach it; ``before`` is its previous bone."""
    tracks = binding.find_tracks_by_exact_type(unreal.MovieScene3DAttachTrack)
    ours = [track for track in tracks if before and before in map(_socket, track.get_sections())]
    if holder is None:
        for track in ours:
            binding.remove_track(track)
        return
    track = ours[0] if ours else binding.add_track(unreal.MovieScene3DAttachTrack)
    section = track.get_sections()[0] if ours else track.add_section()
    assert isinstance(section, unreal.MovieScene3DAttachSection)
    section.set_constraint_binding_id(sequence.get_binding_id(holder))
    section.attach_socket_name = socket
    section.set_start_frame_bounded(False)
    section.set_end_frame_bounded(False)


def _socket(section: unreal.MovieSceneSection) -> str:
    return str(section.attach_socket_name) if isinstance(section, unreal.MovieScene3DAttachSection) else ""


def _put(binding: unreal.MovieSceneBindingProxy, figure: Figure, before: Place | None) -> list[str]:
    """Place an actor, unless the artist has moved it; return reports for the user."""
    tracks = binding.find_tracks_by_exact_type(unreal.MovieScene3DTransformTrack)
    track = tracks[0] if tracks else binding.add_track(unreal.MovieScene3DTransformTrack)
    sections = track.get_sections()
    section = sections[0] if sections else track.add_section()
    section.set_start_frame_bounded(False)
    section.set_end_frame_bounded(False)
    channels = {
        str(channel.channel_name): channel
        for channel in section.get_all_channels()
        if isinstance(channel, unreal.MovieSceneScriptingDoubleChannel)
    }
    requested = _channel_values(figure.place)
    if not set(requested) <= set(channels):
        # The actor was created at its place; only the binding that moves it later is missing.
        return [] if before in (None, figure.place) else [text("unplaced", name=figure.name)]
    if before is not None and sections and _moved(channels, _channel_values(before)):
        return [] if before == figure.place else [text("moved", name=figure.name)]
    for name, value in requested.items():
        channels[name].set_default(value)
    return []


def _moved(channels: dict[str, unreal.MovieSceneScriptingDoubleChannel], left: dict[str, float]) -> bool:
    """Return whether an actor was moved after it was placed."""
    return any(
        channels[name].get_num_keys() > 0 or abs(channels[name].get_default() - value) > _NEAR
        for name, value in left.items()
    )


def _channel_values(place: Place) -> dict[str, float]:
    """The channels of a transform section: rotations about X, Y and Z are roll, pitch and yaw."""
    return {
        "Location.X": place.x_cm,
        "Location.Y": place.y_cm,
        "Location.Z": place.z_cm,
        "Rotation.X": place.roll_deg,
        "Rotation.Y": 0.0,
        "Rotation.Z": place.yaw_deg,
        "Scale.X": 1.0,
        "Scale.Y": 1.0,
        "Scale.Z": 1.0,
    }


def _play(binding: unreal.MovieSceneBindingProxy, figure: Figure, performance: Performance) -> None:
    """Let an actor play its animation from frame 0 to the end."""
    animation = assets.existing(figure.animation)
    if not isinstance(animation, unreal.AnimSequence):
        raise problem("not_imported", asset=figure.animation, file=figure.file)
    section = _animation_section(binding, figure.animation)
    params = section.params
    params.animation = animation
    # The value was a copy and must be assigned back.
    section.params = params
    section.set_range(0, last_frame(performance))


def _animation_section(binding: unreal.MovieSceneBindingProxy, path: str) -> unreal.MovieSceneSkeletalAnimationSection:
    tracks = binding.find_tracks_by_exact_type(unreal.MovieSceneSkeletalAnimationTrack)
    for track in tracks:
        for section in track.get_sections():
            if isinstance(section, unreal.MovieSceneSkeletalAnimationSection):
                animation = section.params.animation
                # A binding that lost its animation is ours too: the animation was created again.
                if animation is None or _path_of(animation) == path:
                    return section
    track = tracks[0] if tracks else binding.add_track(unreal.MovieSceneSkeletalAnimationTrack)
    made = track.add_section()
    assert isinstance(made, unreal.MovieSceneSkeletalAnimationSection)
    return made


# Sound and marks


def _sound(sequence: unreal.LevelSequence, performance: Performance) -> None:
    sound = assets.existing(performance.sound.asset)
    if not isinstance(sound, unreal.SoundBase):
        raise problem("not_imported", asset=performance.sound.asset, file=performance.sound.file)
    section = _sound_section(sequence, performance.sound.asset)
    if section is None:
        track = sequence.add_track(unreal.MovieSceneAudioTrack)
        track.set_display_name(text("sound_track"))
        made = track.add_section()
        assert isinstance(made, unreal.MovieSceneAudioSection)
        section = made
    section.set_sound(sound)
    section.set_looping(False)
    start_s = performance.sound.offset_s
    section.set_range_seconds(start_s, start_s + performance.sound.duration_s)


def _sound_section(sequence: unreal.LevelSequence, path: str) -> unreal.MovieSceneAudioSection | None:
    for track in sequence.find_tracks_by_exact_type(unreal.MovieSceneAudioTrack):
        for section in track.get_sections():
            if isinstance(section, unreal.MovieSceneAudioSection):
                sound = section.get_sound()
                if sound is not None and _path_of(sound) == path:
                    return section
    return None


def _mark(sequence: unreal.LevelSequence, performance: Performance, before: set[str]) -> list[str]:
    """Mark the bars and rehearsal markers; return the labels made by this plug-in."""
    in_frames = hasattr(sequence, "add_marked_frame_to_sequence")
    there = list(sequence.get_marked_frames_from_sequence() if in_frames else sequence.get_marked_frames())
    for index in reversed(range(len(there))):
        if str(there[index].label) in before:
            sequence.delete_marked_frame(index)
    labels = _labels(performance)
    for frame, label in labels.items():
        if in_frames:
            sequence.add_marked_frame_to_sequence(unreal.MovieSceneMarkedFrame(unreal.FrameNumber(frame), label))
        else:
            ticks, (numerator, denominator) = sequence.get_tick_resolution(), performance.rate
            tick = frame * denominator * ticks.numerator // (numerator * ticks.denominator)
            sequence.add_marked_frame(unreal.MovieSceneMarkedFrame(unreal.FrameNumber(tick), label))
    return list(labels.values())


def _labels(performance: Performance) -> dict[int, str]:
    """Return the text of each frame's mark. A frame has one mark: a marker's text also names its bar, so that a letter
    of the piece is not taken for one of the letters that the editor gives to an artist's own marks."""
    labels = {frame: text("bar", number=number) for number, frame in performance.bars}
    named: dict[int, list[str]] = {}
    for name, bar, frame in performance.markers:
        named.setdefault(frame, []).append(name)
        labels[frame] = text("marker", number=bar, names=", ".join(named[frame]))
    return dict(sorted(labels.items()))


# Record of imported parts of the sequence


def _state(sequence: unreal.LevelSequence) -> dict[str, Any]:
    """Return the figures and marks that the last import put into a sequence; none if its record cannot be read."""
    try:
        state = json.loads(unreal.EditorAssetLibrary.get_metadata_tag(sequence, STATE_TAG))
        figures = dict(_known(*item) for item in state["figures"].items())
        return {"figures": figures, "marks": list(state["marks"])}
    except (ValueError, KeyError, TypeError):
        return {"figures": {}, "marks": []}


def _known(key: str, figure: dict[str, Any]) -> tuple[str, dict[str, Any]]:
    """Return a figure of the record with its animation as the key. Earlier versions used the mesh as the key, since
    each figure had a mesh of its own."""
    if "mesh" in figure:
        return key, figure
    folder, _, name = key.rpartition("/SK_")
    return f"{folder}/A_{name}", {**figure, "mesh": key, "skeleton": f"{folder}/SKEL_{name}"}


def _remember(sequence: unreal.LevelSequence, state: dict[str, Any]) -> None:
    unreal.EditorAssetLibrary.set_metadata_tag(sequence, STATE_TAG, json.dumps(state))


def _path_of(asset: unreal.Object) -> str:
    """Path of an asset without the name of the object in it."""
    return str(asset.get_path_name()).split(".")[0]
