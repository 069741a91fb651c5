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
    /// The list of tables and the number of the table in it (counted from 0) that has the key; `None` if
    /// it is a key of the device itself.
    pub entry: Option<(&'static str, usize)>,
    /// What is wrong: quantity, value, unit, and what is allowed.
    pub message: String,
}

impl KeyError {
    /// An error of one key.
    pub fn at(key: &'static str, message: impl Into<String>) -> Self {
        KeyError { key: Some(key), entry: None, message: message.into() }
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
        KeyError { key: None, entry: None, message: message.into() }
    }

    /// The same error in a table of a list: of the list `list` the table of that number, counted from 0.
    #[must_use]
    pub fn within(self, list: &'static str, number: usize) -> Self {
        KeyError { entry: Some((list, number)), ..self }
    }

    /// Where the error is, of a table such as `device.0`: `device.0.side`, `device.0.prism.2.corners`; the table
    /// itself if it is nowhere in particular.
    #[must_use]
    pub fn path_in(&self, table: &str) -> String {
        let entry = self.entry.map(|(list, number)| format!("{list}.{number}"));
        let parts = [Some(table), entry.as_deref(), self.key];
        parts.into_iter().flatten().collect::<Vec<_>>().join(".")
    }
}
