//! Sweeps.

use std::sync::Arc;

use crankpin_core as core;
use crankpin_core::quantity::Quantity;
use crankpin_core::sweep::{MapAxes, Statistic, SweepAxes};
use crankpin_core::{Cancel, Complex64, Error, Orders, memory};
use crankpin_macros::guarded;
use numpy::{Element, PyArrayDyn, PyArrayMethods, PyReadonlyArray1, PyReadwriteArray1};
use pyo3::prelude::*;

use crate::convert::{self, OrRaise, OrderNumber, numbers, python_error};
use crate::engine::{Engine, choice, hold};
use crate::interrupt;
use crate::pressure::Cycle;
use crate::waveform::CrankAngles;

/// Engines and axes, checked.
#[pyclass(frozen, module = "crankpin._core")]
pub struct Sweep {
    sweep: core::Sweep,
    /// Which of engine, bank angle, rod ratio, pin offset, speed and load are dimensions of the result.
    swept: [bool; 6],
}

/// Speeds and loads of a map, loads, and cycles.
type GasMap<'py> = (
    PyReadonlyArray1<'py, f64>,
    PyReadonlyArray1<'py, f64>,
    PyReadonlyArray1<'py, f64>,
    Vec<Vec<PyRef<'py, Cycle>>>,
);

fn quantity(name: &str) -> PyResult<Quantity<'_>> {
    Quantity::parse(name).or_raise()
}

fn figure(name: &str) -> PyResult<Statistic> {
    let figures = [
        ("amplitude", Statistic::Amplitude),
        ("length", Statistic::Length),
        ("sum", Statistic::Sum),
        ("length of sum", Statistic::LengthOfSum),
        ("zero bound", Statistic::ZeroBound),
        ("mean", Statistic::Mean),
    ];
    choice("figure", name, &figures)
}

/// An array's numbers, if there is one.
fn slice<'a>(values: Option<&'a PyReadonlyArray1<'_, f64>>) -> PyResult<Option<&'a [f64]>> {
    Ok(values.map(|values| values.as_slice()).transpose()?)
}

impl Sweep {
    /// Lengths of the axes that are dimensions of a result.
    fn dimensions(&self, shape: &[usize]) -> Vec<usize> {
        let kept = |axis: usize| self.swept.get(axis).copied().unwrap_or(true);
        shape.iter().enumerate().filter(|&(axis, _)| kept(axis)).map(|(_, &n)| n).collect()
    }

    /// A result, of the dimensions that are swept.
    fn values<'py, T: Element + Send>(
        &self,
        py: Python<'py>,
        (quantity, figure): (Quantity, Statistic),
        progress: Option<&Py<PyAny>>,
        write: impl FnOnce(&mut [T], &Cancel) -> core::Result<()> + Send,
    ) -> PyResult<Bound<'py, PyArrayDyn<T>>> {
        self.sweep.check_size(quantity, figure, size_of::<T>()).or_raise()?;
        let kept = self.dimensions(&self.sweep.result_shape(quantity, figure));
        let values: Bound<'py, PyArrayDyn<T>> = interrupt::written(py, kept, progress, write)?;
        values.try_readwrite()?.make_nonwriteable();
        Ok(values)
    }
}

