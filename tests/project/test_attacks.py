"""Every attack on the package in its small version; ``python -m benchmarks.stress.attacks`` runs the long ones."""

import numpy as np
import pytest

from benchmarks.stress.attacks import Attack, attacks

SMALL = [attack for attack in attacks() if attack.small]


@pytest.mark.long
@pytest.mark.parametrize("attack", SMALL, ids=lambda attack: attack.name)
def test_the_package_withstands_the_attack(attack: Attack):
    outcome = attack.run(np.random.default_rng(1), attack.small)
    assert outcome.tried >= attack.small
    assert outcome.failures == []
