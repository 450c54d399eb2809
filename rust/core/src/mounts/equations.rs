//! Equations of motion at many frequencies, several at once.
//!
//! In coordinates of unit mass they are (K − ω²)x = f. Where K does not depend on frequency, a form of it is made
//! once: complex modes, of which a frequency takes six quotients, unless they are so near to merging that their
//! sum would lose digits; then the Schur form K = U T Uᴴ, of which it takes a back substitution. Where it does,
//! K = A + iωB of all mounts with hysteretic and viscous damping and of the others as they are at a frequency, each
//! takes a factorisation L D Lᵀ without pivots; where that would lose digits, or the matrix has no inverse, the
//! frequency is left to the factorisation with pivots of [`Powertrain::motion`].

#![allow(clippy::needless_range_loop, reason = "several arrays are indexed in step")]

use std::array::from_fn;

use nalgebra::{Matrix6, Schur};
use pulp::{Simd, WithSimd};

use super::{ComplexMatrix6, ComplexVector6, NaturalModes, Powertrain};
use crate::Complex64;
use crate::numbers::error::Result;
use crate::numbers::simd::{vector, vector_mut};

/// Frequencies at once.
pub(crate) const LANES: usize = 8;
/// A number at each of them.
pub(crate) type Lane = [f64; LANES];
/// Six complex numbers at each of them: real, imaginary parts.
pub(crate) type Lanes6 = [[Lane; 6]; 2];
/// Rows of a matrix.
pub(crate) type Rows = [[Complex64; 6]; 6];

/// A complex number at each frequency of a vector, of which some make a lane.
///
/// Vectors are written out: compilers make of loops over a lane what is two or three times as slow.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Numbers<S: Simd> {
    /// Real parts.
    pub re: S::f64s,
    /// Imaginary parts.
    pub im: S::f64s,
}

/// Square of the norm of the complex modes' vectors, which is 6 of those at right angles: what is solved by them loses
/// that many roundings.
const LARGEST_VECTORS: f64 = 12.0;
/// Rounds of rotations for complex modes, each of which about squares what is left; two or three suffice.
const MOST_ROTATIONS: usize = 12;
/// Difference of a Schur form's product from the matrix, over that, that rounding makes.
const RECOMPOSED: f64 = 1e-13;
/// Steps of its iteration; a dozen suffice.
const MOST_STEPS: usize = 500;
/// Growth of elements in a factorisation without pivots that costs three digits at most.
const LARGEST_GROWTH: f64 = 1e3;
/// Norm of K over the least ω² for which its rounding costs four digits at most.
const LARGEST_SPREAD: f64 = 1e4;
/// Distance from a resonance, over the norm of K and ω², within which the factorisation with pivots decides
/// whether there is an answer.
const RESONANCE: f64 = 1e-10;
/// Entries of a symmetric matrix.
const ENTRIES: usize = 21;

/// Equations of motion of a powertrain on mounts that stand on what does not move.
pub(crate) struct Equations {
    form: EquationForm,
    /// From a load about the CG to that of the form.
    pub to: ComplexMatrix6,
    /// From the form's solution to the motion.
    pub from: ComplexMatrix6,
}

enum EquationForm {
    /// Complex eigenvalues, and the norm of them.
    Modes([[f64; 2]; 6], f64),
    /// Upper triangle of the Schur form.
    Triangle(Box<Triangle>),
    /// Stiffness over frequency.
    Pencil(Box<Pencil>),
}

/// Upper triangle, real and imaginary parts, and the norm of it.
struct Triangle {
    entries: [[[f64; 2]; 6]; 6],
    size: f64,
}

/// A + iωB, and for each direction of the mounts that depend on frequency otherwise the entries of the stiffness
/// by it.
struct Pencil {
    constant: [[f64; ENTRIES]; 2],
    viscous: [f64; ENTRIES],
    varying: Vec<[f64; ENTRIES]>,
}

/// Row and column of an entry.
const fn places() -> [(usize, usize); ENTRIES] {
    let mut places = [(0, 0); ENTRIES];
    let (mut k, mut row) = (0, 0);
    while row < 6 {
        let mut column = 0;
        while column <= row {
            places[k] = (row, column);
            (k, column) = (k + 1, column + 1);
        }
        row += 1;
    }
    places
}

const PLACES: [(usize, usize); ENTRIES] = places();

