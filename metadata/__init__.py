"""What an animator may edit as data: expressions, bodies, skeleton profiles, wind controllers."""
