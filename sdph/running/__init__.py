"""Runs: how they go, and what they leave behind."""
