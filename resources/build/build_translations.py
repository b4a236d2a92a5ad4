"""Collects the texts of the editor into resources/translations/<room>_ja.ts and releases suisou_ja.qm from them.

Run from the repository, in the environment of the tests: ``python resources/build/build_translations.py``. Texts that
are new stand in the .ts files as unfinished: translate them there (in a text editor or Qt Linguist), then run it again.
"""

from __future__ import annotations

import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

ROOT = Path(__file__).parents[2]
TARGET = ROOT / "resources" / "translations"
LANGUAGE = "ja"


def rooms() -> dict[str, list[Path]]:
    """The sources of every room that shows texts."""
    found = {"shell": sorted((ROOT / "app" / "shell").rglob("*.py"))}
    for folder in sorted((ROOT / "widgets").iterdir()):
        sources = sorted(folder.rglob("*.py"))
        if len(sources) > 1:
            found[folder.name] = sources
    return found


def tool(name: str) -> str:
    """A program of Qt beside this Python."""
    return str(Path(sys.executable).parent / f"pyside6-{name}")


def collect(sources: list[Path], target: Path) -> None:
    """Bring a room's file up to date with its sources; what is translated stays."""
    command = [tool("lupdate"), *map(str, sources), "-ts", str(target), "-target-language", LANGUAGE]
    command += ["-no-obsolete", "-locations", "none"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    complaints = [line for line in done.stderr.splitlines() if line.strip()]
    if done.returncode or complaints:
        sys.exit("\n".join([f"{target.name}: lupdate complains", *complaints]))


def declared() -> dict[str, tuple[str, list[str]]]:
    """The texts that tables declare in English, by file, each with its context."""
    sys.path.insert(0, str(ROOT))
    from app.messages import TEMPLATES
    from app.plan.parameters import PARAMETERS
    from app.project.model import DANCER_PARAMETERS
    from app.shell.settings import SETTINGS

    parameters = (*PARAMETERS.values(), *DANCER_PARAMETERS.values())
    of_parameters = [word for parameter in parameters for word in parameter.words]
    of_settings = [word for setting in SETTINGS if setting.label for word in setting.words]
    return {
        name: (context, list(dict.fromkeys(texts)))
        for name, context, texts in (
            ("messages", "Message", TEMPLATES.values()),
            ("parameters", "Parameter", of_parameters),
            ("settings", "Setting", of_settings),
        )
    }


def collect_declared(target: Path, context: str, texts: list[str]) -> None:
    """Texts of tables, in their order; what is translated stays."""
    known = translations(target) if target.exists() else {}
    ts = ET.Element("TS", version="2.1", language=LANGUAGE, sourcelanguage="en")
    element = ET.SubElement(ts, "context")
    ET.SubElement(element, "name").text = context
    for source in texts:
        message = ET.SubElement(element, "message")
        ET.SubElement(message, "source").text = source
        text = known.get((context, source), "")
        translation = ET.SubElement(message, "translation")
        if text:
            translation.text = text
        else:
            translation.set("type", "unfinished")
    ET.indent(ts, "    ")
    body = ET.tostring(ts, encoding="unicode")
    target.write_text(f'<?xml version="1.0" encoding="utf-8"?>\n<!DOCTYPE TS>\n{body}\n', encoding="utf-8")


def translations(path: Path) -> dict[tuple[str, str], str]:
    """Context and source to translation; empty where it is unfinished."""
    found = {}
    for context in ET.parse(path).getroot().iter("context"):
        name = context.findtext("name") or ""
        for message in context.iter("message"):
            element = message.find("translation")
            finished = element is not None and element.get("type") is None
            text = "".join(element.itertext()) if element is not None and finished else ""
            found[name, message.findtext("source") or ""] = text
    return found


def release() -> None:
    """All rooms into the one file that the editor reads."""
    sources = sorted(TARGET.glob(f"*_{LANGUAGE}.ts"))
    command = [tool("lrelease"), "-silent", "-nounfinished", *map(str, sources), "-qm"]
    subprocess.run([*command, str(TARGET / f"suisou_{LANGUAGE}.qm")], check=True)


def main() -> None:
    """Collect, release, and say what is not translated."""
    TARGET.mkdir(exist_ok=True)
    for room, sources in rooms().items():
        collect(sources, TARGET / f"{room}_{LANGUAGE}.ts")
    for name, (context, texts) in declared().items():
        collect_declared(TARGET / f"{name}_{LANGUAGE}.ts", context, texts)
    release()
    for path in sorted(TARGET.glob(f"*_{LANGUAGE}.ts")):
        found = translations(path)
        missing = [source for (_, source), text in found.items() if not text]
        print(f"{path.name}: {len(found)} texts, {len(missing)} not translated")
        for source in missing:
            print(f"    {source}")


if __name__ == "__main__":
    main()
