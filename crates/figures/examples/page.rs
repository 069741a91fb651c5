//! temporary
fn main() {
    let start = std::time::Instant::now();
    let last = std::cell::Cell::new(0.0);
    let found = cloakroom_figures::verification::verify(
        &|| {
            let t = start.elapsed().as_secs_f64();
            eprintln!("step {:.2}", t - last.get());
            last.set(t);
        },
        &std::sync::atomic::AtomicBool::new(false),
    )
    .unwrap();
    print!("{}", cloakroom_figures::verification::markdown(&found));
}
