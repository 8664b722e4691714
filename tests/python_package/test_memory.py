"""Views of a run under the address sanitizer's allocator: what is read has not been given back."""

import os
import shutil
import subprocess
import sys
import unittest

from small import Case

# bytes() reads by memcpy, which the sanitizer looks at also where NumPy was built without it
READ = """
import ctypes, gc, sys
import numpy as np
import pyroclast
from small import deck

run = pyroclast.Run(deck(blocks__count=60), threads=1)
run.until(steps=50)
copied = run.copy()
views = [run.views.displacement, run.views.velocity, run.views.force, run.views.internals]
del run
gc.collect()
copied.until(steps=50)
while views:
    print(len(views.pop(0).tobytes()), flush=True)
    gc.collect()
libc = ctypes.CDLL(None)
libc.malloc.restype, libc.malloc.argtypes, libc.free.argtypes = ctypes.c_void_p, [ctypes.c_size_t], [ctypes.c_void_p]
place = libc.malloc(8000)
freed = np.ctypeslib.as_array((ctypes.c_double * 1000).from_address(place))
libc.free(place)
print("now what is wrong", flush=True)
freed.tobytes()
"""


def library(name: str) -> str:
    said = subprocess.run(["gcc", f"-print-file-name={name}"], capture_output=True, text=True, check=True)
    found = said.stdout.strip()
    return found if os.path.isabs(found) else ""


@unittest.skipUnless(shutil.which("gcc") and library("libasan.so"), "gcc's address sanitizer is needed")
class Memory(Case):
    def test_views_outlive_their_run(self):
        environment = os.environ | {
            "LD_PRELOAD": f"{library('libasan.so')} {library('libstdc++.so.6')}", "PYTHONMALLOC": "malloc",
            "ASAN_OPTIONS": "detect_leaks=0", "PYTHONPATH": f"{os.environ['PYTHONPATH']}:{os.path.dirname(__file__)}"}
        done = subprocess.run([sys.executable, "-c", READ], capture_output=True, text=True, check=False,
                              env=environment)
        *sizes, last = done.stdout.split("\n", 4)
        self.assertEqual(len(sizes), 4, done.stderr)
        self.assertEqual(last.strip(), "now what is wrong")
        self.assertIn("heap-use-after-free", done.stderr)  # so it would have been told of the views too
        self.assertNotEqual(done.returncode, 0)
