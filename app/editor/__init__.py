"""State and services of the editor, independent of widgets.

State shared by panels and commands (`session` and its parts: selection, listening, recording, streaming, live players,
viewport), and services that update with the project: files and settings, plans and motion, sound, recorder, streamer,
user libraries, background tasks. Only signals, timers and watchers of Qt are used (``PySide6.QtCore``).
"""