/// Index of an entry of the lower triangle.
#[inline(always)]
const fn entry(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

/// Index of an entry below the diagonal.
#[inline(always)]
const fn below(row: usize, column: usize) -> usize {
    row * (row - 1) / 2 + column
}

impl Equations {
    /// Those of angular speeds of `least` and more, with the natural modes where the real stiffness is constant.
    pub fn new(
        powertrain: &Powertrain,
        least: f64,
        natural: Option<&NaturalModes>,
    ) -> Result<Self> {
        let unit = powertrain.unit_mass()?;
        let complex = unit.map(Complex64::from);
        let is_constant = !powertrain.springs().any(|spring| spring.dynamic().damping_varies());
        if is_constant && least > 0.0 {
            let stiffnesses = powertrain.stiffnesses(least, String::new)?;
            if let Some(natural) = natural {
                let matrix = natural.diagonalised(powertrain.deflections(), &stiffnesses);
                if is_near(matrix.norm(), least)
                    && let Some((values, vectors)) = complex_modes(&matrix)
                {
                    let form = EquationForm::Modes(
                        values.map(|value| [value.re, value.im]),
                        matrix.norm(),
                    );
                    let from = natural.shapes.map(Complex64::from) * vectors;
                    return Ok(Self { form, to: from.transpose(), from });
                }
            }
            let matrix = complex.transpose() * powertrain.assembled(&stiffnesses) * complex;
            if let Some((turn, triangle)) = schur(&matrix, least) {
                let part = |i: usize, j: usize| [triangle[(i, j)].re, triangle[(i, j)].im];
                let entries = from_fn(|i| from_fn(|j| part(i, j)));
                let form =
                    EquationForm::Triangle(Box::new(Triangle { entries, size: matrix.norm() }));
                return Ok(Self {
                    form,
                    to: turn.adjoint() * complex.transpose(),
                    from: complex * turn,
                });
            }
        }
        let form = EquationForm::Pencil(Box::new(Pencil::of(powertrain, &unit)));
        Ok(Self { form, to: complex.transpose(), from: complex })
    }

    /// Whether they are in Schur form.
    #[cfg(test)]
    pub fn is_triangular(&self) -> bool {
        matches!(self.form, EquationForm::Triangle(_))
    }

    /// Replaces a load in the form's coordinates by the solution at the angular speeds of a vector; false where that
    /// is left to the caller. `varying` are the stiffnesses, at the whole lane, of each direction of the mounts that
    /// depend on frequency otherwise than by viscous damping, real and imaginary parts; `at` is the vector's place.
    #[inline(always)]
    pub fn solve<S: Simd>(
        &self,
        simd: S,
        rates: S::f64s,
        (varying, at): (&[[Lane; 2]], usize),
        load: &mut [Numbers<S>; 6],
    ) -> S::m64s {
        match &self.form {
            EquationForm::Modes(values, size) => divided(simd, values, *size, rates, load),
            EquationForm::Triangle(triangle) => substituted(simd, triangle, rates, load),
            EquationForm::Pencil(pencil) => factored(simd, pencil, rates, (varying, at), load),
        }
    }

    /// Motions under loads about the CG at a lane of angular speeds, and where they are right. `turns` are the rows of
    /// `to` and `from`.
    pub fn motions(
        &self,
        turns: &[Rows; 2],
        rates: &Lane,
        varying: &[[Lane; 2]],
        loads: &Lanes6,
    ) -> ([bool; LANES], Lanes6) {
        pulp::Arch::new().dispatch(Motions { equations: self, turns, rates, varying, loads })
    }
}

struct Motions<'a> {
    equations: &'a Equations,
    turns: &'a [Rows; 2],
    rates: &'a Lane,
    varying: &'a [[Lane; 2]],
    loads: &'a Lanes6,
}

