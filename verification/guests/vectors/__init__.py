"""Open digits: problems with exact values that anyone can use without installing anything."""
