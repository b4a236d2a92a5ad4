"""A performance judged against real players: clips, questionnaire, answers, statistics."""
