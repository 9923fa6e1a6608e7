"""Public names: each is imported when it is first used, and says how it is called where a call does not fit."""
