//! All tests of light in matter, in one program: one is linked faster than many.

mod birefringence;
mod coatings;
mod conformal_flow;
mod conical_refraction;
mod extreme_media;
mod graded_index;
mod grazing;
mod group_path;
mod hyperbolic_cuts;
mod interfaces;
mod interfaces_million;
mod long;
mod paths;
mod radial_flow;
mod random_media;
mod spatial_flow;
mod square_cloak_faces;
mod typed_tensors;
