"""The editor's dialogs."""
