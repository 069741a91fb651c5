//! The materials that come with the program.
//!
//! The numbers are facts of the publications that are named with each, as collected by the
//! refractiveindex.info database (M. N. Polyanskiy, Sci. Data 11, 94 (2024)), which is in the public
//! domain (CC0 1.0). Laws of transparent media leave their small absorption out.

use super::{Dispersion, IndexLaw, Material, Table};
use std::borrow::Cow;

/// What is said of a material that comes with the program.
struct Entry {
    name: &'static str,
    title: &'static str,
    source: &'static str,
    ordinary: Law,
    extraordinary: Option<Law>,
}

/// A law in constant memory: where it holds, µm, and what it is.
struct Law {
    range_um: [f64; 2],
    kind: Kind,
}

enum Kind {
    /// One of the formulas of [`Dispersion::Formula`].
    Formula(u8, &'static [f64]),
    /// Wavelengths in µm, n and k.
    Measured(&'static [f64], &'static [f64], &'static [f64]),
}

const fn formula(range_um: [f64; 2], number: u8, coefficients: &'static [f64]) -> Law {
    Law { range_um, kind: Kind::Formula(number, coefficients) }
}

const fn measured(um: &'static [f64], n: &'static [f64], k: &'static [f64]) -> Law {
    Law { range_um: [um[0], um[um.len() - 1]], kind: Kind::Measured(um, n, k) }
}

impl Law {
    fn law(&self) -> IndexLaw {
        let table =
            |um, values| Table { wavelengths_um: Cow::Borrowed(um), values: Cow::Borrowed(values) };
        let (dispersion, extinction) = match self.kind {
            Kind::Formula(number, coefficients) => {
                let coefficients = Cow::Borrowed(coefficients);
                (Dispersion::Formula { number, coefficients }, None)
            }
            Kind::Measured(um, n, k) => (Dispersion::Table(table(um, n)), Some(table(um, k))),
        };
        IndexLaw { dispersion, extinction, range_um: self.range_um }
    }
}

impl Material {
    /// The names of the materials that come with the program.
    pub const NAMES: [&'static str; ENTRIES.len()] = {
        let mut names = [""; ENTRIES.len()];
        let mut i = 0;
        while i < names.len() {
            names[i] = ENTRIES[i].name;
            i += 1;
        }
        names
    };

    /// The material of that name that comes with the program.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let entry = ENTRIES.iter().find(|entry| entry.name == name)?;
        Some(Self {
            title: entry.title.to_owned(),
            source: entry.source.to_owned(),
            ordinary: entry.ordinary.law(),
            extraordinary: entry.extraordinary.as_ref().map(Law::law),
        })
    }
}

const ENTRIES: [Entry; 15] = [
    Entry {
        name: "calcite",
        title: "Calcite, CaCO3",
        source: "G. Ghosh, Opt. Commun. 163, 95 (1999)",
        ordinary: formula(
            [0.204, 2.172],
            2,
            &[0.73358749, 0.96464345, 0.0194325203, 1.82831454, 120.0],
        ),
        extraordinary: Some(formula(
            [0.204, 2.172],
            2,
            &[0.35859695, 0.8242783, 0.0106689543, 0.14429128, 120.0],
        )),
    },
    Entry {
        name: "quartz",
        title: "Crystalline quartz, SiO2",
        source: "G. Ghosh, Opt. Commun. 163, 95 (1999)",
        ordinary: formula(
            [0.198, 2.0531],
            2,
            &[0.28604141, 1.07044083, 0.0100585997, 1.10202242, 100.0],
        ),
        extraordinary: Some(formula(
            [0.198, 2.0531],
            2,
            &[0.28851804, 1.09509924, 0.0102101864, 1.15662475, 100.0],
        )),
    },
    Entry {
        name: "sapphire",
        title: "Sapphire, Al2O3",
        source: "I. H. Malitson and M. J. Dodge, J. Opt. Soc. Am. 62, 1405 (1972); formula by M. J. Dodge, Handbook of Laser Science and Technology IV, 30 (1986)",
        ordinary: formula(
            [0.2, 5.0],
            1,
            &[0.0, 1.4313493, 0.0726631, 0.65054713, 0.1193242, 5.3414021, 18.028251],
        ),
        extraordinary: Some(formula(
            [0.2, 5.0],
            1,
            &[0.0, 1.5039759, 0.0740288, 0.55069141, 0.1216529, 6.5927379, 20.072248],
        )),
    },
    Entry {
        name: "magnesium-fluoride",
        title: "Magnesium fluoride, MgF2",
        source: "M. J. Dodge, Appl. Opt. 23, 1980 (1984)",
        ordinary: formula(
            [0.2, 7.0],
            1,
            &[0.0, 0.48755108, 0.04338408, 0.39875031, 0.09461442, 2.3120353, 23.793604],
        ),
        extraordinary: Some(formula(
            [0.2, 7.0],
            1,
            &[0.0, 0.41344023, 0.03684262, 0.50497499, 0.09076162, 2.4904862, 23.771995],
        )),
    },
    Entry {
        name: "rutile",
        title: "Rutile, TiO2",
        source: "J. R. Devore, J. Opt. Soc. Am. 41, 416 (1951)",
        ordinary: formula([0.43, 1.53], 4, &[5.913, 0.2441, 0.0, 0.0803, 1.0]),
        extraordinary: Some(formula([0.43, 1.53], 4, &[7.197, 0.3322, 0.0, 0.0843, 1.0])),
    },
    Entry {
        name: "lithium-niobate",
        title: "Lithium niobate, LiNbO3, congruent",
        source: "D. E. Zelmon, D. L. Small and D. Jundt, J. Opt. Soc. Am. B 14, 3319 (1997)",
        ordinary: formula([0.4, 5.0], 2, &[0.0, 2.6734, 0.01764, 1.229, 0.05914, 12.614, 474.6]),
        extraordinary: Some(formula(
            [0.4, 5.0],
            2,
            &[0.0, 2.9804, 0.02047, 0.5981, 0.0666, 8.9543, 416.08],
        )),
    },
    Entry {
        name: "bk7",
        title: "Glass N-BK7",
        source: "SCHOTT, optical glass catalogue (2017)",
        ordinary: formula(
            [0.3, 2.5],
            2,
            &[0.0, 1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653],
        ),
        extraordinary: None,
    },
    Entry {
        name: "sf11",
        title: "Glass N-SF11",
        source: "SCHOTT, optical glass catalogue (2017)",
        ordinary: formula(
            [0.37, 2.5],
            2,
            &[0.0, 1.73759695, 0.013188707, 0.313747346, 0.0623068142, 1.89878101, 155.23629],
        ),
        extraordinary: None,
    },
    Entry {
        name: "fused-silica",
        title: "Fused silica, SiO2",
        source: "I. H. Malitson, J. Opt. Soc. Am. 55, 1205 (1965)",
        ordinary: formula(
            [0.21, 6.7],
            1,
            &[0.0, 0.6961663, 0.0684043, 0.4079426, 0.1162414, 0.8974794, 9.896161],
        ),
        extraordinary: None,
    },
    Entry {
        name: "pmma",
        title: "Acrylic glass, PMMA",
        source: "N. Sultanova, S. Kasarova and I. Nikolov, Acta Phys. Pol. A 116, 585 (2009)",
        ordinary: formula([0.4368, 1.052], 2, &[0.0, 1.1819, 0.011313]),
        extraordinary: None,
    },
    Entry {
        name: "water",
        title: "Water, 20 degrees Celsius",
        source: "M. Daimon and A. Masumura, Appl. Opt. 46, 3811 (2007)",
        ordinary: formula(
            [0.182, 1.129],
            2,
            &[
                0.0,
                0.5684027565,
                0.005101829712,
                0.1726177391,
                0.01821153936,
                0.02086189578,
                0.02620722293,
                0.1130748688,
                10.69792721,
            ],
        ),
        extraordinary: None,
    },
    Entry {
        name: "air",
        title: "Dry air, 15 degrees Celsius, 101.325 kPa",
        source: "P. E. Ciddor, Appl. Opt. 35, 1566 (1996)",
        ordinary: formula([0.23, 1.69], 6, &[0.0, 0.05792105, 238.0185, 0.00167917, 57.362]),
        extraordinary: None,
    },
    Entry {
        name: "silver",
        title: "Silver, Ag",
        source: "P. B. Johnson and R. W. Christy, Phys. Rev. B 6, 4370 (1972)",
        ordinary: measured(&SILVER_UM, &SILVER_N, &SILVER_K),
        extraordinary: None,
    },
    Entry {
        name: "gold",
        title: "Gold, Au",
        source: "P. B. Johnson and R. W. Christy, Phys. Rev. B 6, 4370 (1972)",
        ordinary: measured(&GOLD_UM, &GOLD_N, &GOLD_K),
        extraordinary: None,
    },
    Entry {
        name: "aluminium",
        title: "Aluminium, Al",
        source: "A. D. Rakic, Appl. Opt. 34, 4755 (1995)",
        ordinary: measured(&ALUMINIUM_UM, &ALUMINIUM_N, &ALUMINIUM_K),
        extraordinary: None,
    },
];

const SILVER_UM: [f64; 49] = [
    0.1879, 0.1916, 0.1953, 0.1993, 0.2033, 0.2073, 0.2119, 0.2164, 0.2214, 0.2262, 0.2313, 0.2371,
    0.2426, 0.249, 0.2551, 0.2616, 0.2689, 0.2761, 0.2844, 0.2924, 0.3009, 0.3107, 0.3204, 0.3315,
    0.3425, 0.3542, 0.3679, 0.3815, 0.3974, 0.4133, 0.4305, 0.4509, 0.4714, 0.4959, 0.5209, 0.5486,
    0.5821, 0.6168, 0.6595, 0.7045, 0.756, 0.8211, 0.892, 0.984, 1.088, 1.216, 1.393, 1.61, 1.937,
];
const SILVER_N: [f64; 49] = [
    1.07, 1.1, 1.12, 1.14, 1.15, 1.18, 1.2, 1.22, 1.25, 1.26, 1.28, 1.28, 1.3, 1.31, 1.33, 1.35,
    1.38, 1.41, 1.41, 1.39, 1.34, 1.13, 0.81, 0.17, 0.14, 0.1, 0.07, 0.05, 0.05, 0.05, 0.04, 0.04,
    0.05, 0.05, 0.05, 0.06, 0.05, 0.06, 0.05, 0.04, 0.03, 0.04, 0.04, 0.04, 0.04, 0.09, 0.13, 0.15,
    0.24,
];
const SILVER_K: [f64; 49] = [
    1.212, 1.232, 1.255, 1.277, 1.296, 1.312, 1.325, 1.336, 1.342, 1.344, 1.357, 1.367, 1.378,
    1.389, 1.393, 1.387, 1.372, 1.331, 1.264, 1.161, 0.964, 0.616, 0.392, 0.829, 1.142, 1.419,
    1.657, 1.864, 2.07, 2.275, 2.462, 2.657, 2.869, 3.093, 3.324, 3.586, 3.858, 4.152, 4.483,
    4.838, 5.242, 5.727, 6.312, 6.992, 7.795, 8.828, 10.1, 11.85, 14.08,
];

const GOLD_UM: [f64; 49] = [
    0.1879, 0.1916, 0.1953, 0.1993, 0.2033, 0.2073, 0.2119, 0.2164, 0.2214, 0.2262, 0.2313, 0.2371,
    0.2426, 0.249, 0.2551, 0.2616, 0.2689, 0.2761, 0.2844, 0.2924, 0.3009, 0.3107, 0.3204, 0.3315,
    0.3425, 0.3542, 0.3679, 0.3815, 0.3974, 0.4133, 0.4305, 0.4509, 0.4714, 0.4959, 0.5209, 0.5486,
    0.5821, 0.6168, 0.6595, 0.7045, 0.756, 0.8211, 0.892, 0.984, 1.088, 1.216, 1.393, 1.61, 1.937,
];
const GOLD_N: [f64; 49] = [
    1.28, 1.32, 1.34, 1.33, 1.33, 1.3, 1.3, 1.3, 1.3, 1.31, 1.3, 1.32, 1.32, 1.33, 1.33, 1.35,
    1.38, 1.43, 1.47, 1.49, 1.53, 1.53, 1.54, 1.48, 1.48, 1.5, 1.48, 1.46, 1.47, 1.46, 1.45, 1.38,
    1.31, 1.04, 0.62, 0.43, 0.29, 0.21, 0.14, 0.13, 0.14, 0.16, 0.17, 0.22, 0.27, 0.35, 0.43, 0.56,
    0.92,
];
const GOLD_K: [f64; 49] = [
    1.188, 1.203, 1.226, 1.251, 1.277, 1.304, 1.35, 1.387, 1.427, 1.46, 1.497, 1.536, 1.577, 1.631,
    1.688, 1.749, 1.803, 1.847, 1.869, 1.878, 1.889, 1.893, 1.898, 1.883, 1.871, 1.866, 1.895,
    1.933, 1.952, 1.958, 1.948, 1.914, 1.849, 1.833, 2.081, 2.455, 2.863, 3.272, 3.697, 4.103,
    4.542, 5.083, 5.663, 6.35, 7.15, 8.145, 9.519, 11.21, 13.78,
];

const ALUMINIUM_UM: [f64; 30] = [
    0.20664, 0.24797, 0.30996, 0.32628, 0.36466, 0.41328, 0.4428, 0.47687, 0.5166, 0.56357,
    0.61993, 0.65225, 0.68881, 0.72932, 0.77491, 0.79478, 0.81569, 0.83774, 0.88561, 0.91166,
    0.93928, 0.96863, 0.99988, 1.0332, 1.1271, 1.2399, 1.3776, 1.5498, 1.7712, 2.0664,
];
const ALUMINIUM_N: [f64; 30] = [
    0.12677, 0.18137, 0.28003, 0.31474, 0.39877, 0.52135, 0.6079, 0.7278, 0.8734, 1.0728, 1.366,
    1.5724, 1.8301, 2.1606, 2.6154, 2.7675, 2.7668, 2.6945, 2.2802, 1.9739, 1.6784, 1.4867, 1.4359,
    1.3998, 1.3281, 1.3157, 1.3899, 1.5782, 1.9205, 2.4738,
];
const ALUMINIUM_K: [f64; 30] = [
    2.3563, 2.9029, 3.7081, 3.9165, 4.3957, 5.0008, 5.3676, 5.7781, 6.2418, 6.7839, 7.4052, 7.7354,
    8.0601, 8.3565, 8.4914, 8.3866, 8.2573, 8.1878, 8.1134, 8.3058, 8.597, 9.0655, 9.4939, 9.8914,
    10.969, 12.245, 13.784, 15.656, 17.991, 20.982,
];
