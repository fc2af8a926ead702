"""``python -m stability`` is the command ``stability``.

Python puts the present folder in front of all packages for ``-m``: an xarray.py that came with a scene would be run in
the place of xarray. So that folder is taken off again before anything else is imported, unless the package lives there.
A file named as a module of Python's own library is beyond reach: ``python -m`` imports some of these before it starts
here. ``python -P -m stability`` and the command ``stability`` never look in the present folder.
"""

import sys
from os import getcwd, path

if not sys.flags.safe_path and sys.path[:1] == [getcwd()] != [path.dirname(path.dirname(path.abspath(__file__)))]:
    del sys.path[0]

from stability.cli import main  # noqa: E402

if __name__ == "__main__":
    main()
