"""The ruler, and beats put where they sound."""
