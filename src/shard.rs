//! Number of a shard, as an argument and in manifests.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Shard `number` of `of`, counted from one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    pub number: usize,
    pub of: usize,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let how = "write K/N: part K of N, such as 1/3";
        let (number, of) = text.split_once('/').ok_or(how)?;
        let number = number.parse().map_err(|_| how)?;
        let of = of.parse().map_err(|_| how)?;
        if (1..=of).contains(&number) {
            Ok(Self { number, of })
        } else {
            Err(format!("K runs from 1 to N; {how}"))
        }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}
