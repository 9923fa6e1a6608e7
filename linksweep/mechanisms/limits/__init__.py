"""Find in closed form where each machine can be assembled, where it toggles, stands still or jams.

Machines list these functions as their findings; results import `finding` to evaluate them.
"""
