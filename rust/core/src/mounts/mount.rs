//! A mount: a place, three axes at right angles, stiffness along them at rest and in motion.

use nalgebra::{Matrix3, Matrix3x6, Vector3};
use serde::{Deserialize, Serialize};

use super::stiffness::{Dynamic, InertiaTrack, Table};
use crate::Complex64;
use crate::numbers::angle::{Angle, cis_degrees};
use crate::numbers::error::{Error, Result};
use crate::numbers::is_default;
use crate::numbers::limits;

/// Largest scalar product of two directions at right angles, and error of a length of 1, that typed
/// digits make; axes are made exact.
const SKEW_BY_TYPING: f64 = 1e-3;

/// Figures of a mount as they are given.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MountFigures {
    /// Name.
    pub name: String,
    /// Place of its elastic centre, m.
    pub at: [f64; 3],
    /// Degrees by which its first axis is turned from +x towards +y; the second is a quarter turn ahead of it, and
    /// the third is along z.
    #[serde(default, skip_serializing_if = "is_default")]
    pub tilt_deg: f64,
    /// Directions of the first, second and third axis, a row each, in place of a tilt.
    #[serde(default, skip_serializing_if = "is_default")]
    pub axes: Option<[[f64; 3]; 3]>,
    /// Static stiffness along them, N/m.
    pub stiffness: [f64; 3],
    /// Dynamic stiffness; the static one where it is not given.
    #[serde(default, skip_serializing_if = "is_default")]
    pub dynamic_stiffness: Option<[f64; 3]>,
    /// Imaginary over real part of the dynamic stiffness.
    #[serde(default, skip_serializing_if = "is_default")]
    pub loss_factor: [f64; 3],
    /// Viscous damping, N·s/m.
    #[serde(default, skip_serializing_if = "is_default")]
    pub damping: [f64; 3],
    /// Fluid of a hydraulic mount, along the first axis.
    #[serde(default, skip_serializing_if = "is_default")]
    pub track: Option<InertiaTrack>,
    /// Measured dynamic stiffness, in place of the figures above.
    #[serde(default, skip_serializing_if = "is_default")]
    pub table: Option<Table>,
    /// Stiffness about its axes, N·m/rad, besides what their places make.
    #[serde(default, skip_serializing_if = "is_default")]
    pub rotational_stiffness: [f64; 3],
    /// Imaginary over real part of that in motion.
    #[serde(default, skip_serializing_if = "is_default")]
    pub rotational_loss_factor: [f64; 3],
    /// Viscous damping about its axes, N·m·s/rad.
    #[serde(default, skip_serializing_if = "is_default")]
    pub rotational_damping: [f64; 3],
    /// Gaps of its snubbers against and along each axis, m, of the mount without load.
    #[serde(default, skip_serializing_if = "is_default")]
    pub gap: [[f64; 2]; 3],
    /// Stiffness that each of them adds beyond its gap, N/m; 0 where there is none.
    #[serde(default, skip_serializing_if = "is_default")]
    pub snubber_stiffness: [[f64; 2]; 3],
}

/// A mount, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Mount {
    figures: MountFigures,
    axes: Matrix3<f64>,
    dynamic: Dynamic,
    /// About the axes, where it resists rotation.
    rotation: Option<Dynamic>,
    /// Stiffness of the snubbers against and along its axes that act at rest, N/m.
    contact: [[f64; 2]; 3],
}

impl Mount {
    /// A mount of these figures.
    pub fn new(figures: MountFigures) -> Result<Self> {
        limits::name("name", &figures.name)?;
        for (name, place) in ["at[0]", "at[1]", "at[2]"].into_iter().zip(figures.at) {
            limits::finite(name, place)?;
        }
        let axes = figures.axes()?;
        let names = ["stiffness[0]", "stiffness[1]", "stiffness[2]"];
        for (name, stiffness) in names.into_iter().zip(figures.stiffness) {
            limits::not_negative(name, stiffness)?;
        }
        let dynamic = figures.dynamic()?;
        dynamic.check()?;
        let rotation = figures.rotation()?;
        figures.check_snubbers()?;
        Ok(Self { figures, axes, dynamic, rotation, contact: [[0.0; 2]; 3] })
    }

    /// Whether it has snubbers.
    #[must_use]
    pub fn is_snubbed(&self) -> bool {
        self.figures.snubber_stiffness != [[0.0; 2]; 3]
    }

    /// Counts the stiffness of the snubbers that act at rest in motion.
    pub(super) fn settle(&mut self, contact: [[f64; 2]; 3]) -> Result<()> {
        if contact != self.contact {
            self.dynamic = self.figures.dynamic()?;
            self.dynamic.stiffen(contact.map(|[against, along]| against + along));
            self.contact = contact;
        }
        Ok(())
    }

    /// Stiffness of the snubbers against and along its axes that act at rest, N/m.
    #[must_use]
    pub fn contact(&self) -> [[f64; 2]; 3] {
        self.contact
    }

