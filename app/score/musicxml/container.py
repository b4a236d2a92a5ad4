"""Reads the XML document of a MusicXML file, plain or compressed, within size limits.

For security, a document that declares entities is refused, and references to external files are ignored. Text may be
UTF-8 or UTF-16, with or without a byte order mark, or in the encoding that the XML declaration names; characters that
XML forbids are dropped.
"""

from __future__ import annotations

import codecs
import re
import zipfile
import zlib
from io import BytesIO
from pathlib import Path
from typing import Final
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from app.errors import FileError, shortened
from app.formats.files import open_file, read_file
from app.score.suffixes import NOTATION

MOST_BYTES: Final = 2**26
"""Largest size in bytes of a file, and of its decompressed content; a symphony has some tens of megabytes."""
MOST_RATIO: Final = 200
"""Greatest compression ratio of a score above `_SMALL`; notes compress by a factor of forty."""
_SMALL: Final = 2**20
MOST_DEPTH: Final = 64
"""Greatest nesting depth of elements; the format has a dozen."""
MOST_ELEMENTS: Final = 3_000_000
_MOST_MEMBERS: Final = 10_000
_INDEX: Final = "META-INF/container.xml"
_ZIP: Final = b"PK\x03\x04"
_METHODS: Final = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
"""Compression methods of the format, which decompress in small steps; others may produce gigabytes in one step."""
_NO_LETTERS: Final = frozenset(("idna", "punycode", "raw-unicode-escape", "undefined", "unicode-escape", "utf-7"))
"""Names of Python's encodings in which no document is written."""
_START: Final = 1024
_DECLARED: Final = re.compile(rb"""^\s*<\?xml[^>]*?encoding\s*=\s*["']([A-Za-z][\w.:-]*)["']""")
_NO_XML: Final = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff\ud800-\udfff]")
_BOMS: Final = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
    (b"<\0", "utf-16-le"),
    (b"\0<", "utf-16-be"),
)


def is_musicxml(path: Path) -> bool:
    """Return whether a file is MusicXML, judged by its first bytes, or by its name if they are not conclusive.

    Raises FileError as `open_file`.
    """
    with open_file(path) as stream:
        try:
            start = stream.read(_START)
        except OSError:
            # Reading the file raises the error.
            return False
    if start.startswith((b"MThd", b"RIFF")):
        return False
    if start.startswith(_ZIP) or start.removeprefix(codecs.BOM_UTF8).lstrip().startswith(b"<"):
        return True
    return start.startswith(tuple(mark for mark, _ in _BOMS)) or path.suffix.lower() in NOTATION


def read_document(path: Path) -> tuple[Element, int]:
    """Parse the XML document of a score.

    Returns
    -------
    root : Element
        Root element, ``score-partwise`` or ``score-timewise``.
    size : int
        Size of the file in bytes.

    Raises
    ------
    FileError
        The file cannot be read, is damaged or too large, or is not a score.
    """
    file = str(path)
    content = read_file(path, MOST_BYTES)
    size = len(content)
    if content.startswith(_ZIP):
        content = _unpacked(content, file)
    root = _parsed(_decoded(content), file)
    if root.tag not in ("score-partwise", "score-timewise"):
        if root.tag == "opus":
            raise FileError("musicxml.list_of_scores", file=file)
        raise FileError("musicxml.not_a_score", file=file, root=shortened(root.tag, 60))
    return root, size


