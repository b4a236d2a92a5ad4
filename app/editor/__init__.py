"""The editor's state and services, below all widgets.

State that panels and commands share (`session` and its parts: selection, listening, recording, streaming, live players,
what the viewport shows), and the services that keep it up with the project: files and settings, plans and motion,
sound, recorder, streamer, the user's own libraries, slow work in the background. Of Qt only signals, timers and
watchers (``PySide6.QtCore``).
"""
