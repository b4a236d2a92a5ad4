"""The plug-in uses only documented names, and syntax supported by the editor's Python."""

from __future__ import annotations

import ast
import inspect
import json
import string
import subprocess
import sys
from enum import Enum
from pathlib import Path

import pytest

from tests.support import unreal_stub
from tests.support.fake_unreal import STUB, fake_unreal, stub_classes
from tests.unit.resources.unreal.conftest import PYTHON, Editor

PLUGIN = PYTHON.parents[1]
SOURCES = sorted(PYTHON.rglob("*.py"))


def test_mypy_finds_no_other_name() -> None:
    command = [
        sys.executable,
        "-m",
        "mypy",
        "--strict",
        "--config-file=",
        "--cache-dir=/dev/null",
        "--explicit-package-bases",
    ]
    done = subprocess.run(
        [*command, *map(str, SOURCES)],
        env={"MYPYPATH": f"{STUB.parents[1]}:{PYTHON}", "PATH": ""},
        cwd=PYTHON,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


real = pytest.mark.skipif(not unreal_stub.FILE.exists(), reason="unreal-stub is set up by ./test")
OPTIONS = {
    "FbxImportUI": "import_ui",
    "FbxSkeletalMeshImportData": "skeletal_mesh",
    "FbxAnimSequenceImportData": "animation",
    "FbxStaticMeshImportData": "static_mesh",
    "FbxTextureImportData": "textures",
}


@real
def test_mypy_finds_no_other_name_in_the_engine_s_own_list(tmp_path: Path) -> None:
    package = tmp_path / "unreal"
    package.mkdir()
    (package / "__init__.py").write_text(unreal_stub.excerpt(set(stub_classes())), encoding="utf-8")
    config = tmp_path / "mypy.ini"
    # The excerpt names classes that it lacks, and is not checked itself.
    config.write_text("[mypy]\nexplicit_package_bases = True\n[mypy-unreal.*]\nignore_errors = True\n")
    wrong = tmp_path / "wrong.py"
    wrong.write_text("import unreal\n\nunreal.EditorAssetLibrary.load_assets('x')\n")
    outputs = []
    for sources in (SOURCES, [wrong]):
        done = subprocess.run(
            [sys.executable, "-m", "mypy", f"--config-file={config}", "--cache-dir=/dev/null", *map(str, sources)],
            env={"MYPYPATH": f"{tmp_path}:{PYTHON}", "PATH": ""},
            cwd=PYTHON,
            capture_output=True,
            text=True,
            check=False,
        )
        outputs.append(done.stdout + done.stderr)
    assert outputs[0].startswith("Success"), outputs[0]
    assert "load_assets" in outputs[1]


@real
@pytest.mark.parametrize("name", OPTIONS)
def test_every_option_that_may_be_set_is_set(editor: Editor, name: str) -> None:
    from suisou_import import fbx_options

    unreal = editor.unreal
    arguments = {"FbxImportUI": (unreal.FBXImportType.FBXIT_ANIMATION, None), "FbxAnimSequenceImportData": (24,)}
    values = getattr(fbx_options, OPTIONS[name])(*arguments.get(name, ()))
    documented = unreal_stub.documented_properties(name)
    data = {prop for prop in documented if prop.endswith("_import_data")}
    assert set(values) == set(documented) - data
    assert bool(data) == (name == "FbxImportUI")
    for prop, value in values.items():
        kind = {"int32": "int", "Name": "str", "Array[str]": "list"}.get(documented[prop], documented[prop])
        assert value is None or type(value).__name__ == kind, prop


@real
@pytest.mark.parametrize("language", ["", "_ja"])
def test_the_guide_lists_every_option(language: str) -> None:
    guide = (PLUGIN.parents[2] / "docs" / f"unreal-import-options{language}.md").read_text(encoding="utf-8")
    for name in OPTIONS:
        for prop in unreal_stub.documented_properties(name):
            assert f"`{prop}`" in guide, f"{name}.{prop}"


def test_a_misspelt_property_is_found_by_mypy_and_by_the_fake(tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.py"
    wrong.write_text('import unreal\n\nunreal.FbxImportUI().set_editor_property("import_meshes", True)\n')
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--config-file=", "--cache-dir=/dev/null", str(wrong)],
        env={"MYPYPATH": str(STUB.parents[1]), "PATH": ""},
        capture_output=True,
        text=True,
        check=False,
    )
    assert "No overload variant" in done.stdout
    unreal = fake_unreal(tmp_path)
    with pytest.raises(AttributeError):
        unreal.FbxImportUI().set_editor_property("import_meshes", True)
    with pytest.raises(TypeError):
        unreal.FbxAnimSequenceImportData().set_editor_property("custom_sample_rate", 29.97)


def test_the_fake_knows_the_documented_names_and_no_others(tmp_path: Path) -> None:
    unreal = fake_unreal(tmp_path)
    for name, node in stub_classes().items():
        fake = getattr(unreal, name)
        functions = {
            item.name: [argument.arg for argument in (*item.args.args, *item.args.kwonlyargs)]
            for item in node.body
            if isinstance(item, ast.FunctionDef) and not item.name.startswith("__")
        }
        known = {name for base in fake.__mro__ for name in vars(base) if not name.startswith("_")}
        assert set(functions) <= known, name
        for function, arguments in functions.items():
            member = inspect.getattr_static(fake, function)
            if function.endswith("editor_property") or isinstance(member, property):
                continue
            real = getattr(member, "__func__", member)
            assert list(inspect.signature(real).parameters) == arguments, f"{name}.{function}"
        documented = {
            item.name if isinstance(item, ast.FunctionDef) else item.target.id
            for base in fake.__mro__
            for item in (stub_classes()[base.__name__].body if base.__name__ in stub_classes() else [])
            if isinstance(item, ast.FunctionDef)
            or (isinstance(item, ast.AnnAssign) and isinstance(item.target, ast.Name))
        }
        values = {item.targets[0].id for item in node.body if isinstance(item, ast.Assign)}  # type: ignore[attr-defined]
        own = {attribute for attribute in vars(fake) if not attribute.startswith("_")}
        if issubclass(fake, Enum):
            assert {member.name for member in fake} == values, name
        else:
            assert own - documented <= {"x", "y", "z", "roll", "pitch", "yaw"}, name


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.name)
def test_python_3_9_understands_it(path: Path) -> None:
    tree = ast.parse(path.read_text(encoding="utf-8"), feature_version=(3, 9))
    imported = {
        (name.name if isinstance(node, ast.Import) else node.module or "").split(".")[0]
        for node in ast.walk(tree)
        if isinstance(node, ast.Import | ast.ImportFrom)
        for name in node.names
    }
    assert imported - {"unreal", "suisou_import"} <= set(sys.stdlib_module_names)
    calls = {node.func.id for node in ast.walk(tree) if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)}
    assert not calls & {"exec", "eval", "compile", "__import__", "globals"}


def test_every_text_is_in_both_languages(editor: Editor) -> None:
    from suisou_import.problem import TEXTS

    used = {
        node.args[0].value
        for path in SOURCES
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id in ("text", "problem", "step")
        and node.args
        and isinstance(node.args[0], ast.Constant)
    }
    chosen = {"import", "import_tip", "update", "update_tip", "ask_import", "ask_update", "done_import", "done_update"}
    assert used | chosen == set(TEXTS)
    for name, (english, japanese) in TEXTS.items():
        fields = [{field for _, field, _, _ in string.Formatter().parse(text) if field} for text in (english, japanese)]
        assert fields[0] == fields[1], name


def test_the_descriptor() -> None:
    descriptor = json.loads((PLUGIN / "Suisou.uplugin").read_text(encoding="utf-8"))
    assert descriptor["CreatedBy"] == "Suisou"
    assert descriptor["EnabledByDefault"] is True
    assert descriptor["CanContainContent"] is True
    assert descriptor["Modules"] == []
    needed = {plugin["Name"] for plugin in descriptor["Plugins"] if plugin["Enabled"]}
    assert needed == {"PythonScriptPlugin", "EditorScriptingUtilities", "LevelSequenceEditor", "SequencerScripting"}
