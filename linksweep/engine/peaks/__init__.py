"""Search for exact peaks within a kernel: lanes (brackets of candidate peaks), trials, and the calls that run them.

Results import `find_peaks`; `search` is compiled into the kernel by `search_kernel`.
"""
