//! Phasors per order.

use std::borrow::Cow;

use crate::array::{frozen, writeable};
use crankpin_core as core;
use crankpin_core::balance::{ErrorBounds, Orders, Request, Vector};
use crankpin_core::engine::Origin;
use crankpin_core::quantity::{Kind, Part, Quantity};
use crankpin_core::wrench::tilt_deg;
use crankpin_core::{Complex64, Error, memory};
use crankpin_macros::guarded;
use ndarray::{Array1, Array2};
use numpy::{PyArray1, PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;

use crate::convert::{self, OrRaise, OrderNumber, numbers, python_error};
use crate::engine::{Engine, choice};
use crate::interrupt;

/// Which orders: a list, or a tolerance to choose them by.
pub fn orders(orders: Option<Vec<OrderNumber>>, rtol: f64) -> PyResult<Orders> {
    orders.map_or(Ok(Orders::Auto { rtol }), |given| convert::orders(&given).map(Orders::Given))
}

/// Directions of the longest half axes of what forward and backward parts trace, degrees; 0 for a circle.
#[guarded]
#[pyfunction]
pub fn tilts_deg<'py>(
    py: Python<'py>,
    forward: PyReadonlyArrayDyn<'py, Complex64>,
    backward: PyReadonlyArrayDyn<'py, Complex64>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let (forward, backward) = (forward.as_array(), backward.as_array());
    let pairs = forward.iter().zip(backward.iter());
    let tilts = pairs.map(|(&forward, &backward)| tilt_deg(forward, backward).unwrap_or(0.0));
    let tilts = memory::collected(tilts).or_raise()?;
    writeable(py, memory::array("backward", forward.shape(), tilts).or_raise()?)
}

/// How an engine shakes at one speed.
#[pyclass(frozen, module = "crankpin._core")]
pub struct Balance(pub core::Balance);

/// Bounds on force, moment and torque about a point this far away along x, y and z, m.
#[guarded]
#[pyfunction]
pub fn bounds_about(of: [f64; 3], arm: [f64; 3]) -> [f64; 3] {
    let [force, moment, torque] = of;
    ErrorBounds { force, moment, torque }.moved(arm).values()
}

/// The balance of an engine.
#[guarded]
#[pyfunction]
#[pyo3(name = "balance")]
#[expect(clippy::too_many_arguments, reason = "the wrapper in Python has defaults for them")]
pub fn balance(
    py: Python<'_>,
    engine: &Bound<'_, Engine>,
    rpm: f64,
    orders: Option<Vec<OrderNumber>>,
    rtol: f64,
    reference_z: Option<f64>,
    spectrum: Option<Vec<(u32, Complex64)>>,
    torque: bool,
) -> PyResult<Balance> {
    let orders = self::orders(orders, rtol)?;
    let request = Request { rpm, reference_z, torque };
    let engine = engine.get().with_spectrum(spectrum)?;
    interrupt::run(py, |cancel| core::balance::balance(&engine, &request, &orders, cancel))
        .map(Balance)
}

/// What each part of an engine adds to a balance of these orders: its kind, index and balance.
#[guarded]
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the wrapper in Python has defaults for them")]
pub fn terms(
    py: Python<'_>,
    engine: &Bound<'_, Engine>,
    rpm: f64,
    orders: Vec<OrderNumber>,
    reference_z: Option<f64>,
    spectrum: Option<Vec<(u32, Complex64)>>,
    torque: bool,
    aside: [f64; 2],
) -> PyResult<Vec<(&'static str, usize, Balance)>> {
    let orders = convert::orders(&orders)?;
    let request = Request { rpm, reference_z, torque };
    let engine = engine.get().with_spectrum(spectrum)?;
    let terms =
        interrupt::run(py, |cancel| core::terms::terms(&engine, &request, aside, &orders, cancel))?;
    let named = |(origin, balance): (Origin, _)| {
        let (kind, index) = origin.named();
        (kind, index, Balance(balance))
    };
    Ok(terms.into_iter().map(named).collect())
}

/// ω in rad/s.
#[guarded]
#[pyfunction]
pub fn angular_speed(rpm: f64) -> PyResult<f64> {
    core::balance::angular_speed(rpm).or_raise()
}

/// Force or moment, or which torque, of a quantity.
enum Reading {
    Vector(Vector),
    Torque { on_crank: bool },
}

