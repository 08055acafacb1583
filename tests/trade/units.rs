//! Quantities in the units of the trade: read to the right value or refused with a help that is right.
