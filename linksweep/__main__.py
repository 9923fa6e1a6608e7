import sys

from linksweep.cli.main import main

sys.exit(main())
