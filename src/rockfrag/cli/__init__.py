"""The command line: ``rockfrag`` and its commands, one file a group of them."""
