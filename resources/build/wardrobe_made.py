"""A record of the scripts and files of the wardrobe, so that a change of scripts without a new build is noticed."""

from __future__ import annotations

import ast
import hashlib
import io
import json
import tokenize
from collections.abc import Iterator
from pathlib import Path

RECORD = "made.json"
"""The file of the record, in the folder of the outfits."""
_SKIPPED = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENCODING,
    tokenize.ENDMARKER,
}


def _documented(tree: ast.AST) -> Iterator[int]:
    """First lines of the texts that only describe: docstrings of modules, classes, functions and constants."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            yield node.lineno


def meant(source: str) -> str:
    """The statements of a script without its descriptions, comments and white space."""
    described = set(_documented(ast.parse(source)))
    words = [
        token.string
        for token in tokenize.generate_tokens(io.StringIO(source).readline)
        if token.type not in _SKIPPED and not (token.type == tokenize.STRING and token.start[0] in described)
    ]
    # Commas before brackets come and go with the layout.
    return "".join("".join(words).split()).replace(",)", ")").replace(",]", "]").replace(",}", "}")


def scripts(first: Path) -> list[Path]:
    """The script and all beside it that it imports, themselves or by others, in the order of their names."""
    found, waiting = set(), [first]
    while waiting:
        path = waiting.pop()
        if path in found or not path.is_file():
            continue
        found.add(path)
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module:
                waiting.append(path.with_name(f"{node.module}.py"))
    return sorted(found)


def record(first: Path, folder: Path) -> dict[str, object]:
    """Digests of the scripts and of the files that they made in a folder."""
    digest = hashlib.blake2b(digest_size=16)
    for path in scripts(first):
        digest.update(f"{path.name}\n{meant(path.read_text(encoding='utf-8'))}\n".encode())
    files = {
        path.name: hashlib.blake2b(path.read_bytes(), digest_size=16).hexdigest()
        for path in sorted(folder.iterdir())
        if path.name != RECORD
    }
    return {"scripts": digest.hexdigest(), "files": files}


def write_record(first: Path, folder: Path) -> None:
    """Write the record beside the files."""
    (folder / RECORD).write_text(json.dumps(record(first, folder), indent=1) + "\n", encoding="utf-8")
