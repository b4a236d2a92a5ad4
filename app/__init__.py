"""Suisou: converts the notes of a wind ensemble to a performance of animated players.

Linear algebra and k-means use one thread: the matrices are small, more threads are slower on a busy machine, and
rounding would vary from run to run. The libraries read these variables when they are loaded. Limiting them later lists
loaded libraries, which can deadlock with an import in another thread (threadpoolctl issue 228).
"""

import os

os.environ.update(dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1"))
os.environ["VECLIB_MAXIMUM_THREADS"] = "1"
