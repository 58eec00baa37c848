/*
 * Glasses and other clear matter: n² = 1 + sum b λ² / (λ² - c), λ in µm, as collected
 * (CC0) by refractiveindex.info.
 *
 * SCHOTT optical glass catalogue 2017-01-20 (N-...).
 * I. H. Malitson, "Interspecimen comparison of the refractive index of fused silica",
 * 1965.
 * M. Daimon, A. Masumura, "Measurement of the refractive index of distilled water ...",
 * 2007 (20 degrees C).
 * F. Peter, "Über Brechungsindizes und Absorptionskonstanten des Diamanten", 1923.
 * Malitson's and Peter's poles are published as wavelengths, hence the squares.
 *
 * Oxides: n² = a + b / (λ² - c) + d λ² + e λ⁴.
 * R. E. Stephens, I. H. Malitson, "Index of refraction of magnesium oxide", 1952.
 * J. R. Devore, "Refractive indices of rutile and sphalerite", 1951 (extraordinary ray).
 */
#include "color/data/tables.h"

const glass_formula measured_glasses[] = {
    {"N-BK7",
     {1.03961212, 0.231792344, 1.01046945},
     {0.00600069867, 0.0200179144, 103.560653}},
    {"N-BAF10",
     {1.5851495, 0.143559385, 1.08521269},
     {0.00926681282, 0.0424489805, 105.613573}},
    {"N-FK51A",
     {0.971247817, 0.216901417, 0.904651666},
     {0.00472301995, 0.0153575612, 168.68133}},
    {"N-LAK8",
     {1.33183167, 0.546623206, 1.19084015},
     {0.00620023871, 0.0216465439, 82.5827736}},
    {"N-LASF9",
     {2.00029547, 0.298926886, 1.80691843},
     {0.0121426017, 0.0538736236, 156.530829}},
    {"N-SF5",
     {1.52481889, 0.187085527, 1.42729015},
     {0.011254756, 0.0588995392, 129.141675}},
    {"N-SF6",
     {1.77931763, 0.338149866, 2.08734474},
     {0.0133714182, 0.0617533621, 174.01759}},
    {"N-SF10",
     {1.62153902, 0.256287842, 1.64447552},
     {0.0122241457, 0.0595736775, 147.468793}},
    {"N-SF11",
     {1.73759695, 0.313747346, 1.89878101},
     {0.013188707, 0.0623068142, 155.23629}},
    {"N-SF66",
     {2.0245976, 0.470187196, 2.59970433},
     {0.0147053225, 0.0692998276, 161.817601}},
    {"SiO2",
     {0.6961663, 0.4079426, 0.8974794},
     {0.0684043 * 0.0684043, 0.1162414 * 0.1162414, 9.896161 * 9.896161}},
    {"water",
     {5.684027565e-1, 1.726177391e-1, 2.086189578e-2, 1.130748688e-1},
     {5.101829712e-3, 1.821153936e-2, 2.620722293e-2, 1.069792721e1}},
    {"diamond", {0.3306, 4.3356}, {0.1750 * 0.1750, 0.1060 * 0.1060}},
    {0},
};

const oxide_formula measured_oxides[] = {
    {"MgO", 2.956362, 0.02195770, 0.01428322, -0.01062387, -0.0000204968},
    {"TiO2", 7.197, 0.3322, 0.0843, 0.0, 0.0},
    {0},
};
