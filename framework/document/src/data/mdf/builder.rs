//! Writes small MDF files for tests: any block by its links and fields.

/// A file that grows by blocks. Links are positions, so blocks are written before those that refer to them.
pub struct MdfBuilder(pub Vec<u8>);

/// A channel: name, unit, kind (0 value, 2 master, 3 virtual master), type of its data, first byte, first bit, bits, conversion.
pub struct ChannelFields<'a> {
    pub name: &'a str,
    pub unit: &'a str,
    pub kind: u8,
    pub data_type: u8,
    pub byte: u32,
    pub bit: u8,
    pub bits: u32,
    pub conversion: u64,
    /// Flags, and the bit of the validity.
    pub flags: (u32, u32),
}

impl<'a> ChannelFields<'a> {
    /// A number of 64 bits with the lowest byte first.
    pub fn float(name: &'a str, unit: &'a str, byte: u32) -> Self {
        Self {
            name,
            unit,
            kind: 0,
            data_type: 4,
            byte,
            bit: 0,
            bits: 64,
            conversion: 0,
            flags: (0, 0),
        }
    }
}

impl MdfBuilder {
    /// Id and header. The link to the first data group is set by [`Self::finish`].
    pub fn new() -> Self {
        let mut bytes = b"MDF     4.10    gearloss".to_vec();
        bytes.resize(64, 0);
        bytes[28..30].copy_from_slice(&410_u16.to_le_bytes());
        let mut new = Self(bytes);
        new.block(*b"HD", &[0; 6], &[0; 32]);
        new
    }

    /// Appends a block and returns its position.
    pub fn block(&mut self, id: [u8; 2], links: &[u64], data: &[u8]) -> u64 {
        while !self.0.len().is_multiple_of(8) {
            self.0.push(0);
        }
        let at = self.0.len() as u64;
        self.0.extend([b'#', b'#', id[0], id[1], 0, 0, 0, 0]);
        self.0
            .extend((24 + 8 * links.len() as u64 + data.len() as u64).to_le_bytes());
        self.0.extend((links.len() as u64).to_le_bytes());
        self.0.extend(links.iter().flat_map(|link| link.to_le_bytes()));
        self.0.extend(data);
        at
    }

    pub fn text(&mut self, text: &str) -> u64 {
        if text.is_empty() {
            return 0;
        }
        self.block(*b"TX", &[], format!("{text}\0").as_bytes())
    }

    /// A conversion of a type with numbers, and references from the fifth link on.
    pub fn conversion(&mut self, kind: u8, values: &[f64], references: &[u64]) -> u64 {
        let mut data = vec![kind, 0, 0, 0];
        data.extend((references.len() as u16).to_le_bytes());
        data.extend((values.len() as u16).to_le_bytes());
        data.extend([0; 16]);
        data.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        let links: Vec<u64> = [0; 4].iter().chain(references).copied().collect();
        self.block(*b"CC", &links, &data)
    }

    /// A list of channels; returns the first.
    pub fn channels(&mut self, channels: &[ChannelFields<'_>]) -> u64 {
        let mut next = 0;
        for channel in channels.iter().rev() {
            let [name, unit] = [channel.name, channel.unit].map(|text| self.text(text));
            let mut data = vec![channel.kind, u8::from(channel.kind > 1), channel.data_type, channel.bit];
            for number in [channel.byte, channel.bits, channel.flags.0, channel.flags.1] {
                data.extend(number.to_le_bytes());
            }
            data.resize(72, 0);
            next = self.block(*b"CN", &[next, 0, name, 0, channel.conversion, 0, unit, 0], &data);
        }
        next
    }

    /// A channel group: next group, first channel, name, number of its records, samples, bytes of channels and of their validity.
    pub fn group(&mut self, next: u64, channels: u64, name: &str, numbers: (u64, u64, u32, u32)) -> u64 {
        let name = self.text(name);
        let (id, samples, bytes, validity) = numbers;
        let mut data = id.to_le_bytes().to_vec();
        data.extend(samples.to_le_bytes());
        data.extend([0; 8]);
        data.extend(bytes.to_le_bytes());
        data.extend(validity.to_le_bytes());
        self.block(*b"CG", &[next, channels, name, 0, 0, 0], &data)
    }

    /// A data group: next group, first channel group, data, bytes of the record numbers.
    pub fn data_group(&mut self, next: u64, group: u64, data: u64, id_bytes: u8) -> u64 {
        self.block(*b"DG", &[next, group, data, 0], &[id_bytes, 0, 0, 0, 0, 0, 0, 0])
    }

    /// The bytes of the file with this first data group.
    pub fn finish(mut self, first: u64) -> Vec<u8> {
        self.0[88..96].copy_from_slice(&first.to_le_bytes());
        self.0
    }
}

/// A file with one group of columns of numbers: names, units, rows.
pub fn simple(columns: &[(&str, &str)], rows: &[Vec<f64>]) -> Vec<u8> {
    let mut file = MdfBuilder::new();
    let fields: Vec<ChannelFields<'_>> = columns
        .iter()
        .enumerate()
        .map(|(i, (name, unit))| ChannelFields::float(name, unit, 8 * i as u32))
        .collect();
    let channels = file.channels(&fields);
    let bytes: Vec<u8> = rows.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let data = file.block(*b"DT", &[], &bytes);
    let group = file.group(0, channels, "", (0, rows.len() as u64, 8 * columns.len() as u32, 0));
    let first = file.data_group(0, group, data, 0);
    file.finish(first)
}
