"""Takes as the timeline shows them."""
