"""Guests: contact codes of others, examined on the shipped cases like the two methods."""
