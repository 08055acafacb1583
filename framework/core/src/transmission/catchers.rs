//! Windows, ribs and pockets of bearings as they catch oil that gears throw.

use crate::attach::Oil;
use crate::hydraulics::{Hydraulics, Pocket, Work};
use crate::real::Points;
use crate::sump::{Catchers, Caught};

/// The pockets of a transmission at a point, with what its oil network feeds into them.
pub(crate) struct Pockets<'a, R: Points> {
    pub network: &'a Hydraulics,
    pub work: &'a Work<R>,
    pub speeds: &'a [R],
    pub oils: &'a [Oil<R>],
}

impl<R: Points> Catchers<R> for Pockets<'_, R> {
    #[inline]
    fn caught<T: Points>(
        &self,
        of: impl Fn(R) -> T + Copy,
        gear: impl Fn(usize) -> [T; 2] + Copy,
        flow: T,
        length: T,
    ) -> Caught<T> {
        let mut caught = Caught {
            through: T::ZERO,
            bare: T::ZERO,
            held: T::ZERO,
        };
        let pockets = &self.network.pockets;
        let through = |pocket: &Pocket| match &pocket.window {
            Some(window) => {
                let [dip, thrown] = gear(window.lift);
                window.taken(of(self.speeds[window.member]), dip).share * thrown
            }
            None => T::ZERO,
        };
        for pocket in pockets {
            caught.through += through(pocket);
        }
        let wetting = (flow - caught.through).at_least(0.0);
        for pocket in pockets {
            if let Some(rib) = &pocket.rib {
                caught.bare += rib.bare(length);
            }
            // What stands in a pocket of another oil is not missing from the sump.
            if let Some(room) = pocket.room.as_ref().filter(|_| pocket.of_sump) {
                let rib = pocket.rib.map_or(T::ZERO, |rib| wetting * rib.share(length));
                let inflow = of(pocket.fed(self.work)) + rib + through(pocket);
                let fluid = self.network.aerated(&self.oils[pocket.oil as usize]).map(of);
                caught.held += room.volume(pocket.height(inflow, &fluid));
            }
        }
        caught.bare = caught.bare.at_most(1.0);
        caught
    }
}