def _unpacked(content: bytes, file: str) -> bytes:
    """Extract the score from a compressed file: the first file named in its index, else the first member that looks
    like a score.
    """
    try:
        with zipfile.ZipFile(BytesIO(content)) as archive:
            names = archive.namelist()
            if len(names) > _MOST_MEMBERS:
                raise FileError("musicxml.damaged_archive", file=file)
            name = _named(archive, names, file) or next(
                (
                    one
                    for one in names
                    if one.lower().endswith((".xml", ".musicxml")) and not one.startswith(("META-INF/", "__MACOSX/"))
                ),
                None,
            )
            if name is None:
                raise FileError("musicxml.no_score_in_archive", file=file)
            return _member(archive, name, file, max(_SMALL, MOST_RATIO * len(content)))
    except (zipfile.BadZipFile, zlib.error, KeyError, NotImplementedError, RuntimeError, OSError, EOFError) as error:
        raise FileError("musicxml.damaged_archive", file=file) from error
    except ValueError as error:
        raise FileError("musicxml.damaged_archive", file=file) from error


def _named(archive: zipfile.ZipFile, names: list[str], file: str) -> str | None:
    """Name of the archive member that the index of a compressed file gives as the score; None if it gives none."""
    if _INDEX not in names:
        return None
    index = _parsed(_decoded(_member(archive, _INDEX, file, _SMALL)), file)
    for one in index.iter():
        if one.tag.rpartition("}")[2].rpartition(":")[2] != "rootfile":
            continue
        kind = one.get("media-type", "")
        path = one.get("full-path", "").replace("\\", "/").removeprefix("./")
        if path in names and (not kind or "musicxml" in kind or kind.endswith("xml")):
            return path
    return None


def _member(archive: zipfile.ZipFile, name: str, file: str, most: int) -> bytes:
    most = min(most, MOST_BYTES)
    if archive.getinfo(name).compress_type not in _METHODS:
        raise FileError("musicxml.damaged_archive", file=file)
    with archive.open(name) as stream:
        content = stream.read(most + 1)
    if len(content) > most:
        raise FileError("musicxml.archive_too_large", file=file, most_mb=most >> 20)
    return content


def _decoded(content: bytes) -> str:
    """Decode the bytes of a document to text, without characters that XML forbids."""
    encoding = next((name for mark, name in _BOMS if content.startswith(mark)), None)
    if encoding is None:
        declared = _DECLARED.match(content[:_START])
        name = "utf-8" if declared is None else declared[1].decode("ascii")
        try:
            encoding = codecs.lookup(name).name
        except LookupError:
            encoding = "utf-8"
        # Content that begins with ASCII letters has no multi-byte encoding, whatever it declares.
        if encoding.startswith(("utf-16", "utf-32")) or encoding.replace("_", "-") in _NO_LETTERS:
            encoding = "utf-8"
    try:
        text = content.decode(encoding)
    except (UnicodeError, LookupError):
        text = content.decode("utf-8" if encoding != "utf-8" else "cp1252", errors="replace")
    return _NO_XML.sub("", text).lstrip("\ufeff \t\r\n")


def _parsed(text: str, file: str) -> Element:
    """Parse an XML document into its elements, within limits of depth and number. Raises FileError if it is damaged."""
    builder = TreeBuilder()
    parser = expat.ParserCreate("utf-8")
    depth = count = 0

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal depth, count
        depth += 1
        count += 1
        if depth > MOST_DEPTH:
            raise FileError("musicxml.too_deep", file=file, line=parser.CurrentLineNumber, most=MOST_DEPTH)
        if count > MOST_ELEMENTS:
            raise FileError("musicxml.too_many_elements", file=file, most=MOST_ELEMENTS)
        builder.start(tag, attributes)

    def end(tag: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(tag)

    def refuse(*_: object) -> None:
        raise FileError("musicxml.entities", file=file)

    parser.buffer_text = True
    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler = builder.data
    parser.EntityDeclHandler = parser.UnparsedEntityDeclHandler = refuse
    try:
        parser.Parse(text.encode(), True)
    except expat.ExpatError as error:
        line, detail = error.lineno, expat.errors.messages.get(error.code, str(error))
        raise FileError("musicxml.damaged", file=file, line=line, detail=shortened(detail)) from error
    root = builder.close()
    assert isinstance(root, Element)
    return root