#[guarded]
#[pymethods]
impl Sweep {
    #[new]
    #[expect(clippy::too_many_arguments, reason = "the wrapper in Python has defaults for them")]
    fn new(
        py: Python<'_>,
        engines: Vec<Engine>,
        bank_angle_deg: Option<PyReadonlyArray1<'_, f64>>,
        held: Option<&str>,
        rod_ratio: Option<PyReadonlyArray1<'_, f64>>,
        pin_offset: Option<PyReadonlyArray1<'_, f64>>,
        rpm: PyReadonlyArray1<'_, f64>,
        gas_map: Option<GasMap<'_>>,
        orders: Option<Vec<OrderNumber>>,
        rtol: f64,
        reference_z: Option<f64>,
        spectrum: Option<Vec<(u32, Complex64)>>,
        torque: bool,
        swept: [bool; 6],
    ) -> PyResult<Self> {
        let held = match (&bank_angle_deg, held) {
            (Some(_), Some(held)) => Some(hold(held)?),
            (None, None) => None,
            (Some(_), None) => {
                let hint = "give what is held as the bank angle changes: hold=\"pins\" (the crank; firing \
                            intervals change) or hold=\"firing\" (the TDCs; pins are split)";
                return Err(python_error(Error::value("hold", "None", hint)));
            }
            (None, Some(held)) => {
                let hint = "hold is of sweeps of bank_angle_deg: give both or neither";
                return Err(python_error(Error::value("hold", held, hint)));
            }
        };
        let engines = engines.iter().map(|engine| engine.with_spectrum(spectrum.clone()));
        let engines = engines.collect::<PyResult<Vec<_>>>()?;
        let orders = orders.map(|orders| convert::orders(&orders)).transpose()?;
        let bank_angle = slice(bank_angle_deg.as_ref())?;
        let (rod_ratio, pin_offset) = (slice(rod_ratio.as_ref())?, slice(pin_offset.as_ref())?);
        let rpm = rpm.as_slice()?;
        let map = match &gas_map {
            Some((rpm, loads, load, cycles)) => {
                let cores = |cycles: &Vec<PyRef<'_, Cycle>>| {
                    cycles.iter().map(|cycle| Arc::clone(&cycle.0)).collect()
                };
                let cycles: Vec<Vec<_>> = cycles.iter().map(cores).collect();
                Some(([rpm.as_slice()?, loads.as_slice()?, load.as_slice()?], cycles))
            }
            None => None,
        };
        let sweep = interrupt::run(py, |cancel| {
            let list =
                |values: Option<&[f64]>| values.map(|v| memory::copied(v, cancel)).transpose();
            let axes = SweepAxes {
                bank_angle: list(bank_angle)?.zip(held),
                rod_ratio: list(rod_ratio)?,
                pin_offset: list(pin_offset)?,
                rpm: memory::copied(rpm, cancel)?,
                map: match map {
                    Some(([rpm, loads, load], cycles)) => Some(MapAxes {
                        cycles,
                        rpm: memory::copied(rpm, cancel)?,
                        loads: memory::copied(loads, cancel)?,
                        load: memory::copied(load, cancel)?,
                    }),
                    None => None,
                },
            };
            let orders = orders.map_or(Orders::Auto { rtol }, Orders::Given);
            core::Sweep::new(engines, axes, &orders, reference_z, torque, cancel)
        })?;
        Ok(Self { sweep, swept })
    }

    #[getter]
    fn orders(&self) -> Vec<OrderNumber> {
        numbers(self.sweep.orders())
    }

    #[getter]
    fn omitted(&self) -> Vec<OrderNumber> {
        numbers(self.sweep.omitted())
    }

    /// Of force, moment and torque.
    #[getter]
    fn error_bound(&self) -> [f64; 3] {
        self.sweep.error_bound().values()
    }

    /// Names of the parts of its quantities.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.sweep.names().iter().map(ToString::to_string).collect()
    }

    #[getter]
    fn mean_piston_speed(&self) -> f64 {
        self.sweep.mean_piston_speed()
    }

    /// Along (about) x and y or, of force and moment, forward and backward parts: (…, `n_orders`, 2).
    fn phasors<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        turning: bool,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyArrayDyn<Complex64>>> {
        let figure = if turning { Statistic::Turning } else { Statistic::Amplitude };
        let quantity = quantity(name)?;
        self.values(py, (quantity, figure), progress.as_ref(), |out, cancel| {
            self.sweep.write_phasors(quantity, figure, out, cancel)
        })
    }

    /// Real values of each order (…, `n_orders`) or of their sum (…,).
    fn peaks<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        which: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let (quantity, figure) = (quantity(name)?, figure(which)?);
        self.values(py, (quantity, figure), progress.as_ref(), |out, cancel| {
            self.sweep.write_peaks(quantity, figure, out, cancel)
        })
    }

    /// Shape of [`Self::waveform`] at a number of angles, if there is room for it.
    fn waveform_shape(&self, name: &str, angles: usize) -> PyResult<Vec<usize>> {
        let shape = self.sweep.waveform_shape(quantity(name)?, angles).or_raise()?;
        Ok(self.dimensions(&shape))
    }

    /// Write values over crank angle to a flat array.
    fn waveform(
        &self,
        py: Python<'_>,
        name: &str,
        angles: &Bound<'_, CrankAngles>,
        exact: bool,
        mut out: PyReadwriteArray1<'_, f64>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<()> {
        let quantity = quantity(name)?;
        let angles = &angles.get().0;
        let out = out.as_slice_mut()?;
        interrupt::watched(py, progress.as_ref(), |cancel| {
            self.sweep.waveforms(quantity, angles, exact, out, cancel)
        })
    }
}