    /// Stiffness about its axes, N·m/rad, where it resists rotation: the same at any frequency but for its damping.
    #[must_use]
    pub fn rotation(&self) -> Option<&Dynamic> {
        self.rotation.as_ref()
    }

    /// The figures.
    #[must_use]
    pub fn figures(&self) -> &MountFigures {
        &self.figures
    }

    /// Name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.figures.name
    }

    /// Place, m.
    #[must_use]
    pub fn at(&self) -> Vector3<f64> {
        self.figures.at.into()
    }

    /// Directions of its axes, a row each.
    #[must_use]
    pub fn axes(&self) -> Matrix3<f64> {
        self.axes
    }

    /// Static stiffness along its axes, N/m.
    #[must_use]
    pub fn static_stiffness(&self) -> [f64; 3] {
        self.figures.stiffness
    }

    /// Dynamic stiffness.
    #[must_use]
    pub fn dynamic(&self) -> &Dynamic {
        &self.dynamic
    }

    /// Complex stiffness along its axes at an angular speed, N/m; outside of a table an error about a
    /// point of operation in words, such as "order 2 at 3000 rpm".
    pub fn stiffness_at(
        &self,
        omega: f64,
        point: impl FnOnce() -> String,
    ) -> Result<[Complex64; 3]> {
        self.dynamic.at(omega).ok_or_else(|| {
            let [low, high] = self.dynamic.range();
            let frequency = omega / std::f64::consts::TAU;
            let argument = format!("table of mount {:?}", self.figures.name);
            let hint = format!(
                "{}, is outside: it has {low} to {high} Hz; extend the table, or give orders and speeds within it",
                point()
            );
            Error::value(argument, format!("{frequency:.6} Hz"), hint)
        })
    }
}

impl MountFigures {
    /// Directions of its axes, a row each.
    fn axes(&self) -> Result<Matrix3<f64>> {
        let Some(rows) = &self.axes else {
            Angle::from_degrees(self.tilt_deg).map_err(|error| error.named("tilt_deg"))?;
            let Complex64 { re: cos, im: sin } = cis_degrees(self.tilt_deg);
            return Ok(Matrix3::new(cos, sin, 0.0, -sin, cos, 0.0, 0.0, 0.0, 1.0));
        };
        if self.tilt_deg != 0.0 {
            let hint = "is given beside axes: leave out one of them";
            return Err(Error::figure("tilt_deg", self.tilt_deg, hint));
        }
        orthonormal(rows)
    }

    /// Dynamic stiffness along its axes without loss, of a table the static one.
    #[must_use]
    pub fn in_motion(&self) -> [f64; 3] {
        self.dynamic_stiffness.unwrap_or(self.stiffness)
    }

    fn check_snubbers(&self) -> Result<()> {
        for (name, figures) in [("gap", self.gap), ("snubber_stiffness", self.snubber_stiffness)] {
            let places = (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]);
            let wrong = |&(axis, side): &(usize, usize)| {
                limits::not_negative("", figures[axis][side]).is_err()
            };
            if let Some((axis, side)) = places.into_iter().find(wrong) {
                limits::not_negative(&format!("{name}[{axis}][{side}]"), figures[axis][side])?;
            }
        }
        Ok(())
    }

    /// Stiffness about its axes, if it has any.
    fn rotation(&self) -> Result<Option<Dynamic>> {
        let figures = [
            ("rotational_stiffness", self.rotational_stiffness),
            ("rotational_loss_factor", self.rotational_loss_factor),
            ("rotational_damping", self.rotational_damping),
        ];
        for (name, about) in figures {
            if let Some((axis, wrong)) =
                (0..).zip(about).find(|(_, v)| limits::not_negative("", *v).is_err())
            {
                limits::not_negative(&format!("{name}[{axis}]"), wrong)?;
            }
        }
        let [(_, stiffness), (_, loss_factor), (_, damping)] = figures;
        let is_none = stiffness == [0.0; 3] && damping == [0.0; 3];
        let about = Dynamic::Constant { stiffness, loss_factor, damping, track: None };
        Ok((!is_none).then_some(about))
    }

    fn dynamic(&self) -> Result<Dynamic> {
        let Some(table) = &self.table else {
            return Ok(Dynamic::Constant {
                stiffness: self.in_motion(),
                loss_factor: self.loss_factor,
                damping: self.damping,
                track: self.track,
            });
        };
        let figures = [
            ("dynamic_stiffness", self.dynamic_stiffness.is_some()),
            ("loss_factor", self.loss_factor != [0.0; 3]),
            ("damping", self.damping != [0.0; 3]),
            ("track", self.track.is_some()),
        ];
        if let Some((name, _)) = figures.into_iter().find(|(_, is_given)| *is_given) {
            let hint =
                "the table has the whole dynamic stiffness and its loss: leave out one of them";
            return Err(Error::value(name, "given beside a table", hint));
        }
        Ok(Dynamic::Table(table.clone()))
    }
}

