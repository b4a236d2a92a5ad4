"""Exports into the folder of an Unreal project: sources, a description, what is ours, and the plug-in that imports."""