impl Balance {
    /// What a quantity is of a balance: of the part that it names.
    fn reading<'a>(&'a self, name: &str) -> PyResult<(Cow<'a, core::Balance>, Reading)> {
        let Quantity { kind, part } = Quantity::parse(name).or_raise()?;
        let balance = match part {
            Part::Whole => Cow::Borrowed(&self.0),
            Part::Of(_) => Cow::Owned(self.0.of_part(part)),
        };
        let reading = match kind {
            Kind::Force => Reading::Vector(Vector::Force),
            Kind::Moment => Reading::Vector(Vector::Moment),
            Kind::Torque => Reading::Torque { on_crank: false },
            Kind::CrankTorque => Reading::Torque { on_crank: true },
        };
        Ok((balance, reading))
    }
}

/// Force or moment by its name.
pub fn vector(quantity: &str) -> PyResult<Vector> {
    choice("quantity", quantity, &[("force", Vector::Force), ("moment", Vector::Moment)])
}

#[guarded]
#[pymethods]
impl Balance {
    #[getter]
    fn orders(&self) -> Vec<OrderNumber> {
        numbers(&self.0.orders)
    }

    #[getter]
    fn omitted(&self) -> Vec<OrderNumber> {
        numbers(&self.0.omitted)
    }

    /// Of force, moment and torque.
    #[getter]
    fn error_bound(&self) -> [f64; 3] {
        self.0.error_bound.values()
    }

    /// That of one order alone, if it was evaluated here.
    fn alone(&self, order: OrderNumber) -> PyResult<Option<Self>> {
        let [order] = convert::orders(&[order])?[..] else { return Ok(None) };
        Ok(self.0.alone(order).map(Self))
    }

    /// As those of a sweep: along (about) x and y or, of force and moment, forward and backward parts.
    fn phasors<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        turning: bool,
    ) -> PyResult<Bound<'py, PyArrayDyn<Complex64>>> {
        let (balance, reading) = self.reading(name)?;
        let orders = 0..balance.orders.len();
        match reading {
            Reading::Torque { on_crank } => {
                let torques = orders.map(|k| {
                    let torque = balance.wrenches[k].torque;
                    if on_crank { torque.crank } else { torque.roll }
                });
                frozen(py, torques.collect::<Array1<_>>().into_dyn())
            }
            Reading::Vector(vector) => {
                let pairs = orders.map(|k| {
                    let planar = balance.planar(vector, k);
                    if turning {
                        [planar.forward, planar.backward()]
                    } else {
                        balance.xy(vector, k)
                    }
                });
                frozen(py, Array2::from(pairs.collect::<Vec<_>>()).into_dyn())
            }
        }
    }

    fn zero_bound<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (balance, reading) = self.reading(name)?;
        let bounds = (0..balance.orders.len()).map(|k| match reading {
            Reading::Torque { on_crank } => {
                balance.torque_zero_bounds(Part::Whole, k)[usize::from(on_crank)]
            }
            Reading::Vector(vector) => balance.zero_bound(vector, k),
        });
        frozen(py, bounds.collect::<Array1<_>>())
    }

    fn total_peak_xy<'py>(
        &self,
        py: Python<'py>,
        name: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (balance, reading) = self.reading(name)?;
        let Reading::Vector(vector) = reading else {
            return Err(python_error(Error::value("quantity", name, "give a force or a moment")));
        };
        let peaks = interrupt::run(py, |cancel| balance.peak_xy(vector, cancel))?;
        frozen(py, peaks.to_vec().into())
    }

    /// The longest vector, or the largest torque, of all orders together.
    fn total_peak(&self, py: Python<'_>, name: &str) -> PyResult<f64> {
        let (balance, reading) = self.reading(name)?;
        interrupt::run(py, |cancel| match reading {
            Reading::Torque { on_crank } => balance.torque_peak(Part::Whole, on_crank, cancel),
            Reading::Vector(vector) => balance.peak(vector, cancel),
        })
    }

    /// Names of the parts of its quantities.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.0.names().iter().map(ToString::to_string).collect()
    }

    /// Mean torque.
    fn mean(&self, name: &str) -> PyResult<f64> {
        let Quantity { kind, part } = Quantity::parse(name).or_raise()?;
        Ok(self.0.mean(part)[usize::from(kind == Kind::CrankTorque)])
    }
}
