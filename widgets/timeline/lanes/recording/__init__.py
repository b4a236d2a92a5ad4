"""Lane of the timeline with the waveform of the audio recording."""
