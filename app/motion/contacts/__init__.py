"""Contacts, solved after all layers: instrument on the lips, hands on the instrument, feet on the floor."""
