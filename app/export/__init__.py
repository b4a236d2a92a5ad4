"""Exports a performance as files: characters, instruments and the report."""
