"""Reads and writes glTF 2.0 and VRM files."""
