"""Live streaming of poses to other programs by the VMC protocol (OSC over UDP)."""
