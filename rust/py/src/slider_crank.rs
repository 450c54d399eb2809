//! One cylinder: motion and harmonics.

use crate::array::writeable;
use crankpin_core::harmonics::{table, torque};
use crankpin_core::mechanism::articulated::table::{self as links, LinkFigures};
use crankpin_core::motion::CrankPosition;
use crankpin_core::{Complex64, Cylinder, Order, angle, crank_angles, limits, memory, order, rod};
use crankpin_macros::guarded;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::convert::{OrRaise, Parts, cylinder};
use crate::interrupt;

fn check_orders(orders: &[u32]) -> PyResult<()> {
    Order::all_whole(orders).and_then(|orders| order::check_list(&orders)).or_raise()
}

/// Refuse a cylinder that makes no engine.
#[guarded]
#[pyfunction]
pub fn check_cylinder(parts: Parts) -> PyResult<()> {
    cylinder(parts).map(drop)
}

/// Crank radius of a cylinder given by bore and stroke: bore, stroke, rod length, reciprocating mass,
/// pin offset.
#[guarded]
#[pyfunction]
pub fn crank_radius_of_stroke(given: Parts) -> PyResult<f64> {
    let (bore, stroke, rod_length, mass, pin_offset) = given;
    let cylinder = Cylinder::from_bore_stroke(bore, stroke, rod_length, mass, pin_offset);
    cylinder.or_raise().map(|cylinder| cylinder.crank_radius())
}

/// Estimated moment of inertia of a rod: mass, length, distance of the centre of mass from the
/// crankpin.
#[guarded]
#[pyfunction]
pub fn estimated_rod_inertia(mass: f64, length: f64, to_crankpin: f64) -> PyResult<f64> {
    rod::Rod::estimated(mass, length, to_crankpin).or_raise().map(|rod| rod.inertia())
}

/// What a rod is replaced by.
#[derive(IntoPyObject)]
struct RodParts {
    reciprocating_mass: f64,
    rotating_mass: f64,
    inertia_excess: f64,
}

/// The parts of a rod, from the distance of its centre of mass from the crankpin.
#[guarded]
#[pyfunction]
pub fn rod_parts(mass: f64, inertia: f64, length: f64, to_crankpin: f64) -> PyResult<RodParts> {
    let rod = rod::Rod::new(mass, inertia, length, to_crankpin).or_raise()?;
    let (reciprocating_mass, rotating_mass) = (rod.reciprocating_mass(), rod.rotating_mass());
    Ok(RodParts { reciprocating_mass, rotating_mass, inertia_excess: rod.inertia_excess() })
}

/// Distance between the ends of a piston's travel, m.
#[guarded]
#[pyfunction]
pub fn piston_travel(parts: Parts) -> PyResult<f64> {
    Ok(cylinder(parts)?.travel())
}

/// Crank angles at which a piston is highest and lowest, degrees.
#[guarded]
#[pyfunction]
pub fn turning_points(parts: Parts) -> PyResult<[f64; 2]> {
    Ok(cylinder(parts)?.turning_points_deg())
}

/// Position (m), velocity (m/rad) and acceleration (m/rad²) at crank angles: columns of (n, 3).
#[guarded]
#[pyfunction]
pub fn motion<'py>(
    py: Python<'py>,
    parts: Parts,
    theta_deg: PyReadonlyArray1<'py, f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let cylinder = cylinder(parts)?;
    let thetas = theta_deg.as_slice()?;
    let hint = "split theta_deg into parts";
    limits::result_size("theta_deg", &[thetas.len(), 3], size_of::<f64>(), hint).or_raise()?;
    let rows = interrupt::run(py, |cancel| {
        crank_angles::check(thetas, cancel)?;
        let (mechanism, radius) = (cylinder.mechanism(), cylinder.crank_radius());
        let mut rows: Vec<f64> = memory::zeros(3 * thetas.len())?;
        for (i, (&theta, row)) in thetas.iter().zip(rows.chunks_exact_mut(3)).enumerate() {
            if i % 4096 == 0 {
                cancel.check()?;
            }
            let unit = angle::cis_degrees(theta);
            let motion = mechanism.motion(&CrankPosition::new(unit.im, unit.re));
            row[0] = motion.position * radius;
            row[1] = motion.velocity * radius;
            row[2] = motion.acceleration * radius;
        }
        memory::array("theta_deg", (thetas.len(), 3), rows)
    })?;
    writeable(py, rows)
}

