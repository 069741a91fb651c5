//! A part of a picture.

use super::{MeasureError, View};

/// Some of the pixels of a picture, one at least.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PixelMask {
    width: usize,
    /// Whether each pixel belongs to it.
    pub(super) mask: Vec<bool>,
}

impl PixelMask {
    /// The pixels that are true, row by row from the top left.
    ///
    /// # Errors
    ///
    /// [`MeasureError::EmptyRegion`] if there are none, or the mask is no rectangle of that width.
    pub fn new(width: usize, mask: Vec<bool>) -> Result<Self, MeasureError> {
        if !mask.len().is_multiple_of(width) || mask.is_empty() || !mask.contains(&true) {
            return Err(MeasureError::EmptyRegion);
        }
        Ok(Self { width, mask })
    }

    /// All pixels of a picture.
    #[must_use]
    pub fn whole(view: &View) -> Self {
        Self { width: view.width, mask: vec![true; view.pixels()] }
    }

    /// A rectangle of a picture: left column, top row, width and height in pixels.
    ///
    /// # Errors
    ///
    /// If it is empty or reaches beyond the picture.
    pub fn rectangle(
        view: &View,
        [left, top, width, height]: [usize; 4],
    ) -> Result<Self, MeasureError> {
        let ends = left.checked_add(width).zip(top.checked_add(height));
        if !ends.is_some_and(|(right, bottom)| right <= view.width && bottom <= view.height) {
            return Err(MeasureError::OutsidePicture { width: view.width, height: view.height });
        }
        let holds = |i: usize| {
            let (column, row) = (i % view.width, i / view.width);
            (left..left + width).contains(&column) && (top..top + height).contains(&row)
        };
        Self::new(view.width, (0..view.pixels()).map(holds).collect())
    }

    /// The pixels of a mask image that are brighter than half of white.
    ///
    /// # Errors
    ///
    /// If there are none.
    pub fn bright(mask: &View) -> Result<Self, MeasureError> {
        let half = crate::photograph::decode(0.5);
        let [red, green, blue] = &mask.light;
        let holds = |i: usize| (red[i] + green[i] + blue[i]) / 3.0 > half;
        Self::new(mask.width, (0..mask.pixels()).map(holds).collect())
    }

    /// Width and height of the picture that it is a part of.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.mask.len() / self.width]
    }

    /// The pixels that belong to it, counted row by row.
    pub fn indices(&self) -> impl Iterator<Item = usize> + Clone {
        self.mask.iter().enumerate().filter(|(_, inside)| **inside).map(|(index, _)| index)
    }

    /// How many pixels belong to it.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.indices().count()
    }

    /// The mean over them of a number that each has.
    #[must_use]
    pub fn mean(&self, value: impl Fn(usize) -> f64) -> f64 {
        self.indices().map(value).sum::<f64>() / self.pixels() as f64
    }

    /// Their share of the picture.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.pixels() as f64 / self.mask.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view() -> View {
        let ramp: Vec<f64> = (0..12).map(|i| f64::from(i) / 11.0).collect();
        View::new(4, 3, [ramp.clone(), ramp.clone(), ramp]).expect("a view")
    }

    #[test]
    fn rectangles_lie_in_the_picture() {
        let region = PixelMask::rectangle(&view(), [1, 1, 2, 2]).expect("a region");
        assert_eq!(region.indices().collect::<Vec<_>>(), [5, 6, 9, 10]);
        assert_eq!((region.size(), region.pixels()), ([4, 3], 4));
        assert!(PixelMask::rectangle(&view(), [3, 0, 2, 1]).is_err());
        assert!(PixelMask::rectangle(&view(), [0, 0, 0, 1]).is_err());
        assert!(PixelMask::rectangle(&view(), [usize::MAX, 0, 2, 1]).is_err());
    }

    #[test]
    fn masks_are_what_is_bright() {
        let region = PixelMask::bright(&view()).expect("a region");
        // Half of white is 0.214 in linear light: from 3/11 on.
        assert_eq!(region.indices().next(), Some(3));
        assert!((region.share() - 0.75).abs() < 1e-15);
    }
}
