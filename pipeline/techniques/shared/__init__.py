"""What several rooms share; a room imports it, it imports no room."""
