"""Where friction changes: `jams` finds the angles at which it jams a slide, `contacts` those at which a contact of two
bears nothing."""
