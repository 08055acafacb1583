//! Machines outside their maps and envelopes, in words.

use gearloss_studies::analyses::common::outside_maps::MachineOutside;
use gearloss_studies::analyses::cycle::MachineOfDuty;
use gearloss_studies::numbers::tidy;

use crate::names::model;
use crate::text::short;

/// What becomes of the points outside a map.
const EDGE: &str = "the loss at the edge of the map is used";

/// A machine that is outside its map at points.
pub fn outside_map(outside: &MachineOutside) -> String {
    let name = model(&outside.machine);
    let points = if outside.points == 1 { "point" } else { "points" };
    let farthest = if outside.size() > 0.0 {
        let excess = [outside.torque_beyond_nm, outside.speed_beyond_rpm];
        format!(", farthest {}", state([outside.torque_nm, outside.speed_rpm], excess))
    } else {
        String::new()
    };
    format!(
        "{name} is outside its map at {} {points}{farthest}; {EDGE}",
        outside.points
    )
}

/// What a reader has to be careful about in a cycle of so many seconds.
pub fn cautions_of_cycle(machine: &MachineOfDuty, duration: f64) -> Vec<String> {
    let mut all = Vec::new();
    let name = model(&machine.machine);
    if machine.outside_map_s > 0.0 {
        let share = 100.0 * machine.outside_map_s / duration.max(f64::MIN_POSITIVE);
        let farthest = machine.farthest.map_or_else(String::new, |at| {
            let excess = [at.torque_beyond_nm, at.speed_beyond_rpm];
            let state = state([at.torque_nm, at.speed_rpm], excess);
            format!(", farthest at {} s {state}", tidy(at.time_s))
        });
        all.push(format!(
            "{name} is outside its map for {share:.1} % of the time{farthest}; {EDGE}"
        ));
    }
    if machine.beyond_envelope_s > 0.0 {
        all.push(format!(
            "{name} is above its envelope for {:.1} s",
            machine.beyond_envelope_s
        ));
    }
    if machine.beyond_peak_time > 0 {
        let times = if machine.beyond_peak_time == 1 { "time" } else { "times" };
        all.push(format!(
            "{name} is above its continuous torque longer than it may be {} {times}, at most {:.1} s",
            machine.beyond_peak_time, machine.longest_above_continuous_s
        ));
    }
    all
}

/// Torque (Nm) and speed (rpm), and by how much they are beyond a map.
fn state([torque, speed]: [f64; 2], [torque_beyond, speed_beyond]: [f64; 2]) -> String {
    let mut words = format!("with {} Nm at {} rpm", short(torque), short(speed));
    if torque_beyond > 0.0 {
        words.push_str(&format!(", {} Nm above its largest torque there", short(torque_beyond)));
    }
    if speed_beyond > 0.0 {
        words.push_str(&format!(", {} rpm above its largest speed", short(speed_beyond)));
    }
    words
}
