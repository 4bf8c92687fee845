"""Parameter studies: the same quantities of many coated contacts in one table."""
