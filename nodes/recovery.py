#!/usr/bin/python3
"""Restarts what the monitor blames; see self_awareness.commands.recovery."""
import sys

from self_awareness.commands.recovery import main

sys.exit(main())
