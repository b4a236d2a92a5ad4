"""Names of the 47 percussion sounds of General MIDI System Level 1 in the user's language."""

from __future__ import annotations

from app.editor.translated import tr


def percussion_names() -> tuple[str, ...]:
    """Return the names of the percussion sounds in `app.choreography.rhythm.SYMBOLS`, from MIDI note 35 on."""
    return (
        tr("percussion.acoustic_bass_drum"),
        tr("percussion.bass_drum_1"),
        tr("percussion.side_stick"),
        tr("percussion.acoustic_snare"),
        tr("percussion.hand_clap"),
        tr("percussion.electric_snare"),
        tr("percussion.low_floor_tom"),
        tr("percussion.closed_hi_hat"),
        tr("percussion.high_floor_tom"),
        tr("percussion.pedal_hi_hat"),
        tr("percussion.low_tom"),
        tr("percussion.open_hi_hat"),
        tr("percussion.low_mid_tom"),
        tr("percussion.high_mid_tom"),
        tr("percussion.crash_cymbal_1"),
        tr("percussion.high_tom"),
        tr("percussion.ride_cymbal_1"),
        tr("percussion.chinese_cymbal"),
        tr("percussion.ride_bell"),
        tr("percussion.tambourine"),
        tr("percussion.splash_cymbal"),
        tr("percussion.cowbell"),
        tr("percussion.crash_cymbal_2"),
        tr("percussion.vibraslap"),
        tr("percussion.ride_cymbal_2"),
        tr("percussion.high_bongo"),
        tr("percussion.low_bongo"),
        tr("percussion.mute_high_conga"),
        tr("percussion.open_high_conga"),
        tr("percussion.low_conga"),
        tr("percussion.high_timbale"),
        tr("percussion.low_timbale"),
        tr("percussion.high_agogo"),
        tr("percussion.low_agogo"),
        tr("percussion.cabasa"),
        tr("percussion.maracas"),
        tr("percussion.short_whistle"),
        tr("percussion.long_whistle"),
        tr("percussion.short_guiro"),
        tr("percussion.long_guiro"),
        tr("percussion.claves"),
        tr("percussion.high_wood_block"),
        tr("percussion.low_wood_block"),
        tr("percussion.mute_cuica"),
        tr("percussion.open_cuica"),
        tr("percussion.mute_triangle"),
        tr("percussion.open_triangle"),
    )
