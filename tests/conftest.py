"""One hypothesis profile for all tests: the same examples on every machine, no deadline on a busy one."""

from hypothesis import settings

settings.register_profile("linkwright", derandomize=True, deadline=None, print_blob=True)
settings.load_profile("linkwright")
