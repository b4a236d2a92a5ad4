"""Evaluation of a performance by viewers in comparison with real players: blinded clips, questionnaire and
statistics.
"""
