"""What graphflow costs, always beside something else measured in the same run: `python -m benchmarks.round_trip`."""
