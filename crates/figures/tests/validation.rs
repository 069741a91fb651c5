//! The paper, statement by statement: the verdict on each, and the numbers that it follows from.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use cloakroom_figures::verification::Verdict::{self, Agrees, AgreesInOrderOfMagnitude, Differs};
use cloakroom_figures::verification::{markdown, steps, verify};
use std::cell::Cell;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// What the paper says, what comes out, and whether that is what it says.
const EXPECTED: &[(&str, &str, Verdict)] = &[
    (
        "Plane mirrors can guide rays around an object such that they leave with their direction, for any polarization",
        "along x: turned by below 1e-12 rad, below 1e-12 cm off its line, power H 100 %, V 100 %",
        Agrees,
    ),
    (
        "The detour makes the optical path longer: a ray cloak, no wave cloak",
        "16.00 cm longer, 0.534 ns late",
        Agrees,
    ),
    (
        "Rays follow an equation of motion derived from Fermat's principle",
        "9 rays through (iv), stepped along it in physical space, differ from the program's by below 1e-5 cm in place, optical path, and 100 cm of direction",
        Agrees,
    ),
    (
        "n_o = sqrt(ε µ_o) and n_e = sqrt(ε µ_e)",
        "ε = 2.366, µ_o = 0.31, µ_e = 3.27: the waves have 0.8564 and 2.7815",
        Agrees,
    ),
    ("(i) is positive uniaxial: µ_o = 0.31, µ_e = 3.27", "µ_o = 0.3057, µ_e = 3.2717", Agrees),
    ("(ii) is negative uniaxial: µ_o = 3.27, µ_e = 0.31", "µ_o = 3.2717, µ_e = 0.3057", Agrees),
    ("A square of side 14.1 cm holds a rhombus of side 11.51 cm", "11.51 cm", Agrees),
    ("The axes of the segments are turned by 33.54 degrees", "33.54 degrees", Agrees),
    ("The region cloaked by (i)-(iii) has 114.83 cm²", "114.78 cm²", AgreesInOrderOfMagnitude),
    ("The region cloaked by (iv) has 114.83 cm²", "114.83 cm²", Agrees),
    ("Turned, (i)-(iii) look like a flat mirror 19.94 cm wide", "19.94 cm", Agrees),
    (
        "Horizontal light in the centre vertical plane is cloaked perfectly",
        "all but below 1e-12 of its power is on its own line",
        Agrees,
    ),
    (
        "Vertical light there is not cloaked at all",
        "at most 0.0 % of its power is on its own line",
        Agrees,
    ),
    (
        "So it is for (ii): horizontal light is cloaked in this plane, vertical light is not",
        "H: all but below 1e-12 on its own line; V: at most 0.0 %",
        Agrees,
    ),
    (
        "Cloaks (i) and (ii) work for at most half of the unpolarized light along the axis",
        "(i) 50.0 %, (ii) 50.0 % of the power goes on undisturbed",
        Agrees,
    ),
    (
        "Unpolarized, the image is an admixture of a cloaked and an uncloaked contribution",
        "it is the mean of H and V; largest difference below 1e-5 of white",
        Agrees,
    ),
    (
        "(i), horizontal: cloaking is quite good, albeit not perfect",
        "correlation with the empty view 0.69, of bare metal 0.38; RMS displacement 13.4 cm",
        Agrees,
    ),
    (
        "(i), vertical: no cloaking at all",
        "correlation with the empty view 0.34, of bare metal 0.38",
        Agrees,
    ),
    (
        "(ii), horizontal: the cloaking is formidable",
        "correlation with the empty view 0.76, of (i) 0.69, of bare metal 0.38; RMS displacement 1.7 cm",
        Agrees,
    ),
    (
        "(ii), vertical: not cloaked",
        "correlation with the empty view 0.30, of bare metal 0.38",
        Agrees,
    ),
    (
        "(ii) is remarkably similar in performance to the ideal cloak (iii), but depends on polarization",
        "correlation with (iii), H: (ii) 0.76, (i) 0.69",
        Agrees,
    ),
    (
        "(i), horizontal, turned by 5, 10, 20 degrees: rather good but for significant Fresnel reflections",
        "correlation with the flat mirror 0.71, 0.65, 0.60, of bare metal 0.36, 0.37, 0.41; mean first reflection 0.21 %, 6.00 %, 5.26 %",
        Agrees,
    ),
    (
        "(ii), horizontal, turned: no Fresnel reflections, in contrast to (i)",
        "mean first reflection 0.12 %, 0.14 %, 0.27 %",
        Agrees,
    ),
    (
        "(ii), horizontal, turned: a very good carpet cloak, the illusion of a flat mirror turned by the same angle",
        "correlation with the flat mirror 0.72, 0.71, 0.76",
        Agrees,
    ),
    (
        "Fresnel reflection of (ii) is of the order of less than 3 %, horizontal",
        "first face: at most 0.45 % in the view; all backward power at 20 degrees to the side: 2.2 % on average",
        Agrees,
    ),
    ("The same, vertical", "first face: at most 9.6 % in the view", Differs),
    (
        "(i) has more impedance mismatch to the sides than (ii)",
        "H in the ordinary wave, at most: (i) 77 %, (ii) 2.0 %; backward power at 20 degrees: (i) 3.5 %, (ii) 2.2 %",
        Agrees,
    ),
    (
        "(ii), vertical: ordinary light is trapped in a segment and escapes after several total internal reflections",
        "trapped beyond 21.06 degrees inside; in the centre plane 88.6 % leaves in one path after 3 reflections in segments, at 92.14 degrees",
        Agrees,
    ),
    (
        "(i): ordinary light is reflected totally in air at the first interface",
        "beyond 58.26 degrees of incidence; the view has at most 53.4 at rotation 0, 71.4 at 20",
        Agrees,
    ),
    (
        "Bare metal distorts the view; (iii) retrieves the empty view perfectly",
        "largest difference of linear light: below 1e-5, bare 0.77",
        Agrees,
    ),
    (
        "The time of flight is retrieved, too, to machine precision: yoctoseconds",
        "largest difference below 100 ys",
        Agrees,
    ),
    (
        "(iii) is impedance matched to air, for any polarization",
        "power that is not on its own line, over the view: below 1e-12",
        Agrees,
    ),
    (
        "Turned by 5, 10, 20 degrees, (iii) looks exactly as a flat mirror 19.94 cm wide does",
        "largest difference of linear light: below 1e-5",
        Agrees,
    ),
    ("w = 10.02 cm and h = 4.25 cm lead to a minimum index of 0.873", "0.873", Agrees),
    ("and to a maximum index of 1.920", "1.918", AgreesInOrderOfMagnitude),
    (
        "The same with w and h that round to the printed digits, 10.0158 and 4.2532 cm",
        "1.920",
        Agrees,
    ),
    ("Dividing the index by its minimum references it to 1", "1.000 to 2.197", Agrees),
    ("Turned, (iv) looks like a wider mirror than (i)-(iii)", "50.00 cm against 19.94 cm", Agrees),
    (
        "(iv) is polarization insensitive",
        "difference of linear light between H and V: RMS 0.0008, at most 0.01; a step of 8 bits is 0.0039",
        Agrees,
    ),
    (
        "(iv) transmits all of the light along the axis",
        "100.0 % of the view's power comes from the photograph",
        Agrees,
    ),
    (
        "The bare corrugation distorts the view severely; with the cloak it vanishes",
        "correlation with the empty view where the metal is seen: cloaked 0.87, bare 0.20",
        Agrees,
    ),
    (
        "The cloaking in three dimensions is also very good",
        "correlation of the whole picture 0.68, bare 0.88; RMS displacement 3.8 cm",
        Differs,
    ),
    (
        "To the left and right the image is cut around the middle horizontal line and stretched towards it, less so further from it, and not on the middle vertical line",
        "0.5 degrees up, light comes from 1.90 cm higher than in the empty view 18 degrees to the side, -0.53 cm in the middle; 12 degrees up, -2.29 and -2.14 cm",
        Agrees,
    ),
    ("The time of flight differs by less than 0.1 ns", "at most 0.075 ns", Agrees),
    (
        "That is a maximum relative error of 6 %",
        "4.5 % of the 1.67 ns through 50 cm of air; 1.4 % of the whole flight from the photograph to the camera",
        AgreesInOrderOfMagnitude,
    ),
    (
        "Fresnel reflection along the axis is of the order of 0.01 % or less",
        "first face: 0.019 % on average, at most 0.059 %",
        Differs,
    ),
    (
        "In all settings of Figs. 8 and 9 it is less than 0.2 %",
        "first face, either polarization: at most 0.026 % on average over a view, 0.09 % anywhere in it",
        Agrees,
    ),
    (
        "It is smaller by orders of magnitude than for (i) and (ii)",
        "on average, unpolarized: (i) 16.5 %, (ii) 3.6 %, (iv) 0.019 %",
        Agrees,
    ),
    (
        "Turned by 5, 10, 20 degrees, (iv) behaves as a Gaussian carpet cloak does: as a flat mirror",
        "correlation with a mirror 50 cm wide, where the metal is seen: cloaked 0.88, 0.49, 0.40, bare 0.14, -0.07, 0.31",
        Agrees,
    ),
];

#[test]
fn each_statement_of_the_paper_has_its_verdict_and_its_numbers() {
    let done = Cell::new(0);
    let findings = verify(&|| done.set(done.get() + 1), &AtomicBool::new(false)).unwrap();
    assert_eq!(done.get(), steps());
    for (found, (statement, computed, verdict)) in findings.iter().zip(EXPECTED) {
        assert_eq!(found.statement, *statement);
        assert_eq!((found.verdict, found.computed.as_str()), (*verdict, *computed), "{statement}");
    }
    assert_eq!(findings.len(), EXPECTED.len());
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/validation.md");
    let page = std::fs::read_to_string(path).unwrap();
    assert!(page == markdown(&findings), "docs/validation.md tells something else");
}
