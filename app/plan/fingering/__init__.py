"""Fingerings, and the mutes that go with them."""
