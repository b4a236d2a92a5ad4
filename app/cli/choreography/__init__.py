"""``suisou choreography``: learning choreographies, and dancing them."""
