//! All tests of the tracer, in one program: one is linked faster than many.

mod any_pose;
mod further_on;
mod graded_space;
mod numbers;
mod paths;
mod scatter;
