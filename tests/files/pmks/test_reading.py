"""Documents of PMKS+ are read into SI units; expected numbers are those of its published data sets and documents."""

import math
import re
from dataclasses import replace
from pathlib import Path

import pytest

from linksweep.files.pmks.reading import read_drawing
from linksweep.files.pmks.text import DIGITS

DOCUMENTS = dict(line.split(" | ") for line in (Path(__file__).parent / "documents.txt").read_text().splitlines())
"""Public drawings of PMKS+ by name: its verification suite's (document "Verification mechanisms, as links" of
PMKS-Web/Planar-Mechanism-Kinematic-Simulator) and, marked 2024, the templates of PMKS-Web/PMKSWeb of April 2024."""


def stamped(body: str) -> str:
    """Return a text with the character that tells its length, as the documents without checksum have it."""
    return body + DIGITS[len(body) % 62]


def body_of(name: str) -> str:
    """Return the text of a document without length and checksum."""
    return DOCUMENTS[name].partition("*")[0][:-1]


@pytest.mark.parametrize("name", DOCUMENTS)
def test_every_document_is_read(name):
    assert read_drawing(DOCUMENTS[name]).bodies


def test_watt_six_bar_of_the_published_data():
    """Case watt_i of PMKS_Verification has these coordinates, masses and load, in metres and kilograms."""
    drawing = read_drawing(DOCUMENTS["Watt I"])
    places = {
        "A": (-3.74, -2.41),
        "B": (-2.72, 0.91),
        "C": (1.58, 0.43),
        "D": (-0.24, 4.01),
        "E": (5.08, 5.31),
        "F": (8.14, 3.35),
        "G": (7.32, -3.51),
    }
    assert {name: joint.at for name, joint in drawing.joints.items()} == {
        name: (pytest.approx(x / 100, rel=1e-15), pytest.approx(y / 100, rel=1e-15)) for name, (x, y) in places.items()
    }
    masses = {name: (body.mass, body.inertia) for name, body in drawing.bodies.items()}
    light, heavy = (0.005, 0.1e-4), (0.010, 0.2e-4)  # 5 g and 0.1 kg cm², 10 g and 0.2 kg cm²
    assert masses == {"AB": light, "BCD": heavy, "DE": light, "EF": heavy, "CFG": light}
    assert drawing.bodies["BCD"].cg == pytest.approx((-0.0046, 0.01783))
    (load,) = drawing.forces
    assert load.force == pytest.approx((50.0, 25.0), abs=0.01) and load.at == pytest.approx((0.0568, 0.0009))
    assert [joint.name for joint in drawing.joints.values() if joint.grounded] == ["A", "G"]
    assert drawing.joints["A"].driven and drawing.joints["A"].speed == pytest.approx(-5 * math.pi / 30, rel=1e-15)


@pytest.mark.parametrize(
    ("unit", "length", "mass", "inertia", "force"),
    [
        ("0", 0.0254, 0.45359237, 0.45359237 * 0.0254**2, 4.4482216152605),
        ("1", 0.01, 1e-3, 1e-4, 1.0),
        ("2", 1.0, 1.0, 1.0, 1.0),
    ],
)
def test_units(unit, length, mass, inertia, force):
    """The factors are those of "Force Analysis: physical inertia and moment units" of PMKS+."""
    drawing = read_drawing(stamped(body_of("Punch press").replace(".1011.", f".{unit}011.")))
    crank = drawing.bodies["AB"]
    assert drawing.joints["B"].at[1] == pytest.approx(1.2 * length, rel=1e-15)
    assert (crank.mass, crank.inertia) == pytest.approx((2.0 * mass, 0.05 * inertia), rel=1e-15)
    assert drawing.joints["C"].mass == pytest.approx(6.0 * mass, rel=1e-15)
    assert drawing.forces[0].force == pytest.approx((0.0, 400.0 * force), rel=1e-15)


def test_inputs_have_their_own_speeds_and_directions():
    joints = read_drawing(DOCUMENTS["Three machines, three drives"]).joints
    rpm = {name: joint.speed * 30 / math.pi for name, joint in joints.items() if joint.driven}
    assert rpm == pytest.approx({"A": 10.0, "E": -8.0, "H": 12.0}, rel=1e-15)


def test_a_sliding_input_moves_in_the_unit_of_length():
    joints = read_drawing(DOCUMENTS["Backhoe bucket"]).joints
    assert joints["C"].driven and joints["C"].sealed and joints["C"].speed == pytest.approx(0.012)


def test_gravity_may_be_switched_off():
    assert read_drawing(DOCUMENTS["Watt I"]).gravity == 9.80665
    flags = DIGITS[0b110] + DIGITS[0b111001]  # the ninth flag, and those of the document
    assert read_drawing(stamped(flags + body_of("Watt I")[2:])).gravity == 0.0


def test_guides_that_are_rounded_have_whole_degrees():
    """The radial engine's cylinders stand 72 degrees apart, in thousandths of a radian."""
    joints = read_drawing(DOCUMENTS["Radial engine, five cylinders"]).joints
    assert [joint.angle for joint in joints.values() if joint.slides] == [90.0, 162.0, 234.0, 306.0, 378.0]


