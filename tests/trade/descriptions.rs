//! Gearbox files: what is absent, misspelt or set from elsewhere.
