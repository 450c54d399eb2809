"""Sound calls, hostile values, and the public surface on which they meet."""
