"""The command by the name of the package: ``python -m rockfrag assess …`` does what ``rockfrag assess …`` does.

In: words of the command line. Out: the exit status. The commands stand in :mod:`rockfrag.cli.main`; whoever
installed the package where its scripts are on no search path starts it so (``docs/install.md``).
"""

import sys

from rockfrag.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
