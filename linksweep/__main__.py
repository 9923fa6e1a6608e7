import sys

from linksweep.surface.cli import main

sys.exit(main())
