"""Run the command line as ``python -m linksweep``."""

import sys

from linksweep.cli.main import main

sys.exit(main())
