"""Exports into an Unreal project's folder: source files, a description, a manifest, and the importing plug-in."""