impl WithSimd for Motions<'_> {
    type Output = ([bool; LANES], Lanes6);

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let [to, from] = self.turns;
        let mut moved: Lanes6 = [[[0.0; LANES]; 6]; 2];
        let mut is_solved = [0.0; LANES];
        for at in 0..LANES / S::F64_LANES {
            let mut loads = [Numbers::zero(simd); 6];
            read(self.loads, at, &mut loads);
            let mut solution = [Numbers::zero(simd); 6];
            for k in 0..6 {
                solution[k] = product(simd, &to[k], &loads);
            }
            let rates = vector::<S>(self.rates, at);
            let mask = self.equations.solve(simd, rates, (self.varying, at), &mut solution);
            *vector_mut::<S>(&mut is_solved, at) = flags(simd, mask);
            let mut motion = [Numbers::zero(simd); 6];
            for k in 0..6 {
                motion[k] = product(simd, &from[k], &solution);
            }
            write(&motion, at, &mut moved);
        }
        (is_solved.map(|flag| flag > 0.0), moved)
    }
}

impl<S: Simd> Numbers<S> {
    /// Zeros.
    #[inline(always)]
    pub fn zero(simd: S) -> Self {
        Self { re: simd.splat_f64s(0.0), im: simd.splat_f64s(0.0) }
    }

    /// Squares of the magnitudes.
    #[inline(always)]
    pub fn squares(self, simd: S) -> S::f64s {
        simd.mul_add_f64s(self.re, self.re, simd.mul_f64s(self.im, self.im))
    }

    /// Sum with a product.
    #[inline(always)]
    pub fn plus(self, simd: S, a: Self, b: Self) -> Self {
        let re = simd.negate_mul_add_f64s(a.im, b.im, self.re);
        let im = simd.mul_add_f64s(a.im, b.re, self.im);
        Self { re: simd.mul_add_f64s(a.re, b.re, re), im: simd.mul_add_f64s(a.re, b.im, im) }
    }

    /// Difference from a product.
    #[inline(always)]
    fn minus(self, simd: S, a: Self, b: Self) -> Self {
        let re = simd.mul_add_f64s(a.im, b.im, self.re);
        let im = simd.negate_mul_add_f64s(a.im, b.re, self.im);
        Self {
            re: simd.negate_mul_add_f64s(a.re, b.re, re),
            im: simd.negate_mul_add_f64s(a.re, b.im, im),
        }
    }

    /// Sum with a product by real numbers.
    #[inline(always)]
    pub fn plus_real(self, simd: S, factor: S::f64s, of: Self) -> Self {
        Self {
            re: simd.mul_add_f64s(factor, of.re, self.re),
            im: simd.mul_add_f64s(factor, of.im, self.im),
        }
    }
}

/// Six numbers of a lane, at the place of a vector.
#[inline(always)]
pub(crate) fn read<S: Simd>(lanes: &Lanes6, at: usize, to: &mut [Numbers<S>; 6]) {
    for k in 0..6 {
        to[k] = Numbers { re: vector::<S>(&lanes[0][k], at), im: vector::<S>(&lanes[1][k], at) };
    }
}

/// The same, written.
#[inline(always)]
pub(crate) fn write<S: Simd>(numbers: &[Numbers<S>; 6], at: usize, to: &mut Lanes6) {
    for k in 0..6 {
        *vector_mut::<S>(&mut to[0][k], at) = numbers[k].re;
        *vector_mut::<S>(&mut to[1][k], at) = numbers[k].im;
    }
}

/// One where a mask is true, zero elsewhere.
#[inline(always)]
pub(crate) fn flags<S: Simd>(simd: S, mask: S::m64s) -> S::f64s {
    simd.select_f64s(mask, simd.splat_f64s(1.0), simd.splat_f64s(0.0))
}

impl Pencil {
    fn of(powertrain: &Powertrain, unit: &Matrix6<f64>) -> Self {
        let zero = [0.0; ENTRIES];
        let mut pencil = Self { constant: [zero; 2], viscous: zero, varying: Vec::new() };
        for (spring, deflection) in powertrain.springs().zip(powertrain.deflections()) {
            let turned = deflection * unit;
            let constant = spring.dynamic().constant();
            for axis in 0..3 {
                let entries = PLACES.map(|(i, j)| turned[(axis, i)] * turned[(axis, j)]);
                let Some((stiffness, damping)) = constant else {
                    pencil.varying.push(entries);
                    continue;
                };
                for (k, entry) in entries.into_iter().enumerate() {
                    pencil.constant[0][k] += stiffness[axis].re * entry;
                    pencil.constant[1][k] += stiffness[axis].im * entry;
                    pencil.viscous[k] += damping[axis] * entry;
                }
            }
        }
        pencil
    }
}

