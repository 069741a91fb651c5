//! The paper, statement by statement: the verdict on each, and the numbers that it follows from.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

use cloakroom_figures::verification::Verdict::{
    self, Agrees, AgreesClosely, AgreesInOrderOfMagnitude, DependsOnTolerance, Differs,
};
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
        "It works for one viewing direction only",
        "on its own line along x 100 %, 5 degrees up 0 %, 5 degrees to the side 0 % of the power",
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
    ("The region cloaked by (i)-(iii) has 114.83 cm²", "114.78 cm²", AgreesClosely),
    ("The region cloaked by (iv) has 114.83 cm²", "114.83 cm²", Agrees),
    ("Turned, (i)-(iii) look like a flat mirror 19.94 cm wide", "19.94 cm", Agrees),
    (
        "In the centre vertical plane (i) and (ii) are one material distribution",
        "µ in the plane and ε across it, all that H meets there, differ by below 1e-12; rays of H by below 1e-8 cm in place, optical path, and 100 cm of direction",
        Agrees,
    ),
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
        "of a ray's power at most (i) 50.0 %, (ii) 50.0 % goes on undisturbed",
        Agrees,
    ),
    (
        "Unpolarized, the image is an admixture of a cloaked and an uncloaked contribution",
        "it is the mean of H and V; largest difference below 1e-5 of white",
        Agrees,
    ),
    (
        "(i), horizontal: cloaking is quite good, albeit not perfect",
        "18.7 % in place (48.5 % widely), FLIP 0.44; bare metal 0.0 % in place (0.0 % widely), FLIP 0.87; RMS displacement 13.4 cm",
        Differs,
    ),
    (
        "(i), vertical: no cloaking at all",
        "0.2 % in place (4.8 % widely), FLIP 0.60; bare metal 0.0 % in place (0.0 % widely), FLIP 0.87",
        Agrees,
    ),
    (
        "(ii), horizontal: the cloaking is formidable, great in 3D",
        "40.5 % in place (95.3 % widely), FLIP 0.32; bare metal 0.0 % in place (0.0 % widely), FLIP 0.87; RMS displacement 1.7 cm",
        DependsOnTolerance,
    ),
    (
        "(ii), vertical: not cloaked",
        "0.0 % in place (24.1 % widely), FLIP 0.59; bare metal 0.0 % in place (0.0 % widely), FLIP 0.87",
        DependsOnTolerance,
    ),
    (
        "(i) and (ii) cloak worse away from the centre vertical plane, horizontal",
        "in place 0 to 2, 10 to 12, 18 to 20 degrees to the side: (i) 99.0 %, 0.0 %, 0.0 %; (ii) 100.0 %, 0.0 %, 0.0 %",
        Agrees,
    ),
    (
        "In (d), horizontal, extraordinary light dominates",
        "its share of what enters the first face: (i) 71.2 % on average, 23.4 % at least; (ii) 99.4 % on average, 98.0 % at least",
        Agrees,
    ),
    (
        "In (e), vertical, ordinary light dominates",
        "its share of what enters the first face: (i) 71.0 % on average, 25.6 % at least; (ii) 99.5 % on average, 98.3 % at least",
        Agrees,
    ),
    (
        "One pulse makes several main pulses in (i) and (ii), which has no single time of flight",
        "pulses of 10 % of the unpolarized power from the photograph, 1 ps apart: several for (i) 97.6 %, (ii) 68.3 % of the rays, up to 4 and 2",
        Agrees,
    ),
    (
        "(iii) and (iv), which are independent of polarization, have a single time of flight",
        "pulses of 10 % of the unpolarized power from the photograph, 1 ps apart: one for (iii) 100.0 %, (iv) 100.0 % of the rays, at most 1 and 1",
        Agrees,
    ),
    (
        "(i), horizontal, turned by 5, 10, 20 degrees: cloaking is rather good",
        "against the flat mirror 18.4 %, 24.1 %, 20.8 % in place (56.5 %, 50.7 %, 79.0 % widely), FLIP 0.41, 0.41, 0.40; bare metal 0.0 %, 0.0 %, 0.0 % in place (0.0 %, 0.0 %, 0.0 % widely), FLIP 0.83, 0.83, 0.82",
        DependsOnTolerance,
    ),
    (
        "except for significant Fresnel reflections, total ones of the ordinary wave",
        "first reflection at most 13.33 %, 53.70 %, 45.67 %; above 1 % on 5.1 %, 31.0 %, 25.9 % of the cloak",
        Agrees,
    ),
    (
        "(ii), horizontal, turned: no Fresnel reflections, in contrast to (i)",
        "first reflection at most 0.67 %, 1.05 %, 3.82 %; above 1 % on 0.0 %, 0.1 %, 9.0 % of the cloak",
        Differs,
    ),
    (
        "(ii), horizontal, turned: a very good carpet cloak, the illusion of a flat mirror turned by the same angle",
        "against the flat mirror 41.0 %, 41.9 %, 50.4 % in place (91.9 %, 93.6 %, 92.1 % widely), FLIP 0.33, 0.33, 0.26",
        DependsOnTolerance,
    ),
    (
        "(ii) cloaks significantly better than (i), horizontal",
        "turned by 0, 5, 10, 20 degrees, against the flat mirror: (ii) 40.5 %, 41.0 %, 41.9 %, 50.4 % in place (95.3 %, 91.9 %, 93.6 %, 92.1 % widely), FLIP 0.32, 0.33, 0.33, 0.26; (i) 18.7 %, 18.4 %, 24.1 %, 20.8 % in place (48.5 %, 56.5 %, 50.7 %, 79.0 % widely), FLIP 0.44, 0.41, 0.41, 0.40",
        Agrees,
    ),
    (
        "(ii) is remarkably similar in performance to the ideal cloak (iii), but depends on polarization",
        "H against (iii), turned by 0, 5, 10, 20 degrees: 40.5 %, 41.0 %, 41.9 %, 50.4 % in place (95.3 %, 91.9 %, 93.6 %, 92.1 % widely), FLIP 0.32, 0.33, 0.33, 0.26",
        DependsOnTolerance,
    ),
    (
        "(i) cloaks worse at angles away from the axis, horizontal",
        "turned by 0, 5, 10, 20 degrees, against the empty view: 18.7 %, 14.6 %, 19.2 %, 3.4 % in place (48.5 %, 46.7 %, 51.4 %, 10.2 % widely), FLIP 0.44, 0.46, 0.48, 0.57",
        Differs,
    ),
    (
        "(ii) cloaks worse at angles away from the axis, horizontal",
        "turned by 0, 5, 10, 20 degrees, against the empty view: 40.5 %, 32.4 %, 25.5 %, 6.8 % in place (95.3 %, 75.8 %, 57.6 %, 15.8 % widely), FLIP 0.32, 0.40, 0.49, 0.57",
        Agrees,
    ),
    (
        "Fresnel reflection of (ii) is of the order of less than 3 %, horizontal",
        "at most 0.45 % (half view 32.5: 2.66 %) at the first face; all that comes back of rays at the edge of the view 3.2 % (half view 32.5: 8.6 %)",
        AgreesClosely,
    ),
    ("The same, vertical", "first face: at most 9.6 % (half view 32.5: 13.1 %)", Differs),
    (
        "(i) has more impedance mismatch to the sides than (ii), horizontal, all surfaces",
        "all that comes back of rays at the edge of the view, at most: (i) 5.1 % (half view 32.5: 9.3 %), (ii) 3.2 % (half view 32.5: 8.6 %); in the ordinary wave, at most: (i) 77 %, (ii) 2.0 %",
        Agrees,
    ),
    (
        "The same at the first face, seen along the axis",
        "reflected on average: (i) 0.0090 % (half view 32.5: 0.3746 %), (ii) 0.112 % (half view 32.5: 0.532 %)",
        Differs,
    ),
    (
        "(ii), vertical: ordinary light is trapped in a segment and escapes after several total internal reflections",
        "trapped beyond 21.06 degrees inside; in the centre plane 88.6 % leaves in one path after 3 reflections in segments, at 92.14 degrees",
        Agrees,
    ),
    (
        "(i): ordinary light is reflected totally in air at the first interface",
        "beyond 58.26 degrees of incidence; the view has at most 53.4 (half view 32.5: 57.7) at rotation 0, 71.4 (half view 32.5: 73.4) at 20",
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
        "(iii) is a perfect three-dimensional ray cloak",
        "power that is not on its own line, over the view: below 1e-12",
        Agrees,
    ),
    (
        "and a perfect three-dimensional wave cloak",
        "over the view the phase path changes by below 1e-11 cm, the field by below 1e-12; of a wave along x the mirror, seen edge-on, shorts 100 % of H, 0 % of V",
        Differs,
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
    ("and to a maximum index of 1.920", "1.918", AgreesClosely),
    (
        "The same with w and h that round to the printed digits, 10.0158 and 4.2532 cm",
        "1.920",
        Agrees,
    ),
    ("Dividing the index by its minimum references it to 1", "1.000 to 2.197", Agrees),
    ("Turned, (iv) looks like a wider mirror than (i)-(iii)", "50.00 cm against 19.94 cm", Agrees),
    (
        "A thinner, higher bump, cut properly, avoids the wider mirror",
        "w = 9 and h = 5.49 cm hide 114.83 cm² behind a mirror 44.91 cm wide, with an index up to 3.20; against the empty view, turned by 0 and 5 degrees: 35.4 %, 4.3 % in place (98.0 %, 37.9 % widely), FLIP 0.35, 0.48; the paper's bump 54.5 %, 8.5 % in place (99.9 %, 35.8 % widely), FLIP 0.26, 0.46",
        Differs,
    ),
    (
        "(iv) is polarization insensitive",
        "H and V part with at most 1.7 % of a ray's power, with more than 1 % on 6.7 % of the view; H 54.5 % in place (99.9 % widely), FLIP 0.26, V 54.5 % in place (99.9 % widely), FLIP 0.26",
        Agrees,
    ),
    (
        "(iv) transmits all of the light along the axis",
        "at least 99.9 % (half view 32.5: 99.9 %) of a ray's power comes from the photograph",
        AgreesClosely,
    ),
    (
        "The bare corrugation distorts the view severely; with the cloak it vanishes completely",
        "54.5 % in place (99.9 % widely), FLIP 0.26; bare metal 0.0 % in place (0.0 % widely), FLIP 0.57",
        DependsOnTolerance,
    ),
    (
        "The cloaking in three dimensions is also very good, amazingly good",
        "54.5 % in place (99.9 % widely), FLIP 0.26; bare metal 0.0 % in place (0.0 % widely), FLIP 0.57; RMS displacement 3.8 cm",
        DependsOnTolerance,
    ),
    (
        "To the left and right the image is cut around the middle horizontal line and stretched towards it, less so further from it, and not on the middle vertical line",
        "0.5 degrees up, light comes from 1.90 cm higher than in the empty view 18 degrees to the side, -0.53 cm in the middle; 12 degrees up, -2.29 and -2.14 cm",
        Agrees,
    ),
    (
        "The time of flight differs by less than 0.1 ns",
        "at most 0.075 ns (half view 32.5: 0.095 ns)",
        Agrees,
    ),
    (
        "That is a maximum relative error of 6 %",
        "4.5 % (half view 32.5: 5.7 %) of the 1.67 ns through 50 cm of air; 1.4 % (half view 32.5: 1.6 %) of the whole flight from the photograph to the camera",
        AgreesInOrderOfMagnitude,
    ),
    (
        "Fresnel reflection along the axis is of the order of 0.01 % or less",
        "first face, unpolarized: at most 0.059 % (half view 32.5: 0.068 %)",
        Differs,
    ),
    (
        "In all settings of Figs. 8 and 9 it is less than 0.2 %",
        "first face, either polarization: at most 0.09 % (half view 32.5: 42.59 %); all surfaces: more than 0.2 % leaves the main path, turned by 0, 5, 10, 20 degrees, on 13.3 % (half view 32.5: 21.4 %), 11.5 % (half view 32.5: 17.8 %), 13.3 % (half view 32.5: 14.2 %), 16.5 % (half view 32.5: 16.3 %) of the view",
        Differs,
    ),
    (
        "One sees no specular reflections on the surface of the cloak",
        "faces of the cloak reflect, from inside, more than 1 % of what is seen on 10.0 % (half view 32.5: 20.0 %), 10.4 % (half view 32.5: 17.3 %), 6.0 % (half view 32.5: 10.0 %), 0.0 % (half view 32.5: 0.0 %) of the view, turned by 0, 5, 10, 20 degrees, and up to 100 % (half view 32.5: 100 %)",
        Differs,
    ),
    (
        "It is smaller by orders of magnitude than for (i) and (ii), vertical",
        "first face, on average: (i) 33.0679 %, (ii) 7.1541 %, (iv) 0.0208 %",
        Agrees,
    ),
    (
        "The same, horizontal",
        "first face, on average: (i) 0.0090 %, (ii) 0.1121 %, (iv) 0.0178 %",
        Differs,
    ),
    (
        "Turned by 5, 10, 20 degrees, (iv) behaves similarly to the Gaussian carpet cloak",
        "against two of these back to back: 99.9 %, 99.9 %, 100.0 % in place (99.9 %, 99.9 %, 100.0 % widely), FLIP 0.00, 0.00, 0.00",
        Agrees,
    ),
    (
        "which gives the illusion of a flat mirror",
        "against a mirror 50 cm wide: 30.0 %, 1.0 %, 0.8 % in place (90.8 %, 94.1 %, 87.1 % widely), FLIP 0.19, 0.40, 0.41; bare metal 0.0 %, 0.0 %, 0.0 % in place (0.0 %, 5.6 %, 0.0 % widely), FLIP 0.58, 0.77, 0.83",
        DependsOnTolerance,
    ),
    (
        "The range of viewing angles of (iv) is narrower than that of (i)-(iii)",
        "H against the empty view, turned by 0, 5, 10, 20 degrees, in place: (i) 18.7 %, 14.6 %, 19.2 %, 3.4 %; (ii) 40.5 %, 32.4 %, 25.5 %, 6.8 %; (iii) 100.0 %, 77.8 %, 61.1 %, 16.7 %; (iv) 54.5 %, 8.5 %, 0.0 %, 0.0 %",
        Agrees,
    ),
    (
        "A true wave cloak reconstructs the time of flight of a light ray or a light pulse",
        "(iii) on its axis: the phase is on time within below 1e-12 ns, a pulse late by at least 1.4514 ns",
        Differs,
    ),
    (
        "Not said, but asked of any cloak by causality: no pulse outruns one in air",
        "over the view of (i)-(iv), the fastest is early by below 1e-9 ns",
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
