"""Straps that instruments hang on, and the chair of who sits: shapes, how they follow, how they are fitted."""
