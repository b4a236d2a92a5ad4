"""The session, design tokens and small widgets that all panels share."""
