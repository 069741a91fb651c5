//! Four rays at once: numbers that hold one value for each, and the widest instructions that the
//! processor has for them, chosen at run time.
//!
//! Results are the same to the last bit whichever rays go side by side. Where the processor
//! multiplies and adds at once, the sum alone is rounded; the portable fallback rounds the product,
//! too.

use std::any::TypeId;
use std::array;
use std::ops::{Add, Mul, Neg, Sub};

use num_complex::Complex64;
use pulp::{Simd, WithSimd, bytemuck};

/// How many rays go side by side.
pub(crate) const LANES: usize = 4;

/// Does `work` with instructions for four numbers, or gives it back where the processor has none.
/// All that it calls must be inlined into it.
#[inline]
pub(crate) fn side_by_side<W: WithSimd>(work: W) -> Result<W::Output, W> {
    #[cfg(all(target_arch = "x86_64", not(feature = "portable")))]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return Ok(Simd::vectorize(simd, work));
    }
    Err(work)
}

/// Does `work` with the instructions of any processor, in ten times the code.
#[cfg(test)]
pub(crate) fn portably<W: WithSimd>(work: W) -> W::Output {
    work.with_simd(pulp::Scalar256b)
}

/// Whether a product is rounded before it is added to something: in portable code, where processors that do both at
/// once would be imitated, in fifty times the time.
#[inline(always)]
fn rounds_products<S: Simd>() -> bool {
    TypeId::of::<S>() == TypeId::of::<pulp::Scalar256b>()
}

/// A number for each ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lanes<S: Simd> {
    simd: S,
    values: S::f64s,
}

impl<S: Simd> Lanes<S> {
    #[inline(always)]
    pub fn new(simd: S, values: [f64; LANES]) -> Self {
        Self { simd, values: bytemuck::cast(values) }
    }

    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        Self { simd, values: simd.splat_f64s(value) }
    }

    /// The same number for each ray.
    #[inline(always)]
    pub fn all(self, value: f64) -> Self {
        Self::splat(self.simd, value)
    }

    /// Other numbers of the same kind.
    #[inline(always)]
    pub fn with(self, values: [f64; LANES]) -> Self {
        Self::new(self.simd, values)
    }

    #[inline(always)]
    pub fn values(self) -> [f64; LANES] {
        bytemuck::cast(self.values)
    }

    /// Does `work` with the same instructions, in a function by itself: for what is done in many places of a large one.
    #[inline(always)]
    pub fn apart<W: WithSimd>(self, work: W) -> W::Output {
        self.simd.vectorize(work)
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self { values: self.simd.sqrt_f64s(self.values), ..self }
    }

    #[inline(always)]
    pub fn abs(self) -> Self {
        Self { values: self.simd.abs_f64s(self.values), ..self }
    }

    /// 1 with the sign of each.
    #[inline(always)]
    pub fn signs(self) -> Self {
        let sign = self.simd.and_f64s(self.values, self.simd.splat_f64s(-0.0));
        Self { values: self.simd.or_f64s(sign, self.simd.splat_f64s(1.0)), ..self }
    }

    #[inline(always)]
    pub fn divided_by(self, other: Self) -> Self {
        Self { values: self.simd.div_f64s(self.values, other.values), ..self }
    }

    /// This plus a product.
    #[inline(always)]
    pub fn plus(self, a: Self, b: Self) -> Self {
        if rounds_products::<S>() {
            return self + a * b;
        }
        Self { values: self.simd.mul_add_e_f64s(a.values, b.values, self.values), ..self }
    }

    /// This less a product.
    #[inline(always)]
    pub fn minus(self, a: Self, b: Self) -> Self {
        if rounds_products::<S>() {
            return self - a * b;
        }
        Self { values: self.simd.negate_mul_add_e_f64s(a.values, b.values, self.values), ..self }
    }

    /// Where it is less than another number; not where one is not a number.
    #[inline(always)]
    pub fn less_than(self, other: Self) -> Mask<S> {
        Mask { simd: self.simd, holds: self.simd.less_than_f64s(self.values, other.values) }
    }
}

/// Where something holds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mask<S: Simd> {
    simd: S,
    holds: S::m64s,
}

impl<S: Simd> Mask<S> {
    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        Self { holds: self.simd.and_m64s(self.holds, other.holds), ..self }
    }

    #[inline(always)]
    pub fn or(self, other: Self) -> Self {
        Self { holds: self.simd.or_m64s(self.holds, other.holds), ..self }
    }

    /// One number where it holds, the other elsewhere.
    #[inline(always)]
    pub fn choose(self, yes: Lanes<S>, no: Lanes<S>) -> Lanes<S> {
        Lanes { values: self.simd.select_f64s(self.holds, yes.values, no.values), ..yes }
    }
}

/// Complex numbers of four rays, in memory.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Complexes {
    pub re: [f64; LANES],
    pub im: [f64; LANES],
}

impl Complexes {
    #[inline(always)]
    pub fn at(&self, i: usize) -> Complex64 {
        Complex64::new(self.re[i], self.im[i])
    }

    #[inline(always)]
    pub fn put(&mut self, i: usize, value: Complex64) {
        (self.re[i], self.im[i]) = (value.re, value.im);
    }

    #[inline(always)]
    pub fn load<S: Simd>(&self, simd: S) -> ComplexLanes<S> {
        ComplexLanes { re: Lanes::new(simd, self.re), im: Lanes::new(simd, self.im) }
    }