/// Whether the rounding of a stiffness of this norm does not count at an angular speed.
fn is_near(size: f64, least: f64) -> bool {
    size <= LARGEST_SPREAD * least * least
}

/// Eigenvalues of a complex symmetric matrix, and vectors X of which `XᵀX` is one, by Jacobi's rotations with complex
/// angles; none near to where values merge, and their vectors with them.
fn complex_modes(matrix: &ComplexMatrix6) -> Option<([Complex64; 6], ComplexMatrix6)> {
    let mut turned = *matrix;
    let mut vectors = ComplexMatrix6::identity();
    let negligible = f64::EPSILON * matrix.norm();
    for _ in 0..MOST_ROTATIONS {
        let mut is_done = true;
        for (q, p) in (0..6).flat_map(|q| (0..q).map(move |p| (q, p))) {
            let between = turned[(p, q)];
            if between.norm() <= negligible {
                continue;
            }
            is_done = false;
            let half = (turned[(q, q)] - turned[(p, p)]) / (between * 2.0);
            let root = (half * half + 1.0).sqrt();
            let [one, other] = [half + root, half - root];
            let tangent = (if one.norm() >= other.norm() { one } else { other }).inv();
            let cosine = (tangent * tangent + 1.0).sqrt().inv();
            let sine = cosine * tangent;
            for k in 0..6 {
                let [first, second] = [vectors[(k, p)], vectors[(k, q)]];
                vectors[(k, p)] = cosine * first - sine * second;
                vectors[(k, q)] = sine * first + cosine * second;
                if k != p && k != q {
                    let [first, second] = [turned[(k, p)], turned[(k, q)]];
                    turned[(k, p)] = cosine * first - sine * second;
                    turned[(k, q)] = sine * first + cosine * second;
                    (turned[(p, k)], turned[(q, k)]) = (turned[(k, p)], turned[(k, q)]);
                }
            }
            turned[(p, p)] -= tangent * between;
            turned[(q, q)] += tangent * between;
            (turned[(p, q)], turned[(q, p)]) = (Complex64::ZERO, Complex64::ZERO);
        }
        // NaN fails the comparison too.
        let is_sound = vectors.norm_squared() <= LARGEST_VECTORS;
        if is_done || !is_sound {
            return is_sound.then(|| (from_fn(|k| turned[(k, k)]), vectors));
        }
    }
    None
}

/// Unitary and triangular factor of a matrix, unless their rounding would count at an angular speed.
fn schur(matrix: &ComplexMatrix6, least: f64) -> Option<(ComplexMatrix6, ComplexMatrix6)> {
    let size = matrix.norm();
    if !is_near(size, least) {
        return None;
    }
    let scale = Complex64::from(size);
    let found = Schur::try_new(matrix / scale, f64::EPSILON, MOST_STEPS)?;
    let (turn, triangle) = found.unpack();
    let triangle = triangle.upper_triangle();
    let product = turn * triangle * turn.adjoint() * scale;
    let triangle = triangle * scale;
    ((product - matrix).norm() <= RECOMPOSED * size).then_some((turn, triangle))
}

// All below is inlined into what is compiled for the vectors of the machine.

#[inline(always)]
fn divided<S: Simd>(
    simd: S,
    values: &[[f64; 2]; 6],
    size: f64,
    rates: S::f64s,
    load: &mut [Numbers<S>; 6],
) -> S::m64s {
    let squares = simd.mul_f64s(rates, rates);
    let mut least = simd.splat_f64s(f64::INFINITY);
    let mut sum = simd.splat_f64s(0.0);
    for k in 0..6 {
        let (quotient, norm) = divide(simd, values[k], squares, load[k]);
        load[k] = quotient;
        least = simd.min_f64s(least, norm);
        sum = simd.add_f64s(sum, quotient.re);
    }
    are_solved(simd, size, squares, least, sum)
}

/// Quotient by a value less squares, and the square of the magnitude of that.
#[inline(always)]
fn divide<S: Simd>(
    simd: S,
    [re, im]: [f64; 2],
    squares: S::f64s,
    of: Numbers<S>,
) -> (Numbers<S>, S::f64s) {
    let rest = simd.sub_f64s(simd.splat_f64s(re), squares);
    let im = simd.splat_f64s(im);
    let norm = simd.mul_add_f64s(rest, rest, simd.mul_f64s(im, im));
    let inverse = simd.div_f64s(simd.splat_f64s(1.0), norm);
    let real = simd.mul_add_f64s(rest, of.re, simd.mul_f64s(im, of.im));
    let imaginary = simd.negate_mul_add_f64s(im, of.re, simd.mul_f64s(rest, of.im));
    let quotient =
        Numbers { re: simd.mul_f64s(real, inverse), im: simd.mul_f64s(imaginary, inverse) };
    (quotient, norm)
}

