"""Suisou: from the notes of a wind ensemble to the performance of its players.

Linear algebra and k-means work on one thread: the matrices are small, more threads are slower on a busy machine, and
the last bits would be chance. The libraries read these variables when they are loaded. A later limit lists what is
loaded, which can deadlock with an import in another thread (issue 228 of threadpoolctl).
"""

import os

os.environ.update(dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1"))
os.environ["VECLIB_MAXIMUM_THREADS"] = "1"
