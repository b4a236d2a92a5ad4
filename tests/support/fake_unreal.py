"""An `unreal` module that records the plug-in's calls. It provides only names of the documented API that the plug-in
uses, checked against the stub in `tests/support/unreal_api`, with the types of its editor properties. FBX files are
read by the program's own reader, so that an import contains what its file contains.

It knows only names of the documented API: those of the stub beside it (`tests/support/unreal_api`), whose editor
properties it takes with their types, and whose classes and functions it is held against in the tests. FBX files that it
is given are read by our own reader, so that what comes of an import is what the file holds.
"""

from __future__ import annotations

import ast
import hashlib
import itertools
import types
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from enum import Enum
from functools import cache
from pathlib import Path
from typing import Any, Literal

import soundfile

from app.formats.fbx.read import decode_scene

STUB = Path(__file__).with_name("unreal_api") / "unreal" / "__init__.pyi"


INTERCHANGE = "Interchange.FeatureFlags.Import.FBX"


@dataclass(frozen=True)
class FbxContents:
    """Contents of an imported file; zero frames without motion."""

    bones: tuple[str, ...]
    morphs: frozenset[str]
    materials: frozenset[str]
    frames: int | None
    curves: frozenset[str]


_READ: dict[bytes, FbxContents] = {}
"""Contents of files by digest, since most tests import the same files."""


def fbx_contents(path: Path) -> FbxContents:
    """Return the bones, morphs, materials and other contents of an FBX file."""
    data = path.read_bytes()
    digest = hashlib.sha256(data).digest()
    if digest not in _READ:
        scene = decode_scene(data, str(path))
        _READ[digest] = FbxContents(
            bones=tuple(bone.name for bone in scene.bones),
            morphs=frozenset(morph.name for one in scene.meshes for morph in one.morphs),
            materials=frozenset(material.name for one in scene.meshes for material in one.materials),
            frames=None if scene.clip is None else scene.clip.frames,
            curves=frozenset() if scene.clip is None else frozenset(scene.clip.morph_weights),
        )
    return _READ[digest]


@cache
def stub() -> ast.Module:
    """The documented API, as far as the plug-in uses it."""
    return ast.parse(STUB.read_text(encoding="utf-8"))


@cache
def stub_classes() -> dict[str, ast.ClassDef]:
    """Classes of the documented API by name."""
    return {node.name: node for node in stub().body if isinstance(node, ast.ClassDef)}


@cache
def editor_properties(name: str, function: str) -> dict[str, str]:
    """Types of the properties that a class's ``set_editor_property`` and ``get_editor_property`` accept, by name."""
    found: dict[str, str] = {}
    bases = [base.id for base in stub_classes()[name].bases if isinstance(base, ast.Name)]
    for base in bases:
        if base != "Object" and base in stub_classes():
            found |= editor_properties(base, function)
    for node in stub_classes()[name].body:
        if isinstance(node, ast.FunctionDef) and node.name == function:
            value = node.args.args[2].annotation if function.startswith("set") else node.returns
            names = node.args.args[1].annotation
            assert names is not None
            assert value is not None
            for constant in ast.walk(names):
                if isinstance(constant, ast.Constant):
                    found[str(constant.value)] = ast.unparse(value)
    return found


def fake_unreal(project: Path, language: str = "en") -> Any:
    """Make a new `unreal` module of an editor with an open project; ``unreal.studio`` is its recorded state."""
    module = types.ModuleType("unreal")
    studio = Studio(project, language)
    classes = {name: value for name, value in _classes(studio, module).items() if name in stub_classes()}
    for name, value in classes.items():
        value.__name__ = name
        setattr(module, name, value)
    module.__dict__["studio"] = studio
    module.__dict__["get_editor_subsystem"] = lambda subsystem: subsystem()
    module.__dict__["log"] = studio.logs.append
    module.__dict__["log_error"] = studio.errors.append
    return module


