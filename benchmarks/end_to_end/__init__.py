"""What a user waits for: a whole campaign from raw files to values, database and figures."""
