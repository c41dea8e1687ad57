"""Where records come from: folders, pinned packages, data centres."""
