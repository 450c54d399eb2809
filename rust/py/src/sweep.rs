//! Sweeps.

use crankpin_core as core;
use crankpin_core::sweep::{Axes, Quantity, Values};
use crankpin_core::{Cancel, Complex64, Error};
use ndarray::{Array1, IxDyn};
use numpy::{PyArray, PyArray1, PyArrayDyn, PyReadonlyArray1, PyReadwriteArray1};
use pyo3::prelude::*;

use crate::convert::{OrRaise, frozen, python_error, spectrum};
use crate::engine::{Engine, hold};
use crate::interrupt;
use crate::waveform::CrankAngles;

/// Engines and axes, checked.
#[pyclass(frozen, module = "crankpin._core")]
pub struct Sweep {
    sweep: core::Sweep,
    /// Which of engine, bank angle, rod ratio, pin offset and speed are dimensions of the result.
    swept: [bool; 5],
}

fn quantity(name: &str) -> PyResult<Quantity> {
    match name {
        "force" => Ok(Quantity::Force),
        "moment" => Ok(Quantity::Moment),
        "torque" => Ok(Quantity::Torque),
        other => {
            let cure = "give \"force\", \"moment\" or \"torque\"";
            Err(python_error(Error::value("quantity", other, cure)))
        }
    }
}

/// Steps that a true peak of a sum of orders costs more than an amplitude.
const PEAK_STEPS: usize = 400;

impl Sweep {
    /// Lengths of the axes that are dimensions of a result.
    fn dimensions(&self, shape: &[usize]) -> Vec<usize> {
        let kept = |axis: usize| self.swept.get(axis).copied().unwrap_or(true);
        shape.iter().enumerate().filter(|&(axis, _)| kept(axis)).map(|(_, &n)| n).collect()
    }

    fn values<'py, T: numpy::Element + Send>(
        &self,
        py: Python<'py>,
        steps_each: usize,
        work: impl FnOnce(&core::Sweep, &Cancel) -> core::Result<Values<T>> + Send,
    ) -> PyResult<Bound<'py, PyArray<T, IxDyn>>> {
        let points = self.sweep.shape().iter().fold(1_usize, |size, &n| size.saturating_mul(n));
        let steps = points.saturating_mul(steps_each);
        let values = interrupt::run(py, steps, |cancel| work(&self.sweep, cancel))?;
        let shape = self.dimensions(values.shape());
        let values = values.into_shape_with_order(IxDyn(&shape)).map_err(|error| {
            python_error(Error::value("sweep", format!("{shape:?}"), error.to_string()))
        })?;
        Ok(frozen(py, values))
    }
}

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
        orders: Option<Vec<u32>>,
        rtol: f64,
        reference_z: Option<f64>,
        spectrum: Option<Vec<(u32, Complex64)>>,
        torque: bool,
        swept: [bool; 5],
    ) -> PyResult<Self> {
        let list = |values: Option<PyReadonlyArray1<'_, f64>>| -> PyResult<Option<Vec<f64>>> {
            Ok(values.map(|values| values.as_slice().map(<[f64]>::to_vec)).transpose()?)
        };
        let bank_angle = match (list(bank_angle_deg)?, held) {
            (Some(angles), Some(held)) => Some((angles, hold(held)?)),
            (None, None) => None,
            (Some(_), None) => {
                let cure = "say what the bank angle leaves as it is: hold=\"pins\" (the crank; firing \
                            intervals change) or hold=\"firing\" (the TDCs; pins are split)";
                return Err(python_error(Error::value("hold", "None", cure)));
            }
            (None, Some(held)) => {
                let cure = "hold says what a sweep of bank_angle_deg leaves as it is: give both";
                return Err(python_error(Error::value("hold", held, cure)));
            }
        };
        let axes = Axes {
            bank_angle,
            rod_ratio: list(rod_ratio)?,
            pin_offset: list(pin_offset)?,
            rpm: rpm.as_slice()?.to_vec(),
        };
        let engines: Vec<_> = engines.into_iter().map(|engine| engine.0).collect();
        let spectrum = self::spectrum(spectrum)?;
        let sweep = if let Some(orders) = orders {
            core::Sweep::new(engines, axes, orders, reference_z, spectrum).or_raise()?
        } else {
            // How much there is to do shows only as the orders are worked out.
            interrupt::run(py, usize::MAX, |cancel| {
                core::Sweep::within(rtol, engines, axes, reference_z, spectrum, torque, cancel)
            })?
        };
        Ok(Self { sweep: if torque { sweep } else { sweep.without_torque() }, swept })
    }

    /// Lengths of engine, bank angle, rod ratio, pin offset, speed.
    #[getter]
    fn shape(&self) -> [usize; 5] {
        self.sweep.shape()
    }

    #[getter]
    fn orders(&self) -> Vec<u32> {
        self.sweep.orders().to_vec()
    }

    #[getter]
    fn omitted(&self) -> Vec<u32> {
        self.sweep.omitted().to_vec()
    }

    /// Of force, moment and torque.
    #[getter]
    fn error_bound(&self) -> [f64; 3] {
        self.sweep.error_bound()
    }

    #[getter]
    fn mean_piston_speed(&self) -> f64 {
        self.sweep.mean_piston_speed()
    }

    /// Values of an axis.
    fn axis<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let axes = self.sweep.axes();
        let values = match name {
            "bank_angle_deg" => axes.bank_angle.as_ref().map(|(angles, _)| angles),
            "rod_ratio" => axes.rod_ratio.as_ref(),
            "pin_offset" => axes.pin_offset.as_ref(),
            "rpm" => Some(&axes.rpm),
            _ => None,
        };
        let values = values.ok_or_else(|| {
            python_error(Error::value("axis", name, "give a quantity that is swept"))
        })?;
        Ok(frozen(py, Array1::from(values.clone())))
    }

    fn phasors<'py>(
        &self,
        py: Python<'py>,
        name: &str,
    ) -> PyResult<Bound<'py, PyArrayDyn<Complex64>>> {
        let quantity = quantity(name)?;
        self.values(py, 8, |sweep, cancel| sweep.phasors(quantity, cancel))
    }

    fn peaks<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let quantity = quantity(name)?;
        self.values(py, 8, |sweep, cancel| sweep.peaks(quantity, cancel))
    }

    fn vector_peaks<'py>(
        &self,
        py: Python<'py>,
        name: &str,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let quantity = quantity(name)?;
        self.values(py, 8, |sweep, cancel| sweep.vector_peaks(quantity, cancel))
    }

    fn sum_peaks<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let quantity = quantity(name)?;
        self.values(py, PEAK_STEPS, |sweep, cancel| sweep.sum_peaks(quantity, cancel))
    }

    fn sum_vector_peaks<'py>(
        &self,
        py: Python<'py>,
        name: &str,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let quantity = quantity(name)?;
        self.values(py, PEAK_STEPS, |sweep, cancel| sweep.sum_vector_peaks(quantity, cancel))
    }

    /// Whether exact kinematics take less time than the orders.
    #[getter]
    fn kinematics_cost_less(&self) -> bool {
        self.sweep.kinematics_cost_less()
    }

    /// Shape of [`Self::waveform`] at so many angles, if there is room for it.
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
        let steps = out.len().saturating_mul(if exact { 8 } else { self.sweep.orders().len() });
        interrupt::watched(py, steps, progress.as_ref(), |cancel| {
            self.sweep.waveforms(quantity, angles, exact, out, cancel)
        })
    }
}
