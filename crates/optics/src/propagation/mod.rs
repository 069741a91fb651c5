//! How a ray runs through a graded medium.
