"""Verification harness above the two contact methods."""