@dataclass
class Studio:
    """State of the editor and its project for tests.

    Attributes
    ----------
    assets : dict
        By path.
    actors : list
        Those in the level.
    logs : list of str
        Lines of the Output Log that are no errors.
    dialogs : list of str
        Messages shown; ``answers`` are given to questions, in order.
    imports : list of dict
        What was asked of the importers, property by property.
    variables : dict of str to str
        Of the console.
    cancel_after : int or None
        Steps of a progress dialog after which Cancel is pressed.
    """

    project: Path
    language: str
    engine: str = "5.6.0-43139311+++UE5+Release-5.6"
    variables: dict[str, str] = field(default_factory=lambda: {INTERCHANGE: "1"})
    assets: dict[str, Any] = field(default_factory=dict)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    referencers: dict[str, list[str]] = field(default_factory=dict)
    actors: list[Any] = field(default_factory=list)
    dialogs: list[str] = field(default_factory=list)
    logs: list[str] = field(default_factory=list)
    answers: list[Any] = field(default_factory=list)
    errors: list[object] = field(default_factory=list)
    imports: list[dict[str, Any]] = field(default_factory=list)
    saved: list[str] = field(default_factory=list)
    deleted: list[str] = field(default_factory=list)
    commands: dict[str, str] = field(default_factory=dict)
    opened: list[str] = field(default_factory=list)
    has_editor: bool = True
    undeletable: set[str] = field(default_factory=set)
    refuse_import: set[str] = field(default_factory=set)
    cancel_after: int | None = None
    lost_keys: int = 0
    ids: Iterator[int] = field(default_factory=lambda: itertools.count(1))

    def add(self, path: str, asset: Any) -> Any:
        """Add an asset at a path."""
        self.assets[path] = asset
        asset._path = path
        return asset


