"""What a monitor says, in a terminal: `top`."""
