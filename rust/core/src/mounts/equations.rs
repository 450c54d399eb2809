//! Equations of motion at many frequencies, several at once.
//!
//! In coordinates of unit mass they are (K − ω²)x = f. Where K does not depend on frequency, a form of it is made
//! once: complex modes, of which a frequency takes six quotients, unless they are so near to merging that their
//! sum would lose digits; then the Schur form K = U T Uᴴ, of which it takes a back substitution. Where it does, K = A + iωB of all mounts with hysteretic and viscous
//! damping and of the others as they are at a frequency, each takes a factorisation L D Lᵀ without pivots; where
//! that would lose digits, or the matrix has no inverse, the frequency is left to the factorisation with pivots
//! of [`Powertrain::motion`].

#![allow(clippy::needless_range_loop, reason = "lanes of several arrays are indexed in step")]

use std::array::from_fn;

use nalgebra::{Matrix6, Schur};

use super::{ComplexMatrix6, ComplexVector6, NaturalModes, Powertrain};
use crate::Complex64;
use crate::numbers::error::Result;

/// Frequencies at once.
pub(crate) const LANES: usize = 8;
/// A number at each of them.
pub(crate) type Lane = [f64; LANES];
/// Six complex numbers at each of them: real, imaginary parts.
pub(crate) type Lanes6 = [[Lane; 6]; 2];

/// Square of the norm of the complex modes' vectors, which is 6 of those at right angles: what is solved by them loses
/// that many roundings.
const LARGEST_VECTORS: f64 = 12.0;
/// Rounds of rotations for complex modes, each of which about squares what is left; two or three suffice.
const MOST_ROUNDS: usize = 12;
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
    form: Form,
    /// From a load about the CG to that of the form.
    pub to: ComplexMatrix6,
    /// From the form's solution to the motion.
    pub from: ComplexMatrix6,
}

enum Form {
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
        let is_constant = !powertrain.mounts().iter().any(|mount| mount.dynamic().damping_varies());
        if is_constant && least > 0.0 {
            let stiffnesses = powertrain.stiffnesses(least, String::new)?;
            if let Some(natural) = natural {
                let matrix = natural.diagonalised(powertrain, &stiffnesses);
                if is_near(matrix.norm(), least)
                    && let Some((values, vectors)) = complex_modes(&matrix)
                {
                    let form = Form::Modes(values.map(|value| [value.re, value.im]), matrix.norm());
                    let from = natural.shapes.map(Complex64::from) * vectors;
                    return Ok(Self { form, to: from.transpose(), from });
                }
            }
            let matrix = complex.transpose() * powertrain.assembled(&stiffnesses) * complex;
            if let Some((turn, triangle)) = schur(&matrix, least) {
                let part = |i: usize, j: usize| [triangle[(i, j)].re, triangle[(i, j)].im];
                let entries = from_fn(|i| from_fn(|j| part(i, j)));
                let form = Form::Triangle(Box::new(Triangle { entries, size: matrix.norm() }));
                return Ok(Self {
                    form,
                    to: turn.adjoint() * complex.transpose(),
                    from: complex * turn,
                });
            }
        }
        let form = Form::Pencil(Box::new(Pencil::of(powertrain, &unit)));
        Ok(Self { form, to: complex.transpose(), from: complex })
    }

    /// Whether they are in Schur form.
    #[cfg(test)]
    pub fn is_triangular(&self) -> bool {
        matches!(self.form, Form::Triangle(_))
    }

    /// Replaces a load in the form's coordinates by the solution at angular speeds; false where that is left to
    /// the caller. `varying` are the stiffnesses at them of each direction of the mounts that depend on frequency
    /// otherwise than by viscous damping, real and imaginary parts.
    #[inline(always)]
    pub fn solve(&self, rates: &Lane, varying: &[[Lane; 2]], load: &mut Lanes6) -> [bool; LANES] {
        match &self.form {
            Form::Modes(values, size) => divided(values, *size, rates, load),
            Form::Triangle(triangle) => substituted(triangle, rates, load),
            Form::Pencil(pencil) => factored(pencil, rates, varying, load),
        }
    }
}

