"""What a user can get: each product with its stages, variables, tables, pictures, report and outputs of studies."""
