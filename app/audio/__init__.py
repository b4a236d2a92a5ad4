"""Sound without a window: synthesiser, decoding, offset; `playback` alone touches Qt."""
