"""Errors that are completed, where they are reported, by what to write instead."""
