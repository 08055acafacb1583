//! The benches, as one program: a link for each would cost more than its compilation. `cargo bench -- GROUP/` runs those of one file,
//! whose name its group has.

mod common;
#[path = "common/identification.rs"]
mod identification;

mod cycle;
mod ehl_mixed;
mod elementary;
mod identify;
mod map;
mod network;
mod point;
mod reading;

criterion::criterion_main!(
    cycle::benches,
    ehl_mixed::benches,
    elementary::benches,
    identify::benches,
    map::benches,
    network::benches,
    point::benches,
    reading::benches,
);
