"""Studies: from one run to a thousand, each with its place in a question."""
