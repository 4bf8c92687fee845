"""The smooth edge of a contact, between the patches."""
