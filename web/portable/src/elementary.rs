//! The elementary functions of the C library, which all that is linked here calls, as `libm` has them.

/// Functions of these names that do what those of `libm` do.
macro_rules! of_libm {
    ($number:ty: $($name:ident($($argument:ident),+))*) => {$(
        #[unsafe(no_mangle)]
        extern "C" fn $name($($argument: $number),+) -> $number {
            libm::$name($($argument),+)
        }
    )*};
}

of_libm! { f64:
    sin(x) cos(x) tan(x) asin(x) acos(x) atan(x) atan2(y, x) sinh(x) cosh(x) tanh(x)
    exp(x) exp2(x) expm1(x) log(x) log2(x) log10(x) log1p(x) pow(x, y) cbrt(x) hypot(x, y)
}

of_libm! { f32:
    sinf(x) cosf(x) tanf(x) asinf(x) acosf(x) atanf(x) atan2f(y, x) sinhf(x) coshf(x) tanhf(x)
    expf(x) exp2f(x) expm1f(x) logf(x) log2f(x) log10f(x) log1pf(x) powf(x, y) cbrtf(x) hypotf(x, y)
}

/// What the compiler makes of a sine and a cosine of the same angle.
#[unsafe(no_mangle)]
extern "C" fn sincos(x: f64, sine: &mut f64, cosine: &mut f64) {
    (*sine, *cosine) = (libm::sin(x), libm::cos(x));
}

/// The same in single precision.
#[unsafe(no_mangle)]
extern "C" fn sincosf(x: f32, sine: &mut f32, cosine: &mut f32) {
    (*sine, *cosine) = (libm::sinf(x), libm::cosf(x));
}
