"""The 47 percussion sounds of General MIDI System Level 1 in the user's language."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication


def percussion_names() -> tuple[str, ...]:
    """Names of the sounds from note 35 on, as of `app.choreography.rhythm.SYMBOLS`."""
    return (
        QCoreApplication.translate("Percussion", "Acoustic Bass Drum"),
        QCoreApplication.translate("Percussion", "Bass Drum 1"),
        QCoreApplication.translate("Percussion", "Side Stick"),
        QCoreApplication.translate("Percussion", "Acoustic Snare"),
        QCoreApplication.translate("Percussion", "Hand Clap"),
        QCoreApplication.translate("Percussion", "Electric Snare"),
        QCoreApplication.translate("Percussion", "Low Floor Tom"),
        QCoreApplication.translate("Percussion", "Closed Hi-hat"),
        QCoreApplication.translate("Percussion", "High Floor Tom"),
        QCoreApplication.translate("Percussion", "Pedal Hi-hat"),
        QCoreApplication.translate("Percussion", "Low Tom"),
        QCoreApplication.translate("Percussion", "Open Hi-hat"),
        QCoreApplication.translate("Percussion", "Low-Mid Tom"),
        QCoreApplication.translate("Percussion", "High-Mid Tom"),
        QCoreApplication.translate("Percussion", "Crash Cymbal 1"),
        QCoreApplication.translate("Percussion", "High Tom"),
        QCoreApplication.translate("Percussion", "Ride Cymbal 1"),
        QCoreApplication.translate("Percussion", "Chinese Cymbal"),
        QCoreApplication.translate("Percussion", "Ride Bell"),
        QCoreApplication.translate("Percussion", "Tambourine"),
        QCoreApplication.translate("Percussion", "Splash Cymbal"),
        QCoreApplication.translate("Percussion", "Cowbell"),
        QCoreApplication.translate("Percussion", "Crash Cymbal 2"),
        QCoreApplication.translate("Percussion", "Vibraslap"),
        QCoreApplication.translate("Percussion", "Ride Cymbal 2"),
        QCoreApplication.translate("Percussion", "High Bongo"),
        QCoreApplication.translate("Percussion", "Low Bongo"),
        QCoreApplication.translate("Percussion", "Mute High Conga"),
        QCoreApplication.translate("Percussion", "Open High Conga"),
        QCoreApplication.translate("Percussion", "Low Conga"),
        QCoreApplication.translate("Percussion", "High Timbale"),
        QCoreApplication.translate("Percussion", "Low Timbale"),
        QCoreApplication.translate("Percussion", "High Agogo"),
        QCoreApplication.translate("Percussion", "Low Agogo"),
        QCoreApplication.translate("Percussion", "Cabasa"),
        QCoreApplication.translate("Percussion", "Maracas"),
        QCoreApplication.translate("Percussion", "Short Whistle"),
        QCoreApplication.translate("Percussion", "Long Whistle"),
        QCoreApplication.translate("Percussion", "Short Guiro"),
        QCoreApplication.translate("Percussion", "Long Guiro"),
        QCoreApplication.translate("Percussion", "Claves"),
        QCoreApplication.translate("Percussion", "High Wood Block"),
        QCoreApplication.translate("Percussion", "Low Wood Block"),
        QCoreApplication.translate("Percussion", "Mute Cuica"),
        QCoreApplication.translate("Percussion", "Open Cuica"),
        QCoreApplication.translate("Percussion", "Mute Triangle"),
        QCoreApplication.translate("Percussion", "Open Triangle"),
    )
