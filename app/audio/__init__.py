"""Sound: synthesiser, decoding and alignment; only `playback` needs Qt."""
