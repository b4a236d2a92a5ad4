"""Recording from MIDI devices: a separate process time-stamps and writes messages, and the program controls it."""
