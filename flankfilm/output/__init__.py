"""What is written: a dataset whose variables describe themselves, and tables and files that follow from it."""