/// Whether speeds are far enough from resonances, and what overflows is not in a sum.
#[inline(always)]
fn are_solved<S: Simd>(
    simd: S,
    size: f64,
    squares: S::f64s,
    least: S::f64s,
    sum: S::f64s,
) -> S::m64s {
    let nearest =
        simd.mul_f64s(simd.splat_f64s(RESONANCE), simd.add_f64s(squares, simd.splat_f64s(size)));
    simd.and_m64s(
        simd.greater_than_f64s(least, simd.mul_f64s(nearest, nearest)),
        is_finite(simd, sum),
    )
}

#[inline(always)]
fn is_finite<S: Simd>(simd: S, of: S::f64s) -> S::m64s {
    simd.less_than_f64s(simd.abs_f64s(of), simd.splat_f64s(f64::INFINITY))
}

#[inline(always)]
fn substituted<S: Simd>(
    simd: S,
    triangle: &Triangle,
    rates: S::f64s,
    load: &mut [Numbers<S>; 6],
) -> S::m64s {
    let squares = simd.mul_f64s(rates, rates);
    let mut least = simd.splat_f64s(f64::INFINITY);
    for k in (0..6).rev() {
        let mut rest = load[k];
        for j in k + 1..6 {
            let [re, im] = triangle.entries[k][j].map(|part| simd.splat_f64s(part));
            rest = rest.minus(simd, Numbers { re, im }, load[j]);
        }
        let (quotient, norm) = divide(simd, triangle.entries[k][k], squares, rest);
        load[k] = quotient;
        least = simd.min_f64s(least, norm);
    }
    // What overflows on the way ends in the first row.
    are_solved(simd, triangle.size, squares, least, load[0].re)
}

/// Row by row, each entry assembled where it is needed.
#[inline(always)]
fn factored<S: Simd>(
    simd: S,
    pencil: &Pencil,
    rates: S::f64s,
    (varying, at): (&[[Lane; 2]], usize),
    load: &mut [Numbers<S>; 6],
) -> S::m64s {
    let none = simd.splat_f64s(0.0);
    let squares = simd.mul_f64s(rates, rates);
    let (mut size, mut least) = (none, simd.splat_f64s(f64::INFINITY));
    // Rows of L, and of L D; the inverse of D; squares of the largest entries of a column of L D, and inverse ones of D.
    let mut lower = [Numbers::zero(simd); ENTRIES - 6];
    let mut row = [Numbers::zero(simd); 6];
    let mut inverses = [Numbers::zero(simd); 6];
    let (mut largest, mut over) = ([none; 6], [none; 6]);
    for i in 0..6 {
        for j in 0..i {
            let mut value = assembled(simd, pencil, entry(i, j), rates, (varying, at));
            for k in 0..j {
                value = value.minus(simd, row[k], lower[below(j, k)]);
            }
            largest[j] = simd.max_f64s(largest[j], value.squares(simd));
            row[j] = value;
        }
        let mut pivot = assembled(simd, pencil, entry(i, i), rates, (varying, at));
        let magnitude = simd.add_f64s(simd.abs_f64s(pivot.re), simd.abs_f64s(pivot.im));
        size = simd.max_f64s(size, simd.add_f64s(magnitude, squares));
        pivot.re = simd.sub_f64s(pivot.re, squares);
        let mut solution = load[i];
        for k in 0..i {
            let factor = Numbers::zero(simd).plus(simd, row[k], inverses[k]);
            pivot = pivot.minus(simd, row[k], factor);
            solution = solution.minus(simd, load[k], factor);
            lower[below(i, k)] = factor;
        }
        load[i] = solution;
        let norm = pivot.squares(simd);
        least = simd.min_f64s(least, norm);
        over[i] = simd.div_f64s(simd.splat_f64s(1.0), norm);
        inverses[i] = Numbers {
            re: simd.mul_f64s(pivot.re, over[i]),
            im: simd.neg_f64s(simd.mul_f64s(pivot.im, over[i])),
        };
    }
    for k in (0..6).rev() {
        let mut solution = Numbers::zero(simd).plus(simd, load[k], inverses[k]);
        for i in k + 1..6 {
            solution = solution.minus(simd, load[i], lower[below(i, k)]);
        }
        load[k] = solution;
    }
    let mut worst = none;
    for k in 0..5 {
        worst = simd.max_f64s(worst, simd.mul_f64s(simd.mul_f64s(largest[k], largest[k]), over[k]));
    }
    let square = simd.mul_f64s(size, size);
    let grown = simd.mul_f64s(simd.splat_f64s(LARGEST_GROWTH * LARGEST_GROWTH), square);
    let nearest = simd.mul_f64s(simd.splat_f64s(RESONANCE * RESONANCE), square);
    // Not of numbers that are none, which end in the first row, nor at rest, where there is no damping.
    let is_apart =
        simd.and_m64s(simd.less_than_f64s(worst, grown), simd.greater_than_f64s(least, nearest));
    let is_number = simd.and_m64s(is_finite(simd, load[0].re), simd.greater_than_f64s(rates, none));
    simd.and_m64s(is_apart, is_number)
}

