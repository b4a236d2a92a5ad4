"""Reads scores in MusicXML, as notation programs write them."""
