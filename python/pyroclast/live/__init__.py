"""Decks, specimens, stages, laws and runs in this process, which take the compiled part. It knows no figures."""
