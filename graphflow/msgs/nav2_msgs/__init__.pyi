# Written by `python -m graphflow.msgs.stubs`; do not edit.
