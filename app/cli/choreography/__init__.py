"""``suisou choreography``: learning choreographies, and generating dances."""
