"""Takes as displayed in the timeline."""
