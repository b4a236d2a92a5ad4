"""The command line: parses, prints, and calls the rooms below."""
