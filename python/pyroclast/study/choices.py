"""Words that the command line of studies may choose from. Nothing is imported here: the manual page reads them too."""

KEEP = ("summary", "history", "all")
EXECUTORS = ("local", "slurm", "commands")
