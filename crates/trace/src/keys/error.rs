//! Why a table cannot be had.

/// Why a table cannot be had: which key is impossible, and how.
///
/// A device whose keys are each allowed but impossible together (an inner radius larger than the
/// outer one) refuses with the same error.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct KeyError {
    /// The key at fault; `None` if no single one is.
    pub key: Option<&'static str>,
    /// The lists of tables, the outermost first, and the numbers of the tables in them (counted
    /// from 0) that hold the key; none if it is a key of the device itself.
    pub entries: Vec<(&'static str, usize)>,
    /// What is wrong: quantity, value, unit, and what is allowed.
    pub message: String,
}

impl KeyError {
    /// An error of one key.
    pub fn at(key: &'static str, message: impl Into<String>) -> Self {
        KeyError { key: Some(key), entries: Vec::new(), message: message.into() }
    }

    /// Refuses a table for one of its keys where `refused` is true.
    ///
    /// # Errors
    ///
    /// The error of that key.
    pub fn refuse_if(
        refused: bool,
        key: &'static str,
        message: impl Into<String>,
    ) -> Result<(), Self> {
        if refused { Err(Self::at(key, message)) } else { Ok(()) }
    }

    /// An error of no single key.
    pub fn general(message: impl Into<String>) -> Self {
        KeyError { key: None, entries: Vec::new(), message: message.into() }
    }

    /// The same error in a table of a list: of the list `list` the table of that number, counted
    /// from 0.
    #[must_use]
    pub fn within(mut self, list: &'static str, number: usize) -> Self {
        self.entries.insert(0, (list, number));
        self
    }

    /// Where the error is, of a table such as `device.0`: `device.0.side`,
    /// `device.0.prism.2.corners`; the table itself if it is nowhere in particular.
    #[must_use]
    pub fn path_in(&self, table: &str) -> String {
        let entries = self.entries.iter().map(|(list, number)| format!("{list}.{number}"));
        let key = self.key.map(str::to_owned);
        [table.to_owned()].into_iter().chain(entries).chain(key).collect::<Vec<_>>().join(".")
    }
}
