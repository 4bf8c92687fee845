"""Contacts that are not round, by angular harmonics."""