/// Three directions at exact right angles, from ones that are to a few digits.
fn orthonormal(rows: &[[f64; 3]; 3]) -> Result<Matrix3<f64>> {
    let axes = Matrix3::from_fn(|row, column| rows[row][column]);
    let skew = (axes * axes.transpose() - Matrix3::identity()).amax();
    if skew.is_nan() || skew > SKEW_BY_TYPING {
        let hint = "give three rows of length 1 at right angles to each other: the directions of the \
                    mount's first, second and third axis";
        return Err(Error::value("axes", format!("{rows:?}"), hint));
    }
    let first = axes.row(0).transpose().normalize();
    let second = axes.row(1).transpose();
    let second = (second - first * first.dot(&second)).normalize();
    let third = first.cross(&second);
    // A third axis of the other sense is the same axis.
    let third = if third.dot(&axes.row(2).transpose()) < 0.0 { -third } else { third };
    Ok(Matrix3::from_rows(&[first.transpose(), second.transpose(), third.transpose()]))
}

/// Motion of a point that is this far from the CG, of (displacement of the CG, rotation): u + φ × arm.
#[must_use]
pub fn motion_of_point(arm: &Vector3<f64>) -> Matrix3x6<f64> {
    let mut motion = Matrix3x6::zeros();
    motion.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
    motion.fixed_view_mut::<3, 3>(0, 3).copy_from(&-arm.cross_matrix());
    motion
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figures() -> MountFigures {
        MountFigures { stiffness: [1e5; 3], ..MountFigures::default() }
    }

    fn along(rows: [[f64; 3]; 3]) -> Result<Mount> {
        Mount::new(MountFigures { axes: Some(rows), ..figures() })
    }

    #[test]
    fn axes_are_made_exact_and_others_rejected() {
        let axes = [[0.707, 0.707, 0.0], [-0.707, 0.707, 0.0], [0.0, 0.0, -1.0]];
        let made = along(axes).unwrap().axes();
        let product = made * made.transpose();
        assert!((product - Matrix3::identity()).amax() < 1e-15);
        assert!((made[(2, 2)] + 1.0).abs() < 1e-15);
        let axes = [[1.0, 0.0, 0.0], [0.1, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let error = along(axes).unwrap_err().to_string();
        assert!(error.starts_with("axes = ") && error.contains("at right angles"), "{error}");
        assert!(along([[f64::NAN; 3]; 3]).is_err());
        let turned = Mount::new(MountFigures { tilt_deg: 90.0, ..figures() }).unwrap().axes();
        assert_eq!(turned.row(0).transpose(), Vector3::y());
        let error = Mount::new(MountFigures { tilt_deg: f64::NAN, ..figures() }).unwrap_err();
        assert!(error.to_string().starts_with("tilt_deg = NaN"));
    }

    #[test]
    fn dynamic_stiffness_is_the_static_one_a_figure_or_a_table() {
        let mount = Mount::new(figures()).unwrap();
        let at_rest = mount.stiffness_at(10.0, String::new).unwrap();
        assert_eq!(at_rest, [Complex64::new(1e5, 0.0); 3]);
        let dynamic_stiffness = Some([1.3e5; 3]);
        let mount = Mount::new(MountFigures { dynamic_stiffness, ..figures() }).unwrap();
        assert_eq!(mount.stiffness_at(10.0, String::new).unwrap()[0].re, 1.3e5);
        assert_eq!(mount.static_stiffness(), [1e5; 3]);
        let stiffness = vec![[Complex64::new(1e5, 1e4); 3]; 2];
        let table = Some(Table { frequency: vec![1.0, 2.0], stiffness });
        let named = MountFigures { name: "rear".into(), table: table.clone(), ..figures() };
        let error = Mount::new(named)
            .unwrap()
            .stiffness_at(std::f64::consts::TAU * 50.0, || "order 2 at 1500 rpm".into());
        let said = "table of mount \"rear\" = 50.000000 Hz: order 2 at 1500 rpm, is outside: it has 1 to 2 Hz";
        assert!(error.unwrap_err().to_string().starts_with(said));
        let both = MountFigures { table, loss_factor: [0.1; 3], ..figures() };
        let error = Mount::new(both).unwrap_err().to_string();
        assert!(error.starts_with("loss_factor = given beside a table"), "{error}");
    }

    #[test]
    fn a_point_moves_with_the_cg_and_about_it() {
        let arm = Vector3::new(0.1, -0.2, 0.3);
        let [shift, turn] = [Vector3::new(1.0, 2.0, 3.0), Vector3::new(-0.4, 0.5, 0.6)];
        let both = nalgebra::Vector6::new(1.0, 2.0, 3.0, -0.4, 0.5, 0.6);
        let moved = motion_of_point(&arm) * both;
        assert!((moved - (shift + turn.cross(&arm))).amax() < 1e-15);
    }
}