/// Harmonics of a cylinder's inertia force over m·r·ω².
#[guarded]
#[pyfunction]
pub fn cylinder_harmonics(
    py: Python<'_>,
    parts: Parts,
    orders: Vec<u32>,
) -> PyResult<Bound<'_, PyArray1<Complex64>>> {
    check_orders(&orders)?;
    let cylinder = cylinder(parts)?;
    let values = interrupt::run(py, |cancel| cylinder.mechanism().force(&orders, cancel))?;
    writeable(py, values.into())
}

/// Harmonics of a cylinder's roll and crank torque over m·r²·ω².
#[guarded]
#[pyfunction]
pub fn cylinder_torque_harmonics(
    py: Python<'_>,
    parts: Parts,
    orders: Vec<u32>,
) -> PyResult<(Bound<'_, PyArray1<Complex64>>, Bound<'_, PyArray1<Complex64>>)> {
    check_orders(&orders)?;
    let cylinder = cylinder(parts)?;
    let torque =
        interrupt::run(py, |cancel| torque::over_second_moment(&cylinder, &orders, cancel))?;
    Ok((writeable(py, torque.roll.into())?, writeable(py, torque.crank.into())?))
}

/// Harmonics without offset for many rod ratios, within a tolerance or to all digits: (n, `n_orders`).
#[guarded]
#[pyfunction]
#[pyo3(signature = (rod_ratios, orders, rtol=None))]
pub fn centred_table<'py>(
    py: Python<'py>,
    rod_ratios: PyReadonlyArray1<'py, f64>,
    orders: Vec<u32>,
    rtol: Option<f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let ratios = rod_ratios.as_slice()?;
    table::check_size::<f64>(ratios.len(), &orders).or_raise()?;
    let shape = [ratios.len(), orders.len()];
    interrupt::written(py, shape, None, |out, cancel| {
        table::write_centred(ratios, &orders, rtol, out, cancel)
    })
}

/// Harmonics of many link rods: (n, `n_orders`).
#[guarded]
#[pyfunction]
pub fn link_rod_table<'py>(
    py: Python<'py>,
    rod_ratios: PyReadonlyArray1<'py, f64>,
    master_ratios: PyReadonlyArray1<'py, f64>,
    knuckle_ratios: PyReadonlyArray1<'py, f64>,
    bores_deg: PyReadonlyArray1<'py, f64>,
    knuckles_deg: PyReadonlyArray1<'py, f64>,
    orders: Vec<u32>,
) -> PyResult<Bound<'py, PyArray2<Complex64>>> {
    let figures = LinkFigures {
        rod_ratios: rod_ratios.as_slice()?,
        master_ratios: master_ratios.as_slice()?,
        knuckle_ratios: knuckle_ratios.as_slice()?,
        bores_deg: bores_deg.as_slice()?,
        knuckles_deg: knuckles_deg.as_slice()?,
    };
    table::check_size::<Complex64>(figures.rod_ratios.len(), &orders).or_raise()?;
    let shape = [figures.rod_ratios.len(), orders.len()];
    interrupt::written(py, shape, None, |out, cancel| links::write(figures, &orders, out, cancel))
}

/// Harmonics for many pairs of rod ratio and offset over r, to all digits: (n, `n_orders`).
#[guarded]
#[pyfunction]
#[pyo3(signature = (rod_ratios, offsets, orders, rtol=None))]
pub fn offset_table<'py>(
    py: Python<'py>,
    rod_ratios: PyReadonlyArray1<'py, f64>,
    offsets: PyReadonlyArray1<'py, f64>,
    orders: Vec<u32>,
    rtol: Option<f64>,
) -> PyResult<Bound<'py, PyArray2<Complex64>>> {
    rtol.map(limits::tolerance).transpose().or_raise()?;
    let (ratios, offsets) = (rod_ratios.as_slice()?, offsets.as_slice()?);
    table::check_size::<Complex64>(ratios.len(), &orders).or_raise()?;
    let shape = [ratios.len(), orders.len()];
    interrupt::written(py, shape, None, |out, cancel| {
        table::write_offset(ratios, offsets, &orders, out, cancel)
    })
}
