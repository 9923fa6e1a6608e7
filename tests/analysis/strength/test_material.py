"""Named materials against public tables."""

import pytest

import linksweep as ls

KSI = 6.894757293168361e6  # Pa


@pytest.mark.parametrize(
    ("name", "tensile", "strength", "fatigue"),
    [  # ksi
        ("AISI 1020 HR", 55.0, 30.0, None),  # estimated minimum values of SAE
        ("AISI 1045 CD", 91.0, 77.0, None),
        ("AISI 4140 QT 540", 138.0, 121.0, None),  # 951 and 834 MPa: efunda.com, AISI 4140, oil quenched
        ("2024-T4", 68.0, 47.0, 20.0),  # typical values of the Aluminum Association; fatigue at 5e8 cycles
        ("6061-T6", 45.0, 40.0, 14.0),
        ("7075-T6", 83.0, 73.0, 23.0),
    ],
)
def test_named_materials_are_those_of_tables_in_ksi(name, tensile, strength, fatigue):
    material = ls.material(name)
    assert material.tensile_strength == pytest.approx(KSI * tensile, rel=6e-3)
    assert material.yield_strength == pytest.approx(KSI * strength, rel=2e-2)  # tables in MPa are rounded to 10
    expected = 0.5 * material.tensile_strength if fatigue is None else KSI * fatigue
    assert material.endurance == pytest.approx(expected, rel=5e-3)
    assert material.knee == (1e6 if fatigue is None else 5e8)


@pytest.mark.parametrize(("name", "strengths"), {"S235": (235, 360), "S275": (275, 430), "S355": (355, 490)}.items())
def test_structural_steels_are_those_of_eurocode_3(name, strengths):
    """EN 1993-1-1, table 3.1, up to 40 mm, for steels of EN 10025-2, with AC:2009; E = 210 GPa."""
    steel = ls.material(name)
    assert (1e-6 * steel.yield_strength, 1e-6 * steel.tensile_strength) == pytest.approx(strengths, rel=1e-12)
    assert steel.E == 210e9 and steel.endurance == 0.5 * steel.tensile_strength