    #[inline(always)]
    pub fn of<S: Simd>(lanes: ComplexLanes<S>) -> Self {
        Self { re: lanes.re.values(), im: lanes.im.values() }
    }
}

/// An operator on the numbers of two `Lanes`, by the instruction for it.
macro_rules! operator {
    ($operator:ident, $method:ident, $instruction:ident) => {
        impl<S: Simd> $operator for Lanes<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self { values: self.simd.$instruction(self.values, other.values), ..self }
            }
        }
    };
}

operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);

impl<S: Simd> Mul<f64> for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self * self.all(factor)
    }
}

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { values: self.simd.neg_f64s(self.values), ..self }
    }
}

/// A complex number for each ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ComplexLanes<S: Simd> {
    pub re: Lanes<S>,
    pub im: Lanes<S>,
}

impl<S: Simd> ComplexLanes<S> {
    #[inline(always)]
    pub fn new(simd: S, [a, b, c, d]: [Complex64; LANES]) -> Self {
        let (re, im) = ([a.re, b.re, c.re, d.re], [a.im, b.im, c.im, d.im]);
        Self { re: Lanes::new(simd, re), im: Lanes::new(simd, im) }
    }

    /// Other numbers of the same kind.
    #[inline(always)]
    pub fn with(self, values: [Complex64; LANES]) -> Self {
        Self::new(self.re.simd, values)
    }

    /// The same real number for each ray.
    #[inline(always)]
    pub fn real(self, value: f64) -> Self {
        Self { re: self.re.all(value), im: self.re.all(0.0) }
    }

    #[inline(always)]
    pub fn values(self) -> [Complex64; LANES] {
        let ([a, b, c, d], [e, f, g, h]) = (self.re.values(), self.im.values());
        [Complex64::new(a, e), Complex64::new(b, f), Complex64::new(c, g), Complex64::new(d, h)]
    }

    /// With `value` of the arguments for which `holds` is false.
    #[cold]
    #[inline(never)]
    pub fn elsewhere(
        self,
        arguments: [Complex64; LANES],
        holds: fn(Complex64) -> bool,
        value: fn(Complex64) -> Complex64,
    ) -> Self {
        let here = self.values();
        let place = |i: usize| if holds(arguments[i]) { here[i] } else { value(arguments[i]) };
        self.with(array::from_fn(place))
    }

    #[inline(always)]
    pub fn conj(self) -> Self {
        Self { im: -self.im, ..self }
    }

    #[inline(always)]
    pub fn norm_squared(self) -> Lanes<S> {
        (self.re * self.re).plus(self.im, self.im)
    }

    /// This plus a product.
    #[inline(always)]
    pub fn plus(self, a: Self, b: Self) -> Self {
        Self {
            re: self.re.plus(a.re, b.re).minus(a.im, b.im),
            im: self.im.plus(a.re, b.im).plus(a.im, b.re),
        }
    }

    /// This plus a product with real numbers.
    #[inline(always)]
    pub fn plus_real(self, a: Self, factor: Lanes<S>) -> Self {
        Self { re: self.re.plus(a.re, factor), im: self.im.plus(a.im, factor) }
    }

    /// i times this.
    #[inline(always)]
    pub fn times_i(self) -> Self {
        Self { re: -self.im, im: self.re }
    }
}

impl<S: Simd> Add for ComplexLanes<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }
}

impl<S: Simd> Sub for ComplexLanes<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { re: self.re - other.re, im: self.im - other.im }
    }
}

impl<S: Simd> Mul for ComplexLanes<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self {
            re: (self.re * other.re).minus(self.im, other.im),
            im: (self.re * other.im).plus(self.im, other.re),
        }
    }
}

impl<S: Simd> Neg for ComplexLanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { re: -self.re, im: -self.im }
    }
}

impl<S: Simd> Mul<Lanes<S>> for ComplexLanes<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: Lanes<S>) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }
}

impl<S: Simd> Mul<f64> for ComplexLanes<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self * self.re.all(factor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Product([Complex64; LANES], [Complex64; LANES]);

    impl WithSimd for Product {
        type Output = ([Complex64; LANES], [f64; LANES]);

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let [a, b] = [self.0, self.1].map(|values| ComplexLanes::new(simd, values));
            let ratio = (a.re.abs().sqrt() * 3.0).divided_by(-b.im);
            ((a.conj() * b - a * b.re + b.times_i()).values(), ratio.values())
        }
    }

    #[test]
    fn lanes_are_what_they_would_be_alone() {
        let numbers = |seed: f64| {
            array::from_fn(|i| {
                let x = (i as f64 + 1.3) * seed;
                Complex64::new(x.sin() * 1e3, (x * 1.7).cos())
            })
        };
        let (a, b): ([Complex64; LANES], [Complex64; LANES]) = (numbers(0.7), numbers(1.9));
        let wide = side_by_side(Product(a, b)).unwrap_or_else(portably);
        let portable = portably(Product(a, b));
        for i in 0..LANES {
            assert!((wide.0[i] - portable.0[i]).norm() < 1e-12);
            assert_eq!(wide.1[i], portable.1[i]);
            let same = side_by_side(Product([a[i]; LANES], [b[i]; LANES])).unwrap_or_else(portably);
            assert_eq!((wide.0[i], wide.1[i]), (same.0[3], same.1[3]));
            let alone = a[i].conj() * b[i] - a[i] * b[i].re + Complex64::i() * b[i];
            assert!((wide.0[i] - alone).norm() < 1e-12);
            assert_eq!(wide.1[i], a[i].re.abs().sqrt() * 3.0 / -b[i].im);
        }
    }
}
