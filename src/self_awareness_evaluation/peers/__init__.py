"""What others would use to watch a robot's communication: a module for each scorer of windows."""
