"""The lane of fingerings."""
