"""What readers of text formats share: lines, numbers, times, units, channels."""
