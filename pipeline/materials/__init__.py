"""Cards and the database: one material, its records, laws, refusals and origins."""
