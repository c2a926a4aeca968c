"""Stands for a library that loads slowly: nothing but a wait."""

import time

time.sleep(0.3)
