//! The traits that models of meshes implement, the same for every kind of mesh.

/// Declares the traits of the models of a mechanism whose loss is a power: the one that its models have as objects, and the one of laws that
/// are written once for one point, for several and for derivatives, from which the first follows. Numbers, tables and formulas implement it, too.
macro_rules! mesh_laws {
    ($M:ident, $At:ident, $(#[$model:meta])+ $Model:ident, $(#[$law:meta])+ $Law:ident) => {
        $(#[$model])+
        pub trait $Model: Send + Sync {
            /// Loss at one operating point. Pure; must not allocate.
            fn loss(&self, at: &$At<'_>) -> Result<$crate::loss::Loss, $crate::loss::Undefined>;

            /// The losses at several points together; written by a law over [`Real`](crate::real::Real). An error has them evaluated one by
            /// one.
            ///
            /// # Errors
            /// As [`Mechanism::answer_together`](crate::mechanism::Mechanism::answer_together).
            fn losses(
                &self,
                _at: &$At<'_, $crate::real::Lane>,
            ) -> Result<$crate::loss::Loss<$crate::real::Lane>, $crate::loss::Undefined> {
                Err($crate::loss::Undefined::DISAGREED)
            }

            /// The loss with its derivatives; written by such a law. `None` has them found by differences.
            fn loss_with_derivatives(
                &self,
                _at: &$At<'_, $crate::real::Dual>,
            ) -> Option<Result<$crate::loss::Loss<$crate::real::Dual>, $crate::loss::Undefined>> {
                None
            }
        }

        $(#[$law])+
        pub trait $Law: Send + Sync {
            /// Loss at one operating point, or at several. Pure; must not allocate.
            fn loss<R: $crate::mechanism::Answers>(
                &self,
                at: &$At<'_, R>,
            ) -> Result<$crate::loss::Loss<R>, $crate::loss::Undefined>;
        }

        impl<L: $Law> $Model for L {
            fn loss(&self, at: &$At<'_>) -> Result<$crate::loss::Loss, $crate::loss::Undefined> {
                $Law::loss(self, at)
            }

            fn losses(
                &self,
                at: &$At<'_, $crate::real::Lane>,
            ) -> Result<$crate::loss::Loss<$crate::real::Lane>, $crate::loss::Undefined> {
                <$crate::real::Lane as $crate::real::Points>::wide(
                    #[inline(always)]
                    || $Law::loss(self, at),
                )
            }

            fn loss_with_derivatives(
                &self,
                at: &$At<'_, $crate::real::Dual>,
            ) -> Option<Result<$crate::loss::Loss<$crate::real::Dual>, $crate::loss::Undefined>> {
                Some($Law::loss(self, at))
            }
        }

        impl $Model for $crate::mechanism::Scalar<$M> {
            fn loss(&self, at: &$At<'_>) -> Result<$crate::loss::Loss, $crate::loss::Undefined> {
                self.power(at)
            }

            fn losses(
                &self,
                at: &$At<'_, $crate::real::Lane>,
            ) -> Result<$crate::loss::Loss<$crate::real::Lane>, $crate::loss::Undefined> {
                Ok($crate::loss::Loss::POWERS.with(&<$M as $crate::mechanism::Mechanism>::TOTAL, self.values(at)?))
            }

            fn loss_with_derivatives(
                &self,
                _at: &$At<'_, $crate::real::Dual>,
            ) -> Option<Result<$crate::loss::Loss<$crate::real::Dual>, $crate::loss::Undefined>> {
                let value = <$crate::real::Dual as $crate::real::Real>::constant(self.constant()?);
                Some(Ok($crate::loss::Loss::POWERS.with(&<$M as $crate::mechanism::Mechanism>::TOTAL, value)))
            }
        }
    };
}

pub(crate) use mesh_laws;
