"""A performance judged by viewers against real players: blinded clips, the questionnaire, its statistics."""
