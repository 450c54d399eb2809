//! Equations of motion at many frequencies, several at once.
//!
//! In coordinates of unit mass they are (K − ω²)x = f. Where K does not depend on frequency, its Schur form
//! K = U T Uᴴ is made once: a frequency then takes a back substitution, and unlike a sum over complex modes it
//! loses no digit where two of them merge. Where it does, K = A + iωB of all mounts with hysteretic and viscous
//! damping and of the others as they are at a frequency, each takes a factorisation L D Lᵀ without pivots; where
//! that would lose digits, or the matrix has no inverse, the frequency is left to the factorisation with pivots
//! of [`Powertrain::motion`].

#![allow(clippy::needless_range_loop, reason = "lanes of several arrays are indexed in step")]

use std::array::from_fn;

use nalgebra::{Matrix6, Schur};

use super::{ComplexMatrix6, ComplexVector6, Powertrain};
use crate::Complex64;
use crate::numbers::error::Result;

/// Frequencies at once.
pub(crate) const LANES: usize = 8;
/// A number at each of them.
pub(crate) type Lane = [f64; LANES];
/// Six complex numbers at each of them: real, imaginary parts.
pub(crate) type Lanes6 = [[Lane; 6]; 2];

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
const fn entry(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

impl Equations {
    /// Those of angular speeds of `least` and more.
    pub fn new(powertrain: &Powertrain, least: f64) -> Result<Self> {
        let unit = powertrain.unit_mass()?;
        let complex = unit.map(Complex64::from);
        let is_constant = !powertrain.mounts().iter().any(|mount| mount.dynamic().damping_varies());
        if is_constant && least > 0.0 {
            let stiffnesses = powertrain.stiffnesses(least, String::new)?;
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

    /// Whether the stiffness at each frequency counts.
    #[cfg(test)]
    pub fn is_factored(&self) -> bool {
        matches!(self.form, Form::Pencil(_))
    }

    /// Replaces a load in the form's coordinates by the solution at angular speeds; false where that is left to
    /// the caller. `varying` are the stiffnesses at them of each direction of the mounts that depend on frequency
    /// otherwise than by viscous damping, real and imaginary parts.
    #[inline(always)]
    pub fn solve(&self, rates: &Lane, varying: &[[Lane; 2]], load: &mut Lanes6) -> [bool; LANES] {
        match &self.form {
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

/// Unitary and triangular factor of a matrix, unless their rounding would count at an angular speed.
fn schur(matrix: &ComplexMatrix6, least: f64) -> Option<(ComplexMatrix6, ComplexMatrix6)> {
    let size = matrix.norm();
    if size.is_nan() || size > LARGEST_SPREAD * least * least {
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

#[inline(always)]
fn substituted(triangle: &Triangle, rates: &Lane, load: &mut Lanes6) -> [bool; LANES] {
    let mut squares = [0.0; LANES];
    for l in 0..LANES {
        squares[l] = rates[l] * rates[l];
    }
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
            let rest = d_re - squares[l];
            let norm = rest.mul_add(rest, d_im * d_im);
            let inverse = 1.0 / norm;
            re[k][l] = rest.mul_add(real[l], d_im * imaginary[l]) * inverse;
            im[k][l] = rest.mul_add(imaginary[l], -(d_im * real[l])) * inverse;
            least[l] = if norm < least[l] { norm } else { least[l] };
        }
    }
    let mut is_solved = [false; LANES];
    for l in 0..LANES {
        let nearest = RESONANCE * (triangle.size + squares[l]);
        // What overflows on the way ends in the first row.
        is_solved[l] = least[l] > nearest * nearest && re[0][l].is_finite();
    }
    is_solved
}

#[inline(always)]
fn factored(
    pencil: &Pencil,
    rates: &Lane,
    varying: &[[Lane; 2]],
    load: &mut Lanes6,
) -> [bool; LANES] {
    let zero = [0.0; LANES];
    let mut matrix = [[zero; 2]; ENTRIES];
    for k in 0..ENTRIES {
        let [re, im, viscous] = [pencil.constant[0][k], pencil.constant[1][k], pencil.viscous[k]];
        for l in 0..LANES {
            matrix[k][0][l] = re;
            matrix[k][1][l] = viscous.mul_add(rates[l], im);
        }
    }
    for (of_direction, [re, im]) in pencil.varying.iter().zip(varying) {
        for (entry, &factor) in matrix.iter_mut().zip(of_direction) {
            for l in 0..LANES {
                entry[0][l] = factor.mul_add(re[l], entry[0][l]);
                entry[1][l] = factor.mul_add(im[l], entry[1][l]);
            }
        }
    }
    let mut size = zero;
    for k in 0..6 {
        let [re, im] = &mut matrix[entry(k, k)];
        for l in 0..LANES {
            let square = rates[l] * rates[l];
            size[l] = size[l].max(re[l].abs() + im[l].abs() + square);
            re[l] -= square;
        }
    }
    let (mut worst, mut least) = (zero, [f64::INFINITY; LANES]);
    let mut inverses = [[zero; 2]; 6];
    let [x_re, x_im] = load;
    for k in 0..6 {
        let [d_re, d_im] = matrix[entry(k, k)];
        let mut inverse = [zero; 2];
        let mut over = zero;
        for l in 0..LANES {
            let norm = d_re[l].mul_add(d_re[l], d_im[l] * d_im[l]);
            over[l] = 1.0 / norm;
            least[l] = least[l].min(norm);
            inverse[0][l] = d_re[l] * over[l];
            inverse[1][l] = -d_im[l] * over[l];
        }
        inverses[k] = inverse;
        // Column of the elimination, and of L.
        let mut column = [[zero; 2]; 6];
        let mut lower = [[zero; 2]; 6];
        for i in k + 1..6 {
            column[i] = matrix[entry(i, k)];
            let [re, im] = column[i];
            for l in 0..LANES {
                lower[i][0][l] = re[l].mul_add(inverse[0][l], -(im[l] * inverse[1][l]));
                lower[i][1][l] = re[l].mul_add(inverse[1][l], im[l] * inverse[0][l]);
                let square = re[l].mul_add(re[l], im[l] * im[l]);
                worst[l] = worst[l].max(square * square * over[l]);
            }
            matrix[entry(i, k)] = lower[i];
        }
        for i in k + 1..6 {
            let [a_re, a_im] = lower[i];
            for j in k + 1..=i {
                let [b_re, b_im] = &column[j];
                let [re, im] = &mut matrix[entry(i, j)];
                for l in 0..LANES {
                    re[l] = (-a_re[l]).mul_add(b_re[l], a_im[l].mul_add(b_im[l], re[l]));
                    im[l] = (-a_re[l]).mul_add(b_im[l], (-a_im[l]).mul_add(b_re[l], im[l]));
                }
            }
            for l in 0..LANES {
                let [p, q] = [x_re[k][l], x_im[k][l]];
                x_re[i][l] = (-a_re[l]).mul_add(p, a_im[l].mul_add(q, x_re[i][l]));
                x_im[i][l] = (-a_re[l]).mul_add(q, (-a_im[l]).mul_add(p, x_im[i][l]));
            }
        }
    }
    for k in (0..6).rev() {
        let (mut real, mut imaginary) = (zero, zero);
        let [d_re, d_im] = inverses[k];
        for l in 0..LANES {
            real[l] = x_re[k][l].mul_add(d_re[l], -(x_im[k][l] * d_im[l]));
            imaginary[l] = x_re[k][l].mul_add(d_im[l], x_im[k][l] * d_re[l]);
        }
        for i in k + 1..6 {
            let [a_re, a_im] = matrix[entry(i, k)];
            for l in 0..LANES {
                let [p, q] = [x_re[i][l], x_im[i][l]];
                real[l] = (-a_re[l]).mul_add(p, a_im[l].mul_add(q, real[l]));
                imaginary[l] = (-a_re[l]).mul_add(q, (-a_im[l]).mul_add(p, imaginary[l]));
            }
        }
        (x_re[k], x_im[k]) = (real, imaginary);
    }
    let mut is_solved = [false; LANES];
    for l in 0..LANES {
        let square = size[l] * size[l];
        // Not of numbers that are none, nor at rest, where there is no damping.
        is_solved[l] = worst[l] <= LARGEST_GROWTH * LARGEST_GROWTH * square
            && least[l] > RESONANCE * RESONANCE * square
            && rates[l] > 0.0;
    }
    is_solved
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
