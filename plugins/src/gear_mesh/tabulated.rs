//! Probe.
#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::print_stdout)]
    use crate::tooth_friction::ehl_mixed::cases::stage;
    use gearloss_framework::loss::Notes;
    use gearloss_framework::mechanism::gear_mesh::{GearMesh, GearMeshAt};
    use gearloss_framework::registry::{Build, Files, Registry};
    use std::sync::Arc;
    use std::io::Write;
    use rayon::prelude::*;

    #[test]
    fn dump() {
        let n: Vec<usize> = std::env::var("GRID").unwrap_or("25,25,13".into()).split(',').map(|x| x.parse().unwrap()).collect();
        for s in [1, 2] {
            for known in [0.0, 1.0] {
            let part = Arc::new(stage(s));
            let registry = Registry::linked().unwrap();
            let files = Files::default();
            let model = serde_json::json!({"type": "path_integral", "load_sharing": "ramp", "tooth_friction": {"type": "ehl_mixed"}});
            let slot = Build::new(&registry, &files).slot_at::<GearMesh>("m", &part, &model).unwrap();
            let grid = |lo: f64, hi: f64, n: usize, i: usize| lo + (hi - lo) * i as f64 / (n - 1) as f64;
            let start = std::time::Instant::now();
            let rows: Vec<f64> = (0..n[0]*n[1]*n[2]).into_par_iter().map(|k| {
                let (i, j, l) = (k / (n[1]*n[2]), k / n[2] % n[1], k % n[2]);
                let speed = grid(5.0_f64.ln(), 20000.0_f64.ln(), n[0], i).exp() * std::f64::consts::PI / 30.0;
                let torque = grid(0.1_f64.ln(), 2000.0_f64.ln(), n[1], j).exp();
                let t = grid(-20.0, 140.0, n[2], l);
                let oil = part.oil.as_ref().unwrap().lubricant.at(t);
                let at = GearMeshAt { torque, speed, temperature: t, nu: oil.nu, eta: oil.eta, rho: oil.rho, alpha: oil.alpha, beta: oil.beta,
                    conductivity: oil.conductivity, x_l: oil.x_l, bodies_known: known, temperature_1: t, temperature_2: t, ..GearMeshAt::usual(&part, Notes::MUTED) };
                slot.loss(&at).map_or(f64::NAN, |l| l.sum() / (torque * speed))
            }).collect();
            println!("{s} {known} {:?}", start.elapsed() / rows.len() as u32);
            let mut f = std::fs::File::create(format!("/tmp/gl/dump_{s}_{known}.bin")).unwrap();
            for r in rows { f.write_all(&r.to_le_bytes()).unwrap(); }
            }
        }
    }
}
