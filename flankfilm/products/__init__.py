"""What a user can get: each product with its stages, variables, tables, report and outputs of studies, in one file."""
