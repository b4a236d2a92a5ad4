"""The lane of acting."""