def _classes(studio: Studio, module: Any) -> dict[str, type]:
    """All classes of the module; those without function are empty."""

    class Object:
        _path = ""

        def __init__(self) -> None:
            self._properties: dict[str, Any] = {}

        def get_name(self) -> str:
            return self._path.rpartition("/")[2]

        def get_path_name(self) -> str:
            return f"{self._path}.{self.get_name()}"

        def get_editor_property(self, name: str) -> Any:
            raise AttributeError(f"{type(self).__name__} has no editor property {name!r}")

        def set_editor_property(self, name: str, value: Any) -> None:
            raise AttributeError(f"{type(self).__name__} has no editor property {name!r}")

    class Editable(Object):
        def set_editor_property(self, name: str, value: Any) -> None:
            known = editor_properties(type(self).__name__, "set_editor_property")
            if name not in known:
                raise AttributeError(f"{type(self).__name__} has no editor property {name!r}")
            if value is None and known[name].endswith(" | None"):
                self._properties[name] = value
                return
            kind = self._kind(known[name])
            if type(value) is not kind and not (isinstance(value, kind) and kind not in (bool, int, float)):
                raise TypeError(f"{type(self).__name__}.{name} is a {known[name]}, not {value!r}")
            self._properties[name] = value

        def get_editor_property(self, name: str) -> Any:
            known = editor_properties(type(self).__name__, "get_editor_property")
            if name not in known:
                raise AttributeError(f"{type(self).__name__} has no editor property {name!r}")
            if name not in self._properties and issubclass(self._kind(known[name]), Editable):
                self._properties[name] = self._kind(known[name])()
            return self._properties.get(name)

        @staticmethod
        def _kind(named: str) -> Any:
            plain = {"bool": bool, "str": str, "int": int, "float": float, "list[str]": list}
            return plain.get(named) or getattr(module, named.removesuffix(" | None"))

    class StructBase:
        pass

    class Factory(Object):
        pass

    class FbxFactory(Factory):
        pass

    class LevelSequenceFactoryNew(Factory):
        pass

    class EditorSubsystem(Object):
        pass

    class Vector(StructBase):
        def __init__(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> None:
            self.x, self.y, self.z = x, y, z

    class Rotator(StructBase):
        def __init__(self, roll: float = 0.0, pitch: float = 0.0, yaw: float = 0.0) -> None:
            self.roll, self.pitch, self.yaw = roll, pitch, yaw

    class Color(StructBase):
        pass

    class LinearColor(StructBase):
        def __init__(self, r: float = 0.0, g: float = 0.0, b: float = 0.0, a: float = 0.0) -> None:
            self.r, self.g, self.b, self.a = r, g, b, a

    class Int32Interval(StructBase):
        pass

    class SoftObjectPath(StructBase):
        pass

    class FrameNumber(StructBase):
        def __init__(self, value: int = 0) -> None:
            assert type(value) is int
            self.value = value

    class FrameRate(StructBase):
        def __init__(self, numerator: int = 0, denominator: int = 1) -> None:
            self.numerator, self.denominator = numerator, denominator

    class Guid(StructBase):
        _value = 0

        def to_string(self) -> str:
            return f"{self._value:032X}"

    # Libraries

    class Paths:
        @classmethod
        def project_dir(cls) -> str:
            return "../../../Game/"

        @classmethod
        def convert_relative_path_to_full(cls, path: str, base_path: str = "") -> str:
            assert path == cls.project_dir()
            return f"{studio.project.as_posix()}/"

    class SystemLibrary:
        @classmethod
        def get_engine_version(cls) -> str:
            return studio.engine

        @classmethod
        def get_console_variable_bool_value(cls, variable_name: str) -> bool:
            return studio.variables.get(variable_name, "0") != "0"

        @classmethod
        def execute_console_command(cls, world_context_object: Any, command: str, specific_player: Any = None) -> None:
            assert isinstance(world_context_object, World)
            name, value = command.split(" ")
            assert name in studio.variables
            studio.variables[name] = value

    class InternationalizationLibrary:
        @classmethod
        def get_current_language(cls) -> str:
            return studio.language

    class AppMsgType(Enum):
        OK = 0
        YES_NO_YES_ALL_NO_ALL_CANCEL = 1

    class AppReturnType(Enum):
        NO = 0
        YES = 1
        YES_ALL = 2
        NO_ALL = 3
        CANCEL = 4
        OK = 5

    class EditorDialog:
        @classmethod
        def show_message(cls, title: str, message: str, message_type: Any) -> Any:
            assert isinstance(title, str)
            assert isinstance(message, str)
            studio.dialogs.append(message)
            return AppReturnType.OK if message_type is AppMsgType.OK else studio.answers.pop(0)

    class ScopedSlowTask:
        def __init__(self, work: float, desc: str = "", enabled: bool = True) -> None:
            self._left = work
            self._steps = 0

        def __enter__(self) -> ScopedSlowTask:
            return self

        def __exit__(self, type: Any, value: Any, traceback: Any) -> Literal[False]:
            if type is None:
                assert self._left == 0, "the progress does not come to its end"
            return False

        def make_dialog(self, can_cancel: bool = False, allow_in_pie: bool = False) -> None:
            assert can_cancel

        def enter_progress_frame(self, work: float = 1.0, desc: str = "") -> None:
            self._left -= work
            self._steps += 1
            assert self._left >= 0

        def should_cancel(self) -> bool:
            return studio.cancel_after is not None and self._steps >= studio.cancel_after

    # Menus

    class ToolMenuStringCommandType(Enum):
        PYTHON = 1

    class MultiBlockType(Enum):
        MENU_ENTRY = 1

    class ToolMenuEntry(StructBase):
        def __init__(self, name: str = "None", *, type: Any = None) -> None:
            assert type is MultiBlockType.MENU_ENTRY
            self._name, self._label, self._tip, self._command = name, "", "", ""

        def set_label(self, label: str) -> None:
            self._label = label

        def set_tool_tip(self, tool_tip: str) -> None:
            self._tip = tool_tip

        def set_string_command(self, type: Any, custom_type: str, string: str) -> None:
            assert type is ToolMenuStringCommandType.PYTHON
            self._command = string

    class ToolMenu(Object):
        def add_sub_menu(self, owner: str, section_name: str, name: str, label: str, tool_tip: str = "") -> ToolMenu:
            assert label
            return ToolMenu()

        def add_menu_entry(self, section_name: str, args: ToolMenuEntry) -> None:
            assert args._tip
            studio.commands[args._label] = args._command

    class ToolMenus(Object):
        @classmethod
        def get(cls) -> ToolMenus:
            return cls()

        def find_menu(self, name: str) -> ToolMenu | None:
            assert name == "LevelEditor.MainMenu"
            return ToolMenu() if studio.has_editor else None

        def refresh_all_widgets(self) -> None:
            pass

    # Assets

    class Skeleton(Object):
        _bones: tuple[str, ...] = ()

    class PhysicsAsset(Object):
        pass

    class MaterialInterface(Object):
        pass

    class SkeletalMaterial(StructBase):
        def __init__(self, material: Any, slot: str) -> None:
            self.material_interface, self.material_slot_name = material, slot

    class SkeletalMesh(Object):
        _skeleton: Any = None
        _slots: tuple[tuple[Any, str], ...] = ()

        @property
        def materials(self) -> list[SkeletalMaterial]:
            # Copies, as structs of Unreal's are.
            return [SkeletalMaterial(*slot) for slot in self._slots]

        @materials.setter
        def materials(self, value: list[SkeletalMaterial]) -> None:
            self._slots = tuple((slot.material_interface, slot.material_slot_name) for slot in value)

        _morphs: frozenset[str] = frozenset()

        @property
        def skeleton(self) -> Any:
            return self._skeleton

    class AnimSequenceBase(Object):
        pass

    class AnimSequence(AnimSequenceBase):
        _skeleton: Any = None
        _frames = 0
        _curves: frozenset[str] = frozenset()

        def get_editor_property(self, name: str) -> Any:
            return {"skeleton": self._skeleton, "number_of_sampled_keys": self._frames}[name]

    class SoundBase(Object):
        pass

    class SoundWave(SoundBase):
        _duration_s = 0.0

    class TextureCompressionSettings(Enum):
        TC_DEFAULT = 0
        TC_NORMALMAP = 1
        TC_MASKS = 2

    class Texture(Editable):
        pass

    class Texture2D(Texture):
        _content = b""

    class BlendMode(Enum):
        BLEND_OPAQUE = 0
        BLEND_MASKED = 1
        BLEND_TRANSLUCENT = 2

    class Material(MaterialInterface, Editable):
        def __init__(self) -> None:
            super().__init__()
            self._nodes: list[Any] = []
            self._inputs: dict[str, tuple[Any, str]] = {}
            self._compiled = 0

    class MaterialFactoryNew(Factory):
        pass

    class MaterialProperty(Enum):
        MP_OPACITY = 0
        MP_OPACITY_MASK = 1
        MP_BASE_COLOR = 2
        MP_METALLIC = 3
        MP_ROUGHNESS = 4
        MP_NORMAL = 5
        MP_AMBIENT_OCCLUSION = 6

    class MaterialSamplerType(Enum):
        SAMPLERTYPE_COLOR = 0
        SAMPLERTYPE_NORMAL = 1
        SAMPLERTYPE_MASKS = 2

    class MaterialExpression(Editable):
        _outputs: tuple[str, ...] = ("",)
        _places: tuple[str, ...] = ()

        def __init__(self) -> None:
            super().__init__()
            self._inputs: dict[str, tuple[Any, str]] = {}

    class MaterialExpressionAdd(MaterialExpression):
        _places = ("A", "B")

    class MaterialExpressionMultiply(MaterialExpression):
        _places = ("A", "B")

    class MaterialExpressionLinearInterpolate(MaterialExpression):
        _places = ("A", "B", "Alpha")

    class MaterialExpressionConstant2Vector(MaterialExpression):
        pass

    class MaterialExpressionTextureCoordinate(MaterialExpression):
        pass

    class MaterialExpressionScalarParameter(MaterialExpression):
        pass

    class MaterialExpressionVectorParameter(MaterialExpression):
        _outputs = ("", "R", "G", "B", "A")

    class MaterialExpressionTextureSampleParameter2D(MaterialExpression):
        _outputs = ("RGB", "R", "G", "B", "A", "RGBA")
        _places = ("",)

        def set_editor_property(self, name: str, value: Any) -> None:
            super().set_editor_property(name, value)
            if name == "sampler_type":
                # The engine does not compile a sampler of another type than the texture's.
                kinds = {"SAMPLERTYPE_NORMAL": "TC_NORMALMAP", "SAMPLERTYPE_MASKS": "TC_MASKS"}
                texture = self._properties["texture"]._properties
                assert texture["compression_settings"].name == kinds.get(value.name, "TC_DEFAULT")
                assert texture["srgb"] == (value.name == "SAMPLERTYPE_COLOR")

    class MaterialEditingLibrary:
        @classmethod
        def create_material_expression(
            cls, material: Any, expression_class: Any, node_pos_x: int = 0, node_pos_y: int = 0
        ) -> Any:
            material._nodes.append(expression_class())
            return material._nodes[-1]

        @classmethod
        def connect_material_expressions(
            cls, from_expression: Any, from_output_name: str, to_expression: Any, to_input_name: str
        ) -> bool:
            if from_output_name not in from_expression._outputs or to_input_name not in to_expression._places:
                return False
            to_expression._inputs[to_input_name] = from_expression, from_output_name
            return True

        @classmethod
        def connect_material_property(cls, from_expression: Any, from_output_name: str, property_: Any) -> bool:
            (owner,) = (one for one in studio.assets.values() if from_expression in getattr(one, "_nodes", ()))
            owner._inputs[property_.name] = from_expression, from_output_name
            return from_output_name in from_expression._outputs

        @classmethod
        def delete_all_material_expressions(cls, material: Any) -> None:
            material._nodes, material._inputs = [], {}

        @classmethod
        def recompile_material(cls, material: Any) -> None:
            material._compiled += 1

    class AssetImportTask(Editable):
        def get_editor_property(self, name: str) -> Any:
            return {"imported_object_paths": self._properties.get("imported_object_paths", [])}[name]

    class FbxImportUI(Editable):
        pass

    class FbxSkeletalMeshImportData(Editable):
        pass

    class FbxAnimSequenceImportData(Editable):
        pass

    class FbxStaticMeshImportData(Editable):
        pass

    class FbxTextureImportData(Editable):
        pass

    class FBXNormalImportMethod(Enum):
        FBXNIM_COMPUTE_NORMALS = 0
        FBXNIM_IMPORT_NORMALS = 1
        FBXNIM_IMPORT_NORMALS_AND_TANGENTS = 2

    class FBXNormalGenerationMethod(Enum):
        BUILT_IN = 0
        MIKK_T_SPACE = 1

    class VertexColorImportOption(Enum):
        REPLACE = 0
        IGNORE = 1
        OVERRIDE = 2

    class FBXImportContentType(Enum):
        FBXICT_ALL = 0
        FBXICT_GEOMETRY = 1
        FBXICT_SKINNING_WEIGHTS = 2

    class MaterialSearchLocation(Enum):
        LOCAL = 0
        UNDER_PARENT = 1
        UNDER_ROOT = 2
        ALL_ASSETS = 3
        DO_NOT_SEARCH = 4

    class CoordinateSystemPolicy(Enum):
        MATCH_UP_FORWARD_AXES = 0
        MATCH_UP_AXIS = 1
        KEEP_XYZ_AXES = 2

    class FBXImportType(Enum):
        FBXIT_STATIC_MESH = 0
        FBXIT_SKELETAL_MESH = 1
        FBXIT_ANIMATION = 2

    class FBXAnimationLengthImportType(Enum):
        FBXALIT_EXPORTED_TIME = 0
        FBXALIT_ANIMATED_KEY = 1
        FBXALIT_SET_RANGE = 2

    def make(path: str, kind: type) -> Any:
        there = studio.assets.get(path)
        if there is not None:
            assert type(there) is kind, f"{path} is a {type(there).__name__} already"
            return there
        return studio.add(path, kind())

    def import_one(task: Any) -> None:
        path = f"{task._properties['destination_path']}/{task._properties['destination_name']}"
        asset = import_file(task)
        task._properties["imported_object_paths"] = [] if asset is None else [f"{path}.{asset.get_name()}"]

    def import_file(task: Any) -> Any:
        asked = task._properties
        path = f"{asked['destination_path']}/{asked['destination_name']}"
        options = asked.get("options")
        studio.imports.append({**asked, **({} if options is None else options._properties)})
        assert asked["automated"], "a dialog for every file"
        if path in studio.refuse_import:
            return None
        if asked["filename"].endswith(".wav"):
            sound = make(path, SoundWave)
            sound._duration_s = soundfile.info(asked["filename"]).duration
            return sound
        if asked["filename"].endswith((".png", ".jpg")):
            texture = make(path, Texture2D)
            texture._content = Path(asked["filename"]).read_bytes()
            return texture
        assert isinstance(asked["factory"], FbxFactory), "newer engines take Interchange"
        assert studio.variables.get(INTERCHANGE, "0") == "0", "newer engines take Interchange"
        ui = options._properties
        file = fbx_contents(Path(asked["filename"]))
        skeleton = ui.get("skeleton")
        if skeleton is not None and skeleton._bones != file.bones:
            return None
        if ui["mesh_type_to_import"] is FBXImportType.FBXIT_SKELETAL_MESH:
            mesh = make(path, SkeletalMesh)
            mesh._morphs = file.morphs
            mesh._skeleton = skeleton or make(f"{path}_Skeleton", Skeleton)
            mesh._skeleton._bones = file.bones
            slots = dict(reversed(slot) for slot in mesh._slots)
            for material in sorted(file.materials):
                made = make(f"{asked['destination_path']}/{material}", Material)
                slots[material] = slots.get(material) or made
            mesh._slots = tuple((slots[slot], slot) for slot in sorted(file.materials))
            return mesh
        assert ui["mesh_type_to_import"] is FBXImportType.FBXIT_ANIMATION
        if skeleton is None or file.frames is None:
            return None
        animation = make(path, AnimSequence)
        animation._skeleton, animation._frames = skeleton, file.frames - studio.lost_keys
        animation._curves = file.curves
        return animation

    class AssetTools:
        def import_asset_tasks(self, import_tasks: list[Any]) -> None:
            for task in import_tasks:
                import_one(task)

        def create_asset(self, asset_name: str, package_path: str, asset_class: type, factory: Any) -> Any:
            known = {LevelSequence: LevelSequenceFactoryNew, Material: MaterialFactoryNew}
            assert type(factory) is known[asset_class]
            return studio.add(f"{package_path}/{asset_name}", asset_class())

    class AssetToolsHelpers:
        @classmethod
        def get_asset_tools(cls) -> AssetTools:
            return AssetTools()

    class EditorAssetLibrary:
        @classmethod
        def does_asset_exist(cls, asset_path: str) -> bool:
            return asset_path in studio.assets

        @classmethod
        def does_directory_exist(cls, directory_path: str) -> bool:
            return any(path.startswith(f"{directory_path}/") for path in studio.assets)

        @classmethod
        def load_asset(cls, asset_path: str) -> Any:
            return studio.assets.get(asset_path)

        @classmethod
        def list_assets(cls, directory_path: str, recursive: bool = True, include_folder: bool = False) -> list[str]:
            return [
                asset.get_path_name() for path, asset in studio.assets.items() if path.startswith(f"{directory_path}/")
            ]

        @classmethod
        def delete_asset(cls, asset_path_to_delete: str) -> bool:
            if asset_path_to_delete in studio.undeletable:
                return False
            gone = studio.assets.pop(asset_path_to_delete)
            studio.metadata.pop(asset_path_to_delete, None)
            studio.deleted.append(asset_path_to_delete)
            for asset in studio.assets.values():
                if isinstance(asset, LevelSequence):
                    asset._forget(gone)
            return True

        @classmethod
        def rename_loaded_asset(cls, source_asset: Any, destination_asset_path: str) -> bool:
            if destination_asset_path in studio.assets:
                return False
            del studio.assets[source_asset._path]
            studio.add(destination_asset_path, source_asset)
            return True

        @classmethod
        def save_directory(cls, directory_path: str, only_if_is_dirty: bool = True, recursive: bool = True) -> bool:
            studio.saved.append(directory_path)
            return True

        @classmethod
        def set_metadata_tag(cls, object: Any, tag: str, value: str) -> None:
            assert isinstance(value, str)
            studio.metadata.setdefault(object._path, {})[tag] = value

        @classmethod
        def get_metadata_tag(cls, object: Any, tag: str) -> str:
            return studio.metadata.get(object._path, {}).get(tag, "")

        @classmethod
        def find_package_referencers_for_asset(cls, asset_path: str, load_assets_to_confirm: bool = False) -> list[str]:
            return studio.referencers.get(asset_path, [])

    # The level

    class ActorComponent(Object):
        pass

    class SkeletalMeshComponent(ActorComponent):
        def __init__(self, owner: Any) -> None:
            super().__init__()
            self._owner = owner

        def set_skinned_asset_and_update(self, new_mesh: Any, reinit_pose: bool = True) -> None:
            assert isinstance(new_mesh, SkeletalMesh)
            self._owner._mesh = new_mesh

    class Actor(Object):
        def __init__(self, mesh: Any, location: Vector, rotation: Rotator) -> None:
            super().__init__()
            self._mesh, self._location, self._rotation, self._label = mesh, location, rotation, ""

        def set_actor_label(self, new_actor_label: str, mark_dirty: bool = True) -> None:
            self._label = new_actor_label

        def get_component_by_class(self, component_class: type) -> Any:
            assert component_class is SkeletalMeshComponent
            return SkeletalMeshComponent(self)

    class World(Object):
        pass

    class UnrealEditorSubsystem(EditorSubsystem):
        def get_editor_world(self) -> World:
            return World()

    class EditorActorSubsystem(EditorSubsystem):
        def spawn_actor_from_object(
            self, object_to_use: Any, location: Vector, rotation: Rotator | None = None, transient: bool = False
        ) -> Any:
            assert isinstance(object_to_use, SkeletalMesh)
            studio.actors.append(Actor(object_to_use, location, rotation or Rotator()))
            return studio.actors[-1]

        def destroy_actor(self, actor_to_destroy: Any) -> bool:
            studio.actors.remove(actor_to_destroy)
            return True

    # The sequence

    class MovieSceneScriptingChannel(Object):
        def __init__(self, name: str) -> None:
            super().__init__()
            self._name = name

        @property
        def channel_name(self) -> str:
            return self._name

    class MovieSceneScriptingDoubleChannel(MovieSceneScriptingChannel):
        _value = 0.0
        _keys = 0

        def set_default(self, default_value: float) -> None:
            self._value = default_value

        def get_default(self) -> float:
            return self._value

        def get_num_keys(self) -> int:
            return self._keys

    class MovieSceneSection(Object):
        _range: Any = None
        _bounded = (True, True)

        def set_range(self, start_frame: int, end_frame: int) -> None:
            assert type(start_frame) is int
            assert type(end_frame) is int
            self._range = ("frames", start_frame, end_frame)

        def set_range_seconds(self, start_time: float, end_time: float) -> None:
            self._range = ("seconds", start_time, end_time)

        def set_start_frame_bounded(self, is_bounded: bool) -> None:
            self._bounded = (is_bounded, self._bounded[1])

        def set_end_frame_bounded(self, is_bounded: bool) -> None:
            self._bounded = (self._bounded[0], is_bounded)

        def get_all_channels(self) -> list[Any]:
            return []

    class MovieScene3DTransformSection(MovieSceneSection):
        def __init__(self) -> None:
            super().__init__()
            names = [f"{kind}.{axis}" for kind in ("Location", "Rotation", "Scale") for axis in "XYZ"]
            self._channels = [MovieSceneScriptingDoubleChannel(name) for name in names]
            self._channels.append(MovieSceneScriptingChannel("Weight"))

        def get_all_channels(self) -> list[Any]:
            return self._channels

    class MovieSceneObjectBindingID(StructBase):
        _id = 0

    class MovieScene3DAttachSection(MovieSceneSection):
        attach_socket_name = "None"
        _holder: Any = None

        def set_constraint_binding_id(self, constraint_binding_id: MovieSceneObjectBindingID) -> None:
            self._holder = constraint_binding_id._id

    class MovieSceneSkeletalAnimationParams(StructBase):
        animation: Any = None

    class MovieSceneSkeletalAnimationSection(MovieSceneSection):
        def __init__(self) -> None:
            super().__init__()
            self._animation: Any = None

        @property
        def params(self) -> MovieSceneSkeletalAnimationParams:
            # A copy, as structs of Unreal's are.
            params = MovieSceneSkeletalAnimationParams()
            params.animation = self._animation
            return params

        @params.setter
        def params(self, value: MovieSceneSkeletalAnimationParams) -> None:
            self._animation = value.animation

    class MovieSceneAudioSection(MovieSceneSection):
        _sound: Any = None
        _looping = True

        def set_sound(self, sound: Any) -> None:
            self._sound = sound

        def get_sound(self) -> Any:
            return self._sound

        def set_looping(self, looping: bool) -> None:
            self._looping = looping

    class MovieSceneTrack(Object):
        _section: Callable[[], Any] = MovieSceneSection

        def __init__(self) -> None:
            super().__init__()
            self._sections: list[Any] = []
            self._display_name = ""

        def add_section(self) -> Any:
            self._sections.append(type(self)._section())
            return self._sections[-1]

        def get_sections(self) -> list[Any]:
            return list(self._sections)

        def set_display_name(self, name: str) -> None:
            self._display_name = name

    class MovieScene3DTransformTrack(MovieSceneTrack):
        _section = MovieScene3DTransformSection

    class MovieScene3DAttachTrack(MovieSceneTrack):
        _section = MovieScene3DAttachSection

    class MovieSceneSkeletalAnimationTrack(MovieSceneTrack):
        _section = MovieSceneSkeletalAnimationSection

    class MovieSceneAudioTrack(MovieSceneTrack):
        _section = MovieSceneAudioSection

    class Tracks:
        """Base of objects with tracks."""

        def __init__(self) -> None:
            self._tracks: list[Any] = []

        def add_track(self, track_type: type) -> Any:
            self._tracks.append(track_type())
            return self._tracks[-1]

        def find_tracks_by_exact_type(self, track_type: type) -> list[Any]:
            return [track for track in self._tracks if type(track) is track_type]

    class MovieSceneBindingProxy(Tracks, StructBase):
        def __init__(self, sequence: Any, mesh: Any) -> None:
            super().__init__()
            self._sequence, self._display_name = sequence, ""
            self._template = Actor(mesh, Vector(), Rotator())
            self._id = Guid()
            self._id._value = next(studio.ids)

        @property
        def _mesh(self) -> Any:
            return self._template._mesh

        def get_object_template(self) -> Any:
            return self._template

        def get_id(self) -> Guid:
            return self._id

        def set_display_name(self, display_name: str) -> None:
            self._display_name = display_name

        def remove_track(self, track_to_remove: Any) -> None:
            self._tracks.remove(track_to_remove)

        def remove(self) -> None:
            self._sequence._bindings.remove(self)

    class MovieSceneMarkedFrame(StructBase):
        def __init__(self, frame_number: FrameNumber | None = None, label: str = "") -> None:
            self.frame_number, self.label = frame_number or FrameNumber(), label

    class MovieSceneSequence(Tracks, Object):
        def __init__(self) -> None:
            Tracks.__init__(self)
            self._bindings: list[Any] = []
            self._marks: list[Any] = []
            self._rate, self._ticks = FrameRate(30, 1), FrameRate(24000, 1)
            self._start, self._end = 0, 150
            self._view, self._work = [0.0, 5.0], [0.0, 5.0]
            self._read_only = False

        def set_display_rate(self, display_rate: FrameRate) -> None:
            self._rate = display_rate

        def get_tick_resolution(self) -> FrameRate:
            return self._ticks

        def set_tick_resolution(self, tick_resolution: FrameRate) -> None:
            self._ticks = tick_resolution

        def set_playback_start(self, start_frame: int) -> None:
            self._start = start_frame

        def set_playback_end(self, end_frame: int) -> None:
            self._end = end_frame

        def set_view_range_start(self, start_time_in_seconds: float) -> None:
            self._view[0] = start_time_in_seconds

        def set_view_range_end(self, end_time_in_seconds: float) -> None:
            self._view[1] = end_time_in_seconds

        def set_work_range_start(self, start_time_in_seconds: float) -> None:
            self._work[0] = start_time_in_seconds

        def set_work_range_end(self, end_time_in_seconds: float) -> None:
            self._work[1] = end_time_in_seconds

        def is_read_only(self) -> bool:
            return self._read_only

        def get_bindings(self) -> list[Any]:
            return list(self._bindings)

        def get_binding_id(self, binding: Any) -> MovieSceneObjectBindingID:
            assert binding in self._bindings
            id = MovieSceneObjectBindingID()
            id._id = binding._id._value
            return id

        def get_marked_frames_from_sequence(self) -> list[Any]:
            return list(self._marks)

        def add_marked_frame_to_sequence(self, marked_frame: MovieSceneMarkedFrame) -> int:
            self._marks.append(marked_frame)
            return len(self._marks) - 1

        def delete_marked_frame(self, delete_index: int) -> None:
            del self._marks[delete_index]

        def get_marked_frames(self) -> list[Any]:
            return list(self._marks)

        def add_marked_frame(self, marked_frame: MovieSceneMarkedFrame) -> int:
            self._marks.append(marked_frame)
            return len(self._marks) - 1

        def add_spawnable_from_instance(self, object_to_spawn: Any) -> MovieSceneBindingProxy:
            assert object_to_spawn in studio.actors
            self._bindings.append(MovieSceneBindingProxy(self, object_to_spawn._mesh))
            return self._bindings[-1]

        def _forget(self, asset: Any) -> None:
            for binding in self._bindings:
                binding._template._mesh = None if binding._mesh is asset else binding._mesh
            for track in [*self._tracks, *(track for binding in self._bindings for track in binding._tracks)]:
                for section in track._sections:
                    for name, value in vars(section).items():
                        if value is asset:
                            setattr(section, name, None)

    class LevelSequence(MovieSceneSequence):
        pass

    class LevelSequenceEditorSubsystem(EditorSubsystem):
        def add_spawnable_from_instance(self, sequence: Any, object_to_spawn: Any) -> MovieSceneBindingProxy:
            made: MovieSceneBindingProxy = sequence.add_spawnable_from_instance(object_to_spawn)
            return made

    class LevelSequenceEditorBlueprintLibrary:
        @classmethod
        def open_level_sequence(cls, level_sequence: Any) -> bool:
            studio.opened.append(level_sequence._path)
            return True

        @classmethod
        def refresh_current_level_sequence(cls) -> None:
            assert studio.opened

    return {name: value for name, value in locals().items() if isinstance(value, type)}
