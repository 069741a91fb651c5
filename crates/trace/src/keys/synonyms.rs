//! What keys and tables are called elsewhere.

/// Words of other programs and of textbooks, each with the keys or tables that may be meant by it:
/// the first one that is known in its place.
const SYNONYMS: &[(&[&str], &[&str])] = &[
    // Cameras.
    (
        &["fov", "fov_deg", "hfov", "horizontal_fov", "angle_of_view", "view_angle", "fovx"],
        &["field_of_view"],
    ),
    (&["eye", "from", "location", "place", "center", "centre", "translation"], &["position"]),
    (&["look_at", "lookat", "at", "to", "focus", "aim"], &["target"]),
    (&["size", "image_size", "pixels", "film_size"], &["resolution", "side", "width"]),
    (&["spp", "samples_per_pixel", "sample_count", "rays_per_pixel"], &["samples"]),
    (&["random_seed", "rng_seed"], &["seed"]),
    // Media.
    (&["ior", "n", "refractive_index", "index_of_refraction", "refraction_index"], &["index"]),
    (
        &["eps", "eps_r", "epsilon", "epsilon_r", "dielectric_constant", "relative_permittivity"],
        &["permittivity", "tolerance"],
    ),
    (&["mu", "mu_r", "relative_permeability"], &["permeability"]),
    (&["ng", "n_g", "group_refractive_index"], &["group_index"]),
    (&["no", "n_o", "ordinary_index"], &["ordinary"]),
    (&["ne", "n_e", "extraordinary_index"], &["extraordinary"]),
    (&["optical_axis", "c_axis", "director"], &["optic_axis"]),
    (&["glass", "medium", "substance"], &["material"]),
    (&["loss", "tan_delta", "dissipation"], &["loss_tangent"]),
    (&["damping", "gamma", "collision_rate"], &["damping_ev"]),
    (&["plasma", "plasma_frequency", "plasma_energy"], &["plasma_ev"]),
    // Devices.
    (&["type"], &["kind"]),
    (&["view", "mode", "shown"], &["show"]),
    (
        &["tilt", "angle", "angle_deg", "rotate", "turn", "yaw", "rotation_deg", "orientation"],
        &["rotation"],
    ),
    (&["inner_radius", "radius_inner", "r_inner", "r_in", "core_radius"], &["inner"]),
    (&["outer_radius", "radius_outer", "r_outer", "r_out"], &["outer"]),
    (&["r1", "radius_1", "radius1", "front_curvature_radius"], &["front_radius"]),
    (&["r2", "radius_2", "radius2", "back_curvature_radius"], &["back_radius"]),
    (&["r"], &["radius"]),
    (&["aperture", "clear_aperture"], &["diameter"]),
    (&["depth"], &["thickness", "length"]),
    (&["edge", "edge_length", "side_length"], &["side"]),
    (&["bump_height"], &["h"]),
    (&["bump_width"], &["w"]),
    (&["vertices", "points", "polygon", "outline"], &["corners"]),
    (&["layers", "layer", "film", "films"], &["coating", "picture"]),
    (&["precedence", "z_index"], &["priority"]),
    (&["conductor"], &["metal"]),
    (&["noise", "sigma", "standard_deviation"], &["error"]),
    (&["correlation_length"], &["correlation"]),
    // Light and pictures.
    (&["lambda", "lambda_nm"], &["wavelength_nm", "design_wavelength_nm"]),
    (&["fwhm", "linewidth", "line_width"], &["bandwidth_nm"]),
    (&["temperature", "color_temperature", "kelvin"], &["black_body_k"]),
    (&["rgb", "emission", "radiance"], &["color"]),
    (&["file", "path", "filename", "texture", "photo"], &["image", "photograph"]),
    (&["distance"], &["x"]),
    (&["edge_mode", "wrap", "tiling", "repeat", "beyond"], &["border"]),
    (&["threshold", "cutoff", "min_weight"], &["min_power"]),
    (&["accuracy", "precision"], &["tolerance"]),
    // Tables.
    (&["screen", "backdrop", "poster", "picture_behind"], &["photograph"]),
    (&["background", "environment", "env", "sky"], &["surroundings"]),
    (&["object", "objects", "cloak", "cloaks", "shape"], &["device"]),
    (&["source", "lamp", "illumination"], &["light"]),
    (&["tracer", "tracing", "solver", "integrator"], &["trace"]),
    (&["output"], &["picture"]),
    (&["detector", "sensor"], &["receiver"]),
];

/// The known word for what is called so elsewhere; case and the difference between `-` and `_` do
/// not count.
pub fn synonym<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let word = super::nearest::fold(word);
    let meant = SYNONYMS.iter().filter(|(words, _)| words.contains(&word.as_str()));
    meant
        .flat_map(|(_, meant)| meant.iter())
        .find_map(|meant| known.iter().copied().find(|known| known == meant))
}

#[cfg(test)]
mod tests {
    use super::super::unknown;
    use super::{SYNONYMS, synonym};

    #[test]
    fn words_from_elsewhere_are_told_their_word_here() {
        let camera = ["position", "target", "field_of_view", "resolution"];
        for (word, meant) in
            [("fov", "field_of_view"), ("FOV-deg", "field_of_view"), ("size", "resolution")]
        {
            assert_eq!(synonym(word, &camera), Some(meant));
        }
        assert_eq!(synonym("ior", &camera), None);
        assert_eq!(synonym("size", &["side", "kappa"]), Some("side"));
        let message = unknown("key", "tilt", " in a body", &["position", "rotation"]);
        assert_eq!(message, "unknown key `tilt` in a body; here it is called `rotation`");
    }

    #[test]
    fn no_word_has_two_entries() {
        let mut words: Vec<&str> = SYNONYMS.iter().flat_map(|(words, _)| *words).copied().collect();
        let count = words.len();
        words.sort_unstable();
        words.dedup();
        assert_eq!(words.len(), count);
    }
}
