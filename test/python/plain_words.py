"""Words that only docs/method.md needs, and those who work on the method."""
import re

JARGON = re.compile(r'\b(linkers?|own history|evidence overdue|tracks?|gains?)\b', re.IGNORECASE)
