//! Files of rigs, loggers and spreadsheets: where their header, units and times are.
