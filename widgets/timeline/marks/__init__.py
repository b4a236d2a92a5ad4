"""Drawing of the composer's marks in the timeline."""
