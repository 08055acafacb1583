//! Tooth loss factors: the lost share of the transmitted power per unit of friction coefficient.

use super::pair::Pair;
use super::path::LoadSharing;

impl Pair {
    fn factor(&self) -> f64 {
        let u = self.ratio();
        std::f64::consts::PI * (u + self.sign()) / (f64::from(self.z[0]) * u * self.base_helix.cos())
    }

    /// Ohlendorf 1958: exact for constant friction, half of the load on each pair in double contact, and one to two pairs in
    /// contact.
    pub fn loss_factor_ohlendorf(&self) -> f64 {
        let [e1, e2] = self.addendum_ratio;
        self.factor() * (1.0 - self.contact_ratio + e1 * e1 + e2 * e2)
    }

    /// Evenly shared load: the limit of helical gears with a large overlap ratio.
    pub fn loss_factor_uniform(&self) -> f64 {
        let [e1, e2] = self.addendum_ratio;
        // With the pitch point off the path, one of its sides has a negative part.
        self.factor() * (e1 * e1.abs() + e2 * e2.abs()).abs() / self.contact_ratio
    }

    /// Wimmer 2006: the local loss factor for any load sharing.
    pub fn loss_factor_local(&self, sharing: LoadSharing) -> f64 {
        let integral: f64 = self
            .path(sharing, 4)
            .iter()
            .map(|p| p.weight * p.share * self.sliding(p.x))
            .sum();
        integral / (self.base_pitch * self.base_helix.cos() * self.base_radius[0])
    }
}

#[cfg(test)]
mod tests;
