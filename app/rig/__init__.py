"""Skeletons, quaternions, FK, IK, characters, instrument models, skinning."""