impl Pencil {
    fn of(powertrain: &Powertrain, unit: &Matrix6<f64>) -> Self {
        let zero = [0.0; ENTRIES];
        let mut pencil = Self { constant: [zero; 2], viscous: zero, varying: Vec::new() };
        for (mount, deflection) in powertrain.mounts().iter().zip(powertrain.deflections()) {
            let turned = deflection * unit;
            let constant = mount.dynamic().constant();
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

/// Eigenvalues of a complex symmetric matrix, and vectors X with XᵀX = 1, by Jacobi's rotations with complex angles; none
/// near to where values merge, and their vectors with them.
fn complex_modes(matrix: &ComplexMatrix6) -> Option<([Complex64; 6], ComplexMatrix6)> {
    let mut turned = *matrix;
    let mut vectors = ComplexMatrix6::identity();
    let negligible = f64::EPSILON * matrix.norm();
    for _ in 0..MOST_ROUNDS {
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
        // Not of numbers that are none, either.
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

// No closure below but what is called once: one that is not inlined would be compiled for the baseline, where
// a fused product is a call.

/// Subtracts a product.
#[inline(always)]
fn subtract(from: &mut [Lane; 2], a: &[Lane; 2], b: &[Lane; 2]) {
    for l in 0..LANES {
        from[0][l] = (-a[0][l]).mul_add(b[0][l], a[1][l].mul_add(b[1][l], from[0][l]));
        from[1][l] = (-a[0][l]).mul_add(b[1][l], (-a[1][l]).mul_add(b[0][l], from[1][l]));
    }
}

#[inline(always)]
fn times(a: &[Lane; 2], b: &[Lane; 2]) -> [Lane; 2] {
    let mut product = [[0.0; LANES]; 2];
    for l in 0..LANES {
        product[0][l] = a[0][l].mul_add(b[0][l], -(a[1][l] * b[1][l]));
        product[1][l] = a[0][l].mul_add(b[1][l], a[1][l] * b[0][l]);
    }
    product
}

/// The larger of two at each frequency, the second where the first is no number.
#[inline(always)]
fn larger(a: &Lane, b: &Lane) -> Lane {
    let mut most = *b;
    for l in 0..LANES {
        most[l] = if a[l] > b[l] { a[l] } else { b[l] };
    }
    most
}

#[inline(always)]
fn divided(values: &[[f64; 2]; 6], size: f64, rates: &Lane, load: &mut Lanes6) -> [bool; LANES] {
    let mut least = [f64::INFINITY; LANES];
    let mut sum = [0.0; LANES];
    let [re, im] = load;
    for k in 0..6 {
        let [d_re, d_im] = values[k];
        for l in 0..LANES {
            let rest = d_re - rates[l] * rates[l];
            let norm = rest.mul_add(rest, d_im * d_im);
            let inverse = 1.0 / norm;
            let [real, imaginary] = [re[k][l], im[k][l]];
            re[k][l] = rest.mul_add(real, d_im * imaginary) * inverse;
            im[k][l] = rest.mul_add(imaginary, -(d_im * real)) * inverse;
            least[l] = if norm < least[l] { norm } else { least[l] };
            sum[l] += re[k][l];
        }
    }
    are_solved(size, rates, &least, &sum)
}

/// Whether speeds are far enough from resonances, and what overflows is not in a sum.
#[inline(always)]
fn are_solved(size: f64, rates: &Lane, least: &Lane, sum: &Lane) -> [bool; LANES] {
    let mut is_solved = [false; LANES];
    for l in 0..LANES {
        let nearest = RESONANCE * rates[l].mul_add(rates[l], size);
        is_solved[l] = least[l] > nearest * nearest && sum[l].is_finite();
    }
    is_solved
}

#[inline(always)]
fn substituted(triangle: &Triangle, rates: &Lane, load: &mut Lanes6) -> [bool; LANES] {
    let mut least = [f64::INFINITY; LANES];
    let [re, im] = load;
    for k in (0..6).rev() {
        let (mut real, mut imaginary) = (re[k], im[k]);
        for j in k + 1..6 {
            let [t_re, t_im] = triangle.entries[k][j];
            for l in 0..LANES {
                real[l] = (-t_re).mul_add(re[j][l], t_im.mul_add(im[j][l], real[l]));
                imaginary[l] = (-t_re).mul_add(im[j][l], (-t_im).mul_add(re[j][l], imaginary[l]));
            }
        }
        let [d_re, d_im] = triangle.entries[k][k];
        for l in 0..LANES {
            let rest = d_re - rates[l] * rates[l];
            let norm = rest.mul_add(rest, d_im * d_im);
            let inverse = 1.0 / norm;
            re[k][l] = rest.mul_add(real[l], d_im * imaginary[l]) * inverse;
            im[k][l] = rest.mul_add(imaginary[l], -(d_im * real[l])) * inverse;
            least[l] = if norm < least[l] { norm } else { least[l] };
        }
    }
    // What overflows on the way ends in the first row.
    are_solved(triangle.size, rates, &least, &re[0])
}

/// Row by row, each entry assembled where it is needed.
#[inline(always)]
fn factored(
    pencil: &Pencil,
    rates: &Lane,
    varying: &[[Lane; 2]],
    load: &mut Lanes6,
) -> [bool; LANES] {
    let zero = [0.0; LANES];
    let (mut size, mut least) = (zero, [f64::INFINITY; LANES]);
    // Rows of L, and of L D; the inverse of D; squares of the largest entries of a column of L D, and inverse ones of D.
    let mut lower = [[zero; 2]; ENTRIES - 6];
    let mut row = [[zero; 2]; 6];
    let mut inverses = [[zero; 2]; 6];
    let (mut largest, mut over) = ([zero; 6], [zero; 6]);
    let [x_re, x_im] = load;
    for i in 0..6 {
        for j in 0..i {
            let mut value = assembled(pencil, entry(i, j), rates, varying);
            for k in 0..j {
                subtract(&mut value, &row[k], &lower[below(j, k)]);
            }
            let mut square = zero;
            for l in 0..LANES {
                square[l] = value[0][l].mul_add(value[0][l], value[1][l] * value[1][l]);
            }
            largest[j] = larger(&square, &largest[j]);
            row[j] = value;
        }
        let mut pivot = assembled(pencil, entry(i, i), rates, varying);
        let mut of_row = zero;
        for l in 0..LANES {
            let square = rates[l] * rates[l];
            of_row[l] = pivot[0][l].abs() + pivot[1][l].abs() + square;
            pivot[0][l] -= square;
        }
        size = larger(&of_row, &size);
        let mut solution = [x_re[i], x_im[i]];
        for k in 0..i {
            let factor = times(&row[k], &inverses[k]);
            subtract(&mut pivot, &row[k], &factor);
            subtract(&mut solution, &[x_re[k], x_im[k]], &factor);
            lower[below(i, k)] = factor;
        }
        [x_re[i], x_im[i]] = solution;
        for l in 0..LANES {
            let norm = pivot[0][l].mul_add(pivot[0][l], pivot[1][l] * pivot[1][l]);
            over[i][l] = 1.0 / norm;
            least[l] = if norm < least[l] { norm } else { least[l] };
            inverses[i][0][l] = pivot[0][l] * over[i][l];
            inverses[i][1][l] = -pivot[1][l] * over[i][l];
        }
    }
    for k in (0..6).rev() {
        let mut solution = times(&[x_re[k], x_im[k]], &inverses[k]);
        for i in k + 1..6 {
            subtract(&mut solution, &[x_re[i], x_im[i]], &lower[below(i, k)]);
        }
        [x_re[k], x_im[k]] = solution;
    }
    let mut worst = zero;
    for k in 0..5 {
        for l in 0..LANES {
            let growth = largest[k][l] * largest[k][l] * over[k][l];
            worst[l] = if growth > worst[l] { growth } else { worst[l] };
        }
    }
    let mut is_solved = [false; LANES];
    for l in 0..LANES {
        let square = size[l] * size[l];
        // Not of numbers that are none, which end in the first row, nor at rest, where there is no damping.
        is_solved[l] = worst[l] <= LARGEST_GROWTH * LARGEST_GROWTH * square
            && least[l] > RESONANCE * RESONANCE * square
            && x_re[0][l].is_finite()
            && rates[l] > 0.0;
    }
    is_solved
}

/// An entry of the stiffness.
#[inline(always)]
fn assembled(pencil: &Pencil, entry: usize, rates: &Lane, varying: &[[Lane; 2]]) -> [Lane; 2] {
    let mut value = [[pencil.constant[0][entry]; LANES], [pencil.constant[1][entry]; LANES]];
    let viscous = pencil.viscous[entry];
    for l in 0..LANES {
        value[1][l] = viscous.mul_add(rates[l], value[1][l]);
    }
    for (of_direction, [re, im]) in pencil.varying.iter().zip(varying) {
        let factor = of_direction[entry];
        for l in 0..LANES {
            value[0][l] = factor.mul_add(re[l], value[0][l]);
            value[1][l] = factor.mul_add(im[l], value[1][l]);
        }
    }
    value
}

/// Products of a complex matrix's rows and six complex numbers at each frequency.
#[inline(always)]
pub(crate) fn product(row: &[Complex64; 6], of: &Lanes6) -> [Lane; 2] {
    let mut sum = [[0.0; LANES]; 2];
    for k in 0..6 {
        let factor = row[k];
        for l in 0..LANES {
            let (re, im) = (of[0][k][l], of[1][k][l]);
            sum[0][l] = factor.re.mul_add(re, (-factor.im).mul_add(im, sum[0][l]));
            sum[1][l] = factor.re.mul_add(im, factor.im.mul_add(re, sum[1][l]));
        }
    }
    sum
}

/// The same of a row with viscous damping.
#[inline(always)]
pub(crate) fn damped_product(
    row: &[Complex64; 6],
    viscous: &[f64; 6],
    rates: &Lane,
    of: &Lanes6,
) -> [Lane; 2] {
    let mut sum = [[0.0; LANES]; 2];
    for k in 0..6 {
        for l in 0..LANES {
            let (re, im) = (of[0][k][l], of[1][k][l]);
            let imaginary = viscous[k].mul_add(rates[l], row[k].im);
            sum[0][l] = row[k].re.mul_add(re, (-imaginary).mul_add(im, sum[0][l]));
            sum[1][l] = row[k].re.mul_add(im, imaginary.mul_add(re, sum[1][l]));
        }
    }
    sum
}

/// The same of a real row.
#[inline(always)]
pub(crate) fn real_product(row: &[f64; 6], of: &Lanes6) -> [Lane; 2] {
    let mut sum = [[0.0; LANES]; 2];
    for k in 0..6 {
        for l in 0..LANES {
            sum[0][l] = row[k].mul_add(of[0][k][l], sum[0][l]);
            sum[1][l] = row[k].mul_add(of[1][k][l], sum[1][l]);
        }
    }
    sum
}

/// Rows of a matrix.
pub(crate) fn rows(matrix: &ComplexMatrix6) -> [[Complex64; 6]; 6] {
    from_fn(|row| from_fn(|column| matrix[(row, column)]))
}

/// Vectors as numbers at each frequency; the last one again where there are fewer.
pub(crate) fn lanes(vectors: &[ComplexVector6]) -> Lanes6 {
    let at = |l: usize| &vectors[l.min(vectors.len() - 1)];
    [from_fn(|k| from_fn(|l| at(l)[k].re)), from_fn(|k| from_fn(|l| at(l)[k].im))]
}
