"""Skeletons, quaternions, forward and inverse kinematics, characters, instrument models, skinning."""
