"""Recording from MIDI devices: a process of its own stamps and writes, the program asks it through a link."""
