//! The Python face of `crankpin-core`: a file for each of its files, and no arithmetic.
//!
//! `crankpin._core` is private; people import `crankpin`, whose classes wrap what is here and carry
//! the documentation.

#![expect(clippy::needless_pass_by_value, reason = "PyO3 hands arguments over by value")]

use pyo3::prelude::*;

mod balance;
mod balancing;
mod closed_form;
mod convert;
mod design;
mod engine;
mod firing;
mod flywheel;
mod internal;
mod interrupt;
mod matching;
mod pressure;
mod reserve;
mod search;
mod slider_crank;
mod sweep;
mod tolerances;
mod vanishing;
mod waveform;

#[global_allocator]
static ALLOCATOR: reserve::Allocator = reserve::Allocator;

// Classes are frozen, and what threads share is behind a lock: packaging/README.md has how that was tested.
#[pymodule(gil_used = false)]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    reserve::allocate();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("ATMOSPHERE", crankpin_core::pressure::ATMOSPHERE)?;
    module.add("MOST_CYLINDERS", crankpin_core::limits::MOST_CYLINDERS)?;
    module.add("LONGEST_AXIS", crankpin_core::limits::LONGEST_AXIS)?;
    module.add("LONGEST_FILE", crankpin_core::engine::file::LONGEST_TEXT)?;
    module.add("InputError", module.py().get_type::<convert::InputError>())?;
    module.add_class::<engine::Engine>()?;
    module.add_class::<balance::Balance>()?;
    module.add_class::<search::Search>()?;
    module.add_class::<search::BankAngles>()?;
    module.add_class::<sweep::Sweep>()?;
    module.add_class::<waveform::CrankAngles>()?;
    module.add_class::<firing::Firing>()?;
    module.add_class::<tolerances::Tolerances>()?;
    module.add_class::<design::Merit>()?;
    module.add_class::<pressure::Cycle>()?;
    module.add_class::<internal::Internal>()?;
    module.add_class::<flywheel::CycleGrid>()?;
    module.add_function(wrap_pyfunction!(convert::exact_angle, module)?)?;
    module.add_function(wrap_pyfunction!(convert::near_miss, module)?)?;
    module.add_function(wrap_pyfunction!(balance::angular_speed, module)?)?;
    module.add_function(wrap_pyfunction!(slider_crank::check_cylinder, module)?)?;
    module.add_function(wrap_pyfunction!(slider_crank::crank_radius_of_stroke, module)?)?;
    module.add_function(wrap_pyfunction!(slider_crank::estimated_rod_inertia, module)?)?;
    module.add_function(wrap_pyfunction!(slider_crank::rod_parts, module)?)?;
    module.add_function(wrap_pyfunction!(slider_crank::motion, module)?)?;
    module.add_function(wrap_pyfunction!(slider_crank::cylinder_harmonics, module)?)?;
    module.add_function(wrap_pyfunction!(slider_crank::cylinder_torque_harmonics, module)?)?;
    module.add_function(wrap_pyfunction!(slider_crank::centred_table, module)?)?;
    module.add_function(wrap_pyfunction!(slider_crank::offset_table, module)?)?;
    module.add_function(wrap_pyfunction!(balance::balance, module)?)?;
    module.add_function(wrap_pyfunction!(balancing::turning, module)?)?;
    module.add_function(wrap_pyfunction!(balancing::roll_torque, module)?)?;
    module.add_function(wrap_pyfunction!(balancing::least_weights, module)?)?;
    module.add_function(wrap_pyfunction!(balancing::fit_shafts, module)?)?;
    module.add_function(wrap_pyfunction!(balancing::pair_heights, module)?)?;
    module.add_function(wrap_pyfunction!(balancing::shared, module)?)?;
    module.add_function(wrap_pyfunction!(pressure::places_on_axis, module)?)?;
    module.add_function(wrap_pyfunction!(firing::check_timing, module)?)?;
    module.add_function(wrap_pyfunction!(firing::inline_throws, module)?)?;
    module.add_function(wrap_pyfunction!(firing::vee_throws, module)?)?;
    module.add_function(wrap_pyfunction!(vanishing::vanishing, module)?)?;
    module.add_function(wrap_pyfunction!(vanishing::star, module)?)?;
    module.add_function(wrap_pyfunction!(closed_form::closed_form, module)?)?;
    module.add_function(wrap_pyfunction!(search::arrangement, module)?)?;
    module.add_function(wrap_pyfunction!(waveform::waveform, module)?)?;
    module.add_function(wrap_pyfunction!(matching::matched, module)?)?;
    module.add_function(wrap_pyfunction!(tolerances::peaks_of_sums, module)?)?;
    Ok(())
}
