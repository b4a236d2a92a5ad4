"""What all panels share: the session, design tokens, small widgets."""
