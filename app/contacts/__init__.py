"""Checks of contacts: touches, grips, lips, feet and penetration depths, for problems, reports and tests alike."""
