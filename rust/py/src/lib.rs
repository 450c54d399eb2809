//! The Python face of `crankpin-core`: a file for each of its files, and no arithmetic.
//!
//! `crankpin._core` is private; people import `crankpin`, whose classes wrap what is here and carry
//! the documentation.

use pyo3::prelude::*;

mod array;
mod balance;
mod balancing;
mod bearing_loads;
mod boundary;
mod closed_form;
mod convert;
mod design;
mod engine;
mod explain;
mod figures;
mod firing;
mod flywheel;
mod interrupt;
mod matching;
mod mounts;
mod pressure;
mod reserve;
mod search;
mod slider_crank;
mod sweep;
mod tolerances;
mod typed;
mod vanishing;
mod warnings;
mod waveform;

#[global_allocator]
static ALLOCATOR: reserve::Allocator = reserve::Allocator;

// Classes are frozen, and what threads share is behind a lock: packaging/README.md has how that was tested.
#[pymodule(gil_used = false)]
mod _core {
    use crankpin_core::{crank_angles, drawing, engine::file, layout::Strokes, limits, pressure};
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::{
        balance::{Balance, angular_speed, balance, bounds_about, terms, tilts_deg},
        balancing::{
            FirstOrder, appearing, bay_loads, corrections, fit_shafts, fit_weights, forward_weight,
            masses_on_pins, pair_heights, roll_torque, shared, turning, with_bob_weights,
        },
        bearing_loads::BearingLoadsModel,
        closed_form::closed_form,
        convert::exact_angle,
        design::Objectives,
        engine::{Engine, check_load},
        explain::{Explanation, dead_text, explain, gas_text},
        figures::{drawn, drawn_rod, drawn_turning, listed_orders, load_rows, rod_ratios},
        firing::{Firing, check_timing, inline_throws, vee_throws},
        flywheel::{
            CycleGrid, disc, energy_levels, inertia_by_irregularity, irregularity_by_order,
            mean_inertias, rim, swing_deg,
        },
        matching::MeasuredParts,
        mounts::{
            AdaptiveLaw, MountObjectives, Powertrain, Response, actuator_phasors, block,
            check_forces, check_mount, check_soil, check_support, combined, force_table,
            least_share, motor_shares, mount_stiffness, peaks_of_vectors, rigid_body, soil_mount,
        },
        pressure::{
            Cycle, compression_peak, crank_clock, cubics, fires_a_turn_later, heat_release,
            low_passed, phasors_of_curves, places_on_axis, polytropic_offsets, repeats_first,
            speed_within_cycles,
        },
        search::{BankAngles, Search, arrangement},
        slider_crank::{
            centred_table, check_cylinder, crank_radius_of_stroke, cylinder_harmonics,
            cylinder_torque_harmonics, estimated_rod_inertia, link_rod_table, motion, offset_table,
            piston_travel, rod_parts, turning_points,
        },
        sweep::Sweep,
        tolerances::{Tolerances, orders_of_samples, peaks_of_sums},
        typed::{
            product, read_amplitudes, read_numbers, unit_factor, unit_symbol, unit_symbols,
            unit_terms,
        },
        vanishing::{star, vanishing},
        warnings::{
            absolute_warnings, body_warnings, cycle_warnings, cylinder_warnings, engine_warnings,
            far_peak, figure_warnings, gas_warnings, hardware_warnings, mount_warnings, near_miss,
            peak_warnings, pin_split_warnings, piston_speed_warnings, point_warnings,
            pressure_warnings, radians, stiffness_warnings, tensor_warnings, unbalance_warnings,
            unit_warnings, work_warnings,
        },
        waveform::{CrankAngles, waveform},
    };

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        crate::reserve::allocate();
        crate::boundary::quiet();
        crate::array::load(module.py())?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("ATMOSPHERE", pressure::ATMOSPHERE)?;
        let exhaust_opens = [Strokes::Four, Strokes::Two].map(drawing::exhaust_opens_deg);
        module.add("EXHAUST_OPENS_DEG", exhaust_opens)?;
        module.add("HIGHEST_ORDER", limits::HIGHEST_ORDER)?;
        module.add("EQUAL_FREQUENCIES", crankpin_core::mounts::EQUAL_FREQUENCIES)?;
        module.add("FEWEST_POINTS", crank_angles::FEWEST_POINTS)?;
        module.add("MOST_CYLINDERS", limits::MOST_CYLINDERS)?;
        module.add("LARGEST_RESULT", limits::LARGEST_RESULT)?;
        module.add("LARGEST", limits::LARGEST)?;
        module.add("LARGEST_SPEED_RATIO", crankpin_core::SpeedRatio::LARGEST_COUNTED)?;
        module.add("LONGEST_AXIS", limits::LONGEST_AXIS)?;
        module.add("SMALLEST", limits::SMALLEST)?;
        module.add("LONGEST_FILE", file::LONGEST_TEXT)?;
        let error = module.py().get_type::<crate::convert::InputError>();
        for field in ["argument", "value", "hint"] {
            error.setattr(field, module.py().None())?;
        }
        module.add("InputError", error)
    }
}
