"""The recording panel: the device, what comes in from it, and who is recorded."""
