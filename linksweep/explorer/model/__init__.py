"""Answers to the questions of the page, in plain numbers, texts and arrays, without a browser."""
