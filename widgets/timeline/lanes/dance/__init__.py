"""The lane of dances."""
