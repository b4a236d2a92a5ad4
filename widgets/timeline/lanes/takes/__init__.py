"""The lane of takes."""
