"""The one judge of touches, grips, lips, feet and depths: the same for problems, reports and tests."""