def test_numbers_with_more_digits_than_records_hold():
    extras = ".PJB~0~0.123456789,PLAB~0~1e-05,PF~F1~4~2,PI~0~7.25"
    text = stamped(body_of("Punch press") + extras.replace("PF~F1~4~2", "PFF1~4~2"))
    drawing = read_drawing(text)
    assert drawing.joints["B"].at[0] == pytest.approx(0.00123456789, rel=1e-15)
    assert drawing.bodies["AB"].mass == pytest.approx(1e-8, rel=1e-15)
    assert drawing.forces[0].force == pytest.approx((0.0, 2.0))
    assert drawing.joints["A"].speed == pytest.approx(-7.25 * math.pi / 30, rel=1e-15)
    assert not drawing.left_out


def test_sliders_of_older_documents_are_one_joint():
    """One machine as PMKS+ wrote it with three objects for a slider, and as it writes it now."""
    older = (
        "2v.Ay,1E8.5,0.1011.6A,A,0,VG,0.0B,B,Fe,VG,0.0C,C,oa,0,0.5P,P,oa,0,0..YRAB,AB,Fe,Fe,7q,VG,c5cae9,A,B,,."
        "YRBC,BC,Fe,Fe,X6,Fe,303e9f,B,C,,.YPCP,CP,0,0,0,0,,C,P,,...N_c"
    )
    drawing = read_drawing(DOCUMENTS["Slider-crank whose rod comes square to the guide"])
    assert replace(read_drawing(older), joints=dict(read_drawing(older).joints)) == drawing


def test_the_template_of_2024_has_a_block_with_mass():
    joints = read_drawing(DOCUMENTS["Slider Crank, 2024"]).joints
    assert list(joints) == ["A", "B", "C"] and joints["C"].slides and joints["C"].mass == 0.001


def test_welded_links_are_one_body():
    drawing = read_drawing(DOCUMENTS["Loader bucket"])
    assert list(drawing.bodies) == ["OA", "AMBCD", "BP"] and drawing.bodies["AMBCD"].joints == tuple("AMBCD")


def test_small_letters_become_capitals():
    assert list(read_drawing(DOCUMENTS["Stephenson I, 2024"]).joints) == list("ABCDEFG")
    mixed = read_drawing(
        stamped(body_of("Drag link").replace("0B,B,0", "0a,a,0").replace("A,B,,", "A,a,,").replace("B,C,,", "a,C,,"))
    )
    assert mixed.bodies["AB"].joints == ("A", "P1") and mixed.joints["P1"].at == pytest.approx((0.0, 0.022))


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda text: text.replace("Fe,Fe,7q", "Fe,Fe,7r"), "the document is damaged: its checksum is 3QLfN7, not "),
        (lambda text: text.partition("*")[0].replace("0B,B,", "0B,B"), "is no document of PMKS+, or it is cut off"),
        (lambda text: text[:60], "is no document of PMKS+, or it is cut off"),
        (lambda text: "", "'' is no document of PMKS+"),
        (lambda text: stamped("abc.def"), "it has no list of joints"),
        (lambda text: stamped(body_of("Watt I").replace(".1011.", ".3011.")), "unit of length is number 3: must be 0"),
        (
            lambda text: stamped(body_of("Watt I").replace("YRDE", "XRDE")),
            "link 'XRDE,DE,1E8,1a,bq,18q,0d125a,D,E,,': cannot",
        ),
    ],
)
def test_damaged_documents_are_refused(spoil, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        read_drawing(spoil(DOCUMENTS["Slider-crank whose rod comes square to the guide"]))


def test_all_names_that_lead_nowhere_are_listed():
    text = body_of("Watt I").replace("YRDE,DE,1E8,1a,bq,18q,0d125a,D,E,,", "YRDE,DE,1E8,1a,bq,18q,0d125a,D,X,,")
    text = text.replace("2F1,CFG", "2F1,CFH")
    with pytest.raises(ValueError, match="not in the document") as refusal:
        read_drawing(stamped(text))
    assert str(refusal.value).splitlines() == [
        "link DE: refers to X, which is not in the document",
        "force F1: refers to CFH, which is not in the document",
    ]


@pytest.mark.parametrize(
    ("name", "old", "new", "message"),
    [
        ("Watt I", "1Om,1Q,1ck,8P,DfU", "1Om,1Q,1Om,1Q,DfU", "force '2F1,CFG,F1,1Om,1Q,1Om,1Q,DfU': cannot be read"),
        ("Shaper's quick-return drive", "0,CD,C,D.", "0,CD,C,.", "joint B: slides on CD in no direction"),
        ("Watt I", ".0B,B,", ".0A,B,", "joint A: is there twice"),
    ],
)
def test_records_without_sense_are_named(name, old, new, message):
    body = body_of(name)
    assert old in body
    with pytest.raises(ValueError, match=re.escape(message)):
        read_drawing(stamped(body.replace(old, new)))


def test_links_welded_in_themselves_are_one_body():
    text = stamped(body_of("Drag link").replace("A,B,,.", "A,B,,AB.").replace("B,C,,.", "B,C,,BC,CD."))
    assert list(read_drawing(text).bodies) == ["AB", "BC", "CD"]


def test_entries_without_a_meaning_here_are_listed():
    body = body_of("Slider-crank whose rod comes square to the guide")
    body = body.replace("5C,C,oa,0,0.", "5C,C,oa,0,0,,,,,,,Ram.")
    drawing = read_drawing(stamped(f"{body}.JB,HlAB,KJB~d,G1~abc,Z9"))
    assert drawing.left_out == ("joint C: its entries Ram (friction or a name)", "gears", "the entry 'Z9'")
