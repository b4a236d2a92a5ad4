"""The recording panel: device, input, and recorded player."""
