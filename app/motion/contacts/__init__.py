"""Contacts, solved last: instrument on the lips, hands on the instrument, feet on the floor."""
