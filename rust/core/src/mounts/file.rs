//! The entry of an engine file for a body and its mounts.

use serde::{Deserialize, Serialize};

use super::{
    InertiaTrack, Mount, MountFigures, Orientation, Powertrain, Products, RigidBody, Table,
};
use crate::Complex64;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;

#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(crate) struct PowertrainEntry {
    body: BodyEntry,
    mounts: Vec<MountEntry>,
}

#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct BodyEntry {
    mass: f64,
    cg: [f64; 3],
    inertia: [[f64; 3]; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    products: Option<String>,
}

#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct MountEntry {
    name: String,
    at: [f64; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    tilt_deg: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    axes: Option<[[f64; 3]; 3]>,
    stiffness: [f64; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    dynamic_stiffness: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "is_zero")]
    loss_factor: [f64; 3],
    #[serde(default, skip_serializing_if = "is_zero")]
    damping: [f64; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    track: Option<InertiaTrack>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    table: Option<TableEntry>,
}

#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct TableEntry {
    frequency: Vec<f64>,
    real: Vec<[f64; 3]>,
    imaginary: Vec<[f64; 3]>,
}

fn is_zero(values: &[f64; 3]) -> bool {
    *values == [0.0; 3]
}

impl Products {
    /// The convention of a name.
    pub fn named(name: &str) -> Result<Self> {
        match name {
            "tensor" => Ok(Self::Tensor),
            "positive-integrals" => Ok(Self::PositiveIntegrals),
            other => {
                let hint =
                    "give \"tensor\" for -∫xy dm off the diagonal, or \"positive-integrals\"";
                Err(Error::value("products", format!("{other:?}"), hint))
            }
        }
    }
}

impl PowertrainEntry {
    pub fn of(powertrain: &Powertrain) -> Self {
        let body = powertrain.body();
        let inertia = body.inertia();
        let has_products = inertia != nalgebra::Matrix3::from_diagonal(&inertia.diagonal());
        Self {
            body: BodyEntry {
                mass: body.mass(),
                cg: body.cg().into(),
                inertia: [0, 1, 2].map(|i| [0, 1, 2].map(|j| inertia[(i, j)])),
                products: has_products.then(|| "tensor".into()),
            },
            mounts: powertrain
                .mounts()
                .iter()
                .map(|mount| MountEntry::of(mount.figures()))
                .collect(),
        }
    }

    pub fn powertrain(self) -> Result<Powertrain> {
        let BodyEntry { mass, cg, inertia, products } = self.body;
        let products = products.map(|name| Products::named(&name)).transpose();
        let body = products.and_then(|products| RigidBody::new(mass, cg, inertia, products));
        let body = body.map_err(|error| error.within("powertrain.body."))?;
        let mount = |(k, entry): (usize, MountEntry)| {
            let mount = entry.figures().and_then(Mount::new);
            mount.map_err(|error| error.within(&format!("powertrain.mounts[{k}].")))
        };
        let mounts = self.mounts.into_iter().enumerate().map(mount).collect::<Result<_>>()?;
        Powertrain::new(body, mounts).map_err(|error| error.within("powertrain."))
    }
}

impl MountEntry {
    fn of(figures: &MountFigures) -> Self {
        let (tilt_deg, axes) = match figures.orientation {
            Orientation::Tilt(0.0) => (None, None),
            Orientation::Tilt(degrees) => (Some(degrees), None),
            Orientation::Axes(axes) => (None, Some(axes)),
        };
        let table = figures.table.as_ref().map(|table| {
            let parts = |part: fn(&Complex64) -> f64| {
                table.stiffness.iter().map(|along| along.each_ref().map(part)).collect()
            };
            let frequency = table.frequency.clone();
            TableEntry { frequency, real: parts(|k| k.re), imaginary: parts(|k| k.im) }
        });
        Self {
            name: figures.name.clone(),
            at: figures.at,
            tilt_deg,
            axes,
            stiffness: figures.stiffness,
            dynamic_stiffness: figures.dynamic_stiffness,
            loss_factor: figures.loss_factor,
            damping: figures.damping,
            track: figures.track,
            table,
        }
    }

    fn figures(self) -> Result<MountFigures> {
        let orientation = match (self.tilt_deg, self.axes) {
            (Some(degrees), Some(_)) => {
                let hint = "is given beside axes: leave out one of them";
                return Err(Error::figure("tilt_deg", degrees, hint));
            }
            (degrees, None) => Orientation::Tilt(degrees.unwrap_or(0.0)),
            (None, Some(axes)) => Orientation::Axes(axes),
        };
        let table = |TableEntry { frequency, real, imaginary }: TableEntry| {
            let (name, of) = ("table.imaginary", "table.real");
            limits::same_length(name, imaginary.len(), of, real.len(), "frequency")?;
            let complex = |(re, im): ([f64; 3], [f64; 3])| {
                [0, 1, 2].map(|axis| Complex64::new(re[axis], im[axis]))
            };
            Ok(Table {
                frequency,
                stiffness: real.into_iter().zip(imaginary).map(complex).collect(),
            })
        };
        Ok(MountFigures {
            name: self.name,
            at: self.at,
            orientation,
            stiffness: self.stiffness,
            dynamic_stiffness: self.dynamic_stiffness,
            loss_factor: self.loss_factor,
            damping: self.damping,
            track: self.track,
            table: self.table.map(table).transpose()?,
        })
    }
}