/// An entry of the stiffness.
#[inline(always)]
fn assembled<S: Simd>(
    simd: S,
    pencil: &Pencil,
    entry: usize,
    rates: S::f64s,
    (varying, at): (&[[Lane; 2]], usize),
) -> Numbers<S> {
    let [re, im] = pencil.constant;
    let viscous = simd.splat_f64s(pencil.viscous[entry]);
    let mut value = Numbers {
        re: simd.splat_f64s(re[entry]),
        im: simd.mul_add_f64s(viscous, rates, simd.splat_f64s(im[entry])),
    };
    for direction in 0..varying.len() {
        let factor = simd.splat_f64s(pencil.varying[direction][entry]);
        let [re, im] = &varying[direction];
        let along = Numbers { re: vector::<S>(re, at), im: vector::<S>(im, at) };
        value = value.plus_real(simd, factor, along);
    }
    value
}

/// Product of a complex matrix's row and six complex numbers at each frequency.
#[inline(always)]
pub(crate) fn product<S: Simd>(simd: S, row: &[Complex64; 6], of: &[Numbers<S>; 6]) -> Numbers<S> {
    let mut sum = Numbers::zero(simd);
    for k in 0..6 {
        let factor = Numbers { re: simd.splat_f64s(row[k].re), im: simd.splat_f64s(row[k].im) };
        sum = sum.plus(simd, factor, of[k]);
    }
    sum
}

/// The same of a row with viscous damping.
#[inline(always)]
pub(crate) fn damped_product<S: Simd>(
    simd: S,
    row: &[Complex64; 6],
    viscous: &[f64; 6],
    rates: S::f64s,
    of: &[Numbers<S>; 6],
) -> Numbers<S> {
    let mut sum = Numbers::zero(simd);
    for k in 0..6 {
        let damping = simd.splat_f64s(row[k].im);
        let factor = Numbers {
            re: simd.splat_f64s(row[k].re),
            im: simd.mul_add_f64s(simd.splat_f64s(viscous[k]), rates, damping),
        };
        sum = sum.plus(simd, factor, of[k]);
    }
    sum
}

/// The same of a real row.
#[inline(always)]
pub(crate) fn real_product<S: Simd>(simd: S, row: &[f64; 6], of: &[Numbers<S>; 6]) -> Numbers<S> {
    let mut sum = Numbers::zero(simd);
    for k in 0..6 {
        sum = sum.plus_real(simd, simd.splat_f64s(row[k]), of[k]);
    }
    sum
}

/// Rows of a matrix.
pub(crate) fn rows(matrix: &ComplexMatrix6) -> Rows {
    from_fn(|row| from_fn(|column| matrix[(row, column)]))
}

/// Vectors as numbers at each frequency; the last one again where there are fewer.
pub(crate) fn lanes(vectors: &[ComplexVector6]) -> Lanes6 {
    let at = |l: usize| &vectors[l.min(vectors.len() - 1)];
    [from_fn(|k| from_fn(|l| at(l)[k].re)), from_fn(|k| from_fn(|l| at(l)[k].im))]
}
