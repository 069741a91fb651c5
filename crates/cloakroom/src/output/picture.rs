//! stub
/// a
#[derive(Debug, Clone)]
pub struct Picture {
    /// a
    pub width: usize,
    /// a
    pub height: usize,
    /// a
    pub channels: Vec<Channel>,
    /// a
    pub metadata: Vec<(String, String)>,
}
/// a
#[derive(Debug, Clone)]
pub struct Channel {
    /// a
    pub name: String,
    /// a
    pub samples: Samples,
}
/// a
#[derive(Debug, Clone)]
pub enum Samples {
    /// a
    F32(Vec<f32>),
    /// a
    F64(Vec<f64>),
}
