"""What a program with sanitizers cannot show: its Python module does not load into a Python without them."""

import os
import unittest

SANITIZED = "PYROCLAST_SANITIZED" in os.environ
needs_studies = unittest.skipIf(SANITIZED, "a module with sanitizers does not load into a Python without them")
