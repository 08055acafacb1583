//! Losses and temperatures that are known from a calculation by hand.
