"""What checks are made of: one probe an idea, each a way to learn something of a package without importing its code."""
