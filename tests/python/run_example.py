"""Runs an example quickly in a folder of its own and looks at what it leaves.

Usage: run_example.py EXAMPLE.py
"""

import os
import runpy
import sys
import tempfile

os.environ["HYDRODIP_EXAMPLE_QUICK"] = "1"
example = os.path.abspath(sys.argv[1])
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    result = runpy.run_path(example, run_name="__main__")
    pictures = [name for name in os.listdir(".") if name.endswith(".png")]
    assert pictures, "no picture was written"
    from matplotlib.image import imread

    for name in pictures:
        picture = imread(name)
        assert picture.std() > 0.02, f"{name} is blank"
    keep = os.environ.get("KEEP_PICTURES")
    for name in pictures if keep else ():
        os.replace(name, os.path.join(keep, name))
    check = result.get("check")
    if check:
        check()
