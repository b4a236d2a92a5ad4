"""Sections of an FBX file other than its objects, and helpers for properties."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

import numpy as np

from app.formats.fbx import encode, ticks
from app.formats.fbx.encode import Element, Property
from app.formats.levels_of_detail import LEAST_HEIGHTS


def integer(name: str, value: int) -> Element:
    """Return an FBX record ``name`` that holds one 32-bit integer."""
    return Element(name, (np.int32(value),))


def property_row(name: str, kind: str, label: str, flags: str, *values: Property) -> Element:
    """Return a record of a property in FBX's block "Properties70": name, type, label, flags and values."""
    return Element("P", (name, kind, label, flags, *values))


def property_block(*rows: Element) -> Element:
    """Return FBX's record "Properties70", which holds rows of properties."""
    return Element("Properties70", (), rows)


def header(creator: str) -> Element:
    """Return FBX's record with version, program and a constant date."""
    stamp = tuple(
        integer(name, value)
        for name, value in (
            ("Version", 1000), ("Year", 1970), ("Month", 1), ("Day", 1),
            ("Hour", 10), ("Minute", 0), ("Second", 0), ("Millisecond", 0),
        )
    )  # fmt: skip
    texts = ("Title", "Subject", "Author", "Keywords", "Revision", "Comment")
    meta = (integer("Version", 100), *(Element(name, ("",)) for name in texts))
    vendor = [
        property_row(f"{when}|{what}", "KString", "", "", value)
        for when in ("Original", "LastSaved")
        for what, value in (("ApplicationVendor", "Suisou"), ("ApplicationName", creator))
    ]
    info = (
        Element("Type", ("UserData",)),
        integer("Version", 100),
        Element("MetaData", (), meta),
        property_block(*vendor),
    )
    return Element(
        "FBXHeaderExtension",
        (),
        (
            integer("FBXHeaderVersion", 1003),
            integer("FBXVersion", encode.VERSION),
            integer("EncryptionType", 0),
            Element("CreationTimeStamp", (), stamp),
            Element("Creator", (creator,)),
            Element("SceneInfo", ("GlobalInfo\0\x01SceneInfo", "UserData"), info),
        ),
    )


def global_settings(rate: Fraction | None, last_tick: int) -> Element:
    """Return FBX's record of axes (Y up, right-handed), unit (centimetres), frame rate and time span."""
    axes = (
        ("UpAxis", 1), ("UpAxisSign", 1), ("FrontAxis", 2), ("FrontAxisSign", 1), ("CoordAxis", 0),
        ("CoordAxisSign", 1), ("OriginalUpAxis", 1), ("OriginalUpAxisSign", 1),
    )  # fmt: skip
    rows = [property_row(name, "int", "Integer", "", np.int32(value)) for name, value in axes]
    rows += [
        property_row("UnitScaleFactor", "double", "Number", "", 1.0),
        property_row("OriginalUnitScaleFactor", "double", "Number", "", 1.0),
    ]
    if rate is not None:
        rows += [
            property_row("TimeMode", "enum", "", "", np.int32(ticks.time_mode(rate))),
            property_row("TimeSpanStart", "KTime", "Time", "", np.int64(0)),
            property_row("TimeSpanStop", "KTime", "Time", "", np.int64(last_tick)),
            property_row("CustomFrameRate", "double", "Number", "", float(rate)),
        ]
    return Element("GlobalSettings", (), (integer("Version", 1000), property_block(*rows)))


def documents(document_id: int, take: str) -> Element:
    """Return FBX's record of documents with the single one that every file needs, the scene.

    ``take`` is the name of its animation.
    """
    document = Element(
        "Document",
        (np.int64(document_id), "Scene", "Scene"),
        (
            property_block(
                property_row("SourceObject", "object", "", ""),
                property_row("ActiveAnimStackName", "KString", "", "", take),
            ),
            Element("RootNode", (np.int64(0),)),
        ),
    )
    return Element("Documents", (), (integer("Count", 1), document))


def definitions(objects: Iterable[Element]) -> Element:
    """Return the Definitions section with the number of objects of each kind; without it the FBX SDK finds no
    objects.
    """
    counts = {"GlobalSettings": 1}
    for element in objects:
        counts[element.name] = counts.get(element.name, 0) + 1
    types = (Element("ObjectType", (kind,), (integer("Count", count),)) for kind, count in counts.items())
    return Element("Definitions", (), (integer("Version", 100), integer("Count", sum(counts.values())), *types))


def lod_group(lower_levels: int) -> tuple[Element, ...]:
    """Return the child records of the attribute of a node that shows one of its children, depending on the height of
    the figure on the screen.
    """
    rows = [
        property_row("MinMaxDistance", "bool", "", "", np.int32(0)),
        property_row("ThresholdsUsedAsPercentage", "bool", "", "", np.int32(1)),
        property_row("WorldSpace", "bool", "", "", np.int32(0)),
    ]
    rows += [
        property_row(f"Thresholds|Level{number}", "Distance", "", "", float(100 * height), "cm")
        for number, height in enumerate(LEAST_HEIGHTS[:lower_levels])
    ]
    rows += [
        property_row(f"DisplayLevels|Level{number}", "enum", "", "", np.int32(0)) for number in range(lower_levels + 1)
    ]
    return (property_block(*rows),)


def takes(take: str, last_tick: int) -> Element:
    """Return FBX's section Takes, in which older programs find the clip."""
    children: tuple[Element, ...] = (Element("Current", (take,)),)
    if take:
        span = (np.int64(0), np.int64(last_tick))
        details = (Element("FileName", (f"{take}.tak",)), Element("LocalTime", span), Element("ReferenceTime", span))
        children += (Element("Take", (take,), details),)
    return Element("Takes", (), children)
