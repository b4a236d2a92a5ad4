"""Notes to plan: what each player does, and when, as named events with reasons."""
